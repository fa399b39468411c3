#include "render/scene_changes.hpp"
#include "scene/material_facts.hpp"

#include "scene/light_kind.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

bool are_equal_spheres(const std::optional<scene::Sphere>& a,
                       const std::optional<scene::Sphere>& b) {
    return a.has_value() == b.has_value() &&
           (!a || (a->centre == b->centre && a->radius == b->radius));
}

bool is_light_emitting(const scene::Material& material) {
    return scene::emitted_radiance(material) != vec3(0);
}

/// Returns whether the object is drawn, traced and counted in the same way with either material, so
/// that only values differ.
bool differ_only_in_values(const scene::Material& a, scene::Material b) {
    if (is_light_emitting(a) != is_light_emitting(b) ||
        (a.albedo == vec3(0)) != (b.albedo == vec3(0)) ||
        (a.reflectance == vec3(1)) != (b.reflectance == vec3(1)))
        return false;
    b.albedo = a.albedo, b.emission = a.emission, b.reflectance = a.reflectance;
    b.light = a.light, b.name = a.name;
    return a == b;
}

} // namespace

SceneChanges SceneChangeTracker::update(const scene::Scene& now, bool report_all) {
    SceneChanges changes;
    changes.layout = report_all || objects_.size() != now.objects.size();
    const std::size_t known = objects_.size();
    objects_.resize(now.objects.size());
    for (std::size_t i = 0; i < now.objects.size(); ++i) {
        const scene::Object& object = now.objects[i];
        const scene::Material& material = now.materials[object.material];
        ObjectState& seen = objects_[i];
        const bool moved = seen.world_from_object != object.world_from_object;
        const bool is_new = i >= known;
        const bool repainted = is_new || materials_[seen.material] != material;
        changes.layout = changes.layout || seen.mesh != object.mesh ||
                         seen.seen_by_camera != object.seen_by_camera ||
                         seen.mirror != object.mirror ||
                         seen.sphere.has_value() != object.sphere.has_value() || is_new ||
                         !differ_only_in_values(materials_[seen.material], material);
        changes.lights = changes.lights ||
                         ((moved || repainted) &&
                          (is_light_emitting(material) ||
                           (!is_new && is_light_emitting(materials_[seen.material]))));
        changes.materials = changes.materials || repainted ||
                            !are_equal_spheres(seen.sphere, object.sphere);
        if (moved) changes.moved.push_back(i);
        seen = {object.mesh,   object.material,       object.world_from_object,
                object.sphere, object.seen_by_camera, object.mirror};
    }
    if (materials_ != now.materials) materials_ = now.materials;
    const bool other_lights = !std::ranges::equal(punctual_, now.punctual,
                                                  scene::have_equal_emission);
    if (other_lights) punctual_ = now.punctual;
    changes.lights = changes.lights || changes.layout || other_lights;
    return changes;
}

} // namespace catoptric::render
