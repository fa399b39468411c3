// Writes and reads OpenEXR pictures with the OpenEXR library. OpenImageIO would write the same
// bytes, but takes a fifth of a second to load.
#include "core/error.hpp"
#include "core/exr_read.hpp"
#include "core/exr_stream.hpp"
#include "core/image_codec.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfVersion.h>

namespace catoptric {

namespace {

/// Collects the bytes of a file in memory, because a writer to disk may report success on a full
/// disk.
class ExrMemoryOutput final : public Imf::OStream {
public:
    ExrMemoryOutput() : OStream("memory") {}
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

std::vector<std::string> list_exr_channel_names(const ImageSizeAndChannels& shape) {
    if (!shape.channels.empty()) return shape.channels;
    switch (shape.channel_count) {
    case 1: return {"Y"};
    case 2: return {"R", "G"};
    case 3: return {"R", "G", "B"};
    default: return {"R", "G", "B", "A"};
    }
}

Imf::Header make_exr_header(const ImageSizeAndChannels& shape) {
    Imf::Header header(static_cast<int>(shape.size.x), static_cast<int>(shape.size.y));
    header.compression() = Imf::ZIP_COMPRESSION;
    // The time is constant, so that equal pictures have equal bytes.
    Imf::addCapDate(header, "2000:01:01 00:00:00");
    if (!shape.description.empty()) Imf::addComments(header, shape.description);
    return header;
}

std::string encode_openexr_in_memory(const ImageSizeAndChannels& shape,
                                     const std::vector<std::string>& channels,
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
    ExrMemoryOutput memory;
    {
        Imf::OutputFile file(memory, header, start_exr_threads(shape.size));
        file.setFrameBuffer(frame);
        file.writePixels(static_cast<int>(shape.size.y));
    } // writes the table of line offsets
    return memory.take_bytes();
}

} // namespace

std::string encode_openexr(const ImageSizeAndChannels& shape, std::span<const float> values) {
    const std::size_t count = std::size_t(shape.size.x) * shape.size.y * shape.channel_count;
    const std::vector<std::string> channels = list_exr_channel_names(shape);
    check(count > 0 && channels.size() == shape.channel_count && values.size() == count,
          Failure::internal, "a picture of ", shape.size.x, "x", shape.size.y,
          " cannot be written as OpenEXR: wanted a name for each channel, found ", channels.size(),
          " names for ", shape.channel_count, " channels and ", values.size(), " values");
    try {
        return encode_openexr_in_memory(shape, channels, values);
    } catch (const std::bad_alloc&) {
        fail(Failure::exhausted, "not enough memory to encode OpenEXR");
    } catch (const std::exception& error) {
        fail(Failure::internal, "OpenEXR cannot encode a picture of ", shape.size.x, "x",
             shape.size.y, ": ", error.what());
    }
}

namespace {

/// Returns the channels in the order of a pixel's values; none if the picture is not a usual one.
std::vector<std::string> list_usual_exr_channels(const Imf::InputFile& file) {
    if (Imf::isMultiPart(file.version())) return {};
    std::vector<std::string> found;
    const Imf::ChannelList& channels = file.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        if (channel.channel().type == Imf::UINT || channel.channel().xSampling != 1 ||
            channel.channel().ySampling != 1)
            return {};
        found.emplace_back(channel.name());
    }
    for (const std::vector<std::string>& usual :
         std::vector<std::vector<std::string>>{{"R", "G", "B"}, {"R", "G", "B", "A"}, {"Y"}})
        if (std::ranges::is_permutation(found, usual)) return usual;
    return {};
}

} // namespace

struct ExrReader::ExrReadState {
    ExrReadState(const RandomAccessByteSource& bytes, std::string file_name, uvec2 size)
        : name(std::move(file_name)), input(bytes), file(input, start_exr_threads(size)) {}

    std::string name;
    ExrByteSourceInput input;
    Imf::InputFile file; // destroyed before the input that it reads from
    ImageSizeAndChannels shape;
};

ExrReader::ExrReader(std::unique_ptr<ExrReadState> state) : exr_state_(std::move(state)) {}
ExrReader::~ExrReader() = default;

std::unique_ptr<ExrReader> ExrReader::open_usual_picture(const RandomAccessByteSource& bytes,
                                                         const std::string& name, uvec2 size) {
    try {
        auto state = std::make_unique<ExrReadState>(bytes, name, size);
        ImageSizeAndChannels& shape = state->shape;
        shape.channels = list_usual_exr_channels(state->file);
        if (shape.channels.empty()) return nullptr;
        shape.channel_count = shape.channels.size();
        const Imath::Box2i& window = state->file.header().dataWindow();
        shape.size = {std::uint32_t(window.max.x) - std::uint32_t(window.min.x) + 1,
                      std::uint32_t(window.max.y) - std::uint32_t(window.min.y) + 1};
        if (Imf::hasComments(state->file.header()))
            shape.description = Imf::comments(state->file.header());
        return std::unique_ptr<ExrReader>(new ExrReader(std::move(state)));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {
        return nullptr;
    }
}

ImageSizeAndChannels ExrReader::image_size_and_channels() const { return exr_state_->shape; }

void ExrReader::read_image_rows(std::uint32_t first, std::uint32_t row_count, float* values) {
    const ImageSizeAndChannels& shape = exr_state_->shape;
    const Imath::Box2i& window = exr_state_->file.header().dataWindow();
    const int begin = window.min.y + static_cast<int>(first);
    const std::size_t pixel_bytes = shape.channel_count * sizeof(float);
    Imf::FrameBuffer frame;
    for (std::size_t channel = 0; channel < shape.channel_count; ++channel)
        frame.insert(shape.channels[channel],
                     Imf::Slice::Make(Imf::FLOAT, values + channel, {window.min.x, begin},
                                      shape.size.x, row_count, pixel_bytes,
                                      pixel_bytes * shape.size.x));
    try {
        exr_state_->file.setFrameBuffer(frame);
        exr_state_->file.readPixels(begin, begin + static_cast<int>(row_count) - 1);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        std::string why = error.what();
        std::ranges::replace(why, '\n', ' ');
        fail(Failure::bad_data, exr_state_->name, ": cannot be decoded: ", why);
    }
}

} // namespace catoptric
