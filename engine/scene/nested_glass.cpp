#include "scene/nested_glass.hpp"

#include "scene/material_facts.hpp"
#include "scene/topology.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace catoptric::scene {

namespace {

constexpr std::size_t kMaxTestedVertices = 16;

/// A solid body of glass: an object's number and the object's bounds in the world.
struct SolidGlass {
    std::size_t object = 0;
    Bounds<double> box;
};

std::vector<SolidGlass> solid_bodies(const Scene& scene) {
    std::vector<SolidGlass> bodies;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Material& material = scene.materials[scene.objects[i].material];
        if (!is_glass(material) || !material.solid) continue;
        const Bounds<double> box = bounds(scene, scene.objects[i]);
        if (!box.empty()) bodies.push_back({i, box});
    }
    std::ranges::sort(bodies, {}, [](const SolidGlass& body) { return body.box.lo.x; });
    return bodies;
}

bool overlap(const Bounds<double>& a, const Bounds<double>& b) {
    return all(lessThan(a.lo, b.hi)) && all(lessThan(b.lo, a.hi));
}

/// How much of a body's surface lies inside another body.
enum class Enclosed { not_at_all, partly, wholly };

/// Tests some vertices of the first body for lying inside the second. The winding number is +-1
/// inside, 0 outside, and +-1/2 on a face.
Enclosed test_enclosure(const Scene& scene, const SolidGlass& inner, const SolidGlass& outer) {
    constexpr double kMinInsideWinding = .75;
    const Object& inner_object = scene.objects[inner.object];
    const Object& outer_object = scene.objects[outer.object];
    const std::vector<dvec3>& positions = scene.meshes[inner_object.mesh].positions;
    const Mesh& mesh = scene.meshes[outer_object.mesh];
    const dmat4 to_outer = glm::inverse(outer_object.world_from_object) *
                           inner_object.world_from_object;
    const std::size_t count = std::min(positions.size(), kMaxTestedVertices);
    std::size_t inside = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const dvec3& vertex = positions[k * positions.size() / count];
        const dvec3 world(inner_object.world_from_object * dvec4(vertex, 1));
        if (!(all(lessThan(outer.box.lo, world)) && all(lessThan(world, outer.box.hi)))) continue;
        const dvec3 point(to_outer * dvec4(vertex, 1));
        const double winding = winding_number(mesh.positions, mesh.triangles, point);
        if (std::abs(winding) > kMinInsideWinding) ++inside;
    }
    return inside == 0       ? Enclosed::not_at_all
           : inside == count ? Enclosed::wholly
                             : Enclosed::partly;
}

/// A pair of bodies that share space. Where they do, the first is there and the second is not.
struct OverlappingPair {
    std::size_t first = 0, second = 0; ///< objects
};

/// Returns the pair in its order, if the two bodies share space.
std::optional<OverlappingPair> order_if_overlapping(const Scene& scene, const SolidGlass& a,
                                                    const SolidGlass& b) {
    const Enclosed of_a = test_enclosure(scene, a, b), of_b = test_enclosure(scene, b, a);
    if (of_a == Enclosed::not_at_all && of_b == Enclosed::not_at_all) return std::nullopt;
    const auto ior = [&](const SolidGlass& body) {
        return scene.materials[scene.objects[body.object].material].ior;
    };
    const bool is_a_first = of_a == Enclosed::wholly   ? of_b != Enclosed::wholly
                            : of_b == Enclosed::wholly ? false
                            : ior(a) != ior(b)         ? ior(a) > ior(b)
                                                       : a.object < b.object;
    return is_a_first ? OverlappingPair{a.object, b.object} : OverlappingPair{b.object, a.object};
}

std::vector<OverlappingPair> overlapping_pairs(const Scene& scene) {
    const std::vector<SolidGlass> bodies = solid_bodies(scene);
    std::map<std::size_t, bool> closed; // by mesh
    const auto is_closed = [&](const SolidGlass& body) {
        const std::size_t number = scene.objects[body.object].mesh;
        const auto [entry, is_new] = closed.try_emplace(number, false);
        const Mesh& mesh = scene.meshes[number];
        if (is_new) entry->second = is_closed_surface(mesh.positions, mesh.triangles);
        return entry->second;
    };
    std::vector<OverlappingPair> pairs;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t k = i + 1; k < bodies.size() && bodies[k].box.lo.x < bodies[i].box.hi.x;
             ++k) {
            const SolidGlass &a = bodies[i], &b = bodies[k];
            if (!overlap(a.box, b.box) || !is_closed(a) || !is_closed(b)) continue;
            if (const auto pair = order_if_overlapping(scene, a, b)) pairs.push_back(*pair);
        }
    return pairs;
}

} // namespace

std::vector<std::uint32_t> rank_nested_glass(const Scene& scene) {
    std::vector<std::uint32_t> ranks(scene.objects.size());
    const std::vector<OverlappingPair> pairs = overlapping_pairs(scene);
    for (const OverlappingPair& pair : pairs) ranks[pair.first] = ranks[pair.second] = 1;
    // The ranks of bodies that overlap in a ring rise without end; then some pairs stay unordered.
    bool has_changed = true;
    for (std::uint32_t turn = 0; has_changed && turn < kMaxGlassRank; ++turn) {
        has_changed = false;
        for (const OverlappingPair& pair : pairs) {
            const std::uint32_t least = std::min(ranks[pair.second] + 1, kMaxGlassRank);
            if (ranks[pair.first] >= least) continue;
            ranks[pair.first] = least;
            has_changed = true;
        }
    }
    return ranks;
}

} // namespace catoptric::scene
