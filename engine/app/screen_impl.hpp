#pragma once

#include "app/engine_impl.hpp"
#include "app/frame_graph.hpp"
#include "app/screen.hpp"
#include "gpu/swapchain.hpp"
#include "graph/physical.hpp"

#include <array>

// What a screen is made of, for screen.cpp alone.
namespace catoptric::app {

struct Screen::Impl {
    explicit Impl(Engine::Impl& engine);
    ~Impl();
    /// Nothing: the window has changed.
    std::optional<std::uint32_t> acquire();
    bool present(); ///< false: likewise
    /// Adds the pass that draws `showing` into the image that was acquired; what it reads is
    /// written now. `slot`: which of the buffers; no frame that reads them is in flight.
    void add(FrameGraph& frame, const FrameSpec& spec, const Showing& showing, std::size_t slot);

    /// What one frame in flight reads.
    struct Slot {
        gpu::Buffer vertices, indices, canvas;
        const graph::Runner* runner = nullptr; ///< and by whose frame
        graph::Ticket ticket;
    };

    gpu::Device& device;
    gpu::Swapchain swapchain;
    std::vector<graph::Physical> images; ///< of the swapchain
    gpu::Buffer font;
    uvec2 font_size{1, 1};
    std::array<Slot, 3> slots;
    std::size_t next_slot = 0;
    std::uint32_t image = 0; ///< that was acquired last
    uvec2 window{0, 0};
    bool fits = false;
    double acquire_ms = 0, present_ms = 0;
};

} // namespace catoptric::app
