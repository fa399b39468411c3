#include "require/suggest.hpp"

#include "require/frustum.hpp"
#include "require/wall.hpp"
#include "scene/flat_mirror.hpp"
#include "scene/mirror_shape.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace catoptric::require {

namespace {

/// A mirror's vertices in the world.
struct Surface {
    std::vector<dvec3> places, normals;
    const std::vector<uvec3>& triangles;
    double extent = 0;
};

Surface surface_of(const scene::Scene& now, const scene::Object& object) {
    const scene::Mesh& mesh = now.meshes[object.mesh];
    Surface surface{.triangles = mesh.triangles};
    const dmat3 to_world = scene::normal_matrix(object.world_from_object);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        surface.places.push_back(
            scene::transform_point(object.world_from_object, mesh.positions[i]));
        surface.normals.push_back(scene::world_normal(to_world, dvec3(mesh.normals[i])));
    }
    const Bounds<double> box = scene::bounds(now, object);
    if (!box.empty()) surface.extent = length(box.extent());
    return surface;
}

dvec3 facet_of(const Surface& surface, const uvec3& t) {
    const dvec3& a = surface.places[t.x];
    const dvec3 facet = scene::normalized_or_zero(
        cross(surface.places[t.y] - a, surface.places[t.z] - a));
    return dot(facet, surface.normals[t.x]) < 0 ? -facet : facet;
}

/// Some of it lies in front of some of its triangles.
bool faces_itself(const Surface& surface) {
    if (surface.triangles.size() * surface.places.size() > kMostFacings) return true;
    const double least = kFacing * surface.extent;
    return std::ranges::any_of(surface.triangles, [&](const uvec3& t) {
        const dvec3 facet = facet_of(surface, t);
        return std::ranges::any_of(surface.places, [&](const dvec3& place) {
            return dot(place - surface.places[t.x], facet) > least;
        });
    });
}

/// Pixels that the mirror takes up at most: those of a ball around its bounds, on the axis.
double pixels_of(const Picture& picture, const Bounds<double>& box, uvec2 size) {
    const double all = double{static_cast<double>(size.x)} * size.y,
                 radius = length(box.extent()) / 2, distance = length(box.centre() - picture.eye());
    if (picture.is_parallel()) {
        const double across = radius / picture.pixel_angle(1);
        return std::min(all, std::numbers::pi * across * across);
    }
    if (distance <= radius) return all;
    const double cosine = std::sqrt(1 - radius * radius / (distance * distance)),
                 pixel = picture.pixel_angle(distance);
    return std::min(all, 2 * std::numbers::pi * (1 - cosine) / (pixel * pixel));
}

struct Choice {
    std::string technique, reason;
};

Choice by_shape(const Question& question, const scene::Object& object) {
    if (object.sphere) return {"secant", "it is an exact sphere"};
    const auto flat = scene::flat(question.now.meshes[object.mesh], object.world_from_object);
    if (flat && flat->off <= scene::flat_tolerance(question.camera, question.size))
        return {"planar", "it is flat within a sixteenth of a pixel"};
    const Surface surface = surface_of(question.now, object);
    using Kind = scene::Shape::Kind;
    const Kind kind = scene::shape_of(question.now, object).kind;
    if (kind == Kind::concave) return {"hybrid", "it is hollow and shows itself"};
    if (kind == Kind::other && faces_itself(surface))
        return {"hybrid", "parts of it face one another"};
    return {"hybrid", "it is neither flat nor a sphere"};
}

Choice choice_of(const Question& question, const Picture& picture, const scene::Object& object,
                 const MirrorNeeds& needs) {
    const std::string cheapest = "reuse:face=" + std::to_string(kSmallFace);
    if (needs.seen_in) return {cheapest, "only other mirrors have it in their view"};
    if (!needs.is_seen) return by_shape(question, object);
    const double pixels = pixels_of(picture, scene::bounds(question.now, object), question.size);
    if (pixels <= kFewPixels)
        return {cheapest, "it takes up " + std::to_string(std::lround(pixels)) + " pixels at most"};
    return by_shape(question, object);
}

/// "1,3=planar *=hybrid": what is not `rest` by its numbers.
std::string plan_of(const std::map<std::string, std::vector<std::size_t>>& mirrors,
                    const std::string& rest) {
    if (mirrors.empty()) return rest;
    if (mirrors.size() == 1) return mirrors.begin()->first;
    std::string plan;
    for (const auto& [technique, numbers] : mirrors) {
        if (technique == rest) continue;
        for (const std::size_t number : numbers)
            plan += (number == numbers.front() ? "" : ",") + std::to_string(number);
        plan += "=" + technique + " ";
    }
    if (mirrors.contains(rest)) return plan + "*=" + rest;
    plan.pop_back();
    return plan;
}

} // namespace

Suggestion suggest(const Question& question) {
    const Model model = required(question);
    const Picture picture(question.camera, question.size);
    Suggestion suggestion;
    std::map<std::string, std::vector<std::size_t>> of_technique;
    const std::vector<std::size_t> mirrors = scene::mirrors(question.now);
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        const auto [technique, reason] = choice_of(
            question, picture, question.now.objects[mirrors[i]], model.mirrors[i]);
        of_technique[technique].push_back(i + 1);
        suggestion.reasons.push_back(technique + ": " + reason);
    }
    suggestion.plan = plan_of(of_technique, "hybrid");
    return suggestion;
}

} // namespace catoptric::require
