// Manages a window's images, and draws a frame's pictures into one of them.
#include "session/screen_impl.hpp"

#include "core/stopwatch.hpp"
#include "session/access.hpp"
#include "session/session_impl.hpp"
#include "shared.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace catoptric::session {

namespace {

/// Packs a picture of values from 0 to 1 into four bytes per pixel.
std::vector<std::uint32_t> pack_rgba8(const measure::Picture& display) {
    std::vector<std::uint32_t> words(display.pixels.size());
    std::ranges::transform(display.pixels, words.begin(), [](const vec3& pixel) {
        std::uint32_t word = 0xFF000000;
        for (int c = 0; c < 3; ++c)
            word |= static_cast<std::uint32_t>(std::lround(std::clamp(pixel[c], 0.f, 1.f) * 255))
                    << (8 * c);
        return word;
    });
    return words;
}

/// Writes data into a buffer. The buffer grows to a power of two, so that changing sizes seldom
/// need a new buffer.
template <typename T>
void write_growing(gpu::Device& device, gpu::Buffer& buffer, const std::string& name,
                   const std::vector<T>& data, gpu::BufferUsage use) {
    const std::uint64_t bytes = data.size() * sizeof(T);
    if (buffer.bytes() < bytes || !buffer.handle())
        buffer = gpu::Buffer(device, name, std::bit_ceil(bytes), use);
    buffer.write(std::span<const T>(data));
}

} // namespace

WindowScreen::Impl::Impl(Access::EngineImpl& engine)
    : device(engine.device), swapchain(engine.device),
      font(device, "font", 4, gpu::BufferUsage::plain) {}

WindowScreen::Impl::~Impl() {
    if (device.is_abandoned()) return;
    try {
        swapchain.wait_idle();
    } catch (const std::exception&) {
        // The device is abandoned by now, and none of its objects are destroyed.
    }
}

WindowScreen::WindowScreen(Engine& engine) : impl_(std::make_unique<Impl>(Access::impl(engine))) {}
WindowScreen::~WindowScreen() = default;

bool WindowScreen::lost() const { return impl_->swapchain.is_surface_lost(); }
uvec2 WindowScreen::size() const { return impl_->swapchain.size(); }
double WindowScreen::acquire_ms() const { return impl_->acquire_ms; }
double WindowScreen::present_ms() const { return impl_->present_ms; }

bool WindowScreen::fit(uvec2 window) {
    Impl& self = *impl_;
    if (self.fits && window == self.window) return true;
    self.fits = false;
    if (window.x == 0 || window.y == 0) return false;
    self.swapchain.wait_idle();
    self.images.clear();
    if (!self.swapchain.create_images(window)) return false;
    self.window = window;
    const uvec2 size = self.swapchain.size();
    for (const auto image : self.swapchain.images())
        self.images.push_back(
            graph::wrap_image({"window", self.swapchain.texel_format(), size.x, size.y}, image));
    self.fits = true;
    return true;
}

void WindowScreen::set_font(uvec2 size, const std::vector<std::uint8_t>& coverage) {
    Impl& self = *impl_;
    check(coverage.size() == std::size_t{size.x} * size.y && !coverage.empty(), Failure::usage,
          "a font's picture of ", size.x, "x", size.y, " texels has ", coverage.size(), " bytes");
    self.swapchain.wait_idle();
    self.font_size = size;
    std::vector<std::uint8_t> padded = coverage; // padded to whole words
    padded.resize((padded.size() + 3) / 4 * 4);
    gpu::upload(self.device, self.font, "font", padded, gpu::BufferUsage::plain);
}

Frame Access::show(Session& session, const FrameSpec& spec, WindowScreen& screen,
                   const WindowPictures& showing) {
    WindowScreen::Impl& onto = *screen.impl_;
    check(onto.fits, Failure::internal,
          "a frame is shown on a screen that does not fit its window");
    graph::GraphRunner& runner = session.impl_->runner;
    const std::size_t index = std::exchange(onto.next_slot,
                                            (onto.next_slot + 1) % onto.slots.size());
    WindowScreen::Impl::FrameBuffers& slot = onto.slots[index];
    if (slot.runner == &runner && !runner.has_ended(slot.ticket)) runner.wait_for(slot.ticket);
    std::optional<std::uint32_t> image;
    onto.fits = false; // after a refused frame, the image is returned when all images are made
                       // again
    Frame frame = render_frame(session, spec, {}, [&](FrameGraph& graph) {
        image = onto.acquire();
        if (!image) return graph::ExternalSemaphores{};
        onto.add(graph, spec, showing, index);
        return graph::ExternalSemaphores{onto.swapchain.acquired_semaphore(),
                                         onto.swapchain.rendered_semaphore(*image)};
    });
    slot.runner = &runner, slot.ticket = frame.impl_->ticket;
    onto.fits = image && onto.present();
    return frame;
}

std::optional<std::uint32_t> WindowScreen::Impl::acquire() {
    const SteadyClock::time_point begin = SteadyClock::now();
    const std::optional<std::uint32_t> acquired = swapchain.acquire_image();
    acquire_ms = ms_since(begin);
    image = acquired.value_or(0);
    return acquired;
}

bool WindowScreen::Impl::present() {
    const SteadyClock::time_point begin = SteadyClock::now();
    const bool is_presented = swapchain.present_image(image);
    present_ms = ms_since(begin);
    return is_presented;
}

void WindowScreen::Impl::add(FrameGraph& frame, const FrameSpec& spec,
                             const WindowPictures& showing, std::size_t index) {
    using graph::ImageHandle;
    FrameBuffers& slot = slots[index];
    const WindowOverlay& overlay = showing.overlay;
    // The first three indices belong to the triangle that covers the whole window.
    std::vector<std::uint32_t> indices{0, 1, 2};
    indices.insert(indices.end(), overlay.indices.begin(), overlay.indices.end());
    write_growing(device, slot.vertices, "overlay.vertices", overlay.vertices,
                  gpu::BufferUsage::vertex);
    write_growing(device, slot.indices, "overlay.indices", indices, gpu::BufferUsage::index);
    std::vector<std::uint32_t> canvas{0};
    if (showing.canvas) canvas = pack_rgba8(*showing.canvas);
    write_growing(device, slot.canvas, "canvas", canvas, gpu::BufferUsage::plain);

    const uvec2 size = swapchain.size();
    const auto picture = [&](std::size_t part) {
        return frame.parts.at(part == WindowPictures::kCanvasPicture ? 0 : part).outputs.display;
    };
    const ImageHandle first = picture(showing.first), second = picture(showing.second);
    const shared::ScreenParameters screening{
        spec.size, static_cast<std::uint32_t>(showing.kind),
        (showing.first == WindowPictures::kCanvasPicture ? 1u : 0u) |
            (showing.second == WindowPictures::kCanvasPicture ? 2u : 0u),
        showing.divider, showing.gain};
    const ImageHandle target = frame.graph.import_resource(
        {"window", swapchain.texel_format(), size.x, size.y}, &images.at(image), std::nullopt,
        graph::ResourceUse::present);
    graph::PassBuilder pass = frame.graph.add_pass("window");
    pass.reads(first, graph::ResourceUse::sampled);
    if (!(second == first)) pass.reads(second, graph::ResourceUse::sampled);
    pass.writes(target, graph::ResourceUse::colour, graph::ClearValue{0, 0, 0, 1})
        .record([&slot, this, first, second, screening, size,
                 draws = overlay.draws](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::RasterState{"screen.vert", "screen.frag", {}});
            commands.bind("first", first);
            commands.bind("second", second);
            commands.bind("Canvas", slot.canvas);
            commands.push_constants(screening);
            commands.bind_geometry(slot.vertices, slot.indices);
            commands.draw(0, 3);
            if (draws.empty()) return;
            commands.bind_pipeline(gpu::RasterState{.vertex = "overlay.vert",
                                                    .fragment = "overlay.frag",
                                                    .blending = gpu::Blending::cover});
            commands.bind("Corners", slot.vertices);
            commands.bind("Font", font);
            commands.push_constants(shared::OverlayParameters{size, font_size});
            for (const WindowOverlay::DrawRange& draw : draws) {
                const auto [x, y, width, height] = draw.area;
                if (x >= size.x || y >= size.y) continue;
                commands.set_scissor(
                    {x, y, std::min(width, size.x - x), std::min(height, size.y - y)});
                commands.draw(3 + draw.first, draw.count);
            }
        });
}

} // namespace catoptric::session
