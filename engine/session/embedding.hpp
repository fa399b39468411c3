#pragma once

#include "session/access.hpp"
#include "session/engine_impl.hpp"
#include "session/frame_graph.hpp"

#include <functional>

namespace catoptric::session {

/// Access to the device of an engine and to the graph of a frame. embed/ adds passes to frames.
/// Tuning chooses other shaders from the next frame on; Engine::device does not report this choice.
struct EmbedAccess {
    static void choose_variants(Engine& engine, const gpu::VariantChoices& choices) {
        Access::impl(engine).device.set_variant_choices(choices);
    }
    static gpu::Device& device(const Engine& engine) { return Access::impl(engine).device; }
    static Frame submit(Session& session, const FrameSpec& spec,
                        const std::function<void(FrameGraph&)>& finish) {
        return Access::render_frame(session, spec, {}, [&](FrameGraph& frame) {
            finish(frame);
            return graph::ExternalSemaphores{};
        });
    }
};

} // namespace catoptric::session
