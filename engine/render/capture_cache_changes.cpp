// Finds which captures changed when they were drawn again.
#include "render/capture_cache.hpp"

#include <algorithm>
#include <cstring>

namespace catoptric::render {

std::vector<char> find_changed(const CaptureCache& captures) {
    std::vector<char> before;
    if (captures.before) before = find_changed(*captures.before);
    const auto was = [&](std::uint32_t other) { return before.empty() || before[other]; };
    std::vector<char> now;
    for (std::size_t mirror = 0; mirror < captures.changes.size(); ++mirror)
        now.push_back(captures.changes[mirror] == CaptureChange::some ||
                      (captures.changes[mirror] == CaptureChange::unknown &&
                       std::ranges::any_of(captures.saw[mirror], was)));
    return now;
}

void read_comparisons(const std::shared_ptr<CaptureCache>& captures,
                      const std::function<bool(std::uint64_t)>& has_ended) {
    if (!captures) return;
    read_comparisons(captures->before, has_ended);
    if (!captures->differing || !has_ended(captures->frame)) return;
    const std::vector<std::byte> found = captures->differing->read();
    for (std::size_t mirror = 0; mirror < captures->changes.size(); ++mirror) {
        std::uint32_t word = 0;
        std::memcpy(&word, found.data() + sizeof word * mirror, sizeof word);
        if (captures->changes[mirror] == CaptureChange::unknown)
            captures->changes[mirror] = word ? CaptureChange::some : CaptureChange::none;
    }
    captures->before = nullptr;
    captures->differing = nullptr;
}

void mark_unchanged(CaptureCache& captures) {
    std::ranges::fill(captures.changes, CaptureChange::none);
    captures.before = nullptr;
    captures.differing = nullptr;
}

std::shared_ptr<gpu::Buffer> ComparisonBuffers::buffer(std::size_t mirrors) {
    const std::vector<std::uint32_t> zeros(mirrors, 0);
    // If a caller discards a frame, its buffer is released while the device may still write to it.
    // Such a buffer must not be used yet.
    const auto fits = [&](const PooledBuffer& entry) {
        return entry.buffer.use_count() == 1 && has_ended_(entry.frame) &&
               entry.buffer->bytes() >= sizeof(std::uint32_t) * mirrors;
    };
    auto found = std::ranges::find_if(entries_, fits);
    if (found == entries_.end())
        found = entries_.insert(found, {std::make_shared<gpu::Buffer>(
                                            device_, "differing", sizeof(std::uint32_t) * mirrors,
                                            gpu::BufferUsage::read_back),
                                        0});
    found->buffer->write(std::span<const std::uint32_t>(zeros));
    return found->buffer;
}

void ComparisonBuffers::mark_used(const std::shared_ptr<const gpu::Buffer>& buffer,
                                  std::uint64_t frame) {
    const auto is_it = [&](const PooledBuffer& entry) { return entry.buffer == buffer; };
    const auto found = std::ranges::find_if(entries_, is_it);
    if (found != entries_.end()) found->frame = frame;
}

void add_comparison_pass(graph::Graph& graph, const FrameInputs& inputs,
                         const CaptureUpdate& feeding) {
    if (!feeding.kept || !feeding.kept->differing) return;
    const MirrorCaptures &last = *feeding.last, &now = *feeding.captures;
    struct ComparisonParameters {
        std::uint32_t before, after, mirror;
    };
    struct CubeImagePair {
        CubeCaptureArray before, after; ///< the whole arrays of captures
        ComparisonParameters push;
        std::uint32_t faces;
    };
    std::vector<CubeImagePair> all;
    for (std::uint32_t mirror = 0; mirror < now.places.size(); ++mirror)
        for_each_face_range(
            [&](std::uint32_t face) {
                return now.places[mirror].has_capture() &&
                       feeding.work.face_work(mirror, face) == FaceUpdate::compare;
            },
            [&](std::uint32_t first, std::uint32_t end) {
                const auto &from = last.places[mirror], &to = now.places[mirror];
                all.push_back({last.arrays[from.array],
                               now.arrays[to.array],
                               {6 * from.cube + first, 6 * to.cube + first, mirror},
                               end - first});
            });
    const graph::BufferHandle differing = graph.import_resource(
        graph::BufferDesc{inputs.prefix + now.name + ".differing",
                          feeding.kept->differing->bytes()},
        feeding.kept->differing.get());
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + now.name + ".compare");
    std::vector<graph::ImageHandle> images;
    for (const CubeImagePair& one : all)
        for (const CubeCaptureArray* const cubes : {&one.before, &one.after})
            for (const graph::ImageHandle image :
                 {cubes->colour, cubes->distance.value_or(cubes->colour)})
                if (std::ranges::find(images, image) == images.end()) images.push_back(image);
    for (const graph::ImageHandle image : images) pass.reads(image, graph::ResourceUse::sampled);
    pass.writes(differing, graph::ResourceUse::storage_write)
        .record([all = std::move(all), differing](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"differing.comp", {}});
            commands.bind("Differing", differing);
            for (const auto& [before, after, push, faces] : all) {
                commands.bind("colour_before", before.colour);
                commands.bind("colour_after", after.colour);
                commands.bind("distance_before", before.distance.value_or(before.colour));
                commands.bind("distance_after", after.distance.value_or(after.colour));
                commands.push_constants(push);
                const std::uint32_t groups = (after.face + 7) / 8;
                commands.dispatch(groups, groups, faces);
            }
        });
}

} // namespace catoptric::render
