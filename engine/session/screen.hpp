#pragma once

#include "session/access.hpp"

#include <array>

/// Images that a window's system shows. Access::show draws into them.
namespace catoptric::session {

/// Triangles over a picture, such as controls and text.
struct WindowOverlay {
    struct Vertex {
        vec2 position;            ///< pixels of the window from its upper left corner
        vec2 uv;                  ///< position in the picture of the font, each coordinate 0 to 1
        std::uint32_t colour = 0; ///< r | g << 8 | b << 16 | a << 24, as the screen shows them
    };
    /// Consecutive indices, whose triangles are clipped to an area.
    struct DrawRange {
        std::uint32_t first = 0, count = 0;
        std::array<std::uint32_t, 4> area{}; ///< x, y, width, height, pixels within the window
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<DrawRange> draws;
};

/// The pictures of a frame that a window shows. They start in the window's upper left corner, and
/// one pixel of a picture covers one pixel of the window.
struct WindowPictures {
    enum class Arrangement {
        one,   ///< shows the first picture
        split, ///< the first picture left of the divider, the second picture right of the divider
        difference ///< difference of the displayed pictures, times `gain`
    };
    static constexpr std::size_t kCanvasPicture = ~std::size_t{0};

    Arrangement kind = Arrangement::one;
    std::size_t first = 0, second = 0; ///< index of a part of the frame, or kCanvasPicture
    float divider = 0;                 ///< pixels from the left
    float gain = 1;
    /// Picture of the caller, of the frame's size, encoded as by measure::to_display; null: none.
    std::shared_ptr<const measure::Picture> canvas;
    WindowOverlay overlay;
};

/// Images of one window. The engine must have been made with EngineHooks::make_surface. The
/// engine must outlive the screen, and the screen must outlive frames shown on it. A window has one
/// screen.
class WindowScreen {
public:
    /// Throws `no_device` if the window accepts no images that the engine can draw.
    explicit WindowScreen(Engine& engine);
    ~WindowScreen();
    WindowScreen(const WindowScreen&) = delete;
    WindowScreen& operator=(const WindowScreen&) = delete;

    /// Adapts the images to the size of the window; call it before each frame. Makes the images
    /// again if the size changed or they no longer fit. Returns false if nothing can be shown (the
    /// window is minimised).
    bool fit(uvec2 window);
    /// Returns whether the window's surface is lost. If it is, make another engine and screen.
    bool lost() const;
    uvec2 size() const; ///< size of the images, pixels
    /// Sets the picture of letters that overlays use: coverage, one byte per texel, row by row.
    /// Waits for the device.
    void set_font(uvec2 size, const std::vector<std::uint8_t>& coverage);

    /// Returns milliseconds of the last shown frame: `acquire_ms` for the wait for a free image,
    /// and `present_ms` for presenting. With a software driver, presenting includes the wait until
    /// the picture is drawn.
    double acquire_ms() const;
    double present_ms() const;

private:
    friend struct Access;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace catoptric::session
