#include "replay.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// Declares random passes. Each pass reads only contents that an earlier pass has written, or
/// contents of the previous frame.
class Author {
public:
    explicit Author(std::mt19937& random) : random_(random) {}

    Graph write() {
        add_resources();
        const std::uint32_t passes = below(14) + 2;
        for (std::uint32_t p = 0; p < passes; ++p) add_pass(p);
        for (std::uint32_t i = 0; i < images_.size(); ++i)
            if ((graph_.lifetime(i) == ImageLifetime::previous)) write_all(i);
        mark_output();
        return std::move(graph_);
    }

private:
    std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>(random_()) % count;
    }
    bool chance(std::uint32_t percent) { return below(100) < percent; }
    bool is_depth(const ImageHandle& image) const {
        return catoptric::is_depth(graph_.images()[image.id].format);
    }

    void add_resources() {
        const Format formats[] = {Format::rgba16f, Format::r8_unorm, Format::rgba32f, Format::d32f,
                                  Format::r32f};
        const std::uint32_t images = below(6) + 3;
        for (std::uint32_t i = 0; i < images; ++i) {
            images_.push_back(graph_.add_image({.name = "i" + std::to_string(i),
                                                .format = formats[i == 0 ? 0 : below(5)],
                                                .width = 8,
                                                .height = 8,
                                                .layers = below(4) + 1}));
            written_.emplace_back(images_.back().layer_count, false);
        }
        const std::uint32_t buffers = below(3);
        for (std::uint32_t b = 0; b < buffers; ++b) {
            buffers_.push_back(
                graph_.add_buffer({.name = "b" + std::to_string(b), .bytes = 100 + below(2000)}));
            buffer_written_.push_back(false);
        }
    }

    bool is_written(const ImageHandle& image) const {
        const auto first = written_[image.id].begin() + image.first_layer;
        return std::all_of(first, first + image.layer_count, [](bool w) { return w; });
    }

    ImageHandle part_of(const ImageHandle& image) {
        const std::uint32_t first = below(image.layer_count);
        return image.layers(first, below(image.layer_count - first) + 1);
    }

    void add_pass(std::uint32_t number) {
        PassBuilder pass = graph_.add_pass("p" + std::to_string(number),
                                           chance(40) ? PassTag::scene : PassTag::none);
        touched_.assign(images_.size(), false);
        const ImageHandle target = part_of(
            images_[below(static_cast<std::uint32_t>(images_.size()))]);
        touched_[target.id] = true;
        const bool raster = is_depth(target) || chance(40);
        const bool copy = !raster && chance(30);
        if (raster)
            add_attachments(pass, target);
        else if (copy)
            pass.writes(target, ResourceUse::copy_to);
        else if (is_written(target) && chance(40))
            pass.writes(target, ResourceUse::storage);
        else
            pass.writes(target, ResourceUse::storage_write);
        add_reads(pass, copy);
        add_disjoint_read(pass, target, copy);
        add_buffers(pass, copy);
        pass.record([](PassCommands&) {});
        std::fill_n(written_[target.id].begin() + target.first_layer, target.layer_count, true);
    }

    void add_attachments(PassBuilder& pass, const ImageHandle& target) {
        const ResourceUse use = is_depth(target) ? ResourceUse::depth : ResourceUse::colour;
        std::optional<ClearValue> clear;
        if (!is_written(target) || chance(60)) clear = ClearValue{};
        pass.writes(target, use, clear).set_layer_count(target.layer_count);
        if (use == ResourceUse::depth || chance(50)) return;
        for (const ImageHandle& image : images_) { // attaches a depth image for the depth test
            if (!is_depth(image) || image.layer_count < target.layer_count) continue;
            const ImageHandle depth = image.layers(0, target.layer_count);
            if (!is_written(depth)) continue;
            touched_[image.id] = true;
            pass.reads(depth, ResourceUse::depth);
            return;
        }
    }

    ResourceUse read_use(const ImageHandle& image, bool copy) {
        if (copy) return ResourceUse::copy_from;
        return !is_depth(image) && chance(30) ? ResourceUse::storage_read : ResourceUse::sampled;
    }

    void add_reads(PassBuilder& pass, bool copy) {
        for (std::uint32_t n = below(7); n > 0; --n) {
            const ImageHandle image = part_of(
                images_[below(static_cast<std::uint32_t>(images_.size()))]);
            if (touched_[image.id]) continue;
            if (is_written(image)) {
                touched_[image.id] = true;
                pass.reads(image, read_use(image, copy));
            } else if (chance(6)) {
                touched_[image.id] = true;
                pass.reads(graph_.previous_contents(image), read_use(image, copy));
            }
        }
    }

    /// Adds a read of the target image: of layers that the pass does not write, or of the previous
    /// frame.
    void add_disjoint_read(PassBuilder& pass, const ImageHandle& target, bool copy) {
        if (target.first_layer == 0) return;
        const ImageHandle rest = images_[target.id].layers(0, target.first_layer);
        if (is_written(rest) && chance(50))
            pass.reads(rest, read_use(rest, copy));
        else if (chance(10))
            pass.reads(graph_.previous_contents(target), ResourceUse::sampled);
    }

    void add_buffers(PassBuilder& pass, bool copy) {
        for (std::uint32_t b = 0; b < buffers_.size(); ++b) {
            if (chance(50)) continue;
            if (buffer_written_[b] && chance(60)) {
                pass.reads(buffers_[b], copy ? ResourceUse::copy_from : ResourceUse::storage_read);
                if (!copy && chance(50)) pass.reads(buffers_[b], ResourceUse::indirect);
                continue;
            }
            const bool modifies = buffer_written_[b] && chance(50);
            const ResourceUse compute = modifies ? ResourceUse::storage
                                                 : ResourceUse::storage_write;
            pass.writes(buffers_[b], copy ? ResourceUse::copy_to : compute);
            buffer_written_[b] = true;
        }
    }

    /// Adds a pass that writes all layers of an image whose previous contents are read. Otherwise
    /// the next frame would read contents that were never written.
    void write_all(std::uint32_t id) {
        if (is_written(images_[id])) return;
        graph_.add_pass("all" + std::to_string(id))
            .writes(images_[id], is_depth(images_[id]) ? ResourceUse::depth : ResourceUse::colour,
                    ClearValue{})
            .set_layer_count(images_[id].layer_count)
            .record([](PassCommands&) {});
        written_[id].assign(images_[id].layer_count, true);
    }

    void mark_output() {
        for (const ImageHandle& image : images_) {
            const ImageHandle part = part_of(image);
            if (is_written(part) && chance(15)) graph_.mark_output(part);
        }
        for (const ImageHandle& image : images_) // so that most graphs have an output
            if (graph_.output_images().empty() && is_written(image.layers(0, 1)))
                graph_.mark_output(image.layers(0, 1));
        for (std::uint32_t b = 0; b < buffers_.size(); ++b)
            if (buffer_written_[b] && chance(20)) graph_.mark_output(buffers_[b]);
    }

    std::mt19937& random_;
    Graph graph_;
    std::vector<ImageHandle> images_;
    std::vector<BufferHandle> buffers_;
    std::vector<std::vector<bool>> written_;
    std::vector<bool> buffer_written_;
    std::vector<bool> touched_; // images that the current pass uses
};

} // namespace

Graph random_graph(std::mt19937& random) { return Author(random).write(); }

} // namespace catoptric::graph
