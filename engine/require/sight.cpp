#include "require/sight.hpp"

#include "scene/transform.hpp"

#include <algorithm>
#include <bit>

namespace catoptric::require {

namespace {

/// Returns the margin to the edges and planes of walls: four times World::rounding, in world units.
double margin_of(const World& world) { return 4 * world.rounding(); }

} // namespace

std::optional<Unseen> hidden_from_camera(const World& world, const PictureFrustum& picture,
                                         std::size_t mirror) {
    const std::size_t object = world.mirrors()[mirror];
    const WorldObject& thing = world.things()[object];
    if (thing.box.empty()) return Unseen{Unseen::Why::empty, 0};
    if (!thing.seen_by_camera) return Unseen{Unseen::Why::hidden_from_camera, 0};
    if (!picture.may_hold(thing.box)) return Unseen{Unseen::Why::outside, 0};
    const double margin = margin_of(world);
    for (const Wall& wall : world.walls()) {
        if (wall.object == object || !wall.seen_by_camera) continue;
        const bool is_hidden = picture.is_parallel()
                                   ? hides_along(wall, picture.eye(), picture.forward(), thing.box,
                                                 margin)
                                   : hides(wall, {picture.eye(), picture.eye()}, thing.box, margin);
        if (is_hidden) return Unseen{Unseen::Why::hidden, wall.object};
    }
    return std::nullopt;
}

bool is_tested(const scene::Mesh& mesh) { return mesh.triangles.size() <= kMostPairs; }

bool is_surface_in(const PictureFrustum& picture, const World& world, std::size_t mirror,
                   const scene::Scene& now) {
    const WorldObject& thing = world.things()[world.mirrors()[mirror]];
    const double margin = margin_of(world);
    if (thing.sphere)
        return picture.may_hold_ball(thing.sphere->centre, thing.sphere->radius + margin);
    const scene::Mesh& mesh = now.meshes[thing.mesh];
    return !is_tested(mesh) || std::ranges::any_of(mesh.triangles, [&](const uvec3& t) {
        const auto corner = [&](std::uint32_t i) {
            return scene::transform_point(thing.place, mesh.positions[i]);
        };
        return picture.may_hold_triangle({corner(t.x), corner(t.y), corner(t.z)}, margin);
    });
}

std::uint8_t Sight::look_at(const World& world, std::size_t viewer, std::size_t target) const {
    const std::size_t from = world.mirrors()[viewer], to = world.mirrors()[target];
    const Bounds<double>&here = world.things()[from].box, &there = world.things()[to].box;
    if (viewer == target || here.empty() || there.empty()) return 0;
    const dvec3 centre = world.things()[from].tight.centre();
    const double margin = margin_of(world);
    const auto [front, back] = places_[viewer].centre;
    const auto [far_front, far_back] = places_[target].box;
    std::uint8_t seen = kReaches | kShows;
    for (std::uint32_t between = (front & far_back) | (back & far_front & two_sided_); between != 0;
         between &= between - 1) {
        const Wall& wall = world.walls()[static_cast<std::size_t>(std::countr_zero(between))];
        if (wall.object == from || wall.object == to) continue;
        // If the wall does not hide the target from the centre, it cannot hide it from all points.
        if (!hides(wall, {centre, centre}, there, margin)) continue;
        seen &= static_cast<std::uint8_t>(~kShows);
        if (hides(wall, here, there, margin)) return 0;
    }
    return seen;
}

Sight::Sides Sight::sides_of(const World& world, const Bounds<double>& box) const {
    static_assert(kMostWalls <= 32);
    Sides sides;
    for (std::size_t i = 0; i < world.walls().size(); ++i) {
        const Wall& wall = world.walls()[i];
        const auto [low, high] = along(wall.normal, box);
        const double plane = dot(wall.normal, wall.corners[0]);
        if (low > plane) sides.front |= 1u << i;
        if (high < plane) sides.back |= 1u << i;
    }
    return sides;
}

Sight::MirrorSides Sight::place_of(const World& world, std::size_t mirror) const {
    const WorldObject& thing = world.things()[world.mirrors()[mirror]];
    if (thing.box.empty()) return {};
    const dvec3 centre = thing.tight.centre();
    return {sides_of(world, thing.box), sides_of(world, {centre, centre})};
}

void Sight::look(const World& world, std::size_t viewer) {
    std::vector<std::uint8_t>& row = rows_[viewer];
    row.resize(count_);
    for (std::size_t target = 0; target < count_; ++target)
        row[target] = look_at(world, viewer, target);
}

void Sight::follow(const World& world) {
    count_ = world.mirrors().size();
    if (layout_ != world.layouts()) {
        layout_ = world.layouts();
        rows_.assign(count_, {});
        changed_.assign(count_, true);
        places_.clear(), two_sided_ = 0;
        for (std::size_t i = 0; i < count_; ++i) places_.push_back(place_of(world, i));
        for (std::size_t i = 0; i < world.walls().size(); ++i)
            if (!world.walls()[i].front_only) two_sided_ |= 1u << i;
        return;
    }
    changed_.assign(count_, false);
    std::vector<std::size_t> moved;
    for (std::size_t i = 0; i < count_; ++i)
        if (world.things()[world.mirrors()[i]].has_moved) {
            moved.push_back(i);
            places_[i] = place_of(world, i);
        }
    const bool is_much = moved.size() * count_ > kMostPairs;
    for (std::size_t viewer = 0; viewer < count_ && !moved.empty(); ++viewer) {
        std::vector<std::uint8_t>& row = rows_[viewer];
        if (row.empty()) continue;
        const auto put = [&](std::size_t target, std::uint8_t seen) {
            changed_[viewer] = changed_[viewer] || row[target] != seen;
            row[target] = seen;
        };
        const auto answer = [&](std::size_t target) -> std::uint8_t {
            if (is_much) return viewer == target ? 0 : kReaches | kShows;
            return look_at(world, viewer, target);
        };
        if (world.things()[world.mirrors()[viewer]].has_moved)
            for (std::size_t target = 0; target < count_; ++target) put(target, answer(target));
        else
            for (const std::size_t target : moved) put(target, answer(target));
    }
}

bool Sight::reaches(const World& world, std::size_t viewer, std::size_t target) {
    if (rows_[viewer].empty()) look(world, viewer);
    return (rows_[viewer][target] & kReaches) != 0;
}

bool Sight::shows(const World& world, std::size_t viewer, std::size_t target) {
    if (rows_[viewer].empty()) look(world, viewer);
    return (rows_[viewer][target] & kShows) != 0;
}

} // namespace catoptric::require
