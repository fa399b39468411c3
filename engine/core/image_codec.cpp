#include "core/image_codec.hpp"

#include "core/error.hpp"
#include "core/image_header.hpp"
#include "core/image_module.hpp"
#include "core/png_read.hpp"

#include <new>
#include <optional>
#include <utility>

namespace catoptric {

namespace {

struct FormatSignature {
    std::string_view bytes, format;
};
using namespace std::string_view_literals;
constexpr FormatSignature kFormatSignatures[] = {{"\x89PNG\r\n\x1a\n", "png"},
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
void check_codec_result(const CodecResult& result, const std::string& name,
                        const std::string& format) {
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

std::string detect_image_format(std::string_view bytes) {
    for (const auto& [beginning, format] : kFormatSignatures)
        if (bytes.starts_with(beginning)) return std::string(format);
    if (bytes.starts_with("RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP")
        return "webp";
    return {};
}

namespace {

void check_image_sides(const ImageShape& shape, const std::string& name) {
    const auto fits = [](std::uint32_t side) {
        return side > 0 && side <= ImageReader::kMaxImageSide;
    };
    check(fits(shape.size.x) && fits(shape.size.y) && shape.channel_count > 0, Failure::bad_data,
          name, ": wanted a flat picture of 1 to ", ImageReader::kMaxImageSide,
          " pixels a side, found ", shape.size.x, "x", shape.size.y, " with ", shape.channel_count,
          " channels");
}

/// Reads a picture with OpenImageIO.
class CodecReader {
public:
    CodecReader(const ByteSource& bytes, const std::string& format, const std::string& name)
        : format_(format), name_(name) {
        check_codec_result(codecs_.open(bytes, format, name, picture_, header_), name, format);
    }
    ~CodecReader() {
        if (picture_) codecs_.close(picture_);
    }
    CodecReader(const CodecReader&) = delete;
    CodecReader& operator=(const CodecReader&) = delete;

    /// Returns the picture's shape. Throws `bad_data` for a deep picture or one without pixels.
    ImageShape shape() const {
        check(!header_.is_deep && header_.size.x > 0 && header_.size.y > 0, Failure::bad_data,
              name_, ": wanted a flat picture of 1 to ", ImageReader::kMaxImageSide,
              " pixels a side, found ", header_.is_deep ? "a deep one of " : "", header_.size.x,
              "x", header_.size.y);
        return {uvec2(header_.size), std::size_t(header_.channel_count), header_.channels,
                header_.description};
    }
    void read_rows(std::uint32_t first, std::uint32_t row_count, CodecValue type, void* values) {
        check_codec_result(codecs_.read(*picture_, first, row_count, type, values), name_, format_);
    }

private:
    std::string format_, name_;
    const ImageCodecs& codecs_ = get_image_codecs();
    ImageCodecs::Picture* picture_ = nullptr;
    ImageCodecs::PictureHeader header_;
};

} // namespace

struct ImageReader::ImageReadState {
    void read_rows(std::uint32_t first, std::uint32_t row_count, CodecValue type, void* values) {
        try {
            if (png)
                png->read_rows(first, row_count, type, values);
            else
                codec->read_rows(first, row_count, type, values);
        } catch (const std::bad_alloc&) {
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
    }
    template <typename Value>
    std::vector<Value> read_all(CodecValue type) {
        std::vector<Value> values;
        try {
            values.resize(std::size_t(shape.size.x) * shape.size.y * shape.channel_count);
        } catch (const std::bad_alloc&) {
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
        read_rows(0, shape.size.y, type, values.data());
        return values;
    }

    std::string name;
    ImageShape shape;
    std::optional<PngReader> png;
    std::optional<CodecReader> codec; ///< set for all formats but PNG
};

ImageReader::ImageReader(const ByteSource& bytes, const std::string& format, std::string name,
                         const ImageShapeCheck& judge)
    : open_(std::make_unique<ImageReadState>()) {
    open_->name = std::move(name);
    const auto accept = [&](const ImageShape& shape) {
        check_image_sides(shape, open_->name);
        if (judge) judge(shape);
        open_->shape = shape;
    };
    if (format == "png") {
        accept(open_->png.emplace(bytes, open_->name).shape());
        open_->png->check_size();
        return;
    }
    if (const auto shape = read_image_header(bytes, format, open_->name)) accept(*shape);
    accept(open_->codec.emplace(bytes, format, open_->name).shape());
}

ImageReader::~ImageReader() = default;

const ImageShape& ImageReader::shape() const { return open_->shape; }
std::vector<float> ImageReader::floats() { return open_->read_all<float>(CodecValue::float32); }
std::vector<std::uint8_t> ImageReader::bytes() {
    return open_->read_all<std::uint8_t>(CodecValue::uint8);
}
void ImageReader::read_rows(std::uint32_t first, std::span<float> values) {
    const std::size_t row = std::size_t(open_->shape.size.x) * open_->shape.channel_count;
    open_->read_rows(first, static_cast<std::uint32_t>(values.size() / row), CodecValue::float32,
                     values.data());
}

std::string encode_openexr(const ImageShape& shape, std::span<const float> values) {
    check(shape.size.x > 0 && shape.size.y > 0, Failure::internal, "a picture of ", shape.size.x,
          "x", shape.size.y, " cannot be written");
    std::string bytes;
    const auto [answer, why] = get_image_codecs().encode("openexr",
                                                         {.size = shape.size,
                                                          .channel_count = shape.channel_count,
                                                          .type = CodecValue::float32,
                                                          .values = values.data(),
                                                          .channels = shape.channels,
                                                          .description = shape.description},
                                                         bytes);
    check(answer != CodecStatus::no_codec, Failure::internal,
          "this OpenImageIO cannot write openexr");
    check(answer != CodecStatus::out_of_memory, Failure::exhausted,
          "not enough memory to encode OpenEXR");
    check(answer == CodecStatus::done, Failure::internal, "OpenImageIO cannot encode openexr",
          why.empty() ? "" : ": ", why);
    return bytes;
}

} // namespace catoptric
