// The lights of a scene on the device, and the views that draw their shadows.
#include "render/gpu_scene.hpp"
#include "render/views.hpp"
#include "scene/light.hpp"
#include "scene/light_kind.hpp"
#include "scene/material_facts.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

/// Returns the light's entry, without its position and its shadow axes.
shared::Light light_entry(const scene::PointLight& light, const SceneUnits& space) {
    const scene::LightKind& kind = scene::find_light_kind(light.kind);
    shared::Light entry{};
    entry.normal = vec3(light.normal);
    entry.forward = light.axis == dvec3(0) ? entry.normal : vec3(light.axis);
    const bool is_alike_all_round = light.normal == dvec3(0) && light.cosines == dvec3(0);
    const double share = is_alike_all_round ? light_share(light, {0, 0, 1}) : 1;
    const double area = light.directional ? 1 : share * light.area * space.scale * space.scale;
    entry.intensity = light.emission * static_cast<float>(area);
    entry.reach = 1 / space.to_scene_length(light.range);
    entry.kind = !light.is_lamp              ? kind.shader_kind
                 : light.cosines != dvec3(0) ? shared::kLightKindTwoSidedLamp
                                             : shared::kLightKindLamp;
    const bool has_numbers = !light.is_lamp && kind.shader_numbers != nullptr;
    const auto [cos_outer, sharpness] = has_numbers ? kind.shader_numbers(light)
                                                    : scene::LightShaderNumbers();
    entry.cos_outer = cos_outer, entry.sharpness = sharpness;
    return entry;
}

/// Returns the extent of a light in the axes of its shadow map, which are the columns of `axes`.
shared::LampExtent make_lamp_extent(const scene::PointLight& light, const SceneUnits& space,
                                    const dmat3& axes) {
    // Third half axis of a flat lamp, relative to its first. Rounding of the lamp's vertices is
    // less.
    constexpr double kFlatLampThickness = 1e-3;
    const dmat3 half_axes = space.scale * glm::transpose(axes) * light.half_axes;
    shared::LampExtent extent{vec3(half_axes[0]), vec3(half_axes[1]), vec3(half_axes[2]), vec3(0)};
    const double least_second = kFlatLampThickness * glm::length(half_axes[0]);
    if (glm::length(half_axes[1]) > least_second && glm::length(half_axes[2]) <= least_second)
        extent.flat_normal = vec3(glm::normalize(glm::cross(half_axes[0], half_axes[1])));
    return extent;
}

} // namespace

void GpuScene::fill_lights(const scene::Scene& now, bool others) {
    if (others) world_lights_ = scene::list_lights(now);
    check(world_lights_.size() <= shared::kMaxLights, Failure::exhausted, "the scene has ",
          world_lights_.size(), " lights, ", shared::kMaxLights, " are allowed");
    lights_.clear(), light_places_.clear();
    shadow_faces_ = 5;
    has_light_kinds_ = !now.punctual.empty() ||
                       std::ranges::any_of(world_lights_, [](const scene::PointLight& light) {
                           return light.cosines != dvec3(0);
                       });
    for (const scene::PointLight& light : world_lights_) {
        shared::Light entry = light_entry(light, space_);
        if (light.directional)
            light_places_.emplace_back(
                make_directional_views(entry.forward, space_.core, geometry_bounds(geometry_))[0]
                    .eye);
        else
            light_places_.push_back(space_.to_scene(light.position));
        entry.position = vec3(light_places_.back());
        if (!light.directional) {
            const float gap = nearest_.distance(geometry_, light_places_.back(),
                                                [](std::size_t, const DrawRange& range) {
                                                    return !range.casts_shadow && !range.tints;
                                                });
            const bool has_axes = light.cosines != dvec3(0);
            const shared::View main = has_axes ? make_turned_views(entry.position,
                                                                   glm::mat3(light.axes), gap)[4]
                                               : make_turned_views(entry.position, entry.forward,
                                                                   gap)[4];
            entry.right = main.right, entry.down = main.down, entry.forward = main.forward,
            entry.near = main.near;
            if (has_axes) entry.normal = vec3(light.cosines);
        }
        lights_.push_back(entry);
        if (light.normal == dvec3(0)) shadow_faces_ = 6;
    }
    std::vector<shared::Light> all = lights_;
    all.resize(shared::kMaxLights);
    light_buffer_.set(all);
}

void GpuScene::fill_lamp_extents() {
    std::vector<shared::LampExtent> extents(shared::kMaxLights);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const dmat3 axes(vec3(lights_[i].right), -vec3(lights_[i].down), vec3(lights_[i].forward));
        extents[i] = make_lamp_extent(world_lights_[i], space_, axes);
    }
    lamp_extent_buffer_.set(extents);
}

std::vector<shared::View> GpuScene::shadow_views(const shared::Light& light) const {
    std::vector<shared::View> views;
    if (light.kind == shared::kLightKindDirectional) {
        std::ranges::copy(
            make_directional_views(light.forward, space_.core, geometry_bounds(geometry_)),
            std::back_inserter(views));
    } else {
        views = make_turned_views(light.position,
                                  glm::mat3(light.right, -light.down, light.forward), 0);
        for (shared::View& view : views) view.near = light.near;
    }
    views.resize(shadow_faces_); // the last face looks back, where a one-sided light is dark
    return views;
}

std::uint32_t GpuScene::drawn_shadow_faces(std::uint32_t light) const {
    return lights_[light].kind == shared::kLightKindDirectional ? 2 : shadow_faces_;
}

} // namespace catoptric::render
