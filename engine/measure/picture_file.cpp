#include "measure/picture_file.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "measure/srgb.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <string_view>

namespace catoptric::measure {
namespace {

constexpr int kLargestSide = 1 << 16;
constexpr OIIO::imagesize_t kMostValues = OIIO::imagesize_t{1} << 29; // 2 GiB of float

enum class Kind { exr, hdr, png, other };

/// By the first bytes, not by the name.
Kind kind_of(std::string_view bytes) {
    if (bytes.starts_with("\x76\x2f\x31\x01")) return Kind::exr;
    if (bytes.starts_with("#?RADIANCE") || bytes.starts_with("#?RGBE")) return Kind::hdr;
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return Kind::png;
    return Kind::other;
}

/// A picture as it is in the file.
struct Raw {
    Kind kind = Kind::other;
    int width = 0;
    int height = 0;
    std::size_t channel_count = 0;
    std::array<std::size_t, 3> rgb = {}; ///< which channels; the same one three times for grey
    std::vector<float> values;

    float value(std::size_t pixel, std::size_t c) const {
        return values[pixel * channel_count + rgb[c]];
    }
};

/// Where R, G and B are; a picture without them is grey in its first channel.
std::array<std::size_t, 3> find_rgb(const OIIO::ImageSpec& spec) {
    std::array<std::size_t, 3> rgb = {0, 0, 0};
    constexpr std::array<const char*, 3> kNames = {"R", "G", "B"};
    for (std::size_t c = 0; c < rgb.size(); ++c) {
        const int index = spec.channelindex(kNames[c]);
        if (index < 0) return {0, 0, 0};
        rgb[c] = static_cast<std::size_t>(index);
    }
    return rgb;
}

/// ": " and what OpenImageIO has to say, in one line; nothing if it says nothing.
template <typename Codec>
std::string reason(const Codec& codec) {
    std::string text = codec.geterror();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? text : ": " + text;
}

void check_shape(const OIIO::ImageSpec& spec, const std::string& name) {
    check(spec.width > 0 && spec.height > 0 && spec.width <= kLargestSide &&
              spec.height <= kLargestSide && spec.nchannels > 0 && !spec.deep,
          Failure::bad_data, name, ": wanted a flat picture of 1 to ", kLargestSide,
          " pixels a side, found ", spec.deep ? "a deep one of " : "", spec.width, "x", spec.height,
          " with ", spec.nchannels, " channels");
    check(spec.image_pixels() * static_cast<OIIO::imagesize_t>(spec.nchannels) <= kMostValues,
          Failure::bad_data, name, ": wanted at most ", kMostValues, " values, found ", spec.width,
          "x", spec.height, " with ", spec.nchannels, " channels");
}

Raw decode(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    const std::string name = path.string();
    Raw raw{.kind = kind_of(bytes)};
    check(raw.kind != Kind::other, Failure::bad_data, name,
          ": wanted an OpenEXR, Radiance or PNG picture, found ", bytes.size(),
          " bytes of something else");

    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const std::string format = raw.kind == Kind::exr   ? "openexr"
                               : raw.kind == Kind::hdr ? "hdr"
                                                       : "png";
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
    check(input != nullptr, Failure::internal, "this OpenImageIO cannot read ", format);
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1); // colours as stored, not times alpha
    input->set_ioproxy(&memory);
    OIIO::ImageSpec spec;
    const bool opened = input->open(name, spec, hints);
    check(opened, Failure::bad_data, name, ": cannot be decoded", reason(*input));
    check_shape(spec, name);
    raw.width = spec.width;
    raw.height = spec.height;
    raw.channel_count = static_cast<std::size_t>(spec.nchannels);
    raw.rgb = find_rgb(spec);
    raw.values.resize(static_cast<std::size_t>(spec.image_pixels()) * raw.channel_count);
    const bool read = input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat,
                                        raw.values.data());
    check(read, Failure::bad_data, name, ": cannot be decoded", reason(*input));
    input->close();
    return raw;
}

Raw decode_or_say_memory(const std::filesystem::path& path) {
    try {
        return decode(path);
    } catch (const std::bad_alloc&) {
        fail(Failure::exhausted, path.string(), ": not enough memory to decode it");
    }
}

/// Encodes in memory: OpenImageIO's PNG writer reports success on a full disk.
template <typename Value>
std::string encode(const std::string& format, const Picture& picture,
                   const std::vector<Value>& values, const OIIO::TypeDesc& type) {
    check(picture.width > 0 && picture.height > 0, Failure::internal, "a picture of ",
          picture.width, "x", picture.height, " cannot be written");
    OIIO::ImageSpec spec(picture.width, picture.height, 3, type);
    spec.attribute("DateTime", "2000:01:01 00:00:00"); // not the clock: same picture, same bytes
    spec.attribute("oiio:ColorSpace", format == "png" ? "sRGB" : "Linear");
    OIIO::Filesystem::IOVecOutput memory;
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    check(output != nullptr, Failure::internal, "this OpenImageIO cannot write ", format);
    output->set_ioproxy(&memory);
    const bool encoded = output->open("memory." + format, spec) &&
                         output->write_image(type, values.data()) && output->close();
    check(encoded, Failure::internal, "OpenImageIO cannot encode ", format, reason(*output));
    const std::vector<unsigned char>& bytes = memory.buffer();
    return {bytes.begin(), bytes.end()};
}

} // namespace

Picture read_picture(const std::filesystem::path& path) {
    const Raw raw = decode_or_say_memory(path);
    Picture picture(raw.width, raw.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        vec3 pixel(raw.value(i, 0), raw.value(i, 1), raw.value(i, 2));
        if (raw.kind == Kind::png)
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<float>(linear_from_srgb(static_cast<double>(pixel[c])));
        picture.pixels[i] = pixel;
    }
    return picture;
}

Mask read_mask(const std::filesystem::path& path, int width, int height) {
    const Raw raw = decode_or_say_memory(path);
    check(raw.kind == Kind::png, Failure::bad_data, path.string(), ": wanted a PNG as mask, found ",
          raw.kind == Kind::exr ? "OpenEXR" : "Radiance");
    check(raw.width == width && raw.height == height, Failure::bad_data, path.string(),
          ": wanted a mask of ", width, "x", height, " as the pictures, found ", raw.width, "x",
          raw.height);
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
    return encode("exr", picture, values, OIIO::TypeFloat);
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
    return encode("png", display, values, OIIO::TypeUInt8);
}

void write_exr(const Picture& picture, const std::filesystem::path& path) {
    write_file(path, exr_bytes(picture));
}

void write_png(const Picture& display, const std::filesystem::path& path) {
    write_file(path, png_bytes(display));
}

} // namespace catoptric::measure
