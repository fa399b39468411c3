#pragma once

#include "gpu/swapchain.hpp"
#include "graph/physical.hpp"
#include "session/engine_impl.hpp"
#include "session/frame_graph.hpp"
#include "session/screen.hpp"

#include <array>

// Implementation of WindowScreen, only for screen.cpp.
namespace catoptric::session {

struct WindowScreen::Impl {
    explicit Impl(Access::EngineImpl& engine);
    ~Impl();
    /// Acquires an image. Returns nothing if the window has changed.
    std::optional<std::uint32_t> acquire();
    bool present(); ///< returns false if the window has changed
    /// Adds the pass that draws `showing` into the acquired image, and writes the data that the
    /// pass reads. `slot`: index of the buffers to write, which no frame in flight may read.
    void add(FrameGraph& frame, const FrameSpec& spec, const WindowPictures& showing,
             std::size_t slot);

    /// Buffers that one frame in flight reads.
    struct FrameBuffers {
        gpu::Buffer vertices, indices, canvas;
        const graph::GraphRunner* runner = nullptr; ///< runner of the frame that reads them
        graph::FrameTicket ticket;
    };

    gpu::Device& device;
    gpu::Swapchain swapchain;
    std::vector<graph::PhysicalImage> images; ///< images of the swapchain
    gpu::Buffer font;
    uvec2 font_size{1, 1};
    std::array<FrameBuffers, 3> slots;
    std::size_t next_slot = 0;
    std::uint32_t image = 0; ///< index of the image acquired last
    uvec2 window{0, 0};
    bool fits = false;
    double acquire_ms = 0, present_ms = 0;
};

} // namespace catoptric::session
