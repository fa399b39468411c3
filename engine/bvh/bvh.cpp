#include "bvh/bvh.hpp"

#include "bvh/copies.hpp"
#include "bvh/top_level_tree.hpp"
#include "bvh/words.hpp"
#include "core/error.hpp"
#include "core/large_pages.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>

namespace catoptric::bvh {
namespace {

constexpr std::uint32_t kMaxTriangles = f32::kBvhIndexMask;
constexpr std::size_t kTrianglesPerTask = 8192; // triangles that one task of a thread reads

/// The references that have been written for a list of triangles.
struct WrittenReferences {
    /// The references of triangles that cast shadows, and the references of all other triangles.
    /// Both lie in one run.
    std::array<ReferenceRange, 2> parts;
    std::vector<std::size_t> shadowless; ///< places in the run of the second part, ascending

    std::size_t count() const { return parts[0].count + parts[1].count; }
};

/// Writes a reference to each finite triangle. The first triangle has the number `first`. An empty
/// `core` means that all triangles lie in the core.
WrittenReferences write_references(std::span<const Triangle> triangles, std::size_t first,
                                   const BoundingBox& core, TriangleReference* into) {
    WrittenReferences written;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        if (!is_finite(t)) continue;
        BoundingBox box = triangle_bounds(t.a, t.b, t.c, t.flags);
        if (!core.empty()) box = expand(box, box_padding(box, core));
        const TriangleReference r{load_simd(box.lo, pack_number(first + i)), load_simd(box.hi, 0)};
        const bool is_shadowless = (t.flags & kCastsNoShadowFlag) != 0;
        if (is_shadowless) written.shadowless.push_back(written.count());
        written.parts[is_shadowless ? 1 : 0].add(r);
        *into++ = r;
    }
    return written;
}

/// Writes references to all finite triangles, on several threads.
WrittenReferences write_in_parallel(std::span<const Triangle> triangles, const BoundingBox& core,
                                    TriangleReferences into, unsigned threads) {
    std::vector<WrittenReferences> runs((triangles.size() + kTrianglesPerTask - 1) /
                                        kTrianglesPerTask);
    parallel_for(runs.size(), threads, [&](std::size_t i) {
        const std::size_t first = i * kTrianglesPerTask,
                          count = std::min(kTrianglesPerTask, triangles.size() - first);
        runs[i] = write_references(triangles.subspan(first, count), first, core, &into[first]);
    });
    WrittenReferences all;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::size_t before = all.count();
        if (before < i * kTrianglesPerTask) // an earlier task had triangles that are not finite
            std::copy_n(&into[i * kTrianglesPerTask], runs[i].count(), &into[before]);
        for (const std::size_t place : runs[i].shadowless) all.shadowless.push_back(before + place);
        for (std::size_t k = 0; k < 2; ++k) {
            const ReferenceRange& part = runs[i].parts[k];
            all.parts[k].box.add_box(part.box), all.parts[k].centres.add_box(part.centres);
            all.parts[k].count += part.count;
        }
    }
    return all;
}

/// Returns the parts of the references over which separate trees are built. This is either one part
/// with all references, or two parts: triangles that cast shadows, and others. In the second case,
/// the references are sorted into the two parts.
std::vector<ReferenceRange> split_shadowless(const WrittenReferences& written,
                                             TriangleReferences references) {
    const auto& [casters, others] = written.parts;
    if (casters.count == 0 || others.count == 0 || others.count > kMaxShadowless) {
        ReferenceRange all = casters;
        all.box.add_box(others.box), all.centres.add_box(others.centres), all.count += others.count;
        return {all};
    }
    std::size_t end = written.count();
    for (auto place = written.shadowless.rbegin(); place != written.shadowless.rend(); ++place)
        std::swap(references[*place], references[--end]);
    std::vector<ReferenceRange> parts{casters, others};
    parts[1].first = casters.count;
    return parts;
}

} // namespace

Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core, std::uint32_t leaf,
          unsigned threads) {
    return build(triangles, core, CopyScope::within_object, leaf, threads);
}

Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core, CopyScope copies,
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
    const WrittenReferences written = write_in_parallel(triangles, core, work.buffers[0], threads);
    const std::vector<ReferenceRange> parts = split_shadowless(written, work.buffers[0]);
    Bvh bvh;
    bvh.dropped = triangles.size() - written.count();
    bvh.triangles.reserve(3 * written.count());
    advise_large_pages(bvh.triangles.data(), bvh.triangles.capacity() * sizeof(vec4));
    bvh.triangles.resize(3 * written.count());
    work.triangles = bvh.triangles.data();
    bvh.nodes.resize(4, vec4(0));
    const std::size_t kept = build_in_parallel(work, parts, threads, bvh.nodes);
    bvh.copies = written.count() - kept;
    bvh.triangles.resize(3 * kept);
    SimdBox bounds;
    for (const ReferenceRange& part : parts) bounds.add_box(part.box);
    const BoundingBox slack = core.empty() ? bounds.to_bounds() : core;
    bvh.nodes[0] = vec4(slack.lo, pack_number(count_triangles(bvh)));
    bvh.nodes[1] = vec4(slack.hi, pack_number(count_nodes(bvh)));
    if (parts.size() == 2)
        write_start(bvh, float_to_bits(bvh.nodes[4].w), float_to_bits(bvh.nodes[5].w));
    else
        write_start(bvh, f32::kBvhRoot, f32::kBvhEmptyChild);
    bvh.cost = sah_cost(bvh);
    return bvh;
}

void write_start(Bvh& bvh, std::uint32_t casters, std::uint32_t others) {
    bvh.nodes[3] = vec4(std::bit_cast<float>(casters), std::bit_cast<float>(others), 0, 0);
}

std::size_t count_nodes(const Bvh& bvh) { return bvh.nodes.size() / 4; }

std::size_t count_triangles(const Bvh& bvh) { return bvh.triangles.size() / 3; }

} // namespace catoptric::bvh
