#include "require/shadows.hpp"
#include "scene/light.hpp"

#include <algorithm>

namespace catoptric::require {

namespace {

constexpr double kUnlimitedShadow = std::numeric_limits<double>::infinity();

/// Returns how many times further from the light than the box a shaded point can be.
double max_shadow_stretch(const dvec3& light, const Bounds<double>& box,
                          const Bounds<double>& everything) {
    double times = kUnlimitedShadow;
    for (int axis = 0; axis < 3; ++axis) {
        // The ratio (wall - L) / (b - L) is largest for the point b of the box that is nearest to
        // the light L.
        const double above = box.lo[axis] - light[axis], below = light[axis] - box.hi[axis];
        if (above > 0) times = std::min(times, (everything.hi[axis] - light[axis]) / above);
        if (below > 0) times = std::min(times, (light[axis] - everything.lo[axis]) / below);
    }
    return std::max(times, 1.);
}

double max_shadow_distance(const dvec3& axis, const Bounds<double>& box,
                           const Bounds<double>& everything) {
    double times = kUnlimitedShadow;
    for (int i = 0; i < 3; ++i) {
        if (axis[i] > 0) times = std::min(times, (everything.hi[i] - box.lo[i]) / axis[i]);
        if (axis[i] < 0) times = std::min(times, (everything.lo[i] - box.hi[i]) / axis[i]);
    }
    return std::max(times, 0.);
}

double max_distance(const dvec3& place, const Bounds<double>& box) {
    return glm::length(glm::max(abs(box.lo - place), abs(box.hi - place)));
}

/// Returns the length of kShadowFilterTexels at the box, in world units.
double filter_length(const scene::PointLight& light, const Bounds<double>& box,
                     const Bounds<double>& everything, std::uint32_t edge) {
    // A cube face at depth d is 2 d wide. The window of a directional light's shadow map is at most
    // slightly wider than the whole scene (render::make_directional_views).
    const double span = light.directional ? 1.5 * glm::length(everything.extent())
                                          : 2 * max_distance(light.position, box);
    return kShadowFilterTexels * span / std::max(edge, 1u);
}

Bounds<double> expand(const Bounds<double>& box, double by) { return {box.lo - by, box.hi + by}; }

Bounds<double> intersect_boxes(const Bounds<double>& a, const Bounds<double>& b) {
    return {glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)};
}

} // namespace

ShadowedVolume shadowed_volume(const scene::PointLight& light, const Bounds<double>& caster,
                               const Bounds<double>& everything) {
    if (light.directional) {
        const double far = max_shadow_distance(light.axis, caster, everything);
        if (far == kUnlimitedShadow) return {everything, everything};
        return {caster, {caster.lo + far * light.axis, caster.hi + far * light.axis}};
    }
    const double times = max_shadow_stretch(light.position, caster, everything);
    if (times == kUnlimitedShadow) return {everything, everything};
    return {caster,
            {light.position + times * (caster.lo - light.position),
             light.position + times * (caster.hi - light.position)}};
}

void find_shadow_receivers(const VisibilityScene& world, std::uint32_t edge, bool is_soft,
                           std::vector<ShadowReceiver>& receivers) {
    receivers.clear();
    Bounds<double> everything;
    for (const VisibilityObject& thing : world.objects()) everything.add(thing.box);
    for (const std::size_t mover : world.movers()) {
        const VisibilityObject& caster = world.objects()[mover];
        if (!caster.casts_shadow || caster.box.empty()) continue;
        for (const scene::PointLight& light : world.lights()) {
            const auto [from, to] = is_soft && light.is_lamp
                                        ? ShadowedVolume{everything, everything}
                                        : shadowed_volume(light, caster.box, everything);
            Bounds<double> shade = from;
            shade.add(to);
            for (std::size_t i = 0; i < world.objects().size(); ++i) {
                const Bounds<double>& receiver = world.objects()[i].box;
                if (receiver.empty()) continue;
                const double room = filter_length(light, receiver, everything, edge);
                const Bounds<double> box = intersect_boxes(expand(shade, room), receiver);
                if (!box.empty())
                    receivers.push_back({mover, i, box, {expand(from, room), expand(to, room)}});
            }
        }
    }
}

} // namespace catoptric::require
