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
ReferenceRange refer(std::span<const Triangle> triangles, std::size_t first,
                     const BoundingBox& core, TriangleReference* into) {
    ReferenceRange part;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        if (!is_finite(t)) continue;
        BoundingBox box = box_of(t.a, t.b, t.c, t.flags);
        if (!core.empty()) box = padded(box, pad_of(box, core));
        const TriangleReference r{lanes(box.lo, id_word(first + i)), lanes(box.hi, 0)};
        part.add(r);
        *into++ = r;
    }
    return part;
}

/// Writes references to all finite triangles, on several threads. Returns the part that they make
/// up.
ReferenceRange refer_all(std::span<const Triangle> triangles, const BoundingBox& core,
                         References into, unsigned threads) {
    std::vector<ReferenceRange> runs((triangles.size() + kRunCount - 1) / kRunCount);
    in_parallel(runs.size(), threads, [&](std::size_t i) {
        const std::size_t first = i * kRunCount,
                          count = std::min(kRunCount, triangles.size() - first);
        runs[i] = refer(triangles.subspan(first, count), first, core, &into[first]);
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

Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core, std::uint32_t leaf,
          unsigned threads) {
    return build(triangles, core, Copies::of_object, leaf, threads);
}

Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core, Copies copies,
          std::uint32_t leaf, unsigned threads) {
    check(triangles.size() <= kMaxTriangles, Failure::exhausted, "bounding volume hierarchy wants ",
          triangles.size(), " triangles, its words hold ", kMaxTriangles);
    if (threads == 0) threads = all_threads();
    // The memory stays uninitialised because each reference is written before it is read.
    const auto memory = std::make_unique_for_overwrite<TriangleReference[]>(2 * triangles.size());
    const References references(memory.get(), 2 * triangles.size());
    advise_large_pages(references.data(), references.size_bytes());
    Workspace work{triangles,
                   {references.first(triangles.size()), references.last(triangles.size())},
                   nullptr,
                   leaf,
                   copies};
    const ReferenceRange root = refer_all(triangles, core, work.buffers[0], threads);
    Bvh bvh;
    bvh.dropped = triangles.size() - root.count;
    bvh.triangles.reserve(3 * root.count);
    advise_large_pages(bvh.triangles.data(), bvh.triangles.capacity() * sizeof(vec4));
    bvh.triangles.resize(3 * root.count);
    work.triangles = bvh.triangles.data();
    bvh.nodes.resize(4, vec4(0));
    const std::size_t kept = build_tree(work, root, threads, bvh.nodes);
    bvh.copies = root.count - kept;
    bvh.triangles.resize(3 * kept);
    const BoundingBox slack = core.empty() ? root.box.box() : core;
    bvh.nodes[0] = vec4(slack.lo, id_word(triangle_count(bvh)));
    bvh.nodes[1] = vec4(slack.hi, id_word(node_count(bvh)));
    bvh.cost = cost(bvh);
    return bvh;
}

std::size_t node_count(const Bvh& bvh) { return bvh.nodes.size() / 4; }

std::size_t triangle_count(const Bvh& bvh) { return bvh.triangles.size() / 3; }

} // namespace catoptric::bvh
