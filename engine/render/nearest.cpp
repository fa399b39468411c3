#include "render/nearest.hpp"

#include "core/shader_math.hpp"

#include <numeric>

namespace catoptric::render {

namespace {

constexpr std::uint32_t kMaxLinearSearchTriangles =
    16; // the most triangles that are tested one by one

Bounds<float> triangle_bounds(const FrameGeometry& geometry, std::uint32_t first_index) {
    Bounds<float> box;
    for (std::uint32_t j = 0; j < 3; ++j)
        box.add(geometry.vertices[geometry.indices[first_index + j]].position);
    return box;
}

std::vector<Bounds<float>> triangle_boxes(const FrameGeometry& geometry, const DrawRange& range) {
    std::vector<Bounds<float>> boxes;
    for (std::uint32_t k = 0; k < range.index_count; k += 3)
        boxes.push_back(triangle_bounds(geometry, range.first_index + k));
    return boxes;
}

std::vector<Bounds<float>> object_boxes(const FrameGeometry& geometry) {
    std::vector<Bounds<float>> boxes;
    for (const DrawRange& range : geometry.ranges) boxes.push_back(range.bounds);
    return boxes;
}

} // namespace

float min_distance(const vec3& point, const Bounds<float>& box) {
    if (box.empty()) return std::numeric_limits<float>::infinity();
    const vec3 apart = max(max(box.lo - point, point - box.hi), vec3(0));
    const vec3 size = max(abs(point), max(abs(box.lo), abs(box.hi)));
    return std::max(0.0f, length(apart) - f32::rounding_error_gamma_bound(64) *
                                              f32::largest_vector_component(size));
}

BoxTree::BoxTree(std::span<const Bounds<float>> boxes, std::uint32_t leaf)
    : max_boxes_per_leaf_(leaf), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!boxes.empty()) add_boxes(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
}

/// Adds the node over these boxes. Splits it by count into halves along the longest axis.
void BoxTree::add_boxes(std::span<const Bounds<float>> boxes, std::uint32_t first,
                        std::uint32_t count) {
    const std::size_t place = nodes_.size();
    nodes_.emplace_back();
    Bounds<float> box, centres;
    for (std::uint32_t i = first; i < first + count; ++i) {
        box.add(boxes[order_[i]]);
        if (!boxes[order_[i]].empty()) centres.add(boxes[order_[i]].centre());
    }
    nodes_[place].box = box;
    if (count <= max_boxes_per_leaf_) {
        nodes_[place].first = first, nodes_[place].count = count;
        return;
    }
    const vec3 size = centres.empty() ? vec3(0) : centres.extent();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto along = [&](std::uint32_t i) {
        return boxes[i].empty() ? 0.0f : boxes[i].centre()[axis];
    };
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float at_a = along(a), at_b = along(b);
                         return at_a != at_b ? at_a < at_b : a < b;
                     });
    add_boxes(boxes, first, count / 2);
    nodes_[place].second = static_cast<std::uint32_t>(nodes_.size());
    add_boxes(boxes, first + count / 2, count - count / 2);
}

void BoxTree::refit(std::span<const Bounds<float>> boxes) {
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        node.box = {};
        for (std::uint32_t k = 0; k < node.count; ++k) node.box.add(boxes[order_[node.first + k]]);
        if (node.count == 0) node.box.add(nodes_[i + 1].box), node.box.add(nodes_[node.second].box);
    }
}

std::vector<BoxTree::Step> BoxTree::traversal() const {
    std::vector<Step> steps(nodes_.size());
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        const Node& node = nodes_[i];
        steps[i].box = node.box;
        steps[i].past = node.count > 0 ? static_cast<std::uint32_t>(i + 1)
                                       : steps[node.second].past;
        if (node.count == 1) steps[i].only = order_[node.first];
    }
    return steps;
}

void NearestTriangle::set_geometry(const FrameGeometry& geometry) {
    objects_ = BoxTree(object_boxes(geometry));
    moved_ = false;
    parts_.assign(geometry.ranges.size(), {});
}

void NearestTriangle::record_move(std::size_t object) { moved_ = parts_[object].moved = true; }

void NearestTriangle::visit_triangles(const FrameGeometry& geometry, std::size_t object,
                                      const vec3& point, float& squared) {
    const DrawRange& range = geometry.ranges[object];
    const auto look = [&](std::uint32_t triangle) {
        const auto corner = [&](std::uint32_t j) {
            return geometry.vertices[geometry.indices[range.first_index + 3 * triangle + j]]
                .position;
        };
        squared = std::min(squared, squared_distance(point, corner(0), corner(1), corner(2)));
    };
    if (range.index_count <= 3 * kMaxLinearSearchTriangles) {
        for (std::uint32_t i = 0; i < range.index_count / 3; ++i) look(i);
        return;
    }
    ObjectTree& part = parts_[range.storage];
    if (!part.tree)
        part.tree = BoxTree(triangle_boxes(geometry, range));
    else if (part.moved)
        part.tree->refit(triangle_boxes(geometry, range));
    part.moved = false;
    part.tree->find_nearest(point, squared, look);
}

void NearestTriangle::visit_in_object_space(const FrameGeometry& geometry, std::size_t object,
                                            const dvec3& point, float& squared) {
    constexpr double kTransformRoundingError =
        1e-5; // larger than the error of the transform there and back
    const ObjectSpace& own = *geometry.ranges[object].own;
    // The search starts with the smallest distance known so far, so that farther triangles are
    // skipped.
    const double known = std::sqrt(double{squared}) / own.least * (1 + kTransformRoundingError);
    float own_squared = static_cast<float>(known * known);
    visit_triangles(geometry, object, vec3(own.to_object(point)), own_squared);
    const double gap = std::sqrt(double{own_squared}) * own.least;
    squared = std::min(squared, static_cast<float>(gap * gap));
}

float NearestTriangle::distance(const FrameGeometry& geometry, const dvec3& at,
                                const std::function<bool(std::size_t, const DrawRange&)>& skip) {
    if (moved_) objects_.refit(object_boxes(geometry));
    moved_ = false;
    const vec3 point(at);
    float squared = std::numeric_limits<float>::infinity();
    objects_.find_nearest(point, squared, [&](std::uint32_t object) {
        if (skip(object, geometry.ranges[object])) return;
        if (geometry.ranges[object].own)
            visit_in_object_space(geometry, object, at, squared);
        else if (const float gap = min_distance(point, geometry.ranges[object].bounds);
                 !(gap * gap >= squared))
            visit_triangles(geometry, object, point, squared);
    });
    return std::sqrt(squared);
}

} // namespace catoptric::render
