#pragma once

#include "measure/lines.hpp"
#include "scene/shapes.hpp"
#include "session/access.hpp"
#include "support/rendering.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

/// Scenes whose pictures tell which mirrors a ray has met. The surroundings have radiance 1, and
/// each of three mirrors halves one colour channel.
namespace test {

/// Adds the material of mirror `number` (0 to 2), which halves channel `number`, and returns its
/// index.
inline std::size_t add_halving_mirror(scene::Scene& scene, int number) {
    scene::Material material{.name = "mirror" + std::to_string(number + 1), .mirror = true};
    material.reflectance[number] = .5f;
    return add_material(scene, material);
}

/// Adds a closed box [lo, hi] that emits radiance 1 in all channels at every point.
inline void add_bright_box(scene::Scene& scene, dvec3 lo, dvec3 hi) {
    const std::size_t bright = add_material(scene, {.name = "bright", .emission = vec3(1)});
    for (int face = 0; face < 6; ++face) add_mesh(scene, make_box_wall(face, lo, hi), bright);
}

/// Returns a scene of three mirror balls in a bright box. The balls reflect each other and are
/// exact spheres.
inline scene::Scene make_three_ball_scene() {
    scene::Scene scene{.name = "three balls"};
    add_bright_box(scene, {-4, -3, -5}, {4, 3, 5});
    const std::array<dvec3, 3> places{{{-1.25, -.3, .6}, {1.2, .1, .3}, {.05, 1, 2.2}}};
    const std::array<double, 3> radii{1.1, 1, 1.1};
    for (int i = 0; i < 3; ++i)
        add_ball(scene, "ball" + std::to_string(i + 1), add_halving_mirror(scene, i),
                 places[static_cast<std::size_t>(i)], radii[static_cast<std::size_t>(i)], 5);
    scene.cameras.push_back(
        {.eye = {.1, .3, -4}, .target = {0, .3, 1}, .vertical_fov_degrees = 44});
    return scene;
}

/// Adds a board that emits this radiance on both sides.
inline void add_glowing_board(scene::Scene& scene, vec3 emission, dvec3 centre, dvec3 half_along,
                              dvec3 half_up) {
    const std::size_t glow = add_material(scene, {.name = "glow", .emission = emission});
    for (const dvec3& up : {half_up, -half_up}) // a lamp shines from its front side only
        add_quad(scene, "board", glow, centre - half_along - up, centre + half_along - up,
                 centre + half_along + up, centre - half_along + up);
}

/// Number of compared mirror pixels, and number of those that are off.
struct PixelComparison {
    std::size_t pixels = 0, off = 0;
    double share_of_off_mirror_pixels() const {
        return static_cast<double>(off) / static_cast<double>(pixels);
    }
};

inline bool do_pixel_channels_differ(const vec3& a, const vec3& b) {
    // A channel that is NaN counts as off, because the comparison is then false.
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(a[i] - b[i]) <= static_cast<float>(measure::kMaxInvisibleDifference)))
            return true;
    return false;
}

/// Returns how many mirrors a traced ray has met, from the colour of its pixel; 0 for black. The
/// surroundings of the mirrors must have radiance 1.
inline int count_mirrors_met_by_ray(const vec3& colour) {
    const float product = colour.x * colour.y * colour.z;
    return product > 0 ? static_cast<int>(std::lround(-std::log2(product))) : 0;
}

/// Compares a picture with the ray-traced one over the mirror pixels for which `counts(hit,
/// colour)` is true. Hit and colour are those of the ray-traced picture.
template <typename Counts>
PixelComparison compare_pixels_of_mirrors(const measure::Picture& picture,
                                          const session::TechniqueResult& truth, Counts&& counts) {
    PixelComparison result;
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        if (!measure::first_mirror(truth.hits[i])) continue;
        if (!counts(truth.hits[i], truth.hdr.pixels[i])) continue;
        ++result.pixels;
        result.off += do_pixel_channels_differ(picture.pixels[i], truth.hdr.pixels[i]);
    }
    return result;
}
inline PixelComparison compare_pixels_of_mirrors(const measure::Picture& picture,
                                                 const session::TechniqueResult& truth) {
    return compare_pixels_of_mirrors(picture, truth,
                                     [](std::uint32_t, const vec3&) { return true; });
}

inline std::ostream& operator<<(std::ostream& out, const PixelComparison& found) {
    return out << found.off << " of " << found.pixels << " off";
}

} // namespace test
