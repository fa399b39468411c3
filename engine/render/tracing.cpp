#include "render/tracing.hpp"

#include "bvh/copies.hpp"
#include "bvh/words.hpp"
#include "core/error.hpp"
#include "core/stopwatch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <set>
#include <utility>

namespace catoptric::render {

namespace {

std::uint32_t ray_mask_of(const DrawRange& range) {
    return (range.seen_by_camera ? 0 : bvh::kHiddenFromCameraFlag) |
           (range.casts_shadow || range.tints ? 0 : bvh::kCastsNoShadowFlag) |
           (range.tints ? bvh::kTintsShadowFlag : 0) |
           (range.exact_sphere ? bvh::kStandsForSphereFlag : 0) |
           (range.one_sided ? bvh::kOneSidedFlag : 0) | (range.masked ? bvh::kAlphaMaskedFlag : 0);
}

/// Reads an object's triangles, as rays see them. Also reads the normal and the attribute number of
/// each corner.
void read_triangles(const FrameGeometry& geometry, std::size_t object, std::uint32_t added_flags,
                    std::vector<bvh::Triangle>& triangles, std::vector<vec4>& normals) {
    const DrawRange& range = geometry.ranges[object];
    for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count; k += 3) {
        const auto vertex = [&](std::uint32_t j) -> const shared::Vertex& {
            return geometry.vertices[geometry.indices[k + j]];
        };
        triangles[k / 3] = {vertex(0).position, vertex(1).position, vertex(2).position,
                            static_cast<std::uint32_t>(object), ray_mask_of(range) | added_flags};
        for (std::uint32_t j = 0; j < 3; ++j) {
            const std::uint32_t local = geometry.indices[k + j] - range.first_vertex;
            normals[k + j] = vec4(vertex(j).normal,
                                  bvh::pack_number(range.first_attribute.value_or(0) +
                                                   (range.first_attribute ? local : 0)));
        }
    }
}

/// Adds `first` to the triangle numbers of a tree.
void offset_triangles(bvh::Bvh& tree, std::uint32_t first) {
    for (std::size_t i = 1; i < tree.triangles.size(); i += 3)
        tree.triangles[i].w = std::bit_cast<float>(
            std::bit_cast<std::uint32_t>(tree.triangles[i].w) + first);
}

bool has_object_space(const FrameGeometry& geometry, std::size_t object) {
    return geometry.ranges[object].own && geometry.ranges[object].storage == object;
}

/// Returns the list with exact spheres in scene units as spheres. Each sphere takes the place of
/// its first triangle. Its other triangles become NaN, which the build drops.
std::vector<bvh::Triangle> replace_by_exact_spheres(std::span<const bvh::Triangle> flat,
                                                    const FrameGeometry& geometry,
                                                    std::span<const shared::Surface> surfaces) {
    std::vector<bvh::Triangle> triangles(flat.begin(), flat.end());
    const bvh::Triangle nothing{.a = vec3(std::numeric_limits<float>::quiet_NaN())};
    for (std::uint32_t i = 0; i < geometry.ranges.size(); ++i) {
        const DrawRange& range = geometry.ranges[i];
        if (!range.exact_sphere || range.own || range.index_count == 0) continue;
        const auto own = std::span(triangles).subspan(range.first_index / 3, range.index_count / 3);
        std::ranges::fill(own, nothing);
        own.front() = bvh::make_sphere(
            surfaces[i].centre, surfaces[i].radius, i,
            ray_mask_of(range) &
                (bvh::kHiddenFromCameraFlag | bvh::kCastsNoShadowFlag | bvh::kTintsShadowFlag));
    }
    return triangles;
}

/// Returns a key that is equal for two objects of one mesh whose object spaces have the same
/// placement.
std::array<double, 15> object_space_key(const DrawRange& range) {
    std::array<double, 15> place{double(range.storage), double(ray_mask_of(range)),
                                 double(range.own->radius)};
    for (int i = 0; i < 3; ++i) {
        place[static_cast<std::size_t>(3 + i)] = range.own->centre[i];
        for (int j = 0; j < 3; ++j)
            place[static_cast<std::size_t>(6 + 3 * i + j)] = range.own->scene_from_own[i][j];
    }
    return place;
}

constexpr std::string_view kBvhInStorageConstant = "bvh_in_storage";

/// Returns the list with which shaders find the hierarchy's copy of a triangle that the rasteriser
/// drew (intersect_rasterised_triangle in shaders/lib/whitted.glsl). `count`: number of stored
/// triangles.
std::vector<std::uint32_t> first_hit_words(const bvh::Bvh& shown,
                                           std::span<const bvh::BvhInstance> instances,
                                           const FrameGeometry& geometry, std::size_t count) {
    constexpr std::uint32_t kNoFirstHitWord = 0xffffffff; // as in shaders/lib/whitted.glsl
    const std::size_t objects = geometry.ranges.size();
    std::vector<std::uint32_t> list(2 * objects + count, kNoFirstHitWord);
    const auto first = static_cast<std::uint32_t>(2 * objects);
    for (std::size_t i = 0; i < objects; ++i) {
        if (!geometry.ranges[i].own) list[2 * i] = 0;
        list[2 * i + 1] = first + geometry.ranges[i].first_index / 3;
    }
    for (std::uint32_t i = 0; i < instances.size(); ++i)
        list[2 * std::size_t{instances[i].object}] = shown.first_record +
                                                     f32::kBvhNodesPerInstance * i;
    for (std::uint32_t place = 0; place < bvh::count_triangles(shown); ++place)
        list[first + bvh::unpack_number(shown.triangles[3 * std::size_t{place} + 1].w)] = place;
    return list;
}

} // namespace

gpu::ShaderConstants make_tracer_constants(const gpu::VariantChoices& choices, std::uint64_t bytes,
                                           std::uint64_t most_of_storage) {
    gpu::ShaderConstants constants;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const std::string_view constant = gpu::shader_variants()[i].constant;
        if (choices[i] == 0 || (constant == kBvhInStorageConstant && bytes > most_of_storage))
            continue;
        constants.emplace_back(constant, choices[i]);
    }
    return constants;
}

RayTracingTrees::RayTracingTrees(std::size_t slots)
    : hierarchies_{DeviceBvh(slots), DeviceBvh(slots)},
      corner_normals_("normals", gpu::BufferUsage::texels, slots) {}

void RayTracingTrees::set_backdrops(std::vector<std::uint8_t> backdrops) {
    if (backdrops == backdrops_) return;
    backdrops_ = std::move(backdrops);
    record_layout_change();
}

void RayTracingTrees::record_layout_change() {
    is_read_ = false;
    moved_.clear();
}

void RayTracingTrees::build(DeviceBvh& hierarchy, const FrameGeometry& geometry,
                            std::span<const bvh::Triangle> flat) {
    hierarchy.tree = bvh::build(flat, geometry.core, bvh::CopyScope::across_objects);
    hierarchy.reached.clear();
    hierarchy.lists_first_hits = false;
    hierarchy.built_cost = hierarchy.tree.cost;
    hierarchy.changed = {0, hierarchy.tree.triangles.size()};
    ++built_;
}

void RayTracingTrees::refit(DeviceBvh& hierarchy, const FrameGeometry& geometry,
                            std::span<const bvh::Triangle> flat) {
    if (hierarchy.moved != hierarchy.reached) { // mostly the same objects move from frame to frame
        hierarchy.reach = bvh::find_refit_region(hierarchy.tree, hierarchy.moved);
        hierarchy.reached = hierarchy.moved;
    }
    hierarchy.changed = bvh::refit(hierarchy.tree, flat, geometry.core, &hierarchy.reach);
    ++refitted_;
    // The comparison is written so that a cost of NaN also causes a new build.
    if (!(hierarchy.tree.cost <= kMaxRefitCostRatio * hierarchy.built_cost))
        build(hierarchy, geometry, flat);
}

void RayTracingTrees::build_object_tree(const FrameGeometry& geometry, std::size_t object) {
    const DrawRange& range = geometry.ranges[object];
    bvh::Bvh& tree = own_trees_[object];
    tree = bvh::build(std::span(triangles_).subspan(range.first_index / 3, range.index_count / 3));
    offset_triangles(tree, range.first_index / 3);
}

/// Reads the triangles of objects that have moved.
void RayTracingTrees::read_moves(const FrameGeometry& geometry) {
    bvh::IndexRange changed{normals_.size(), 0};
    for (const auto& [object, vertices] : moved_) {
        const DrawRange& range = geometry.ranges[object];
        const bool own = range.own.has_value();
        if (vertices) {
            read_triangles(geometry, object, backdrop_flag(object), triangles_, normals_);
            changed = {std::min<std::size_t>(changed.first, range.first_index),
                       std::max<std::size_t>(changed.end, range.first_index + range.index_count)};
        }
        if (vertices && own) build_object_tree(geometry, object);
        for (DeviceBvh& hierarchy : hierarchies_) {
            hierarchy.moved.resize(geometry.ranges.size());
            if (!own) hierarchy.moved[object] = 1;
        }
    }
    corner_normals_.set(normals_, changed.first, changed.end);
}

/// Reads all triangles after a change of the objects' layout, or else the triangles of objects that
/// have moved.
void RayTracingTrees::read_changes(const FrameGeometry& geometry) {
    if (is_read_ && moved_.empty()) return;
    // `is_read_` stays false if this throws, so that the next call fills everything.
    if (std::exchange(is_read_, false)) {
        ++version_.moves;
        read_moves(geometry);
    } else {
        ++version_.layouts;
        triangles_.resize(geometry.indices.size() / 3);
        normals_.resize(geometry.indices.size());
        own_trees_.clear();
        for (std::size_t i = 0; i < geometry.ranges.size(); ++i)
            if (geometry.ranges[i].storage == i)
                read_triangles(geometry, i, backdrop_flag(i), triangles_, normals_);
        for (std::size_t i = 0; i < geometry.ranges.size(); ++i)
            if (has_object_space(geometry, i)) build_object_tree(geometry, i);
        corner_normals_.set(normals_);
    }
    is_read_ = true;
    moved_.clear();
}

/// Returns the objects in object space that rays can meet. Checks the number of triangles.
std::vector<bvh::BvhInstance> RayTracingTrees::bvh_instances(const FrameGeometry& geometry) const {
    std::vector<bvh::BvhInstance> instances;
    std::set<std::array<double, 15>> places; // rays never hit a copy in the same place as another
                                             // one
    auto next = static_cast<std::uint32_t>(triangles_.size());
    for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
        const DrawRange& range = geometry.ranges[i];
        if (!range.own) continue;
        // A copy of a mesh gets triangle numbers of its own, after the numbers of all other
        // triangles.
        const bool copy = range.storage != i;
        if (range.masked || places.insert(object_space_key(range)).second)
            instances.push_back({&own_trees_.at(range.storage), range.own->scene_from_own,
                                 range.own->centre, static_cast<std::uint32_t>(i),
                                 ray_mask_of(range), copy ? next - range.first_index / 3 : 0,
                                 range.own->radius});
        if (copy) next += range.index_count / 3;
    }
    check(next <= f32::kBvhIdMask, Failure::exhausted, "rays tell ", f32::kBvhIdMask,
          " triangles apart, the scene shows ", next);
    return instances;
}

/// Assembles the trees that the device walks. `first_hits`: lists the places of triangles, too.
void RayTracingTrees::assemble(DeviceBvh& hierarchy, const FrameGeometry& geometry,
                               bool first_hits) const {
    const std::vector<bvh::BvhInstance> instances = this->bvh_instances(geometry);
    const bvh::Bvh whole = instances.empty() ? bvh::Bvh()
                                             : bvh::assemble_two_level(hierarchy.tree, instances);
    const bvh::Bvh& shown = instances.empty() ? hierarchy.tree : whole;
    hierarchy.nodes.set(shown.nodes);
    if (instances.empty())
        hierarchy.triangles.set(shown.triangles, hierarchy.changed.first, hierarchy.changed.end);
    else
        hierarchy.triangles.set(shown.triangles);
    // A refit keeps the places of triangles, but assembling two levels may change them.
    hierarchy.lists_first_hits = hierarchy.lists_first_hits && instances.empty();
    if (!first_hits || hierarchy.lists_first_hits) return;
    hierarchy.first_hits.set(first_hit_words(shown, instances, geometry, triangles_.size()));
    hierarchy.lists_first_hits = true;
}

/// Builds the trees of an outdated hierarchy again, or refits them. `flat`: the triangles and
/// spheres in scene units.
void RayTracingTrees::rebuild_or_refit(DeviceBvh& hierarchy, const FrameGeometry& geometry,
                                       std::span<const bvh::Triangle> flat, bool first_hits) {
    // Triangles that were left out as copies of others may no longer coincide with them after a
    // move.
    const bool is_new = hierarchy.seen.layouts != version_.layouts || hierarchy.tree.copies > 0;
    hierarchy.seen = {}, hierarchy.changed = {}; // if this throws, the next call fills everything
    if (is_new)
        build(hierarchy, geometry, flat);
    else if (std::ranges::find(hierarchy.moved, 1) != hierarchy.moved.end())
        refit(hierarchy, geometry, flat);
    assemble(hierarchy, geometry, first_hits);
    hierarchy.moved.clear();
    hierarchy.seen = version_;
}

void RayTracingTrees::prepare(gpu::Device& device, const FrameGeometry& geometry,
                              std::span<const shared::Surface> surfaces, SphereMode spheres,
                              bool first_hits, std::size_t slot) {
    const Stopwatch watch(ms_);
    const bool is_first = built_ == 0;
    read_changes(geometry);
    DeviceBvh& hierarchy = bvh_of(spheres);
    if (hierarchy.seen != version_) {
        const std::size_t count = geometry.flat_indices / 3;
        if (spheres == SphereMode::mesh)
            rebuild_or_refit(hierarchy, geometry, std::span(triangles_).first(count), first_hits);
        else
            rebuild_or_refit(
                hierarchy, geometry,
                replace_by_exact_spheres(std::span(triangles_).first(count), geometry, surfaces),
                first_hits);
    }
    if (first_hits && !hierarchy.lists_first_hits) assemble(hierarchy, geometry, true);
    const double build_ms = watch.elapsed_ms();
    for (DeviceList* buffer : {&hierarchy.nodes, &hierarchy.triangles, &corner_normals_})
        writes_ += buffer->write(device, slot);
    if (hierarchy.lists_first_hits) writes_ += hierarchy.first_hits.write(device, slot);
    if (is_first) first_build_ms_ = build_ms, first_write_ms_ = watch.elapsed_ms() - build_ms;
}

std::uint64_t RayTracingTrees::largest_buffer_bytes(SphereMode spheres, std::size_t slot) const {
    const DeviceBvh& hierarchy = hierarchies_[static_cast<std::size_t>(spheres)];
    return std::max(hierarchy.nodes.buffer(slot).bytes(), hierarchy.triangles.buffer(slot).bytes());
}

void RayTracingTrees::bind(graph::PassCommands& commands, SphereMode spheres,
                           std::size_t slot) const {
    const DeviceBvh& hierarchy = hierarchies_[static_cast<std::size_t>(spheres)];
    check(hierarchy.seen == version_ && moved_.empty(), Failure::internal,
          "a pass traces rays without having asked for it (FrameRequests::trace_rays)");
    commands.bind("bvh_nodes", hierarchy.nodes.buffer(slot));
    commands.bind("bvh_triangles", hierarchy.triangles.buffer(slot));
    commands.bind("normals", corner_normals_.buffer(slot));
    if (hierarchy.lists_first_hits) commands.bind("first_hits", hierarchy.first_hits.buffer(slot));
}

} // namespace catoptric::render
