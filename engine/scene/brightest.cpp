// Keeps the strongest lights of a scene.
#include "scene/scene_overrides.hpp"

#include "core/luminance.hpp"
#include "core/text.hpp"
#include "scene/light.hpp"
#include "scene/light_kind.hpp"
#include "scene/unsupported_feature.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace catoptric::scene {

namespace {

/// Returns how strongly one light lights a surface at `point` that faces it, without shadows.
double strength_at(const dvec3& point, const PointLight& light) {
    const double emitted = luminance(dvec3(light.emission)) * light.area;
    if (light.directional) return emitted;
    const dvec3 way = point - light.position;
    const double square = glm::dot(way, way), distance = std::sqrt(square);
    if (square == 0) return std::numeric_limits<double>::infinity();
    const dvec3 along = way / distance;
    const double facing = light_share(light, along);
    const double part = std::isinf(light.range) ? 0 : std::pow(distance / light.range, 4);
    const double window = std::clamp(1 - part, 0.0, 1.0);
    double cone = 1;
    if (const LightKind& kind = find_light_kind(light.kind);
        !light.is_lamp && kind.share != nullptr)
        cone = kind.share(light, glm::dot(light.axis, along));
    return emitted * facing * window * cone / square;
}

/// One of the points from which an object, or a light without a surface, lights the scene.
struct LightSource {
    std::size_t index = 0; ///< index of the object; lights without a surface follow the objects
    std::size_t point = 0; ///< number among the points of this index
    double strength = 0;
};

std::vector<LightSource> light_sources(const Scene& scene) {
    const dvec3 centre = bounds(scene).centre();
    Scene one; // scene that holds only one light source at a time
    one.meshes = scene.meshes, one.materials = scene.materials;
    std::vector<LightSource> sources;
    const auto add = [&](std::size_t index) {
        std::size_t point = 0;
        for (const PointLight& light : list_lights(one))
            sources.push_back({index, point++, strength_at(centre, light)});
    };
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        one.objects = {scene.objects[i]};
        add(i);
    }
    one.objects.clear();
    for (std::size_t i = 0; i < scene.punctual.size(); ++i) {
        one.punctual = {scene.punctual[i]};
        add(scene.objects.size() + i);
    }
    return sources;
}

/// Gives the object a material that lights nothing.
void stop_emission(Scene& scene, Object& object) {
    Material dark = scene.materials[object.material];
    dark.light = vec3(0);
    const auto known = std::ranges::find(scene.materials, dark);
    object.material = static_cast<std::size_t>(known - scene.materials.begin());
    if (known == scene.materials.end()) scene.materials.push_back(std::move(dark));
}

/// Moves the triangles of all points except the `kept` points into a new object that emits no
/// light.
void split_emitters(Scene& scene, std::size_t index, const std::vector<std::size_t>& kept) {
    Object rest = scene.objects[index];
    Mesh bright = scene.meshes[rest.mesh], dark = bright;
    const auto points = triangle_lights(bright, rest.world_from_object);
    bright.triangles.clear(), dark.triangles.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool stays = points[i] && std::ranges::find(kept, *points[i]) != kept.end();
        (stays ? bright : dark).triangles.push_back(scene.meshes[rest.mesh].triangles[i]);
    }
    scene.objects[index].mesh = scene.meshes.size();
    scene.meshes.push_back(std::move(bright));
    rest.mesh = scene.meshes.size();
    scene.meshes.push_back(std::move(dark));
    stop_emission(scene, rest);
    scene.objects.push_back(std::move(rest));
}

} // namespace

void drop_weakest_lights(Scene& scene, std::size_t most) {
    if (list_lights(scene).size() <= most) return;
    std::vector<LightSource> sources = light_sources(scene);
    std::ranges::stable_sort(sources, std::ranges::greater(), &LightSource::strength);
    struct LightSourceOwner {
        std::vector<std::size_t> kept;
        std::size_t points = 0;
    };
    std::map<std::size_t, LightSourceOwner> things; // objects or lights, by index
    for (std::size_t i = 0; i < sources.size(); ++i) {
        LightSourceOwner& thing = things[sources[i].index];
        ++thing.points;
        if (i < most) thing.kept.push_back(sources[i].point);
    }
    const std::size_t objects = scene.objects.size();
    std::vector<PunctualLight> punctual;
    for (const auto& [index, thing] : things) {
        const bool is_object = index < objects;
        if (thing.kept.size() == thing.points) {
            if (!is_object) punctual.push_back(scene.punctual[index - objects]);
            continue;
        }
        std::string place = is_object ? "object " + quote(scene.objects[index].name)
                                      : "light " + quote(scene.punctual[index - objects].name);
        if (!thing.kept.empty())
            place += ", " + std::to_string(thing.points - thing.kept.size()) + " of its " +
                     std::to_string(thing.points) + " parts";
        add_unsupported(scene.unsupported, "lights-left-out", place);
        if (!thing.kept.empty())
            split_emitters(scene, index, thing.kept);
        else if (is_object)
            stop_emission(scene, scene.objects[index]);
    }
    scene.punctual = std::move(punctual);
}

} // namespace catoptric::scene
