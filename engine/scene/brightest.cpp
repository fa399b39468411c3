// Of many lights the strongest.
#include "scene/wishes.hpp"

#include "core/text.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::scene {

namespace {

double luminance(const vec3& colour) { // Rec. 709
    return .2126 * colour.x + .7152 * colour.y + .0722 * colour.z;
}

/// What one light does to a surface at the point that faces it, without shadows.
double strength_at(const dvec3& point, const PointLight& light) {
    const double emitted = luminance(light.emission) * light.area;
    if (light.directional) return emitted;
    const dvec3 way = point - light.position;
    const double square = glm::dot(way, way), distance = std::sqrt(square);
    if (square == 0) return std::numeric_limits<double>::infinity();
    const dvec3 along = way / distance;
    const double facing = light.normal == dvec3(0) ? 1
                                                   : std::max(0.0, glm::dot(light.normal, along));
    const double part = std::isinf(light.range) ? 0 : std::pow(distance / light.range, 4);
    const double window = std::clamp(1 - part, 0.0, 1.0);
    double cone = 1;
    if (light.axis != dvec3(0)) {
        const double wide = std::max(.001, light.cos_inner - light.cos_outer);
        cone = std::clamp((glm::dot(light.axis, along) - light.cos_outer) / wide, 0.0, 1.0);
        cone *= cone;
    }
    return emitted * facing * window * cone / square;
}

/// A thing that lights, as one or several points.
struct Source {
    std::size_t index = 0; ///< of the object, or after them of the light without a surface
    std::size_t points = 0;
    double strength = 0;
};

std::vector<Source> sources_of(const Scene& scene) {
    const dvec3 centre = bounds(scene).centre();
    Scene one; // source by source
    one.meshes = scene.meshes, one.materials = scene.materials;
    std::vector<Source> sources;
    const auto add = [&](std::size_t index) {
        Source source{.index = index};
        for (const PointLight& light : lights(one))
            ++source.points, source.strength += strength_at(centre, light);
        if (source.points > 0) sources.push_back(source);
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

} // namespace

void leave_out_lights(Scene& scene, std::size_t most) {
    if (lights(scene).size() <= most) return;
    std::vector<Source> sources = sources_of(scene);
    std::ranges::stable_sort(sources, std::ranges::greater(), &Source::strength);
    std::size_t kept = 0;
    std::vector<std::size_t> left_out;
    for (const Source& source : sources) {
        if (kept + source.points <= most)
            kept += source.points;
        else
            left_out.push_back(source.index);
    }
    std::ranges::sort(left_out);
    std::vector<Punctual> punctual;
    for (std::size_t i = 0; i < scene.punctual.size(); ++i)
        if (!std::ranges::binary_search(left_out, scene.objects.size() + i))
            punctual.push_back(scene.punctual[i]);
    for (const std::size_t index : left_out) {
        const bool is_object = index < scene.objects.size();
        const std::string& name = is_object ? scene.objects[index].name
                                            : scene.punctual[index - scene.objects.size()].name;
        add_gap(scene.gaps, "lights-left-out",
                (is_object ? "object " : "light ") + in_quotes(name));
        if (!is_object) continue;
        Object& object = scene.objects[index];
        Material dark = scene.materials[object.material];
        dark.light = vec3(0);
        const auto known = std::ranges::find(scene.materials, dark);
        object.material = static_cast<std::size_t>(known - scene.materials.begin());
        if (known == scene.materials.end()) scene.materials.push_back(std::move(dark));
    }
    scene.punctual = std::move(punctual);
}

} // namespace catoptric::scene
