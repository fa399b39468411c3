// The module that links OpenImageIO; no other code uses it. It opens no files itself: pictures are
// read from and written to memory.
#include "core/image_module.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace catoptric {

namespace {

/// Lets OpenImageIO read from a source of bytes.
class ByteSourceProxy final : public OIIO::Filesystem::IOProxy {
public:
    explicit ByteSourceProxy(const ByteSource& bytes) : IOProxy("", Read), bytes_(bytes) {}

    const char* proxytype() const override { return "catoptric"; }
    std::size_t size() const override { return bytes_.size(); }
    std::size_t read(void* into, std::size_t size) override {
        const std::size_t count = pread(into, size, m_pos);
        m_pos += static_cast<std::int64_t>(count);
        return count;
    }
    std::size_t pread(void* into, std::size_t size, std::int64_t offset) override {
        try {
            return bytes_.read(static_cast<std::uint64_t>(offset),
                               {static_cast<char*>(into), size});
        } catch (const std::exception&) {
            return 0; // the reader reports a short read
        }
    }

private:
    const ByteSource& bytes_;
};

} // namespace

struct ImageCodecs::Picture {
    std::string copied_bytes; // read by a proxy of OpenImageIO's own
    std::unique_ptr<OIIO::Filesystem::IOProxy> proxy;
    std::unique_ptr<OIIO::ImageInput> input; // destroyed before the proxy that it reads from
    int channel_count = 0;
};

namespace {

/// The JPEG reader of OpenImageIO 2.4 accepts only OpenImageIO's own proxies, so it gets a copy of
/// all bytes.
void attach_source(ImageCodecs::Picture& picture, const ByteSource& bytes,
                   const std::string& format) {
    if (format != "jpeg") {
        picture.proxy = std::make_unique<ByteSourceProxy>(bytes);
        return;
    }
    std::string& copy = picture.copied_bytes;
    copy.resize(bytes.size());
    copy.resize(bytes.read(0, {copy.data(), copy.size()}));
    picture.proxy = std::make_unique<OIIO::Filesystem::IOMemReader>(copy.data(), copy.size());
}

OIIO::TypeDesc to_oiio_type(PixelType type) {
    return type == PixelType::float32 ? OIIO::TypeFloat : OIIO::TypeUInt8;
}

/// Returns OpenImageIO's error message, in one line.
template <typename Codec>
CodecResult last_error(const Codec& codec) {
    std::string text = codec.geterror();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return {CodecStatus::refused, std::move(text)};
}

/// Returns the result of `work`, with exceptions turned into results.
template <typename Work>
CodecResult run_codec(const Work& work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return {CodecStatus::out_of_memory};
    } catch (const std::exception& error) {
        return {CodecStatus::broken, error.what()};
    } catch (...) {
        return {CodecStatus::broken, "with an exception of its own"};
    }
}

constexpr const char* kDescriptionName = "ImageDescription";

CodecResult open_picture(const ByteSource& bytes, const std::string& format,
                         const std::string& name, ImageCodecs::Picture*& picture,
                         ImageCodecs::Header& header) noexcept {
    picture = nullptr;
    return run_codec([&]() -> CodecResult {
        auto opened = std::make_unique<ImageCodecs::Picture>();
        attach_source(*opened, bytes, format);
        opened->input = OIIO::ImageInput::create(format);
        if (!opened->input) return {CodecStatus::no_codec};
        OIIO::ImageSpec hints, spec;
        hints.attribute("oiio:UnassociatedAlpha", 1); // colours as stored, not multiplied by alpha
        opened->input->set_ioproxy(opened->proxy.get());
        if (!opened->input->open(name, spec, hints)) return last_error(*opened->input);
        header = {{spec.width, spec.height},
                  spec.nchannels,
                  spec.deep,
                  spec.channelnames,
                  std::string(opened->input->spec().get_string_attribute(kDescriptionName))};
        opened->channel_count = spec.nchannels;
        picture = opened.release();
        return {};
    });
}

/// Reads all tiles that contain the rows, and copies the rows from them.
bool read_tile_rows(OIIO::ImageInput& input, std::uint32_t first, std::uint32_t row_count,
                    int channel_count, const OIIO::TypeDesc& type, void* values) {
    const OIIO::ImageSpec& spec = input.spec();
    const int begin = static_cast<int>(first), end = begin + static_cast<int>(row_count);
    const int from = begin / spec.tile_height * spec.tile_height;
    const int to = std::min((end + spec.tile_height - 1) / spec.tile_height * spec.tile_height,
                            spec.height);
    const std::size_t row = std::size_t(spec.width) * std::size_t(channel_count) * type.size();
    std::vector<char> tiles(row * std::size_t(to - from));
    if (!input.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + from, spec.y + to, spec.z,
                          spec.z + 1, 0, channel_count, type, tiles.data()))
        return false;
    std::memcpy(values, tiles.data() + row * std::size_t(begin - from), row * row_count);
    return true;
}

CodecResult read_rows(ImageCodecs::Picture& picture, std::uint32_t first, std::uint32_t row_count,
                      PixelType type, void* values) noexcept {
    return run_codec([&]() -> CodecResult {
        OIIO::ImageInput& input = *picture.input;
        const OIIO::ImageSpec& spec = input.spec();
        const int from = spec.y + static_cast<int>(first);
        const bool is_read = spec.tile_width > 0
                                 ? read_tile_rows(input, first, row_count, picture.channel_count,
                                                  to_oiio_type(type), values)
                                 : input.read_scanlines(
                                       0, 0, from, from + static_cast<int>(row_count), 0, 0,
                                       picture.channel_count, to_oiio_type(type), values);
        if (!is_read) return last_error(input);
        return {};
    });
}

void close_picture(ImageCodecs::Picture* picture) noexcept { delete picture; }

/// Encodes to memory, because OpenImageIO's writers report success on a full disk. The engine
/// itself writes PNG and OpenEXR files. Tests compare its files with those of this function.
CodecResult encode_picture(const std::string& format, const ImageCodecs::Pixels& picture,
                           std::string& bytes) noexcept {
    return run_codec([&]() -> CodecResult {
        const OIIO::TypeDesc type = to_oiio_type(picture.type);
        OIIO::ImageSpec spec(static_cast<int>(picture.size.x), static_cast<int>(picture.size.y),
                             static_cast<int>(picture.channel_count), type);
        spec.attribute("DateTime",
                       "2000:01:01 00:00:00"); // constant, so that equal pictures have equal bytes
        spec.attribute("oiio:ColorSpace", format == "png" ? "sRGB" : "Linear");
        spec.attribute("oiio:UnassociatedAlpha", 1);
        if (!picture.channels.empty()) spec.channelnames = picture.channels;
        if (!picture.description.empty()) spec.attribute(kDescriptionName, picture.description);
        OIIO::Filesystem::IOVecOutput memory;
        const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
        if (!output) return {CodecStatus::no_codec};
        output->set_ioproxy(&memory);
        if (!output->open("memory." + format, spec) || !output->write_image(type, picture.values) ||
            !output->close())
            return last_error(*output);
        bytes.assign(memory.buffer().begin(), memory.buffer().end());
        return {};
    });
}

constexpr ImageCodecs kOpenImageIoCodecs{
    .open = open_picture, .read = read_rows, .close = close_picture, .encode = encode_picture};

} // namespace

} // namespace catoptric

extern "C" __attribute__((visibility("default"))) const catoptric::ImageCodecs*
catoptric_image_codecs_3() {
    return &catoptric::kOpenImageIoCodecs;
}
