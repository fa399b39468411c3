#include "require/shadows.hpp"
#include "scene/light.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::require {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Returns how many times further from the light than the box a shaded point can be.
double farthest_from_point(const dvec3& light, const Bounds<double>& box,
                           const Bounds<double>& everything) {
    double times = kNever;
    for (int axis = 0; axis < 3; ++axis) {
        // (wall - L) / (b - L) is largest for the b nearest to the light.
        const double above = box.lo[axis] - light[axis], below = light[axis] - box.hi[axis];
        if (above > 0) times = std::min(times, (everything.hi[axis] - light[axis]) / above);
        if (below > 0) times = std::min(times, (light[axis] - everything.lo[axis]) / below);
    }
    return std::max(times, 1.);
}

double farthest_along(const dvec3& axis, const Bounds<double>& box,
                      const Bounds<double>& everything) {
    double times = kNever;
    for (int i = 0; i < 3; ++i) {
        if (axis[i] > 0) times = std::min(times, (everything.hi[i] - box.lo[i]) / axis[i]);
        if (axis[i] < 0) times = std::min(times, (everything.lo[i] - box.hi[i]) / axis[i]);
    }
    return std::max(times, 0.);
}

/// Returns the largest distance from a point to the points of a box.
double reach(const dvec3& place, const Bounds<double>& box) {
    return glm::length(glm::max(abs(box.lo - place), abs(box.hi - place)));
}

/// Returns the length of kShadowTexels at the box, in world units.
double texels_at(const scene::PointLight& light, const Bounds<double>& box,
                 const Bounds<double>& everything, std::uint32_t edge) {
    // A face at depth d is 2 d wide. The windows of a directional light are at most slightly wider
    // than everything (render::sun_views).
    const double span = light.directional ? 1.5 * glm::length(everything.extent())
                                          : 2 * reach(light.position, box);
    return kShadowTexels * span / std::max(edge, 1u);
}

Bounds<double> grown(const Bounds<double>& box, double by) { return {box.lo - by, box.hi + by}; }

Bounds<double> common(const Bounds<double>& a, const Bounds<double>& b) {
    return {glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)};
}

} // namespace

Shade shade_of(const scene::PointLight& light, const Bounds<double>& caster,
               const Bounds<double>& everything) {
    if (light.directional) {
        const double far = farthest_along(light.axis, caster, everything);
        if (far == kNever) return {everything, everything};
        return {caster, {caster.lo + far * light.axis, caster.hi + far * light.axis}};
    }
    const double times = farthest_from_point(light.position, caster, everything);
    if (times == kNever) return {everything, everything};
    return {caster,
            {light.position + times * (caster.lo - light.position),
             light.position + times * (caster.hi - light.position)}};
}

void find_landings(const World& world, std::uint32_t edge, std::vector<Landing>& landings) {
    landings.clear();
    Bounds<double> everything;
    for (const WorldObject& thing : world.things()) everything.add(thing.box);
    for (const std::size_t mover : world.movers()) {
        const WorldObject& caster = world.things()[mover];
        if (!caster.casts_shadow || caster.box.empty()) continue;
        for (const scene::PointLight& light : world.lights()) {
            const auto [from, to] = shade_of(light, caster.box, everything);
            Bounds<double> shade = from;
            shade.add(to);
            for (std::size_t i = 0; i < world.things().size(); ++i) {
                const Bounds<double>& receiver = world.things()[i].box;
                if (receiver.empty()) continue;
                const double room = texels_at(light, receiver, everything, edge);
                const Bounds<double> box = common(grown(shade, room), receiver);
                if (!box.empty())
                    landings.push_back({mover, i, box, {grown(from, room), grown(to, room)}});
            }
        }
    }
}

} // namespace catoptric::require
