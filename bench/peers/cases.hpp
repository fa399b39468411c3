#pragma once

#include "embree_scene.hpp"
#include "scene/scene.hpp"
#include "session/engine.hpp"
#include "session/usage.hpp"

#include <span>

namespace peers {

/// The devices and settings that all comparisons use.
struct EmbreeComparisonBench {
    catoptric::session::Engine& engine;
    const catoptric::session::UsageMeter& meter; ///< measures the whole process
    const EmbreeDevice& device;
    int threads = 1; ///< number of threads for our tracer, and for Embree
    int rounds = 0;
};

struct NamedSceneFactory {
    const char* name;
    catoptric::scene::Scene (*make)();
};
/// Returns the scenes of the comparisons: the built-in scene; two variants of it with finer balls
/// and a ring, with 100,144 and 1,001,756 triangles; and the scene `room`.
std::span<const NamedSceneFactory> list_named_scene_factories();

/// Compares pictures of the built-in scene: traced with mesh balls and with exact spheres, with the
/// first hit by the rasteriser, by captures, and by prototypes. Prints times and differences.
/// Returns whether all traced pictures agree.
bool compare_built_in_scene_pictures(const EmbreeComparisonBench& bench);
/// Compares our traced picture of a scene with Embree's. Prints times and differences. Returns
/// whether the pictures agree.
bool compare_whitted_pictures_with_embree(const EmbreeComparisonBench& bench,
                                          const NamedSceneFactory& of);
/// Compares the first hits of two lists of rays in a scene, without shading: the camera's rays, and
/// rays with random origins and directions. Prints times and differences. Returns whether our hits
/// and Embree's agree.
bool compare_ray_lists_with_embree(const EmbreeComparisonBench& bench, const NamedSceneFactory& of);
/// Compares with Embree the build times of trees of a million triangles, and the expected cost of
/// rays in the trees of all built-in scenes. Prints both.
void compare_bvhs_with_embree(const EmbreeComparisonBench& bench);

} // namespace peers
