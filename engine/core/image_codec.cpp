#include "core/image_codec.hpp"

#include "core/error.hpp"
#include "core/image_module.hpp"

#include <new>
#include <utility>

namespace catoptric {

namespace {

struct Beginning {
    std::string_view bytes, format;
};
using namespace std::string_view_literals;
constexpr Beginning kBeginnings[] = {{"\x89PNG\r\n\x1a\n", "png"},
                                     {"\xff\xd8\xff", "jpeg"},
                                     {"\x76\x2f\x31\x01", "openexr"},
                                     {"#?", "hdr"},
                                     {"BM", "bmp"},
                                     {"GIF8", "gif"},
                                     {"II*\0"sv, "tiff"},
                                     {"MM\0*"sv, "tiff"},
                                     {"DDS ", "dds"},
                                     {"8BPS", "psd"}};

/// Throws unless it is done.
void check_decoded(const CodecResult& result, const std::string& name, const std::string& format) {
    const std::string why = result.why.empty() ? "" : ": " + result.why;
    switch (result.answer) {
    case CodecAnswer::done: return;
    case CodecAnswer::no_codec:
        fail(Failure::bad_data, name, ": this OpenImageIO cannot read ", format);
    case CodecAnswer::refused: fail(Failure::bad_data, name, ": cannot be decoded", why);
    case CodecAnswer::out_of_memory:
        fail(Failure::exhausted, name, ": not enough memory to decode it");
    case CodecAnswer::broken: fail(Failure::internal, name, ": OpenImageIO fails", why);
    }
}

} // namespace

std::string image_format(std::string_view bytes) {
    for (const auto& [beginning, format] : kBeginnings)
        if (bytes.starts_with(beginning)) return std::string(format);
    if (bytes.starts_with("RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP")
        return "webp";
    return {};
}

struct ImageReader::Open {
    Open(std::string its_format, std::string its_name)
        : format(std::move(its_format)), name(std::move(its_name)) {}
    ~Open() {
        if (picture) codecs.close(picture);
    }
    Open(const Open&) = delete;
    Open& operator=(const Open&) = delete;

    template <typename Value>
    std::vector<Value> read(CodecValue type) {
        try {
            std::vector<Value> values(std::size_t(shape.size.x) * shape.size.y *
                                      shape.channel_count);
            check_decoded(codecs.read(*picture, type, values.data()), name, format);
            return values;
        } catch (const std::bad_alloc&) {
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
    }

    std::string format, name;
    const ImageCodecs& codecs = image_codecs();
    ImageCodecs::Picture* picture = nullptr;
    ImageShape shape;
};

ImageReader::ImageReader(std::string_view bytes, const std::string& format, std::string name)
    : open_(std::make_unique<Open>(format, std::move(name))) {
    ImageCodecs::Header header;
    check_decoded(open_->codecs.open(bytes, format, open_->name, open_->picture, header),
                  open_->name, format);
    const auto fits = [](int side) { return side > 0 && std::uint32_t(side) <= kLargestSide; };
    check(fits(header.size.x) && fits(header.size.y) && header.channel_count > 0 && !header.is_deep,
          Failure::bad_data, open_->name, ": wanted a flat picture of 1 to ", kLargestSide,
          " pixels a side, found ", header.is_deep ? "a deep one of " : "", header.size.x, "x",
          header.size.y, " with ", header.channel_count, " channels");
    open_->shape = {uvec2(header.size), std::size_t(header.channel_count),
                    std::move(header.channels)};
}

ImageReader::~ImageReader() = default;

const ImageShape& ImageReader::shape() const { return open_->shape; }
std::vector<float> ImageReader::floats() { return open_->read<float>(CodecValue::float32); }
std::vector<std::uint8_t> ImageReader::bytes() {
    return open_->read<std::uint8_t>(CodecValue::uint8);
}

std::string openexr_bytes(const ImageShape& shape, std::span<const float> values) {
    check(shape.size.x > 0 && shape.size.y > 0, Failure::internal, "a picture of ", shape.size.x,
          "x", shape.size.y, " cannot be written");
    std::string bytes;
    const auto [answer, why] = image_codecs().encode("openexr",
                                                     {.size = shape.size,
                                                      .channel_count = shape.channel_count,
                                                      .type = CodecValue::float32,
                                                      .values = values.data()},
                                                     bytes);
    check(answer != CodecAnswer::no_codec, Failure::internal,
          "this OpenImageIO cannot write openexr");
    check(answer != CodecAnswer::out_of_memory, Failure::exhausted,
          "not enough memory to encode OpenEXR");
    check(answer == CodecAnswer::done, Failure::internal, "OpenImageIO cannot encode openexr",
          why.empty() ? "" : ": ", why);
    return bytes;
}

} // namespace catoptric
