#include "measure/picture_file.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_codec.hpp"
#include "measure/srgb.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <vector>

namespace catoptric::measure {
namespace {

/// Returns the format by the first bytes, not by the file name.
std::string picture_format(const ByteSource& bytes, const std::string& name) {
    std::array<char, 16> first{};
    const std::size_t count = bytes.read(0, first);
    std::string format = detect_format({first.data(), count});
    check(format == "openexr" || format == "hdr" || format == "png", Failure::bad_data, name,
          ": wanted an OpenEXR, Radiance or PNG picture, found ", bytes.size(),
          " bytes of something else");
    return format;
}

ImageReader::ShapeCheck make_shape_check(const std::string& name,
                                         const PictureReader::SizeCheck& judge) {
    return [&name, &judge](const ImageShape& shape) {
        if (judge) judge(static_cast<int>(shape.size.x), static_cast<int>(shape.size.y));
        check(std::uint64_t(shape.size.x) * shape.size.y * shape.channel_count <= kMaxPictureValues,
              Failure::bad_data, name, ": wanted at most ", kMaxPictureValues, " values, found ",
              shape.size.x, "x", shape.size.y, " with ", shape.channel_count, " channels");
    };
}

/// Decodes the stored values of a PNG to linear light. Most PNGs have 8 bits, whose light is in a
/// table.
class PngDecoder {
public:
    PngDecoder() {
        for (std::size_t i = 0; i < table_.size(); ++i) table_[i] = decode_srgb(to_unit(i));
    }
    float operator()(float value) const {
        // Not negative, so the cast rounds down as floor does.
        const float above = value * 255 + .5F;
        const auto i = static_cast<std::size_t>(static_cast<int>(above));
        return to_unit(i) == value ? table_[i] : decode_srgb(value);
    }

private:
    static float to_unit(std::size_t i) { return static_cast<float>(i) * (1.0F / 255); }
    static float decode_srgb(float value) {
        return static_cast<float>(linear_from_srgb(static_cast<double>(value)));
    }
    std::array<float, 256> table_{};
};

ImageShape rgb_shape(const Picture& picture) {
    return {{static_cast<std::uint32_t>(std::max(picture.width, 0)),
             static_cast<std::uint32_t>(std::max(picture.height, 0))},
            3,
            {}};
}

} // namespace

PictureLocation locate_picture(const std::filesystem::path& path) {
    std::error_code error;
    const std::string text = path.string();
    const std::size_t colon = text.rfind(':');
    if (colon == text.npos || colon == 0 || std::filesystem::exists(path, error) ||
        !std::filesystem::exists(text.substr(0, colon), error))
        return {path, {}};
    return {text.substr(0, colon), text.substr(colon + 1)};
}

struct PictureReader::State {
    State(const PictureLocation& at, const SizeCheck& judge)
        : file_name(at.file.string()), bytes(open_source(at.file)),
          format(picture_format(*bytes, file_name)),
          image_reader(*bytes, format, file_name, make_shape_check(file_name, judge),
                       ImageColours{at.layer}),
          rgb(find_colour_channels(image_reader.shape(), file_name).rgb) {}

    std::string file_name;
    std::unique_ptr<ByteSource> bytes;
    std::string format; ///< "openexr", "hdr" or "png"
    ImageReader image_reader;
    /// Indices of the channels; the same index three times for grey.
    std::array<std::size_t, 3> rgb;
    std::vector<float> values;
};

PictureReader::PictureReader(const std::filesystem::path& path, const SizeCheck& judge)
    : state_(std::make_unique<State>(locate_picture(path), judge)) {}
PictureReader::~PictureReader() = default;
PictureReader::PictureReader(PictureReader&&) noexcept = default;
PictureReader& PictureReader::operator=(PictureReader&&) noexcept = default;

int PictureReader::picture_width() const {
    return static_cast<int>(state_->image_reader.shape().size.x);
}
int PictureReader::height() const { return static_cast<int>(state_->image_reader.shape().size.y); }
std::string PictureReader::format() const {
    return state_->format == "png" ? "PNG" : state_->format == "hdr" ? "Radiance" : "OpenEXR";
}

bool PictureReader::is_8_bit() const { return state_->image_reader.shape().is_8_bit; }

void PictureReader::read_rows(int first, std::span<vec3> pixels) {
    static const PngDecoder kDecoded;
    // Pixels that are read at once; at least a row.
    constexpr std::size_t kPixelsPerBlock = std::size_t{1} << 15;
    const bool is_stored = state_->format == "png"; // PNGs store sRGB values
    const std::size_t channel_count = state_->image_reader.shape().channel_count;
    const auto columns = static_cast<std::size_t>(picture_width());
    const std::size_t most = std::max<std::size_t>(1, kPixelsPerBlock / columns) * columns;
    auto row = static_cast<std::uint32_t>(first);
    while (!pixels.empty()) {
        const std::size_t count = std::min(most, pixels.size());
        state_->values.resize(count * channel_count);
        state_->image_reader.read_rows(row, state_->values);
        const auto [red, green, blue] = state_->rgb;
        const float* value = state_->values.data();
        if (is_stored)
            for (std::size_t i = 0; i < count; ++i, value += channel_count)
                pixels[i] = {kDecoded(value[red]), kDecoded(value[green]), kDecoded(value[blue])};
        else
            for (std::size_t i = 0; i < count; ++i, value += channel_count)
                pixels[i] = {value[red], value[green], value[blue]};
        pixels = pixels.subspan(count);
        row += static_cast<std::uint32_t>(count / columns);
    }
}

Picture read_picture(const std::filesystem::path& path) { return read_picture(path, {}); }

Picture read_picture(const std::filesystem::path& path, const PictureReader::SizeCheck& judge) {
    PictureReader picture_reader(path, judge);
    Picture picture(picture_reader.picture_width(), picture_reader.height());
    picture_reader.read_rows(0, picture.pixels);
    return picture;
}

bool is_png(const std::filesystem::path& path) {
    std::string start(8, '\0');
    std::ifstream file(locate_picture(path).file, std::ios::binary);
    return file.read(start.data(), 8) && detect_format(start) == "png";
}

Mask read_mask(const std::filesystem::path& path, int width, int height) {
    PictureReader picture_reader(path, [&](int columns, int rows) {
        check(columns == width && rows == height, Failure::bad_data, path.string(),
              ": wanted a mask of ", width, "x", height, " as the pictures, found ", columns, "x",
              rows);
    });
    check(picture_reader.format() == "PNG", Failure::bad_data, path.string(),
          ": wanted a PNG as mask, found ", picture_reader.format());
    Mask mask(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    std::vector<vec3> row(static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y) {
        picture_reader.read_rows(y, row);
        std::uint8_t* const counts = mask.data() + static_cast<std::size_t>(y) * row.size();
        for (std::size_t x = 0; x < row.size(); ++x) counts[x] = row[x] == vec3(0) ? 0 : 255;
    }
    return mask;
}

std::string encode_exr(const Picture& picture, const std::string& text) {
    return encode_exr(picture, {}, text);
}

std::string encode_exr(const Picture& picture, std::span<const ExtraChannel> channels,
                       const std::string& text) {
    ImageShape shape = rgb_shape(picture);
    shape.description = text;
    shape.channel_count += channels.size();
    if (!channels.empty()) shape.channels = {"R", "G", "B"};
    for (const ExtraChannel& channel : channels) {
        check(channel.values.size() == picture.pixels.size(), Failure::internal, "channel ",
              channel.name, ": wanted ", picture.pixels.size(), " values, found ",
              channel.values.size());
        shape.channels.push_back(channel.name);
    }
    std::vector<float> values;
    values.reserve(shape.channel_count * picture.pixels.size());
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const vec3& pixel = picture.pixels[i];
        values.insert(values.end(), {pixel.x, pixel.y, pixel.z});
        for (const ExtraChannel& channel : channels) values.push_back(channel.values[i]);
    }
    return encode_openexr(shape, values);
}

std::vector<std::uint8_t> to_bytes(const Picture& display) {
    const auto byte = [](float value) {
        if (!(value > 0)) return std::uint8_t{0}; // NaN falls here
        return static_cast<std::uint8_t>(std::lround(std::min(value, 1.0F) * 255));
    };
    std::vector<std::uint8_t> values;
    values.reserve(3 * display.pixels.size());
    for (const vec3& pixel : display.pixels)
        values.insert(values.end(), {byte(pixel.x), byte(pixel.y), byte(pixel.z)});
    return values;
}

std::string encode_png(const Picture& display) {
    return catoptric::encode_png(rgb_shape(display), to_bytes(display));
}

void write_exr(const Picture& picture, const std::filesystem::path& path, const std::string& text) {
    write_file(path, encode_exr(picture, text));
}

void write_png(const Picture& display, const std::filesystem::path& path) {
    write_file(path, encode_png(display));
}

} // namespace catoptric::measure
