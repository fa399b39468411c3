#include "measure/picture.hpp"

#include "measure/display.hpp"
#include "measure/srgb.hpp"

#include <cmath>

namespace catoptric::measure {

vec3 apply_exposure(const vec3& pixel, double exposure_stops) {
    return vec3(std::exp2(exposure_stops) * dvec3(pixel));
}

Picture apply_exposure(Picture picture, double exposure_stops) {
    if (exposure_stops == 0) return picture;
    for (vec3& pixel : picture.pixels) pixel = apply_exposure(pixel, exposure_stops);
    return picture;
}

namespace {

/// Writes the picture as displayed. `curve` gets values between 0 and 1.
template <typename Curve>
void write_display_rows(const Picture& picture, double exposure_stops, Picture& display,
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

void convert_to_display(const Picture& picture, double exposure_stops, bool is_rounded,
                        Picture& display) {
    if (is_rounded)
        write_display_rows(picture, exposure_stops, display, SrgbEncoder::instance());
    else
        write_display_rows(picture, exposure_stops, display, srgb_from_linear);
}

Picture to_display(const Picture& picture, double exposure_stops) {
    Picture display;
    convert_to_display(picture, exposure_stops, true, display);
    return display;
}

Picture to_unrounded_display(const Picture& picture, double exposure_stops) {
    Picture display;
    convert_to_display(picture, exposure_stops, false, display);
    return display;
}

} // namespace catoptric::measure
