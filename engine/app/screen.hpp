#pragma once

#include "app/session.hpp"

#include <array>

/// A window as the engine sees it: images that its system shows. Session::show draws into them.
namespace catoptric::app {

/// Triangles over a picture, such as controls and text.
struct Overlay {
    struct Vertex {
        vec2 position;            ///< pixels of the window from its upper left corner
        vec2 uv;                  ///< in the font's picture, 0 to 1
        std::uint32_t colour = 0; ///< r | g << 8 | b << 16 | a << 24, as the screen shows them
    };
    /// Consecutive indices, drawn within an area only.
    struct Draw {
        std::uint32_t first = 0, count = 0;
        std::array<std::uint32_t, 4> area{}; ///< x, y, width, height, pixels within the window
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<Draw> draws;
};

/// What a window shows of a frame, in its upper left corner, a pixel for a pixel.
struct Showing {
    enum class Kind {
        one,       ///< the first picture
        split,     ///< the first left of the divider, the second right of it
        difference ///< of what the screen shows of both, times `gain`
    };
    static constexpr std::size_t kCanvas = ~std::size_t{0};

    Kind kind = Kind::one;
    std::size_t first = 0, second = 0; ///< parts of the frame, or the canvas
    float divider = 0;                 ///< pixels from the left
    float gain = 1;
    /// A picture of the caller's, of the frame's size, as measure::to_display has them; null: none.
    std::shared_ptr<const measure::Picture> canvas;
    Overlay overlay;
};

/// The images of a window: of an engine that was made with EngineOptions::make_surface, which must
/// outlive it, as it must outlive frames that were shown on it. One a window.
class Screen {
public:
    /// Throws `no_device` where the window takes no pictures that the engine could draw.
    explicit Screen(Engine& engine);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// Says how large the window is now, before each frame; the images are made anew where they
    /// are not so, or no longer fit. False: nothing can be shown (the window is minimised).
    bool fit(uvec2 window);
    /// The window's surface is gone: make another engine and screen.
    bool lost() const;
    uvec2 size() const; ///< of its images
    /// The picture of letters that overlays use: coverage, a byte a texel, row after row. Waits
    /// for the device.
    void set_font(uvec2 size, const std::vector<std::uint8_t>& coverage);

    /// Of the last frame that was shown: the host stood still until an image was free, and handed
    /// the picture over (where a software driver waits until it is drawn).
    double acquire_ms() const;
    double present_ms() const;

private:
    friend class Session;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace catoptric::app
