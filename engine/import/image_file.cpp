#include "import/image_file.hpp"

#include "core/image_codec.hpp"
#include "core/shader_math.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace catoptric::scene {

namespace {

bool is_targa_file(const std::string& file) {
    std::string end = file.substr(file.size() - std::min<std::size_t>(file.size(), 4));
    std::ranges::transform(end, end.begin(), [](unsigned char c) { return std::tolower(c); });
    return end == ".tga";
}

std::vector<std::uint32_t> pack_texels(const ImageShape& shape, const ColourChannels& layout,
                                       const std::vector<std::uint8_t>& values) {
    std::vector<std::uint32_t> texels(std::size_t(shape.size.x) * shape.size.y);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const std::uint8_t* const pixel = values.data() + i * shape.channel_count;
        const auto [r, g, b] = layout.rgb;
        const std::uint32_t alpha = layout.alpha < shape.channel_count ? pixel[layout.alpha] : 255;
        texels[i] = pixel[r] | pixel[g] << 8 | pixel[b] << 16 | alpha << 24;
    }
    return texels;
}

/// Returns an image of a file that holds linear light, encoded as sRGB.
Image encode_light(const ImageShape& shape, const ColourChannels& layout,
                   const std::vector<float>& values) {
    Image image{.size = shape.size, .texels = {}};
    image.texels.reserve(std::size_t(shape.size.x) * shape.size.y);
    const auto to_byte = [](float share) {
        return share > 0 ? static_cast<std::uint32_t>(std::lround(std::min(share, 1.f) * 255)) : 0u;
    };
    for (std::size_t i = 0; i < values.size(); i += shape.channel_count) {
        std::uint32_t texel = 0;
        for (int channel = 0; channel < 3; ++channel) {
            const float light = values[i + layout.rgb[std::size_t(channel)]];
            image.is_clamped = image.is_clamped || light > 1;
            texel |= to_byte(f32::srgb_from_linear_channel(light)) << 8 * channel;
        }
        const float alpha = layout.alpha < shape.channel_count ? values[i + layout.alpha] : 1;
        image.texels.push_back(texel | to_byte(alpha) << 24);
    }
    return image;
}

} // namespace

std::shared_ptr<const Image> decode_image(std::string_view bytes, const std::string& file,
                                          const std::string& place, LoadAccount& account,
                                          bool is_light) {
    std::string format = detect_format(bytes);
    if (format.empty() && is_targa_file(file)) format = "targa";
    if (format.empty()) return nullptr;
    const auto texels = [](const ImageShape& shape) { // four values count as a texel
        return std::uint64_t(shape.size.x) * shape.size.y * ((shape.channel_count + 3) / 4);
    };
    const MemorySource source(bytes);
    const auto judge = [&](const ImageShape& shape) {
        constexpr std::uint32_t kMaxTextureSide = 65535; // the renderer stores a side in 16 bits
        check(shape.size.x <= kMaxTextureSide && shape.size.y <= kMaxTextureSide, Failure::bad_data,
              place, ": wanted sides of at most ", kMaxTextureSide, " texels, found ", shape.size.x,
              "x", shape.size.y);
        account.texels.check_fits(texels(shape), place);
    };
    ImageReader image_reader(source, format, place, judge, ImageColours());
    const ImageShape& shape = image_reader.shape();
    account.texels.add(texels(shape), place);
    const ColourChannels channels = find_colour_channels(shape, place);
    if (is_light && (format == "openexr" || format == "hdr")) {
        Image image = encode_light(shape, channels, image_reader.floats());
        image.name = file;
        return std::make_shared<const Image>(std::move(image));
    }
    return std::make_shared<const Image>(
        Image{.name = file,
              .size = shape.size,
              .texels = pack_texels(shape, channels, image_reader.bytes())});
}

std::string encode_png(const Image& image) {
    std::vector<std::uint8_t> values;
    values.reserve(4 * image.texels.size());
    for (const std::uint32_t texel : image.texels)
        for (int shift = 0; shift < 32; shift += 8)
            values.push_back(static_cast<std::uint8_t>(texel >> shift));
    return catoptric::encode_png({image.size, 4, {"R", "G", "B", "A"}}, values);
}

} // namespace catoptric::scene
