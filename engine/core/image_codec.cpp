#include "core/image_codec.hpp"

#include "core/error.hpp"
#include "core/exr_colours.hpp"
#include "core/image_header.hpp"
#include "core/image_module.hpp"
#include "core/png_read.hpp"
#include "core/radiance.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>

namespace catoptric {

namespace {

struct ImageFormatSignature {
    std::string_view bytes, format;
};
using namespace std::string_view_literals;
constexpr ImageFormatSignature kFormatSignatures[] = {{"\x89PNG\r\n\x1a\n", "png"},
                                                      {"\xff\xd8\xff", "jpeg"},
                                                      {"\x76\x2f\x31\x01", "openexr"},
                                                      {"#?", "hdr"},
                                                      {"BM", "bmp"},
                                                      {"GIF8", "gif"},
                                                      {"II*\0"sv, "tiff"},
                                                      {"MM\0*"sv, "tiff"},
                                                      {"DDS ", "dds"},
                                                      {"8BPS", "psd"}};

/// Throws unless the answer is `done`.
void check_codec_result(const ImageCodecResult& result, const std::string& name,
                        const std::string& format) {
    const std::string why = result.why.empty() ? "" : ": " + result.why;
    switch (result.answer) {
    case ImageCodecStatus::done: return;
    case ImageCodecStatus::no_codec:
        fail(Failure::bad_data, name, ": this OpenImageIO cannot read ", format);
    case ImageCodecStatus::refused: fail(Failure::bad_data, name, ": cannot be decoded", why);
    case ImageCodecStatus::out_of_memory:
        fail(Failure::exhausted, name, ": not enough memory to decode it");
    case ImageCodecStatus::broken: fail(Failure::internal, name, ": OpenImageIO fails", why);
    }
}

} // namespace

ColourChannels find_colour_channels(const ImageSizeAndChannels& shape, const std::string& name) {
    const std::vector<std::string>& channels = shape.channels;
    const auto find = [&](const char* channel) {
        check(std::ranges::count(channels, channel) <= 1, Failure::bad_data, name,
              ": wanted one channel ", channel, ", found several");
        return static_cast<std::size_t>(std::ranges::find(channels, channel) - channels.begin());
    };
    const std::size_t none = channels.size(), alpha = find("A"), grey = find("Y");
    const std::array rgb{find("R"), find("G"), find("B")};
    if (std::ranges::find(rgb, none) == rgb.end()) return {rgb, alpha};
    std::string names;
    for (const std::string& channel : channels)
        names += (names.empty() ? "" : ", ") + escape_control_characters(channel);
    check(grey != none && rgb == std::array{none, none, none}, Failure::bad_data, name,
          ": wanted the channels R, G and B, or Y, found ", names.empty() ? "none" : names);
    return {{grey, grey, grey}, alpha};
}

std::string detect_image_format(std::string_view bytes) {
    for (const auto& [beginning, format] : kFormatSignatures)
        if (bytes.starts_with(beginning)) return std::string(format);
    if (bytes.starts_with("RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP")
        return "webp";
    return {};
}

namespace {

void check_image_side_lengths(const ImageSizeAndChannels& shape, const std::string& name) {
    const auto fits = [](std::uint32_t side) {
        return side > 0 && side <= ImageReader::kMaxImageSide;
    };
    check(fits(shape.size.x) && fits(shape.size.y) && shape.channel_count > 0, Failure::bad_data,
          name, ": wanted a flat picture of 1 to ", ImageReader::kMaxImageSide,
          " pixels a side, found ", shape.size.x, "x", shape.size.y, " with ", shape.channel_count,
          " channels");
}

/// Reads a picture with OpenImageIO.
class ImageCodecReader {
public:
    ImageCodecReader(const RandomAccessByteSource& bytes, const std::string& format,
                     const std::string& name)
        : image_format_(format), name_(name) {
        check_codec_result(codecs_.open(bytes, format, name, picture_, header_), name, format);
    }
    ~ImageCodecReader() {
        if (picture_) codecs_.close(picture_);
    }
    ImageCodecReader(const ImageCodecReader&) = delete;
    ImageCodecReader& operator=(const ImageCodecReader&) = delete;

    /// Returns the picture's shape. Throws `bad_data` for a deep picture or one without pixels.
    ImageSizeAndChannels image_size_and_channels() const {
        check(!header_.is_deep && header_.size.x > 0 && header_.size.y > 0, Failure::bad_data,
              name_, ": wanted a flat picture of 1 to ", ImageReader::kMaxImageSide,
              " pixels a side, found ", header_.is_deep ? "a deep one of " : "", header_.size.x,
              "x", header_.size.y);
        return {uvec2(header_.size), std::size_t(header_.channel_count), header_.channels,
                header_.description};
    }
    void read_image_rows(std::uint32_t first, std::uint32_t row_count, ImageCodecValueType type,
                         void* values) {
        check_codec_result(codecs_.read(*picture_, first, row_count, type, values), name_,
                           image_format_);
    }

private:
    std::string image_format_, name_;
    const ImageCodecs& codecs_ = get_image_codecs();
    ImageCodecs::Picture* picture_ = nullptr;
    ImageCodecs::CodecPictureHeader header_;
};

} // namespace

struct ImageReader::CodecImageReadState {
    void read_image_rows(std::uint32_t first, std::uint32_t row_count, ImageCodecValueType type,
                         void* values) {
        try {
            if (png)
                png->read_image_rows(first, row_count, type, values);
            else if (colours || radiance)
                read_colour_rows(first, row_count, type, values);
            else
                open_codec().read_image_rows(first, row_count, type, values);
        } catch (const std::bad_alloc&) {
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
    }
    void read_colour_rows(std::uint32_t first, std::uint32_t row_count, ImageCodecValueType type,
                          void* values) {
        const std::size_t row = shape.channel_count * shape.size.x, count = row * row_count;
        if (type == ImageCodecValueType::float32)
            return read_colour_floats(first, row_count, {static_cast<float*>(values), count});
        std::vector<float> floats(count);
        read_colour_floats(first, row_count, floats);
        auto* const rounded = static_cast<std::uint8_t*>(values);
        for (std::size_t i = 0; i < count; ++i) // NaN becomes 0
            rounded[i] = static_cast<std::uint8_t>(
                floats[i] > 0 ? std::min(floats[i], 1.f) * 255 + .5f : 0);
    }
    void read_colour_floats(std::uint32_t first, std::uint32_t row_count, std::span<float> values) {
        if (colours) return colours->read_image_rows(first, row_count, values.data());
        constexpr ImageCodecValueType kFloats = ImageCodecValueType::float32;
        if (radiance->has_usual_order()) {
            open_codec().read_image_rows(first, row_count, kFloats, values.data());
            return radiance->scale_pixels(values);
        }
        if (turned.empty()) { // OpenImageIO gives the lines in the order of the file
            std::vector<float> stored(std::size_t(shape.size.x) * shape.size.y * 3);
            open_codec().read_image_rows(0, radiance->stored.y, kFloats, stored.data());
            radiance->scale_pixels(stored);
            turned = radiance->turn_pixels(stored);
        }
        std::ranges::copy(
            std::span(turned).subspan(std::size_t(first) * shape.size.x * 3, values.size()),
            values.begin());
    }
    template <typename Value>
    std::vector<Value> read_all_pixel_values(ImageCodecValueType type) {
        std::vector<Value> values;
        try {
            values.resize(std::size_t(shape.size.x) * shape.size.y * shape.channel_count);
        } catch (const std::bad_alloc&) {
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
        read_image_rows(0, shape.size.y, type, values.data());
        return values;
    }

    ImageCodecReader& open_codec() { return codec ? *codec : codec.emplace(bytes, format, name); }

    const RandomAccessByteSource& bytes;
    std::string format, name;
    ImageSizeAndChannels shape = {};
    std::optional<PngReader> png = {};
    std::unique_ptr<ExrColourReader> colours = {};
    std::optional<RadianceHeader> radiance = {};
    std::vector<float> turned = {}; ///< all pixels of a Radiance picture in unusual order
    std::optional<ImageCodecReader> codec = {}; ///< reader for everything else
};

ImageReader::ImageReader(const RandomAccessByteSource& bytes, const std::string& format,
                         std::string name, const ImageShapeCheckCallback& judge,
                         const std::optional<ImageColours>& colours)
    : image_state_(new CodecImageReadState{bytes, format, std::move(name)}) {
    const auto accept = [&](const ImageSizeAndChannels& shape) {
        check_image_side_lengths(shape, image_state_->name);
        if (judge) judge(shape);
        image_state_->shape = shape;
    };
    const bool has_layers = format == "openexr";
    if (!has_layers && colours && !colours->layer.empty())
        fail(Failure::bad_data, image_state_->name, ": wanted an OpenEXR picture with the layer ",
             quote_text_with_escapes(colours->layer), ", found a format without layers");
    if (format == "png") {
        accept(image_state_->png.emplace(bytes, image_state_->name).image_size_and_channels());
        image_state_->png->check_size_against_file();
        return;
    }
    if (const auto shape = read_image_header(bytes, format, image_state_->name)) accept(*shape);
    if (format == "hdr") {
        image_state_->radiance = read_radiance_header(bytes, image_state_->name);
        check(image_state_->open_codec().image_size_and_channels().size ==
                  image_state_->radiance->stored,
              Failure::bad_data, image_state_->name, ": cannot be decoded: its size is not clear");
        return;
    }
    if (format == "openexr" && colours) {
        image_state_->colours = std::make_unique<ExrColourReader>(
            bytes, image_state_->name, image_state_->shape.size, colours->layer);
        accept(image_state_->colours->image_size_and_channels());
        return;
    }
    accept(image_state_->open_codec().image_size_and_channels());
}

ImageReader::~ImageReader() = default;

const ImageSizeAndChannels& ImageReader::image_size_and_channels() const {
    return image_state_->shape;
}
std::vector<float> ImageReader::floats() {
    return image_state_->read_all_pixel_values<float>(ImageCodecValueType::float32);
}
std::vector<std::uint8_t> ImageReader::bytes() {
    return image_state_->read_all_pixel_values<std::uint8_t>(ImageCodecValueType::uint8);
}
void ImageReader::read_image_rows(std::uint32_t first, std::span<float> values) {
    const std::size_t row = std::size_t(image_state_->shape.size.x) *
                            image_state_->shape.channel_count;
    image_state_->read_image_rows(first, static_cast<std::uint32_t>(values.size() / row),
                                  ImageCodecValueType::float32, values.data());
}

} // namespace catoptric
