#include "replay.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// Declares random passes. Each pass reads only contents that an earlier pass has written, or
/// contents of the previous frame.
class RandomGraphAuthor {
public:
    explicit RandomGraphAuthor(std::mt19937& random) : random_(random) {}

    Graph write_random_graph() {
        add_random_resources();
        const std::uint32_t passes = random_number_below(14) + 2;
        for (std::uint32_t p = 0; p < passes; ++p) add_random_pass(p);
        for (std::uint32_t i = 0; i < images_.size(); ++i)
            if ((graph_.image_lifetime(i) == Lifetime::previous)) add_pass_writing_whole_image(i);
        mark_random_output();
        return std::move(graph_);
    }

private:
    std::uint32_t random_number_below(std::uint32_t count) {
        return static_cast<std::uint32_t>(random_()) % count;
    }
    bool is_chosen_with_chance(std::uint32_t percent) { return random_number_below(100) < percent; }
    bool is_depth_image(const ImageHandle& image) const {
        return catoptric::is_depth(graph_.images()[image.id].format);
    }

    void add_random_resources() {
        const TexelFormat formats[] = {TexelFormat::rgba16f, TexelFormat::r8_unorm,
                                       TexelFormat::rgba32f, TexelFormat::d32f, TexelFormat::r32f};
        const std::uint32_t images = random_number_below(6) + 3;
        for (std::uint32_t i = 0; i < images; ++i) {
            images_.push_back(
                graph_.add_image({.name = "i" + std::to_string(i),
                                  .format = formats[i == 0 ? 0 : random_number_below(5)],
                                  .width = 8,
                                  .height = 8,
                                  .layers = random_number_below(4) + 1}));
            written_.emplace_back(images_.back().layer_count, false);
        }
        const std::uint32_t buffers = random_number_below(3);
        for (std::uint32_t b = 0; b < buffers; ++b) {
            buffers_.push_back(graph_.add_buffer(
                {.name = "b" + std::to_string(b), .bytes = 100 + random_number_below(2000)}));
            buffer_written_.push_back(false);
        }
    }

    bool is_image_written(const ImageHandle& image) const {
        const auto first = written_[image.id].begin() + image.first_layer;
        return std::all_of(first, first + image.layer_count, [](bool w) { return w; });
    }

    ImageHandle choose_random_part_of_image(const ImageHandle& image) {
        const std::uint32_t first = random_number_below(image.layer_count);
        return image.layers(first, random_number_below(image.layer_count - first) + 1);
    }

    void add_random_pass(std::uint32_t number) {
        PassBuilder pass = graph_.add_pass("p" + std::to_string(number), is_chosen_with_chance(40)
                                                                             ? PassPurpose::scene
                                                                             : PassPurpose::none);
        touched_.assign(images_.size(), false);
        const ImageHandle target = choose_random_part_of_image(
            images_[random_number_below(static_cast<std::uint32_t>(images_.size()))]);
        touched_[target.id] = true;
        const bool raster = is_depth_image(target) || is_chosen_with_chance(40);
        const bool copy = !raster && is_chosen_with_chance(30);
        if (raster)
            add_random_attachments(pass, target);
        else if (copy)
            pass.writes(target, ResourceUse::copy_to);
        else if (is_image_written(target) && is_chosen_with_chance(40))
            pass.writes(target, ResourceUse::storage);
        else
            pass.writes(target, ResourceUse::storage_write);
        add_random_reads(pass, copy);
        add_disjoint_read(pass, target, copy);
        add_random_buffers(pass, copy);
        pass.record([](PassCommands&) {});
        std::fill_n(written_[target.id].begin() + target.first_layer, target.layer_count, true);
    }

    void add_random_attachments(PassBuilder& pass, const ImageHandle& target) {
        const ResourceUse use = is_depth_image(target) ? ResourceUse::depth : ResourceUse::colour;
        std::optional<ClearValue> clear;
        if (!is_image_written(target) || is_chosen_with_chance(60)) clear = ClearValue{};
        pass.writes(target, use, clear).layers(target.layer_count);
        if (use == ResourceUse::depth || is_chosen_with_chance(50)) return;
        for (const ImageHandle& image : images_) { // attaches a depth image for the depth test
            if (!is_depth_image(image) || image.layer_count < target.layer_count) continue;
            const ImageHandle depth = image.layers(0, target.layer_count);
            if (!is_image_written(depth)) continue;
            touched_[image.id] = true;
            pass.reads(depth, ResourceUse::depth);
            return;
        }
    }

    ResourceUse random_reading_use(const ImageHandle& image, bool copy) {
        if (copy) return ResourceUse::copy_from;
        return !is_depth_image(image) && is_chosen_with_chance(30) ? ResourceUse::storage_read
                                                                   : ResourceUse::sampled;
    }

    void add_random_reads(PassBuilder& pass, bool copy) {
        for (std::uint32_t n = random_number_below(7); n > 0; --n) {
            const ImageHandle image = choose_random_part_of_image(
                images_[random_number_below(static_cast<std::uint32_t>(images_.size()))]);
            if (touched_[image.id]) continue;
            if (is_image_written(image)) {
                touched_[image.id] = true;
                pass.reads(image, random_reading_use(image, copy));
            } else if (is_chosen_with_chance(6)) {
                touched_[image.id] = true;
                pass.reads(graph_.previous(image), random_reading_use(image, copy));
            }
        }
    }

    /// Adds a read of the target image: of layers that the pass does not write, or of the previous
    /// frame.
    void add_disjoint_read(PassBuilder& pass, const ImageHandle& target, bool copy) {
        if (target.first_layer == 0) return;
        const ImageHandle rest = images_[target.id].layers(0, target.first_layer);
        if (is_image_written(rest) && is_chosen_with_chance(50))
            pass.reads(rest, random_reading_use(rest, copy));
        else if (is_chosen_with_chance(10))
            pass.reads(graph_.previous(target), ResourceUse::sampled);
    }

    void add_random_buffers(PassBuilder& pass, bool copy) {
        for (std::uint32_t b = 0; b < buffers_.size(); ++b) {
            if (is_chosen_with_chance(50)) continue;
            if (buffer_written_[b] && is_chosen_with_chance(60)) {
                pass.reads(buffers_[b], copy ? ResourceUse::copy_from : ResourceUse::storage_read);
                if (!copy && is_chosen_with_chance(50))
                    pass.reads(buffers_[b], ResourceUse::indirect);
                continue;
            }
            const bool modifies = buffer_written_[b] && is_chosen_with_chance(50);
            const ResourceUse compute = modifies ? ResourceUse::storage
                                                 : ResourceUse::storage_write;
            pass.writes(buffers_[b], copy ? ResourceUse::copy_to : compute);
            buffer_written_[b] = true;
        }
    }

    /// Adds a pass that writes all layers of an image whose previous contents are read. Otherwise
    /// the next frame would read contents that were never written.
    void add_pass_writing_whole_image(std::uint32_t id) {
        if (is_image_written(images_[id])) return;
        graph_.add_pass("all" + std::to_string(id))
            .writes(images_[id],
                    is_depth_image(images_[id]) ? ResourceUse::depth : ResourceUse::colour,
                    ClearValue{})
            .layers(images_[id].layer_count)
            .record([](PassCommands&) {});
        written_[id].assign(images_[id].layer_count, true);
    }

    void mark_random_output() {
        for (const ImageHandle& image : images_) {
            const ImageHandle part = choose_random_part_of_image(image);
            if (is_image_written(part) && is_chosen_with_chance(15)) graph_.output(part);
        }
        // Output images are marked, so that most graphs have an output.
        for (const ImageHandle& image : images_)
            if (graph_.output_images().empty() && is_image_written(image.layers(0, 1)))
                graph_.output(image.layers(0, 1));
        for (std::uint32_t b = 0; b < buffers_.size(); ++b)
            if (buffer_written_[b] && is_chosen_with_chance(20)) graph_.output(buffers_[b]);
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

Graph make_random_graph(std::mt19937& random) {
    return RandomGraphAuthor(random).write_random_graph();
}

} // namespace catoptric::graph
