#include "measure/picture.hpp"

#include "measure/display.hpp"
#include "measure/srgb.hpp"

#include <cmath>

namespace catoptric::measure {

vec3 exposed(const vec3& pixel, double exposure_stops) {
    return vec3(std::exp2(exposure_stops) * dvec3(pixel));
}

Picture exposed(Picture picture, double exposure_stops) {
    if (exposure_stops == 0) return picture;
    for (vec3& pixel : picture.pixels) pixel = exposed(pixel, exposure_stops);
    return picture;
}

namespace {

/// Writes the picture as displayed. `curve` gets values between 0 and 1.
template <typename Curve>
void write_displayed(const Picture& picture, double exposure_stops, Picture& display,
                     const Curve& curve) {
    const double gain = std::exp2(exposure_stops);
    const auto shown = [&](float linear) {
        const double value = gain * static_cast<double>(linear);
        if (!(value > 0)) return 0.0F; // NaN falls here
        if (value >= 1) return 1.0F;
        return static_cast<float>(curve(value));
    };
    display.width = picture.width, display.height = picture.height;
    display.pixels.resize(picture.pixels.size());
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const vec3& pixel = picture.pixels[i];
        display.pixels[i] = vec3(shown(pixel.x), shown(pixel.y), shown(pixel.z));
    }
}

} // namespace

void write_display(const Picture& picture, double exposure_stops, bool is_rounded,
                   Picture& display) {
    if (is_rounded)
        write_displayed(picture, exposure_stops, display, EightBitCurve::get());
    else
        write_displayed(picture, exposure_stops, display, srgb_from_linear);
}

Picture to_display(const Picture& picture, double exposure_stops) {
    Picture display;
    write_display(picture, exposure_stops, true, display);
    return display;
}

Picture to_unrounded_display(const Picture& picture, double exposure_stops) {
    Picture display;
    write_display(picture, exposure_stops, false, display);
    return display;
}

} // namespace catoptric::measure
