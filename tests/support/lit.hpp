#pragma once

#include "measure/lines.hpp"
#include "scene/shapes.hpp"
#include "support/rendering.hpp"

/// Outdoor scenes, and comparisons of their rasterised pictures with ray-traced ones.
namespace test {

/// Returns the transform of a light at `from` that shines along `axis`. A light shines along -z of
/// its node.
inline dmat4 make_light_transform(const dvec3& from, const dvec3& axis) {
    const dvec3 back = -glm::normalize(axis);
    const dvec3 other = std::abs(back.y) < .9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 right = glm::normalize(glm::cross(other, back));
    return {dvec4(right, 0), dvec4(glm::cross(back, right), 0), dvec4(back, 0), dvec4(from, 1)};
}

/// Returns a scene of a grey floor of 4x4 around the origin at y = 0.
inline scene::Scene make_floor_scene() {
    scene::Scene scene{.name = "floor"};
    const std::size_t grey = add_material(scene, {.name = "grey", .albedo = {.6f, .5f, .4f}});
    add_quad(scene, "floor", grey, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2});
    return scene;
}

/// Returns a scene of the floor with a wall, a ball and a block, seen from the side.
inline scene::Scene make_yard_scene() {
    scene::Scene scene = make_floor_scene();
    scene.name = "yard";
    const std::size_t red = add_material(scene, {.name = "red", .albedo = {.7f, .3f, .2f}});
    add_quad(scene, "wall", red, {-2, 0, -2}, {2, 0, -2}, {2, 1, -2}, {-2, 1, -2});
    add_ball(scene, "ball", red, {-.6, .5, .2}, .5);
    for (int face = 0; face < 6; ++face)
        add_mesh(scene, scene::make_box_wall(face, {1.1, .8, -.3}, {.5, 0, -.9}), red);
    scene.cameras.push_back(
        {.name = "side", .eye = {1, 2.5, 4}, .target = {0, .3, 0}, .vertical_fov_degrees = 50});
    return scene;
}

/// Returns the largest channel of the difference of two colours, each clamped to [0,1].
inline float max_channel_difference(const vec3& a, const vec3& b) {
    const vec3 size = abs(clamp(a, 0.0f, 1.0f) - clamp(b, 0.0f, 1.0f));
    return std::max({size.x, size.y, size.z});
}

/// Returns the mask of all pixels within two pixels of a shadow's edge. A pixel is in shadow if the
/// pictures with and without shadows differ there.
inline measure::Mask mask_shadow_edges(const measure::Picture& lit,
                                       const measure::Picture& shadowed) {
    measure::Mask edges(lit.pixels.size(), 0);
    const auto is_dark = [&](int x, int y) {
        return max_channel_difference(lit.at(x, y), shadowed.at(x, y)) > .002f;
    };
    for (int y = 0; y < lit.height; ++y)
        for (int x = 0; x < lit.width; ++x)
            for (int i = 0; i < 25; ++i) {
                const int beside_x = std::clamp(x + i % 5 - 2, 0, lit.width - 1),
                          beside_y = std::clamp(y + i / 5 - 2, 0, lit.height - 1);
                if (is_dark(x, y) != is_dark(beside_x, beside_y))
                    edges[static_cast<std::size_t>(y) * lit.width + x] = 255;
            }
    return edges;
}

/// Returns the share of a picture's pixels that are off and not in the mask `left_out`.
inline double share_of_off_pixels(const measure::Picture& a, const measure::Picture& b,
                                  const measure::Mask& left_out) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        off += left_out[i] == 0 && !(max_channel_difference(a.pixels[i], b.pixels[i]) <=
                                     float(measure::kMaxInvisibleDifference));
    return double(off) / double(a.pixels.size());
}

/// Renders frames from the scene's first camera without ambient light and returns the last.
inline session::TechniqueResult render_without_ambient(const scene::Scene& scene,
                                                       const std::string& technique, uvec2 size,
                                                       int frames = 1) {
    session::Request asked = make_test_request(scene, {technique}, size);
    asked.ambient = 0;
    asked.warmup = frames - 1;
    return std::move(session::run(get_test_engine(), asked).parts.front());
}

/// Returns the share of pixels off between the rasterised and the ray-traced picture, without
/// pixels at shadow edges.
inline double share_off_in_raster_picture(const scene::Scene& scene, uvec2 size) {
    const session::TechniqueResult traced = render_without_ambient(scene, "raytrace", size),
                                   lit = render_without_ambient(scene, "raytrace:shadow=none",
                                                                size),
                                   raster = render_without_ambient(scene, "naive:bounces=0", size);
    return share_of_off_pixels(raster.hdr, traced.hdr, mask_shadow_edges(lit.hdr, traced.hdr));
}

} // namespace test
