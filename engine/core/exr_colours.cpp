#include "core/exr_colours.hpp"

#include "core/error.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

namespace catoptric {

namespace {

class ExrInput final : public Imf::IStream {
public:
    explicit ExrInput(const ByteSource& bytes) : IStream("memory"), bytes_(bytes) {}
    bool read(char into[], int size) override {
        const std::span<char> wanted(into, static_cast<std::size_t>(size));
        if (bytes_.read(at_, wanted) < wanted.size())
            throw std::runtime_error("the file ends too early");
        at_ += wanted.size();
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

private:
    const ByteSource& bytes_;
    std::uint64_t at_ = 0;
};

/// Colours that one part of a file has under one name.
struct ExrLayer {
    std::string name;   ///< as FILE:LAYER names it; empty for colours without a layer
    std::string prefix; ///< of the channels' names, with the dot
    int part = 0;
    std::vector<std::string> channels; ///< "R", "G", "B" or "Y", then "A" if it has one
};

/// Returns a list of names for a message: the first of many.
std::string join_names(const std::vector<std::string>& names) {
    constexpr std::size_t kMostNames = 16;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
        text += (i == 0 ? "" : ", ") + escape(names[i]);
    if (names.size() > kMostNames)
        text += " and " + std::to_string(names.size() - kMostNames) + " more";
    return text;
}

std::vector<ExrLayer> part_layers(const Imf::Header& header, int part,
                                  const std::string& part_name) {
    std::map<std::string, std::set<std::string>> colours_of; // by prefix with the dot
    const Imf::ChannelList& channels = header.channels();
    for (auto at = channels.begin(); at != channels.end(); ++at) {
        const std::string name = at.name();
        const std::size_t dot = name.rfind('.');
        const std::size_t begin = dot == name.npos ? 0 : dot + 1;
        // Channels with fewer samples than pixels are no colours of pixels.
        const bool is_whole = at.channel().xSampling == 1 && at.channel().ySampling == 1;
        if (is_whole) colours_of[name.substr(0, begin)].insert(name.substr(begin));
    }
    std::vector<ExrLayer> layers;
    for (const auto& [prefix, colours] : colours_of) {
        const bool is_coloured = colours.contains("R") && colours.contains("G") &&
                                 colours.contains("B");
        // Y with X is a direction or a place, with RY and BY a luminance without its colours.
        const bool is_grey = colours.contains("Y") && !colours.contains("X") &&
                             !colours.contains("RY") && !colours.contains("BY");
        if (!is_coloured && !is_grey) continue;
        ExrLayer layer{.prefix = prefix, .part = part};
        layer.name = prefix.substr(0, prefix.size() - (prefix.empty() ? 0 : 1));
        if (!part_name.empty() && layer.name != part_name && !prefix.starts_with(part_name + "."))
            layer.name = layer.name.empty() ? part_name : part_name + "." + layer.name;
        if (is_coloured)
            layer.channels = {"R", "G", "B"};
        else
            layer.channels = {"Y"};
        if (colours.contains("A")) layer.channels.emplace_back("A");
        layers.push_back(std::move(layer));
    }
    return layers;
}

/// The layers and channels of all parts of a file.
struct ExrContents {
    explicit ExrContents(const Imf::MultiPartInputFile& file) {
        for (int part = 0; part < file.parts(); ++part) {
            const Imf::Header& header = file.header(part);
            const std::string part_name = file.parts() > 1 && header.hasName() ? header.name() : "";
            const std::string before = part_name.empty() ? "" : part_name + ": ";
            for (auto at = header.channels().begin(); at != header.channels().end(); ++at)
                channel_names.push_back(before + at.name());
            std::ranges::move(part_layers(header, part, part_name), std::back_inserter(layers));
        }
    }
    std::vector<std::string> layer_names() const {
        std::vector<std::string> names;
        for (const ExrLayer& layer : layers)
            names.push_back(layer.name.empty() ? "(colours without a layer)" : layer.name);
        return names;
    }

    std::vector<ExrLayer> layers;
    std::vector<std::string> channel_names;
};

[[noreturn]] void refuse_several_layers(const ExrContents& file, const std::string& name) {
    fail(Failure::bad_data, name, ": wanted one picture, found the layers ",
         join_names(file.layer_names()), "; choose one with FILE:LAYER");
}

ExrLayer choose_layer(const ExrContents& file, const std::string& name, const std::string& wanted) {
    const auto keep = [&](const auto& fits) {
        std::vector<ExrLayer> kept;
        std::ranges::copy_if(file.layers, std::back_inserter(kept), fits);
        return kept;
    };
    if (file.layers.empty())
        fail(Failure::bad_data, name, ": wanted the channels R, G and B, or Y, found ",
             join_names(file.channel_names));
    if (!wanted.empty()) {
        const std::vector<ExrLayer> named = keep([&](const ExrLayer& layer) {
            return layer.name == wanted || layer.prefix == wanted + ".";
        });
        if (named.size() == 1) return named.front();
        if (named.empty())
            fail(Failure::bad_data, name, ": wanted one of the layers ",
                 join_names(file.layer_names()), ", found ", quote(wanted));
        refuse_several_layers(file, name);
    }
    const auto is_coloured = [](const ExrLayer& layer) { return layer.channels.front() == "R"; };
    const std::vector<ExrLayer> plain = keep(
        [&](const ExrLayer& layer) { return layer.prefix.empty() && is_coloured(layer); });
    if (plain.size() == 1) return plain.front();
    const std::vector<ExrLayer> coloured = keep(is_coloured);
    if (plain.empty() && coloured.size() == 1) return coloured.front();
    if (coloured.empty() && file.layers.size() == 1) return file.layers.front();
    refuse_several_layers(file, name);
}

uvec2 window_size(const Imath::Box2i& window) {
    return {std::uint32_t(window.max.x) - std::uint32_t(window.min.x) + 1,
            std::uint32_t(window.max.y) - std::uint32_t(window.min.y) + 1};
}

/// Throws if the display window is much larger than the stored pixels, as in a file that would
/// cost memory for nothing.
void check_display(uvec2 display, uvec2 data, const std::string& name) {
    constexpr std::uint64_t kAlwaysAllowed = 1 << 22, kMostTimes = 64;
    const auto area = [](uvec2 size) { return std::uint64_t(size.x) * size.y; };
    check(area(display) <= kAlwaysAllowed || area(display) / kMostTimes <= area(data),
          Failure::bad_data, name, ": wanted a display window of at most ", kMostTimes,
          " times the stored pixels, found ", display.x, "x", display.y, " for ", data.x, "x",
          data.y);
}

/// Runs `work` and turns errors of OpenEXR into `bad_data`.
template <typename Work>
auto run_exr(const std::string& name, const Work& work) {
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        std::string why = error.what();
        std::ranges::replace(why, '\n', ' ');
        fail(Failure::bad_data, name, ": cannot be decoded: ", why);
    }
}

} // namespace

struct ExrColourReader::State {
    State(const ByteSource& bytes, const std::string& file_name, uvec2 size,
          const std::string& wanted)
        : name(file_name), input(bytes), file(input, start_exr_threads(size)),
          layer(choose_layer(ExrContents(file), name, wanted)), part(file, layer.part) {
        const Imf::Header& header = part.header();
        shape.size = window_size(header.displayWindow());
        shape.channels = layer.channels;
        shape.channel_count = layer.channels.size();
        if (Imf::hasComments(header)) shape.description = Imf::comments(header);
        check_display(shape.size, window_size(header.dataWindow()), name);
    }

    std::string name;
    ExrInput input;
    Imf::MultiPartInputFile file; // destroyed before the input that it reads from
    ExrLayer layer;
    Imf::InputPart part;
    ImageShape shape;
};

ExrColourReader::ExrColourReader(const ByteSource& bytes, const std::string& name, uvec2 size,
                                 const std::string& layer)
    : state_(run_exr(name, [&] { return std::make_unique<State>(bytes, name, size, layer); })) {}
ExrColourReader::~ExrColourReader() = default;

const ImageShape& ExrColourReader::shape() const { return state_->shape; }

void ExrColourReader::read_rows(std::uint32_t first, std::uint32_t row_count, float* values) {
    State& state = *state_;
    const ImageShape& shape = state.shape;
    const Imath::Box2i &data = state.part.header().dataWindow(),
                       &display = state.part.header().displayWindow();
    const std::size_t channel_count = shape.channel_count;
    std::fill_n(values, std::size_t(row_count) * shape.size.x * channel_count, 0.f);
    const int top = display.min.y + static_cast<int>(first), begin = std::max(top, data.min.y),
              end = std::min(top + static_cast<int>(row_count) - 1, data.max.y),
              left = std::max(display.min.x, data.min.x),
              right = std::min(display.max.x, data.max.x);
    if (begin > end || left > right) return;
    // Rows of the data window, which the display window may cut on both sides.
    const std::size_t stored_width = window_size(data).x;
    const auto rows = static_cast<std::size_t>(end - begin + 1);
    const bool is_whole = data == display;
    std::vector<float> stored(is_whole ? 0 : rows * stored_width * channel_count);
    float* const target = is_whole ? values : stored.data();
    const std::size_t pixel_bytes = channel_count * sizeof(float);
    Imf::FrameBuffer frame;
    for (std::size_t channel = 0; channel < channel_count; ++channel)
        frame.insert(state.layer.prefix + shape.channels[channel],
                     Imf::Slice::Make(Imf::FLOAT, target + channel, {data.min.x, begin},
                                      std::int64_t(stored_width), std::int64_t(rows), pixel_bytes,
                                      pixel_bytes * stored_width));
    run_exr(state.name, [&] {
        state.part.setFrameBuffer(frame);
        state.part.readPixels(begin, end);
    });
    if (is_whole) return;
    const std::size_t shown = std::size_t(right - left + 1) * channel_count;
    for (int y = begin; y <= end; ++y) {
        const float* const from = stored.data() + (std::size_t(y - begin) * stored_width +
                                                   std::size_t(left - data.min.x)) *
                                                      channel_count;
        float* const to = values + (std::size_t(y - top) * shape.size.x +
                                    std::size_t(left - display.min.x)) *
                                       channel_count;
        std::copy_n(from, shown, to);
    }
}

} // namespace catoptric
