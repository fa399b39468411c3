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

struct FormatSignature {
    std::string_view bytes, format;
};
using namespace std::string_view_literals;
constexpr FormatSignature kSignatures[] = {{"\x89PNG\r\n\x1a\n", "png"},
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
void check_result(const CodecResult& result, const std::string& name, const std::string& format) {
    const std::string why = result.why.empty() ? "" : ": " + result.why;
    switch (result.answer) {
    case CodecStatus::done: return;
    case CodecStatus::no_codec:
        fail(Failure::bad_data, name, ": this OpenImageIO cannot read ", format);
    case CodecStatus::refused: fail(Failure::bad_data, name, ": cannot be decoded", why);
    case CodecStatus::out_of_memory:
        fail(Failure::exhausted, name, ": not enough memory to decode it");
    case CodecStatus::broken: fail(Failure::internal, name, ": OpenImageIO fails", why);
    }
}

} // namespace

ColourChannels find_colour_channels(const ImageShape& shape, const std::string& name) {
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
        names += (names.empty() ? "" : ", ") + escape(channel);
    check(grey != none && rgb == std::array{none, none, none}, Failure::bad_data, name,
          ": wanted the channels R, G and B, or Y, found ", names.empty() ? "none" : names);
    return {{grey, grey, grey}, alpha};
}

std::string detect_format(std::string_view bytes) {
    for (const auto& [beginning, format] : kSignatures)
        if (bytes.starts_with(beginning)) return std::string(format);
    if (bytes.starts_with("RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP")
        return "webp";
    return {};
}

namespace {

void check_sides(const ImageShape& shape, const std::string& name) {
    const auto fits = [](std::uint32_t side) { return side > 0 && side <= ImageReader::kMaxSide; };
    check(fits(shape.size.x) && fits(shape.size.y) && shape.channel_count > 0, Failure::bad_data,
          name, ": wanted a flat picture of 1 to ", ImageReader::kMaxSide, " pixels a side, found ",
          shape.size.x, "x", shape.size.y, " with ", shape.channel_count, " channels");
}

/// Reads a picture with OpenImageIO.
class CodecReader {
public:
    CodecReader(const ByteSource& bytes, const std::string& format, const std::string& name)
        : format_(format), name_(name) {
        check_result(codecs_.open(bytes, format, name, picture_, header_), name, format);
    }
    ~CodecReader() {
        if (picture_) codecs_.close(picture_);
    }
    CodecReader(const CodecReader&) = delete;
    CodecReader& operator=(const CodecReader&) = delete;

    /// Throws `bad_data` for a deep picture or one without pixels.
    ImageShape shape() const {
        check(!header_.is_deep && header_.size.x > 0 && header_.size.y > 0, Failure::bad_data,
              name_, ": wanted a flat picture of 1 to ", ImageReader::kMaxSide,
              " pixels a side, found ", header_.is_deep ? "a deep one of " : "", header_.size.x,
              "x", header_.size.y);
        return {uvec2(header_.size), std::size_t(header_.channel_count), header_.channels,
                header_.description};
    }
    void read_rows(std::uint32_t first, std::uint32_t row_count, PixelType type, void* values) {
        check_result(codecs_.read(*picture_, first, row_count, type, values), name_, format_);
    }

private:
    std::string format_, name_;
    const ImageCodecs& codecs_ = image_codecs();
    ImageCodecs::Picture* picture_ = nullptr;
    ImageCodecs::Header header_;
};

} // namespace

struct ImageReader::State {
    void read_rows(std::uint32_t first, std::uint32_t row_count, PixelType type, void* values) {
        try {
            if (png)
                png->read_rows(first, row_count, type, values);
            else if (colours || radiance)
                read_colours(first, row_count, type, values);
            else
                open_codec().read_rows(first, row_count, type, values);
        } catch (const std::bad_alloc&) {
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
    }
    void read_colours(std::uint32_t first, std::uint32_t row_count, PixelType type, void* values) {
        const std::size_t row = shape.channel_count * shape.size.x, count = row * row_count;
        if (type == PixelType::float32)
            return read_floats(first, row_count, {static_cast<float*>(values), count});
        std::vector<float> floats(count);
        read_floats(first, row_count, floats);
        auto* const rounded = static_cast<std::uint8_t*>(values);
        for (std::size_t i = 0; i < count; ++i) // NaN becomes 0
            rounded[i] = static_cast<std::uint8_t>(
                floats[i] > 0 ? std::min(floats[i], 1.f) * 255 + .5f : 0);
    }
    void read_floats(std::uint32_t first, std::uint32_t row_count, std::span<float> values) {
        if (colours) return colours->read_rows(first, row_count, values.data());
        constexpr PixelType kFloats = PixelType::float32;
        if (radiance->has_usual_order()) {
            open_codec().read_rows(first, row_count, kFloats, values.data());
            return radiance->scale(values);
        }
        if (turned.empty()) { // OpenImageIO gives the lines in the order of the file
            std::vector<float> stored(std::size_t(shape.size.x) * shape.size.y * 3);
            open_codec().read_rows(0, radiance->stored.y, kFloats, stored.data());
            radiance->scale(stored);
            turned = radiance->turn(stored);
        }
        std::ranges::copy(
            std::span(turned).subspan(std::size_t(first) * shape.size.x * 3, values.size()),
            values.begin());
    }
    template <typename Value>
    std::vector<Value> read_values(PixelType type) {
        std::vector<Value> values;
        try {
            values.resize(std::size_t(shape.size.x) * shape.size.y * shape.channel_count);
        } catch (const std::bad_alloc&) {
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
        read_rows(0, shape.size.y, type, values.data());
        return values;
    }

    CodecReader& open_codec() { return codec ? *codec : codec.emplace(bytes, format, name); }

    const ByteSource& bytes;
    std::string format, name;
    ImageShape shape = {};
    std::optional<PngReader> png = {};
    std::unique_ptr<ExrColourReader> colours = {};
    std::optional<RadianceHeader> radiance = {};
    std::vector<float> turned = {};        ///< all pixels of a Radiance picture in unusual order
    std::optional<CodecReader> codec = {}; ///< reader for everything else
};

ImageReader::ImageReader(const ByteSource& bytes, const std::string& format, std::string name,
                         const ShapeCheck& judge, const std::optional<ImageColours>& colours)
    : state_(new State{bytes, format, std::move(name)}) {
    const auto accept = [&](const ImageShape& shape) {
        check_sides(shape, state_->name);
        if (judge) judge(shape);
        state_->shape = shape;
    };
    const bool has_layers = format == "openexr";
    if (!has_layers && colours && !colours->layer.empty())
        fail(Failure::bad_data, state_->name, ": wanted an OpenEXR picture with the layer ",
             quote(colours->layer), ", found a format without layers");
    if (format == "png") {
        accept(state_->png.emplace(bytes, state_->name).shape());
        state_->png->check_size();
        return;
    }
    if (const auto shape = read_image_header(bytes, format, state_->name)) accept(*shape);
    if (format == "hdr") {
        state_->radiance = read_radiance_header(bytes, state_->name);
        check(state_->open_codec().shape().size == state_->radiance->stored, Failure::bad_data,
              state_->name, ": cannot be decoded: its size is not clear");
        return;
    }
    if (format == "openexr" && colours) {
        state_->colours = std::make_unique<ExrColourReader>(bytes, state_->name, state_->shape.size,
                                                            colours->layer);
        accept(state_->colours->shape());
        return;
    }
    accept(state_->open_codec().shape());
}

ImageReader::~ImageReader() = default;

const ImageShape& ImageReader::shape() const { return state_->shape; }
std::vector<float> ImageReader::floats() { return state_->read_values<float>(PixelType::float32); }
std::vector<std::uint8_t> ImageReader::bytes() {
    return state_->read_values<std::uint8_t>(PixelType::uint8);
}
void ImageReader::read_rows(std::uint32_t first, std::span<float> values) {
    const std::size_t row = std::size_t(state_->shape.size.x) * state_->shape.channel_count;
    state_->read_rows(first, static_cast<std::uint32_t>(values.size() / row), PixelType::float32,
                      values.data());
}

} // namespace catoptric
