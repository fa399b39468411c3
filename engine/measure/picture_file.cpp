#include "measure/picture_file.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_codec.hpp"
#include "measure/srgb.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace catoptric::measure {
namespace {

constexpr std::uint64_t kMostValues = std::uint64_t{1} << 29; // 2 GiB of float

/// A picture as it is in the file.
struct Raw {
    bool is_png = false;
    ImageShape shape;
    std::array<std::size_t, 3> rgb = {}; ///< which channels; the same one three times for grey
    std::vector<float> values;

    float value(std::size_t pixel, std::size_t c) const {
        return values[pixel * shape.channel_count + rgb[c]];
    }
};

/// Where R, G and B are; a picture without them is grey in its first channel.
std::array<std::size_t, 3> find_rgb(const std::vector<std::string>& channels) {
    std::array<std::size_t, 3> rgb = {0, 0, 0};
    constexpr std::array<const char*, 3> kNames = {"R", "G", "B"};
    for (std::size_t c = 0; c < rgb.size(); ++c) {
        const auto at = std::ranges::find(channels, kNames[c]);
        if (at == channels.end()) return {0, 0, 0};
        rgb[c] = static_cast<std::size_t>(at - channels.begin());
    }
    return rgb;
}

/// By the first bytes, not by the name.
Raw decode(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    const std::string name = path.string(), format = image_format(bytes);
    check(format == "openexr" || format == "hdr" || format == "png", Failure::bad_data, name,
          ": wanted an OpenEXR, Radiance or PNG picture, found ", bytes.size(),
          " bytes of something else");
    ImageReader reader(bytes, format, name);
    Raw raw{.is_png = format == "png", .shape = reader.shape()};
    const auto& [size, channel_count, channels] = raw.shape;
    check(std::uint64_t(size.x) * size.y * channel_count <= kMostValues, Failure::bad_data, name,
          ": wanted at most ", kMostValues, " values, found ", size.x, "x", size.y, " with ",
          channel_count, " channels");
    raw.rgb = find_rgb(channels);
    raw.values = reader.floats();
    return raw;
}

ImageShape shape_of(const Picture& picture) {
    return {{static_cast<std::uint32_t>(std::max(picture.width, 0)),
             static_cast<std::uint32_t>(std::max(picture.height, 0))},
            3,
            {}};
}

} // namespace

Picture read_picture(const std::filesystem::path& path) {
    const Raw raw = decode(path);
    Picture picture(static_cast<int>(raw.shape.size.x), static_cast<int>(raw.shape.size.y));
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        vec3 pixel(raw.value(i, 0), raw.value(i, 1), raw.value(i, 2));
        if (raw.is_png)
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<float>(linear_from_srgb(static_cast<double>(pixel[c])));
        picture.pixels[i] = pixel;
    }
    return picture;
}

Mask read_mask(const std::filesystem::path& path, int width, int height) {
    const Raw raw = decode(path);
    check(raw.is_png, Failure::bad_data, path.string(),
          ": wanted a PNG as mask, found OpenEXR or Radiance");
    const ivec2 size(raw.shape.size);
    check(size == ivec2(width, height), Failure::bad_data, path.string(), ": wanted a mask of ",
          width, "x", height, " as the pictures, found ", size.x, "x", size.y);
    Mask mask(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (raw.value(i, 0) > 0 || raw.value(i, 1) > 0 || raw.value(i, 2) > 0) mask[i] = 255;
    return mask;
}

std::string exr_bytes(const Picture& picture) {
    std::vector<float> values;
    values.reserve(3 * picture.pixels.size());
    for (const vec3& pixel : picture.pixels)
        values.insert(values.end(), {pixel.x, pixel.y, pixel.z});
    return openexr_bytes(shape_of(picture), values);
}

std::string png_bytes(const Picture& display) {
    const auto byte = [](float value) {
        if (!(value > 0)) return std::uint8_t{0}; // NaN falls here
        return static_cast<std::uint8_t>(std::lround(std::min(value, 1.0F) * 255));
    };
    std::vector<std::uint8_t> values;
    values.reserve(3 * display.pixels.size());
    for (const vec3& pixel : display.pixels)
        values.insert(values.end(), {byte(pixel.x), byte(pixel.y), byte(pixel.z)});
    return catoptric::png_bytes(shape_of(display), values);
}

void write_exr(const Picture& picture, const std::filesystem::path& path) {
    write_file(path, exr_bytes(picture));
}

void write_png(const Picture& display, const std::filesystem::path& path) {
    write_file(path, png_bytes(display));
}

} // namespace catoptric::measure
