#include "render/face_needs.hpp"

#include "render/footprint.hpp"
#include "render/views.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

/// Returns the vertices of an object with an object space, relative to its middle, in scene units.
std::vector<shared::Vertex> centred_vertices(const FrameGeometry& geometry,
                                             const DrawRange& range) {
    std::vector<shared::Vertex> arms;
    const dmat3 turn = range.own->scene_from_own, normals = glm::transpose(glm::inverse(turn));
    for (std::uint32_t i = 0; i < range.vertex_count; ++i) {
        const shared::Vertex& vertex = geometry.vertices[range.first_vertex + i];
        arms.push_back({vec3(turn * dvec3(vertex.position)),
                        vec3(glm::normalize(normals * dvec3(vertex.normal)))});
    }
    return arms;
}

/// Returns the object's indices, counted from its first vertex.
std::vector<std::uint32_t> relative_indices(const FrameGeometry& geometry, const DrawRange& range) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count; ++k)
        indices.push_back(geometry.indices[k] - range.first_vertex);
    return indices;
}

/// Replaces an orthographic view by a perspective one whose eye is one unit, the size of the scene,
/// in front of the shown point.
shared::View as_perspective(shared::View view, const vec3& shown) {
    if (view.parallel == 0) return view;
    view.eye += view.forward * (dot(view.forward, shown - view.eye) - 1);
    view.parallel = 0;
    return view;
}

} // namespace

std::vector<double> find_needed_edges(const FrameGeometry& geometry,
                                      std::span<const std::size_t> mirrors,
                                      std::span<const shared::Probe> probes,
                                      const shared::View& camera, const dvec3& eye,
                                      std::uint32_t height) {
    std::vector<double> needs;
    for (std::size_t mirror = 0; mirror < mirrors.size(); ++mirror) {
        const DrawRange& range = geometry.ranges[mirrors[mirror]];
        const double radius{probes[mirror].radius};
        PixelGrid pixels{as_perspective(camera, range.bounds.centre()), height};
        if (range.own)
            pixels.view.eye = vec3(eye + dvec3(pixels.view.eye - camera.eye) - range.own->centre);
        if (!range.seen_by_camera || !may_show(camera, range.bounds))
            needs.push_back(0);
        else if (radius > 0)
            needs.push_back(
                edge_for_sphere(pixels, range.own ? vec3(0) : probes[mirror].sphere, radius));
        else if (range.own)
            needs.push_back(edge_for_mesh(pixels, centred_vertices(geometry, range),
                                          relative_indices(geometry, range)));
        else
            needs.push_back(edge_for_mesh(
                pixels, geometry.vertices,
                std::span(geometry.indices).subspan(range.first_index, range.index_count)));
        if (range.lobe_alpha > 0)
            needs.back() = std::min(needs.back(), edge_for_lobe(range.lobe_alpha));
    }
    return needs;
}

} // namespace catoptric::render
