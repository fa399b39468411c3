#pragma once

#include "session/engine_impl.hpp"
#include "session/frame_graph.hpp"
#include "session/session.hpp"

#include <functional>
#include <memory>

namespace catoptric::app {

/// Internal access to engines and sessions. embed/ makes an engine on a given device, and adds
/// passes to frames. Tuning chooses other shaders from the next frame on; Engine::device does not
/// report this choice. Other code reads the device itself.
struct Embedding {
    static Engine make(const EngineOptions& options, const gpu::GivenDevice& given) {
        return Engine(options, given);
    }
    static void choose(Engine& engine, const gpu::Choices& choices) {
        engine.impl_->device.choose(choices);
    }
    static gpu::Device& device(const Engine& engine) { return engine.impl_->device; }
    static Frame submit(Session& session, const FrameSpec& spec,
                        const std::function<void(FrameGraph&)>& finish) {
        return session.submit(spec, [&](FrameGraph& frame) {
            finish(frame);
            return graph::ExternalSync{};
        });
    }
};

} // namespace catoptric::app
