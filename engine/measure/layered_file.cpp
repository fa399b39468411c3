#include "measure/layered_file.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_codec.hpp"

#include <algorithm>
#include <array>

namespace catoptric::measure {

namespace {

constexpr std::array kExrChannelSuffixes{".R", ".G", ".B"};

/// Throws `bad_data` if the file lacks the channel.
std::size_t find_channel(const ImageShape& shape, const std::string& channel,
                         const std::string& file) {
    const auto found = std::ranges::find(shape.channels, channel);
    check(found != shape.channels.end(), Failure::bad_data, file, ": wanted the channel ", channel,
          ", found ", shape.channel_count, " channels without it");
    return static_cast<std::size_t>(found - shape.channels.begin());
}

} // namespace

void write_layers(const LayeredFile& file, const std::filesystem::path& path) {
    check(!file.layers.empty(), Failure::internal, "a file of layers wants a layer, found none");
    const Picture& first = file.layers.front().picture;
    ImageShape shape{
        {static_cast<std::uint32_t>(first.width), static_cast<std::uint32_t>(first.height)},
        3 * file.layers.size(),
        {},
        file.description};
    std::vector<float> values(shape.channel_count * first.pixels.size());
    for (std::size_t layer = 0; layer < file.layers.size(); ++layer)
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const PictureLayer& part = file.layers[layer];
            check(part.picture.pixels.size() == first.pixels.size(), Failure::internal,
                  "layers of one file want one size");
            shape.channels.push_back(part.name + kExrChannelSuffixes[channel]);
            for (std::size_t i = 0; i < first.pixels.size(); ++i)
                values[i * shape.channel_count + 3 * layer + channel] =
                    part.picture.pixels[i][static_cast<int>(channel)];
        }
    write_file(path, encode_openexr(shape, values));
}

LayeredFile read_layers(const std::filesystem::path& path, std::span<const std::string> names) {
    const std::unique_ptr<ByteSource> bytes = open_source(path);
    std::array<char, 16> start{};
    const std::size_t count = bytes->read(0, start);
    check(detect_format({start.data(), count}) == "openexr", Failure::bad_data, path.string(),
          ": wanted an OpenEXR file, found something else");
    ImageReader exr_reader(*bytes, "openexr", path.string());
    const ImageShape& shape = exr_reader.shape();
    LayeredFile file{.description = shape.description};
    std::vector<std::size_t> channels;
    for (const std::string& name : names) {
        file.layers.push_back(
            {name, Picture(static_cast<int>(shape.size.x), static_cast<int>(shape.size.y))});
        for (const char* suffix : kExrChannelSuffixes)
            channels.push_back(find_channel(shape, name + suffix, path.string()));
    }
    const std::vector<float> values = exr_reader.floats();
    for (std::size_t k = 0; k < channels.size(); ++k) {
        std::vector<vec3>& pixels = file.layers[k / 3].picture.pixels;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i][static_cast<int>(k % 3)] = values[i * shape.channel_count + channels[k]];
    }
    return file;
}

} // namespace catoptric::measure
