#include "require/stamps.hpp"

#include "core/stamp.hpp"
#include "require/frustum.hpp"
#include "require/sight.hpp"

#include <algorithm>

namespace catoptric::require {

namespace {

double distance(const dvec3& place, const Bounds<double>& box) {
    return length(glm::max(dvec3(0), glm::max(box.lo - place, place - box.hi)));
}

/// At least the distance from the place to the nearest triangle of what stands still: a wall's, or
/// that to the far corner of the nearest side of a box, each of which some triangle touches.
double gap_at_most(const World& world, const dvec3& place, std::size_t but, bool casters) {
    double gap = std::numeric_limits<double>::infinity();
    const auto counts = [&](std::size_t object) {
        const Thing& thing = world.things()[object];
        return !thing.is_mover && object != but && (!casters || thing.casts_shadow) &&
               !thing.tight.empty();
    };
    for (const Wall& wall : world.walls())
        if (counts(wall.object)) gap = std::min(gap, distance(wall, place));
    for (std::size_t i = 0; i < world.things().size(); ++i) {
        if (!counts(i)) continue;
        const Bounds<double>& box = world.things()[i].tight;
        const dvec3 far = glm::max(abs(box.lo - place), abs(box.hi - place));
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 corner = far;
            corner[axis] = std::min(std::abs(box.lo[axis] - place[axis]),
                                    std::abs(box.hi[axis] - place[axis]));
            gap = std::min(gap, length(corner));
        }
    }
    return gap + world.rounding();
}

Bounds<double> seen_from(const dvec3& centre, const Bounds<double>& box) {
    return {box.lo - centre, box.hi - centre};
}

/// Whether the sun's windows, which end where everything does, may depend on where the thing is.
bool may_bound(const World& world, const Thing& thing) {
    const Bounds<double>& still = world.still();
    return !(all(lessThan(still.lo, thing.box.lo)) && all(lessThan(thing.box.hi, still.hi)));
}

bool may_be_small(const World& world, const Thing& thing) {
    Bounds<double> around = world.still();
    around.add(thing.box);
    const auto largest = [](const dvec3& v) { return std::max({v.x, v.y, v.z}); };
    return largest(thing.tight.extent()) < kSmall * largest(around.extent());
}

} // namespace

/// Movers that may be next to a light, bound the sun's windows or have a space of their own.
void Stamps::find_everywhere(const World& world) {
    const std::vector<scene::PointLight>& lights = world.lights();
    light_gaps_.clear();
    for (const scene::PointLight& light : lights)
        light_gaps_.push_back(
            light.directional ? -1
                              : gap_at_most(world, light.position, world.things().size(), true));
    const bool has_sun = std::ranges::any_of(lights, &scene::PointLight::directional);
    everywhere_.assign(world.things().size(), false);
    for (const std::size_t mover : world.movers()) {
        const Thing& thing = world.things()[mover];
        bool is_everywhere = may_be_small(world, thing) || (has_sun && may_bound(world, thing));
        for (std::size_t i = 0; i < lights.size() && thing.casts_shadow; ++i)
            is_everywhere = is_everywhere ||
                            distance(lights[i].position, thing.box) <= light_gaps_[i];
        everywhere_[mover] = is_everywhere;
    }
}

void Stamps::follow(const World& world, std::uint32_t shadow_edge) {
    const bool is_anew = layout_ != world.layouts();
    if (!world.has_changed() && !is_anew && shadow_edge_ == shadow_edge) return;
    if (is_anew) mirrors_.assign(world.mirrors().size(), {});
    ++changes_;
    layout_ = world.layouts(), epoch_ = world.epoch(), shadow_edge_ = shadow_edge;
    Stamp all(epoch_);
    for (const std::size_t mover : world.movers()) all.add(world.things()[mover].stamp);
    all_ = all.value();
    find_everywhere(world);
    const std::size_t movers = world.movers().size(), mirrors = world.mirrors().size();
    is_much_ = movers * world.lights().size() * world.things().size() > kMostPairs ||
               movers * mirrors > kMostPairs;
    landings_.clear();
    if (is_much_) return;
    find_landings(world, shadow_edge, landings_);
    is_much_ = landings_.size() * mirrors > kMostLandings;
}

Faces Stamps::look(const World& world, const Faces6& faces, std::size_t mover) const {
    const Thing& thing = world.things()[mover];
    if (thing.box.empty()) return 0;
    if (everywhere_[mover] || distance(faces.centre, thing.box) <= faces.gap) return kAllFaces;
    return faces_with(seen_from(faces.centre, thing.box));
}

const std::array<std::uint64_t, 6>& Stamps::of_faces(const World& world, std::size_t mirror) {
    Faces6& faces = mirrors_[mirror];
    const std::size_t object = world.mirrors()[mirror];
    const Thing& own = world.things()[object];
    if (faces.made_at == changes_) return faces.stamps;
    faces.made_at = changes_;
    if (is_much_ || own.has_moved || own.box.empty())
        faces.stamps.fill(Stamp(all_).add(mirror).value());
    else
        add_up(world, faces, mirror);
    return faces.stamps;
}

void Stamps::add_up(const World& world, Faces6& faces, std::size_t mirror) const {
    const std::size_t object = world.mirrors()[mirror];
    const Thing& own = world.things()[object];
    if (faces.layout != layout_ || faces.centre != own.tight.centre()) {
        faces.layout = layout_, faces.centre = own.tight.centre();
        faces.gap = gap_at_most(world, faces.centre, object, false);
    }
    // Sums, since the order in which movers are looked at says nothing.
    std::array<std::uint64_t, 6> sums{};
    const auto add = [&](Faces which, std::uint64_t stamp) {
        for (std::size_t face = 0; face < 6; ++face)
            if ((which >> face & 1) != 0) sums[face] += stamp;
    };
    for (const std::size_t mover : world.movers())
        if (mover != object) add(look(world, faces, mover), world.things()[mover].stamp);
    for (const Landing& landing : landings_) {
        if (landing.receiver == object) continue;
        const std::uint64_t stamp =
            Stamp(world.things()[landing.caster].stamp).add(landing.receiver).value();
        const auto& [box, shade] = std::tie(landing.box, landing.shade);
        add(faces_with(seen_from(faces.centre, box)) &
                faces_with(seen_from(faces.centre, shade.from), seen_from(faces.centre, shade.to)),
            stamp);
    }
    for (std::size_t face = 0; face < 6; ++face)
        faces.stamps[face] =
            Stamp(epoch_).add(own.stamp).add(mirror).add(face).add(sums[face]).value();
}

std::uint64_t Stamps::of_light(const World& world, std::size_t light) const {
    Stamp stamp(epoch_);
    stamp.add(light);
    for (const std::size_t mover : world.movers()) {
        const Thing& thing = world.things()[mover];
        if (thing.casts_shadow || (world.lights()[light].directional && may_bound(world, thing)))
            stamp.add(thing.stamp);
    }
    return stamp.value();
}

} // namespace catoptric::require
