#include "bvh/bvh.hpp"

#include "bvh/copies.hpp"
#include "bvh/top_level_tree.hpp"
#include "core/error.hpp"
#include "core/large_pages.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <memory>

namespace catoptric::bvh {
namespace {

constexpr std::uint32_t kMaxTriangles = f32::kBvhIndexMask;
constexpr std::size_t kRunCount = 8192; // triangles that one task of a thread reads

/// Writes a reference to each finite triangle. The first triangle has the number `first`. An empty
/// `core` means that all triangles lie in the core. Returns the part that the references make up.
ReferenceRange write_triangle_references(std::span<const Triangle> triangles, std::size_t first,
                                         const BoundingBox& core, TriangleReference* into) {
    ReferenceRange part;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        if (!is_finite(t)) continue;
        BoundingBox box = triangle_bounds(t.a, t.b, t.c, t.flags);
        if (!core.empty()) box = pad_box(box, compute_box_padding(box, core));
        const TriangleReference r{load_lanes(box.lo, id_to_float_word(first + i)),
                                  load_lanes(box.hi, 0)};
        part.add(r);
        *into++ = r;
    }
    return part;
}

/// Writes references to all finite triangles, on several threads. Returns the part that they make
/// up.
ReferenceRange write_references_in_parallel(std::span<const Triangle> triangles,
                                            const BoundingBox& core, TriangleReferences into,
                                            unsigned threads) {
    std::vector<ReferenceRange> runs((triangles.size() + kRunCount - 1) / kRunCount);
    run_in_parallel(runs.size(), threads, [&](std::size_t i) {
        const std::size_t first = i * kRunCount,
                          count = std::min(kRunCount, triangles.size() - first);
        runs[i] = write_triangle_references(triangles.subspan(first, count), first, core,
                                            &into[first]);
    });
    ReferenceRange all;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        if (all.count < i * kRunCount) // an earlier run had triangles that are not finite
            std::copy_n(&into[i * kRunCount], runs[i].count, &into[all.count]);
        all.box.add(runs[i].box), all.centres.add(runs[i].centres), all.count += runs[i].count;
    }
    return all;
}

} // namespace

Bvh build_bvh(std::span<const Triangle> triangles, const Bounds<float>& core, std::uint32_t leaf,
              unsigned threads) {
    return build_bvh(triangles, core, CopyHandling::of_object, leaf, threads);
}

Bvh build_bvh(std::span<const Triangle> triangles, const Bounds<float>& core, CopyHandling copies,
              std::uint32_t leaf, unsigned threads) {
    check(triangles.size() <= kMaxTriangles, Failure::exhausted, "bounding volume hierarchy wants ",
          triangles.size(), " triangles, its words hold ", kMaxTriangles);
    if (threads == 0) threads = hardware_thread_count();
    // The memory stays uninitialised because each reference is written before it is read.
    const auto memory = std::make_unique_for_overwrite<TriangleReference[]>(2 * triangles.size());
    const TriangleReferences references(memory.get(), 2 * triangles.size());
    advise_large_pages(references.data(), references.size_bytes());
    BuildWorkspace work{triangles,
                        {references.first(triangles.size()), references.last(triangles.size())},
                        nullptr,
                        leaf,
                        copies};
    const ReferenceRange root = write_references_in_parallel(triangles, core, work.buffers[0],
                                                             threads);
    Bvh bvh;
    bvh.dropped = triangles.size() - root.count;
    bvh.triangles.reserve(3 * root.count);
    advise_large_pages(bvh.triangles.data(), bvh.triangles.capacity() * sizeof(vec4));
    bvh.triangles.resize(3 * root.count);
    work.triangles = bvh.triangles.data();
    bvh.nodes.resize(4, vec4(0));
    const std::size_t kept = build_tree_in_parallel(work, root, threads, bvh.nodes);
    bvh.copies = root.count - kept;
    bvh.triangles.resize(3 * kept);
    const BoundingBox slack = core.empty() ? root.box.box() : core;
    bvh.nodes[0] = vec4(slack.lo, id_to_float_word(count_triangles(bvh)));
    bvh.nodes[1] = vec4(slack.hi, id_to_float_word(count_nodes(bvh)));
    bvh.cost = compute_sah_cost(bvh);
    return bvh;
}

std::size_t count_nodes(const Bvh& bvh) { return bvh.nodes.size() / 4; }

std::size_t count_triangles(const Bvh& bvh) { return bvh.triangles.size() / 3; }

} // namespace catoptric::bvh
