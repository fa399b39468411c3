#pragma once

#include "app/engine.hpp"
#include "app/usage.hpp"
#include "embree_scene.hpp"
#include "scene/scene.hpp"

#include <span>

namespace peers {

/// What all comparisons are measured with.
struct Bench {
    catoptric::app::Engine& engine;
    const catoptric::app::UsageMeter& meter; ///< of the process
    const EmbreeDevice& device;
    int threads = 1; ///< of each side
    int rounds = 0;
};

struct NamedScene {
    const char* name;
    catoptric::scene::Scene (*make)();
};
/// The built-in scene; the same with finer balls and a ring, in all 100,144 triangles and
/// 1,001,756; the furnished room.
std::span<const NamedScene> scenes();

// Each prints what it finds, and returns whether both sides find the same.
/// Pictures of the built-in scene with balls as triangles and exact ones, captures, prototypes.
bool compare_built_in(const Bench& bench);
/// The picture of a scene.
bool compare_pictures(const Bench& bench, const NamedScene& of);
/// What rays from anywhere in any direction meet first in a scene.
bool compare_rays(const Bench& bench, const NamedScene& of);
/// How long trees of a million triangles take to build, and what walks cost in those of scenes.
void compare_trees(const Bench& bench);

} // namespace peers
