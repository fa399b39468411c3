#include "stress/double_tracer.hpp"

#include <cmath>
#include <numbers>

namespace catoptric::stress {

namespace {

constexpr double kTracerRayOffset = 1e-9; // for scenes about 1 in size

} // namespace

dvec3 ray_direction(const scene::Camera& camera, uvec2 size, double x, double y) {
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    const dvec3 right = glm::normalize(glm::cross(forward, camera.up)),
                up = glm::cross(right, forward);
    const double tangent = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    const double u = ((x + .5) / size.x * 2 - 1) * tangent * size.x / size.y,
                 v = (1 - (y + .5) / size.y * 2) * tangent;
    return glm::normalize(forward + u * right + v * up);
}

DoubleTracer::DoubleTracer(const scene::Scene& scene, double ambient)
    : scene_(scene), ambient_(ambient) {
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        const scene::Mesh& mesh = scene.meshes[object.mesh];
        if (object.sphere) continue;
        const auto corner = [&](std::uint32_t v) {
            return dvec3(object.world_from_object * dvec4(mesh.positions[v], 1));
        };
        for (const uvec3& t : mesh.triangles)
            triangles_.push_back({corner(t.x), corner(t.y), corner(t.z), i});
        if (scene.materials[object.material].emission != vec3(0)) add_lamp(object, mesh);
    }
}

dvec3 DoubleTracer::trace_pixel(const scene::Camera& camera, uvec2 size, std::uint32_t x,
                                std::uint32_t y, int depth) const {
    return radiance(camera.eye, ray_direction(camera, size, x, y), depth);
}

/// Adds one flat lamp: mean of its corners, normal, and area.
void DoubleTracer::add_lamp(const scene::Object& object, const scene::Mesh& mesh) {
    Lamp lamp{dvec3(0), dvec3(0), dvec3(0)};
    std::vector<dvec3> corners;
    for (const dvec3& p : mesh.positions)
        corners.emplace_back(object.world_from_object * dvec4(p, 1));
    for (const dvec3& p : corners) lamp.position += p / static_cast<double>(corners.size());
    double area = 0;
    for (const uvec3& t : mesh.triangles) {
        const dvec3 twice = glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]);
        area += glm::length(twice) / 2;
        lamp.normal = glm::normalize(twice);
    }
    lamp.power = dvec3(scene_.materials[object.material].emission) * area;
    lamps_.push_back(lamp);
}

DoubleTracer::Hit DoubleTracer::find_closest_hit(dvec3 origin, dvec3 direction, double most,
                                                 bool for_shadow) const {
    Hit hit;
    hit.t = most;
    for (const Triangle& triangle : triangles_) {
        if (for_shadow && material_of_object(triangle.object).emission != vec3(0)) continue;
        const dvec3 ab = triangle.b - triangle.a, ac = triangle.c - triangle.a,
                    p = glm::cross(direction, ac);
        const double det = glm::dot(ab, p);
        if (det == 0) continue;
        const dvec3 s = origin - triangle.a, q = glm::cross(s, ab);
        const double u = glm::dot(s, p) / det, v = glm::dot(direction, q) / det,
                     t = glm::dot(ac, q) / det;
        if (u < 0 || v < 0 || u + v > 1 || t <= kTracerRayOffset || t >= hit.t) continue;
        hit = {t, glm::normalize(glm::cross(ab, ac)), triangle.object};
    }
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
        const auto& sphere = scene_.objects[i].sphere;
        if (!sphere) continue;
        const dvec3 f = origin - sphere->centre;
        const double b = glm::dot(f, direction),
                     c = glm::dot(f, f) - sphere->radius * sphere->radius, d = b * b - c;
        if (d < 0) continue;
        for (const double t : {-b - std::sqrt(d), -b + std::sqrt(d)})
            if (t > kTracerRayOffset && t < hit.t)
                hit = {t, (f + t * direction) / sphere->radius, i};
    }
    return hit;
}

dvec3 DoubleTracer::radiance(dvec3 origin, dvec3 direction, int depth) const {
    dvec3 weight(1);
    for (int bounce = 0;; ++bounce) {
        const double infinity = std::numeric_limits<double>::infinity();
        const Hit hit = find_closest_hit(origin, direction, infinity, false);
        if (hit.t == infinity) return dvec3(0);
        const dvec3 x = origin + hit.t * direction;
        const scene::Material& surface = material_of_object(hit.object);
        if (!surface.mirror) return weight * shade_hit(surface, x, hit.normal);
        if (bounce == depth) return dvec3(0);
        weight *= dvec3(surface.reflectance);
        origin = x;
        direction -= 2 * glm::dot(direction, hit.normal) * hit.normal;
    }
}

dvec3 DoubleTracer::shade_hit(const scene::Material& surface, dvec3 x, dvec3 normal) const {
    const dvec3 kd(surface.albedo);
    dvec3 result = dvec3(surface.emission) + kd * ambient_;
    for (const Lamp& lamp : lamps_) {
        const double t = glm::length(lamp.position - x);
        const dvec3 w = (lamp.position - x) / t;
        const double at_lamp = -glm::dot(w, lamp.normal), at_surface = glm::dot(normal, w);
        if (at_lamp <= 0 || at_surface <= 0 ||
            find_closest_hit(x, w, t - kTracerRayOffset, true).t < t - kTracerRayOffset)
            continue;
        result += kd / std::numbers::pi * lamp.power * (at_lamp / (t * t) * at_surface);
    }
    return result;
}

} // namespace catoptric::stress
