#include "core/image_codec.hpp"

#include "core/error.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
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

/// ": " and what OpenImageIO has to say, in one line; nothing if it says nothing.
template <typename Codec>
std::string reason(const Codec& codec) {
    std::string text = codec.geterror();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? text : ": " + text;
}

/// Encodes in memory: OpenImageIO's PNG writer reports success on a full disk.
std::string encode(const std::string& format, const ImageShape& shape, const void* values,
                   const OIIO::TypeDesc& type) {
    check(shape.size.x > 0 && shape.size.y > 0, Failure::internal, "a picture of ", shape.size.x,
          "x", shape.size.y, " cannot be written");
    OIIO::ImageSpec spec(static_cast<int>(shape.size.x), static_cast<int>(shape.size.y),
                         static_cast<int>(shape.channel_count), type);
    spec.attribute("DateTime", "2000:01:01 00:00:00"); // not the clock: same picture, same bytes
    spec.attribute("oiio:ColorSpace", format == "png" ? "sRGB" : "Linear");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    OIIO::Filesystem::IOVecOutput memory;
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    check(output != nullptr, Failure::internal, "this OpenImageIO cannot write ", format);
    output->set_ioproxy(&memory);
    const bool encoded = output->open("memory." + format, spec) &&
                         output->write_image(type, values) && output->close();
    check(encoded, Failure::internal, "OpenImageIO cannot encode ", format, reason(*output));
    const std::vector<unsigned char>& bytes = memory.buffer();
    return {bytes.begin(), bytes.end()};
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
    Open(std::string_view bytes, std::string its_name)
        : name(std::move(its_name)), memory(bytes.data(), bytes.size()) {}

    template <typename Value>
    std::vector<Value> read(const OIIO::TypeDesc& type) {
        try {
            std::vector<Value> values(std::size_t(shape.size.x) * shape.size.y *
                                      shape.channel_count);
            const bool is_read = input->read_image(0, 0, 0, static_cast<int>(shape.channel_count),
                                                   type, values.data());
            check(is_read, Failure::bad_data, name, ": cannot be decoded", reason(*input));
            return values;
        } catch (const std::bad_alloc&) {
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
    }

    std::string name;
    OIIO::Filesystem::IOMemReader memory;
    std::unique_ptr<OIIO::ImageInput> input; // goes before what it reads from
    ImageShape shape;
};

ImageReader::ImageReader(std::string_view bytes, const std::string& format, std::string name)
    : open_(std::make_unique<Open>(bytes, std::move(name))) {
    open_->input = OIIO::ImageInput::create(format);
    check(open_->input != nullptr, Failure::internal, "this OpenImageIO cannot read ", format);
    OIIO::ImageSpec hints, spec;
    hints.attribute("oiio:UnassociatedAlpha", 1); // colours as stored, not times alpha
    open_->input->set_ioproxy(&open_->memory);
    const bool opened = open_->input->open(open_->name, spec, hints);
    check(opened, Failure::bad_data, open_->name, ": cannot be decoded", reason(*open_->input));
    const auto fits = [](int side) { return side > 0 && std::uint32_t(side) <= kLargestSide; };
    check(fits(spec.width) && fits(spec.height) && spec.nchannels > 0 && !spec.deep,
          Failure::bad_data, open_->name, ": wanted a flat picture of 1 to ", kLargestSide,
          " pixels a side, found ", spec.deep ? "a deep one of " : "", spec.width, "x", spec.height,
          " with ", spec.nchannels, " channels");
    open_->shape = {{std::uint32_t(spec.width), std::uint32_t(spec.height)},
                    std::size_t(spec.nchannels),
                    spec.channelnames};
}

ImageReader::~ImageReader() = default;

const ImageShape& ImageReader::shape() const { return open_->shape; }
std::vector<float> ImageReader::floats() { return open_->read<float>(OIIO::TypeFloat); }
std::vector<std::uint8_t> ImageReader::bytes() {
    return open_->read<std::uint8_t>(OIIO::TypeUInt8);
}

std::string openexr_bytes(const ImageShape& shape, std::span<const float> values) {
    return encode("openexr", shape, values.data(), OIIO::TypeFloat);
}

std::string png_bytes(const ImageShape& shape, std::span<const std::uint8_t> values) {
    return encode("png", shape, values.data(), OIIO::TypeUInt8);
}

} // namespace catoptric
