#include "render/tracing.hpp"

#include "bvh/words.hpp"
#include "core/error.hpp"
#include "core/stopwatch.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace catoptric::render {

namespace {

std::uint32_t flags_of(const DrawRange& range) {
    return (range.seen_by_camera ? 0 : bvh::kHidden) | (range.casts_shadow ? 0 : bvh::kShadowless) |
           (range.exact_sphere ? bvh::kSphere : 0) | (range.one_sided ? bvh::kOneSided : 0) |
           (range.masked ? bvh::kMasked : 0);
}

/// What rays see of an object's triangles, and the normals at their corners with the number of the
/// attribute there.
void read_object(const Geometry& geometry, std::size_t object,
                 std::vector<bvh::Triangle>& triangles, std::vector<vec4>& normals) {
    const DrawRange& range = geometry.ranges[object];
    for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count; k += 3) {
        const auto vertex = [&](std::uint32_t j) -> const shared::Vertex& {
            return geometry.vertices[geometry.indices[k + j]];
        };
        triangles[k / 3] = {vertex(0).position, vertex(1).position, vertex(2).position,
                            static_cast<std::uint32_t>(object), flags_of(range)};
        for (std::uint32_t j = 0; j < 3; ++j) {
            const std::uint32_t local = geometry.indices[k + j] - range.first_vertex;
            normals[k + j] = vec4(vertex(j).normal,
                                  bvh::id_word(range.first_attribute.value_or(0) +
                                               (range.first_attribute ? local : 0)));
        }
    }
}

/// Makes a tree's triangles count from `first`.
void renumber(bvh::Bvh& tree, std::uint32_t first) {
    for (std::size_t i = 1; i < tree.triangles.size(); i += 3)
        tree.triangles[i].w = std::bit_cast<float>(
            std::bit_cast<std::uint32_t>(tree.triangles[i].w) + first);
}

bool is_own_storage(const Geometry& geometry, std::size_t object) {
    return geometry.ranges[object].own && geometry.ranges[object].storage == object;
}

} // namespace

Tracing::Tracing(std::size_t slots)
    : nodes_buffer_("bvh_nodes", gpu::BufferUse::texels, slots),
      triangles_buffer_("bvh_triangles", gpu::BufferUse::texels, slots),
      normals_buffer_("normals", gpu::BufferUse::texels, slots) {}

void Tracing::lay_out() {
    laid_out_ = false;
    moved_.clear();
}

void Tracing::build(const Geometry& geometry) {
    tree_ = bvh::build(std::span(triangles_).first(geometry.flat_indices / 3), geometry.core);
    cost_when_built_ = bvh::cost(tree_);
    changed_triangles_ = {0, tree_.triangles.size()};
    ++built_;
}

void Tracing::refit(const Geometry& geometry, const std::vector<char>& objects) {
    changed_triangles_ = bvh::refit(tree_, std::span(triangles_).first(geometry.flat_indices / 3),
                                    geometry.core, objects);
    ++refitted_;
    // Written so that a NaN builds too.
    if (!(bvh::cost(tree_) <= kWorstRefit * cost_when_built_)) build(geometry);
}

void Tracing::build_own(const Geometry& geometry, std::size_t object) {
    const DrawRange& range = geometry.ranges[object];
    bvh::Bvh& tree = own_trees_[object];
    tree = bvh::build(std::span(triangles_).subspan(range.first_index / 3, range.index_count / 3));
    renumber(tree, range.first_index / 3);
}

/// Does what the moves since the last time ask for.
void Tracing::follow(const Geometry& geometry) {
    bool flat = false;
    std::vector<char> objects(geometry.ranges.size());
    changed_normals_ = {normals_.size(), 0}, changed_triangles_ = {};
    for (const auto& [object, vertices] : moved_) {
        const DrawRange& range = geometry.ranges[object];
        const bool own = range.own.has_value();
        if (vertices) {
            read_object(geometry, object, triangles_, normals_);
            changed_normals_ = {
                std::min<std::size_t>(changed_normals_.first, range.first_index),
                std::max<std::size_t>(changed_normals_.end, range.first_index + range.index_count)};
        }
        if (vertices && own) build_own(geometry, object);
        objects[object] = !own;
        flat = flat || !own;
    }
    if (flat) refit(geometry, objects);
}

/// Puts together what the device walks.
void Tracing::fill(const Geometry& geometry) {
    std::vector<bvh::Instance> instances;
    auto next = static_cast<std::uint32_t>(triangles_.size());
    for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
        const DrawRange& range = geometry.ranges[i];
        if (!range.own) continue;
        const bool copy = range.storage != i; // has numbers of its own, after all others
        instances.push_back({&own_trees_.at(range.storage), range.own->scene_from_own,
                             range.own->centre, static_cast<std::uint32_t>(i), flags_of(range),
                             copy ? next - range.first_index / 3 : 0, range.own->radius});
        if (copy) next += range.index_count / 3;
    }
    check(next <= f32::kBvhIdMask, Failure::exhausted, "rays tell ", f32::kBvhIdMask,
          " triangles apart, the scene shows ", next);
    const bvh::Bvh whole = instances.empty() ? bvh::Bvh() : bvh::assemble(tree_, instances);
    const bvh::Bvh& shown = instances.empty() ? tree_ : whole;
    nodes_buffer_.set(shown.nodes);
    if (instances.empty())
        triangles_buffer_.set(tree_.triangles, changed_triangles_.first, changed_triangles_.end);
    else
        triangles_buffer_.set(whole.triangles);
    normals_buffer_.set(normals_, changed_normals_.first, changed_normals_.end);
}

void Tracing::bring_up_to_date(const Geometry& geometry) {
    if (laid_out_ && moved_.empty()) return;
    // Until the end: whatever throws, the next time starts anew.
    if (std::exchange(laid_out_, false)) {
        follow(geometry);
    } else {
        triangles_.resize(geometry.indices.size() / 3);
        normals_.resize(geometry.indices.size());
        own_trees_.clear();
        for (std::size_t i = 0; i < geometry.ranges.size(); ++i)
            if (geometry.ranges[i].storage == i) read_object(geometry, i, triangles_, normals_);
        for (std::size_t i = 0; i < geometry.ranges.size(); ++i)
            if (is_own_storage(geometry, i)) build_own(geometry, i);
        build(geometry);
        changed_normals_ = {0, normals_.size()};
    }
    fill(geometry);
    laid_out_ = true;
    moved_.clear();
}

void Tracing::prepare(gpu::Device& device, const Geometry& geometry, std::size_t slot) {
    const Stopwatch watch(ms_);
    const bool is_first = built_ == 0;
    bring_up_to_date(geometry);
    const double build_ms = watch.ms();
    for (Resident* buffer : {&nodes_buffer_, &triangles_buffer_, &normals_buffer_})
        writes_ += buffer->write(device, slot);
    if (is_first) first_build_ms_ = build_ms, first_write_ms_ = watch.ms() - build_ms;
}

void Tracing::bind(graph::Commands& commands, std::size_t slot) const {
    commands.bind("bvh_nodes", nodes_buffer_.at(slot));
    commands.bind("BvhNodes", nodes_buffer_.at(slot));
    commands.bind("bvh_triangles", triangles_buffer_.at(slot));
    commands.bind("BvhTriangles", triangles_buffer_.at(slot));
    commands.bind("normals", normals_buffer_.at(slot));
    commands.bind("Normals", normals_buffer_.at(slot));
}

} // namespace catoptric::render
