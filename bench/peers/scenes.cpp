#include "cases.hpp"
#include "import/load.hpp"
#include "scene/build.hpp"
#include "scene/built_in.hpp"

namespace peers {

using namespace catoptric;

namespace {

/// Returns the built-in scene with more triangles: balls of 4^(levels+1) triangles, and a diffuse
/// torus of around^2 triangles.
scene::Scene make_finely_tessellated_cornell_mirrors(int levels, int around) {
    scene::Scene scene = scene::make_cornell();
    // All four balls share the mesh that is replaced here.
    scene.meshes[scene.objects.back().mesh] = scene::ball("ball", levels);
    scene::add_mesh(scene, scene::torus("ring", 130, 50, around),
                    scene::add_material(scene, {.name = "paint", .albedo = {.3f, .4f, .7f}}));
    scene.objects.back().world_from_object[3] = dvec4(278, 330, 300, 1);
    return scene;
}

constexpr NamedSceneFactory kNamedSceneFactories[] = {
    {"built-in", scene::make_cornell},
    {"100k", [] { return make_finely_tessellated_cornell_mirrors(6, 186); }},
    {"1M", [] { return make_finely_tessellated_cornell_mirrors(7, 860); }},
    {"room", [] { return scene::load("room"); }}};

} // namespace

std::span<const NamedSceneFactory> list_named_scene_factories() { return kNamedSceneFactories; }

} // namespace peers
