#include "study/oracle.hpp"

#include "bvh/closest_hit.hpp"
#include "core/watch.hpp"
#include "measure/lookup.hpp"
#include "render/views.hpp"
#include "scene/capture_centre.hpp"
#include "scene/material_facts.hpp"
#include "scene/pose.hpp"
#include "session/rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::study {

namespace {

constexpr int kLookupStateUnknown = 1, kLookupStateMiss = 2; // Lookup::state
constexpr std::size_t kRaysBetweenLooks = 1024;              // at the signal to stop
constexpr float kUnlimited = std::numeric_limits<float>::max();

/// Returns the ray that a mirror reflects from the point where `ray` met it, as
/// shaders/lib/whitted.glsl does.
f32::Ray reflect_ray(const render::FrameGeometry& geometry, const f32::Ray& ray,
                     const bvh::RayHit<float>& hit) {
    const auto vertex = [&](std::uint32_t j) -> const shared::Vertex& {
        return geometry.vertices[geometry.indices[3 * hit.triangle + j]];
    };
    const vec3 a = vertex(0).position, b = vertex(1).position, c = vertex(2).position,
               w = hit.barycentric;
    vec3 error;
    const vec3 point = f32::triangle_hit_point(a, b, c, w, error);
    const vec3 facet = f32::facet_normal(a, b, c);
    const vec3 normal = normalize(w.x * vertex(0).normal + w.y * vertex(1).normal +
                                  w.z * vertex(2).normal);
    const vec3 direction = f32::reflect_above_facet(ray.direction, normal, facet);
    return {f32::ray_spawn_origin(point, error, facet, direction), direction, hit.triangle + 1};
}

} // namespace

TrueHitFinder::TrueHitFinder(const Request& request) {
    const scene::SceneAtTime at_time(request.scene, request.time);
    const scene::Scene& now = *at_time;
    const render::SceneUnits space = render::make_scene_units(request.scene);
    geometry_ = render::make_geometry(now, space);
    mirror_objects_ = scene::mirrors(now);
    for (const scene::Object& object : now.objects)
        emits_.push_back(scene::is_visibly_emissive(now.materials[object.material]));
    everything_ = build_bvh_without(geometry_, geometry_.ranges.size());
    for (const dvec3& centre : scene::capture_centres(now))
        centres_.push_back(space.to_scene_point(centre));
    for (const std::size_t object : mirror_objects_) {
        without_.push_back(build_bvh_without(geometry_, object));
    }
    trace(request);
}

void TrueHitFinder::trace(const Request& request) {
    const render::SceneUnits space = render::make_scene_units(request.scene);
    const shared::View view = render::make_camera_view(
        scene::camera_at(request.camera, request.time), space, request.size, 0,
        render::geometry_bounds(geometry_));
    const auto mirror_of = [&](std::uint32_t object) {
        return static_cast<std::uint32_t>(std::ranges::find(mirror_objects_, object) -
                                          mirror_objects_.begin());
    };
    for (std::size_t pixel = 0; pixel < std::size_t{request.size.x} * request.size.y; ++pixel) {
        if (pixel % kRaysBetweenLooks == 0) look_at_stop();
        const f32::Ray ray = make_camera_ray(view, request.size, pixel);
        const auto hit = bvh::find_closest_hit<float>(
            everything_, ray, kUnlimited, bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag);
        if (!hit || mirror_of(hit->object) == mirror_objects_.size()) continue;
        const f32::Ray onward = reflect_ray(geometry_, ray, *hit);
        const auto met = bvh::find_closest_hit<float>(everything_, onward, kUnlimited);
        if (met && mirror_of(met->object) < mirror_objects_.size()) continue;
        FirstOrderPixel target{pixel, mirror_of(hit->object),
                               met ? static_cast<int>(met->object) : kNoObject,
                               dvec3(onward.direction)};
        if (met) target.place = dvec3(onward.origin) + double{met->t} * dvec3(onward.direction);
        targets_.push_back(target);
    }
}

int TrueHitFinder::find_captured_object(std::uint32_t mirror, const vec3& direction,
                                        bool second_layer, bool left_out) const {
    const bvh::Bvh& tree = without_[mirror];
    f32::Ray ray{centres_[mirror], direction, 0};
    // The second layer is the next surface behind the first that faces the centre.
    bool behind_first = !second_layer;
    for (auto hit = bvh::find_closest_hit<float>(tree, ray, kUnlimited); hit;
         hit = bvh::find_closest_hit<float>(tree, ray, kUnlimited)) {
        const vec4* corner = &tree.triangles[3 * hit->place];
        const bool faces = dot(f32::facet_normal(vec3(corner[0]), vec3(corner[1]), vec3(corner[2])),
                               ray.direction) < 0;
        const render::DrawRange& range = geometry_.ranges[hit->object];
        if (!(left_out && range.mirror && range.exact_sphere && !range.lit)) {
            if (behind_first && (!second_layer || faces)) return static_cast<int>(hit->object);
            behind_first = true;
        }
        ray.origin += ray.direction * hit->t;
        ray.leaves = hit->triangle + 1;
    }
    return kNoObject;
}

std::vector<measure::LookupError> TrueHitFinder::judge_lookups(const std::vector<vec4>& lookup,
                                                               bool left_out) const {
    std::vector<measure::LookupError> judged;
    for (const FirstOrderPixel& target : targets_) {
        if (judged.size() % kRaysBetweenLooks == 0) look_at_stop();
        const vec4& pixel = lookup[target.pixel];
        const int code = static_cast<int>(pixel.w) - 1;
        if (code < 0) continue;
        const auto capture = static_cast<std::uint32_t>(code / 8);
        const vec3 direction = normalize(vec3(pixel));
        const int state = code & 3;
        const bool second = (code & 4) != 0;
        const bool leaves = state == kLookupStateMiss ||
                            (state == kLookupStateUnknown &&
                             second); // as kLeaves in shaders/lib/probe.glsl
        const int object = leaves ? kNoObject
                                  : find_captured_object(capture, direction, second, left_out);
        const dvec3 wanted = target.object == kNoObject ? target.place
                                                        : target.place - dvec3(centres_[capture]);
        judged.push_back({measure::angle_between_degrees(dvec3(direction), wanted),
                          object != target.object, state,
                          double{pixel.w} - std::floor(double{pixel.w})});
    }
    return judged;
}

measure::Mask TrueHitFinder::find_light_edges(const std::vector<vec4>& lookup,
                                              const std::vector<std::uint32_t>& faces) const {
    measure::Mask found(lookup.size(), 0);
    for (std::size_t pixel = 0; pixel < lookup.size(); ++pixel) {
        if (pixel % kRaysBetweenLooks == 0) look_at_stop();
        if (!(lookup[pixel].w > 0)) continue;
        const auto mirror = static_cast<std::uint32_t>(lookup[pixel].w - 1) / 8;
        const float texel = 2.0f / static_cast<float>(faces.at(mirror));
        const vec3 size = abs(vec3(lookup[pixel]));
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        // Position on the cube's face, whose edge is 2.
        const vec3 place = vec3(lookup[pixel]) / size[axis];
        int lights = 0;
        for (int i = 0; i < 9; ++i) {
            vec3 beside = place;
            beside[(axis + 1) % 3] += texel * static_cast<float>(i % 3 - 1);
            beside[(axis + 2) % 3] += texel * static_cast<float>(i / 3 - 1);
            const int object = find_captured_object(mirror, normalize(beside), false, false);
            lights += object != kNoObject && emits_[static_cast<std::size_t>(object)];
        }
        found[pixel] = lights > 0 && lights < 9 ? 255 : 0;
    }
    return found;
}

} // namespace catoptric::study
