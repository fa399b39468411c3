#include "render/tracing.hpp"

#include "render/stopwatch.hpp"

namespace catoptric::render {

namespace {

/// What rays see of an object's triangles, and the normals at their corners.
void read_object(const Geometry& geometry, std::size_t object,
                 std::vector<bvh::Triangle>& triangles, std::vector<vec4>& normals) {
    const DrawRange& range = geometry.ranges[object];
    const std::uint32_t flags = (range.seen_by_camera ? 0 : bvh::kHidden) |
                                (range.casts_shadow ? 0 : bvh::kShadowless) |
                                (range.exact_sphere ? bvh::kSphere : 0) |
                                (range.one_sided ? bvh::kOneSided : 0);
    for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count; k += 3) {
        const auto vertex = [&](std::uint32_t j) -> const shared::Vertex& {
            return geometry.vertices[geometry.indices[k + j]];
        };
        triangles[k / 3] = {vertex(0).position, vertex(1).position, vertex(2).position,
                            static_cast<std::uint32_t>(object), flags};
        for (std::uint32_t j = 0; j < 3; ++j) normals[k + j] = vec4(vertex(j).normal, 0.0f);
    }
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
    tree_ = bvh::build(triangles_, geometry.core);
    cost_when_built_ = bvh::cost(tree_);
    ++built_;
}

void Tracing::refit(const Geometry& geometry) {
    bvh::refit(tree_, triangles_, geometry.core);
    ++refitted_;
    // Written so that a NaN builds too.
    if (!(bvh::cost(tree_) <= kWorstRefit * cost_when_built_)) build(geometry);
}

void Tracing::prepare(gpu::Device& device, const Geometry& geometry, std::size_t slot) {
    const Stopwatch watch(ms_);
    if (!laid_out_) {
        triangles_.resize(geometry.indices.size() / 3);
        normals_.resize(geometry.indices.size());
        for (std::size_t i = 0; i < geometry.ranges.size(); ++i)
            read_object(geometry, i, triangles_, normals_);
        build(geometry);
    } else if (!moved_.empty()) {
        for (const std::size_t object : moved_) read_object(geometry, object, triangles_, normals_);
        refit(geometry);
    }
    if (!laid_out_ || !moved_.empty()) {
        nodes_buffer_.set(tree_.nodes);
        triangles_buffer_.set(tree_.triangles);
        normals_buffer_.set(normals_);
    }
    laid_out_ = true;
    moved_.clear();
    for (Resident* buffer : {&nodes_buffer_, &triangles_buffer_, &normals_buffer_})
        writes_ += buffer->write(device, slot);
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
