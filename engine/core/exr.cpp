// Writes OpenEXR pictures with the OpenEXR library. OpenImageIO would write the same
// bytes, but takes a fifth of a second to load.
#include "core/error.hpp"
#include "core/exr_colours.hpp"
#include "core/image_codec.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfThreading.h>

namespace catoptric {

int start_exr_threads(uvec2 size) {
    constexpr std::size_t kLargePicturePixels = 1 << 19;
    if (std::size_t(size.x) * size.y < kLargePicturePixels) return 0;
    static std::once_flag once;
    std::call_once(once, [] {
        if (Imf::globalThreadCount() == 0)
            Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
    });
    return Imf::globalThreadCount();
}

namespace {

/// Collects the bytes of a file in memory, because a writer to disk may report success on a full
/// disk.
class ExrOutput final : public Imf::OStream {
public:
    ExrOutput() : OStream("memory") {}
    void write(const char data[], int size) override {
        const auto end = at_ + static_cast<std::size_t>(size);
        if (end > bytes_.size()) bytes_.resize(end);
        std::memcpy(bytes_.data() + at_, data, static_cast<std::size_t>(size));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }
    std::string take_bytes() { return std::move(bytes_); }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

std::vector<std::string> exr_channels(const ImageShape& shape) {
    if (!shape.channels.empty()) return shape.channels;
    switch (shape.channel_count) {
    case 1: return {"Y"};
    case 2: return {"R", "G"};
    case 3: return {"R", "G", "B"};
    default: return {"R", "G", "B", "A"};
    }
}

Imf::Header make_exr_header(const ImageShape& shape) {
    Imf::Header header(static_cast<int>(shape.size.x), static_cast<int>(shape.size.y));
    header.compression() = Imf::ZIP_COMPRESSION;
    // The time is constant, so that equal pictures have equal bytes.
    Imf::addCapDate(header, "2000:01:01 00:00:00");
    if (!shape.description.empty()) Imf::addComments(header, shape.description);
    return header;
}

std::string encode_channels(const ImageShape& shape, const std::vector<std::string>& channels,
                            std::span<const float> values) {
    Imf::Header header = make_exr_header(shape);
    Imf::FrameBuffer frame;
    const std::size_t pixel_bytes = shape.channel_count * sizeof(float);
    for (std::size_t channel = 0; channel < shape.channel_count; ++channel) {
        header.channels().insert(channels[channel], Imf::Channel(Imf::FLOAT));
        // OpenEXR has one type for buffers that it reads and buffers that it writes.
        auto* const first = reinterpret_cast<char*>(const_cast<float*>(&values[channel]));
        frame.insert(channels[channel],
                     Imf::Slice(Imf::FLOAT, first, pixel_bytes, pixel_bytes * shape.size.x));
    }
    ExrOutput memory;
    {
        Imf::OutputFile file(memory, header, start_exr_threads(shape.size));
        file.setFrameBuffer(frame);
        file.writePixels(static_cast<int>(shape.size.y));
    } // writes the table of line offsets
    return memory.take_bytes();
}

} // namespace

std::string encode_openexr(const ImageShape& shape, std::span<const float> values) {
    const std::size_t count = std::size_t(shape.size.x) * shape.size.y * shape.channel_count;
    const std::vector<std::string> channels = exr_channels(shape);
    check(count > 0 && channels.size() == shape.channel_count && values.size() == count,
          Failure::internal, "a picture of ", shape.size.x, "x", shape.size.y,
          " cannot be written as OpenEXR: wanted a name for each channel, found ", channels.size(),
          " names for ", shape.channel_count, " channels and ", values.size(), " values");
    try {
        return encode_channels(shape, channels, values);
    } catch (const std::bad_alloc&) {
        fail(Failure::exhausted, "not enough memory to encode OpenEXR");
    } catch (const std::exception& error) {
        fail(Failure::internal, "OpenEXR cannot encode a picture of ", shape.size.x, "x",
             shape.size.y, ": ", error.what());
    }
}

} // namespace catoptric
