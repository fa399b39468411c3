// The module that links OpenImageIO, the only place that knows it. It opens no file of its own
// accord here.
#include "core/image_module.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <utility>

namespace catoptric {

struct ImageCodecs::Picture {
    explicit Picture(std::string_view bytes) : memory(bytes.data(), bytes.size()) {}

    OIIO::Filesystem::IOMemReader memory;
    std::unique_ptr<OIIO::ImageInput> input; // goes before what it reads from
    int channel_count = 0;
};

namespace {

OIIO::TypeDesc type_of(CodecValue type) {
    return type == CodecValue::float32 ? OIIO::TypeFloat : OIIO::TypeUInt8;
}

/// What OpenImageIO has to say, in one line.
template <typename Codec>
CodecResult refused(const Codec& codec) {
    std::string text = codec.geterror();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return {CodecAnswer::refused, std::move(text)};
}

/// What `work` returns, exceptions as results.
template <typename Work>
CodecResult without_exceptions(const Work& work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return {CodecAnswer::out_of_memory};
    } catch (const std::exception& error) {
        return {CodecAnswer::broken, error.what()};
    } catch (...) {
        return {CodecAnswer::broken, "with an exception of its own"};
    }
}

CodecResult open(std::string_view bytes, const std::string& format, const std::string& name,
                 ImageCodecs::Picture*& picture, ImageCodecs::Header& header) noexcept {
    picture = nullptr;
    return without_exceptions([&]() -> CodecResult {
        auto opened = std::make_unique<ImageCodecs::Picture>(bytes);
        opened->input = OIIO::ImageInput::create(format);
        if (!opened->input) return {CodecAnswer::no_codec};
        OIIO::ImageSpec hints, spec;
        hints.attribute("oiio:UnassociatedAlpha", 1); // colours as stored, not times alpha
        opened->input->set_ioproxy(&opened->memory);
        if (!opened->input->open(name, spec, hints)) return refused(*opened->input);
        header = {{spec.width, spec.height}, spec.nchannels, spec.deep, spec.channelnames};
        opened->channel_count = spec.nchannels;
        picture = opened.release();
        return {};
    });
}

CodecResult read(ImageCodecs::Picture& picture, CodecValue type, void* values) noexcept {
    return without_exceptions([&]() -> CodecResult {
        OIIO::ImageInput& input = *picture.input;
        if (!input.read_image(0, 0, 0, picture.channel_count, type_of(type), values))
            return refused(input);
        return {};
    });
}

void close(ImageCodecs::Picture* picture) noexcept { delete picture; }

/// In memory, since OpenImageIO's writers report success on a full disk. PNG is what core/png.cpp
/// is tested against.
CodecResult encode(const std::string& format, const ImageCodecs::Values& picture,
                   std::string& bytes) noexcept {
    return without_exceptions([&]() -> CodecResult {
        const OIIO::TypeDesc type = type_of(picture.type);
        OIIO::ImageSpec spec(static_cast<int>(picture.size.x), static_cast<int>(picture.size.y),
                             static_cast<int>(picture.channel_count), type);
        spec.attribute("DateTime",
                       "2000:01:01 00:00:00"); // not the clock: same picture, same bytes
        spec.attribute("oiio:ColorSpace", format == "png" ? "sRGB" : "Linear");
        spec.attribute("oiio:UnassociatedAlpha", 1);
        OIIO::Filesystem::IOVecOutput memory;
        const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
        if (!output) return {CodecAnswer::no_codec};
        output->set_ioproxy(&memory);
        if (!output->open("memory." + format, spec) || !output->write_image(type, picture.values) ||
            !output->close())
            return refused(*output);
        bytes.assign(memory.buffer().begin(), memory.buffer().end());
        return {};
    });
}

constexpr ImageCodecs kCodecs{.open = open, .read = read, .close = close, .encode = encode};

} // namespace

} // namespace catoptric

extern "C" __attribute__((visibility("default"))) const catoptric::ImageCodecs*
catoptric_image_codecs_1() {
    return &catoptric::kCodecs;
}
