#include "require/sight.hpp"

#include "scene/transform.hpp"

#include <algorithm>
#include <bit>

namespace catoptric::require {

namespace {

/// Returns the margin to the edges and planes of walls: four times VisibilityScene::rounding_error,
/// in world units.
double wall_margin(const VisibilityScene& world) { return 4 * world.rounding_error(); }

} // namespace

std::optional<UnseenReason> find_unseen_reason(const VisibilityScene& world,
                                               const PictureFrustum& picture, std::size_t mirror) {
    const std::size_t object = world.mirrors()[mirror];
    const VisibilityObject& thing = world.objects()[object];
    if (thing.box.empty()) return UnseenReason{UnseenReason::Cause::empty, 0};
    if (!thing.seen_by_camera) return UnseenReason{UnseenReason::Cause::hidden_from_camera, 0};
    if (!picture.may_contain_box(thing.box)) return UnseenReason{UnseenReason::Cause::outside, 0};
    const double margin = wall_margin(world);
    for (const Wall& wall : world.walls()) {
        if (wall.object == object || !wall.seen_by_camera) continue;
        const bool is_hidden = picture.is_orthographic()
                                   ? hides_from_orthographic(wall, picture.eye(), picture.forward(),
                                                             thing.box, margin)
                                   : hides(wall, {picture.eye(), picture.eye()}, thing.box, margin);
        if (is_hidden) return UnseenReason{UnseenReason::Cause::hidden, wall.object};
    }
    return std::nullopt;
}

bool has_few_triangles(const scene::Mesh& mesh) {
    return mesh.triangles.size() <= kMaxVisibilityPairs;
}

bool may_picture_show(const PictureFrustum& picture, const VisibilityScene& world,
                      std::size_t mirror, const scene::Scene& now) {
    const VisibilityObject& thing = world.objects()[world.mirrors()[mirror]];
    const double margin = wall_margin(world);
    if (thing.sphere)
        return picture.may_contain_ball(thing.sphere->centre, thing.sphere->radius + margin);
    const scene::Mesh& mesh = now.meshes[thing.mesh];
    return !has_few_triangles(mesh) || std::ranges::any_of(mesh.triangles, [&](const uvec3& t) {
        const auto corner = [&](std::uint32_t i) {
            return scene::transform_point(thing.place, mesh.positions[i]);
        };
        return picture.may_contain_triangle({corner(t.x), corner(t.y), corner(t.z)}, margin);
    });
}

std::uint8_t MirrorVisibility::classify_visibility(const VisibilityScene& world, std::size_t viewer,
                                                   std::size_t target) const {
    const std::size_t from = world.mirrors()[viewer], to = world.mirrors()[target];
    const Bounds<double>&here = world.objects()[from].box, &there = world.objects()[to].box;
    if (viewer == target || here.empty() || there.empty()) return 0;
    const dvec3 centre = world.objects()[from].tight.centre();
    const double margin = wall_margin(world);
    const auto [front, back] = places_[viewer].centre;
    const auto [far_front, far_back] = places_[target].box;
    std::uint8_t seen = kReachesFlag | kShowsFlag;
    for (std::uint32_t between = (front & far_back) | (back & far_front & two_sided_); between != 0;
         between &= between - 1) {
        const Wall& wall = world.walls()[static_cast<std::size_t>(std::countr_zero(between))];
        if (wall.object == from || wall.object == to) continue;
        // If the wall does not hide the target from the centre, it cannot hide it from all points.
        if (!hides(wall, {centre, centre}, there, margin)) continue;
        seen &= static_cast<std::uint8_t>(~kShowsFlag);
        if (hides(wall, here, there, margin)) return 0;
    }
    return seen;
}

MirrorVisibility::WallSides MirrorVisibility::wall_sides(const VisibilityScene& world,
                                                         const Bounds<double>& box) const {
    static_assert(kMaxWalls <= 32);
    WallSides sides;
    for (std::size_t i = 0; i < world.walls().size(); ++i) {
        const Wall& wall = world.walls()[i];
        const auto [low, high] = project_box(wall.normal, box);
        const double plane = dot(wall.normal, wall.corners[0]);
        if (low > plane) sides.front |= 1u << i;
        if (high < plane) sides.back |= 1u << i;
    }
    return sides;
}

MirrorVisibility::FacingSides MirrorVisibility::facing_sides(const VisibilityScene& world,
                                                             std::size_t mirror) const {
    const VisibilityObject& thing = world.objects()[world.mirrors()[mirror]];
    if (thing.box.empty()) return {};
    const dvec3 centre = thing.tight.centre();
    return {wall_sides(world, thing.box), wall_sides(world, {centre, centre})};
}

void MirrorVisibility::update_row(const VisibilityScene& world, std::size_t viewer) {
    std::vector<std::uint8_t>& row = rows_[viewer];
    row.resize(count_);
    for (std::size_t target = 0; target < count_; ++target)
        row[target] = classify_visibility(world, viewer, target);
}

void MirrorVisibility::update(const VisibilityScene& world) {
    count_ = world.mirrors().size();
    if (layout_ != world.layout_version()) {
        layout_ = world.layout_version();
        rows_.assign(count_, {});
        changed_.assign(count_, true);
        places_.clear(), two_sided_ = 0;
        for (std::size_t i = 0; i < count_; ++i) places_.push_back(facing_sides(world, i));
        for (std::size_t i = 0; i < world.walls().size(); ++i)
            if (!world.walls()[i].front_only) two_sided_ |= 1u << i;
        return;
    }
    changed_.assign(count_, false);
    std::vector<std::size_t> moved;
    for (std::size_t i = 0; i < count_; ++i)
        if (world.objects()[world.mirrors()[i]].has_moved) {
            moved.push_back(i);
            places_[i] = facing_sides(world, i);
        }
    const bool is_much = moved.size() * count_ > kMaxVisibilityPairs;
    for (std::size_t viewer = 0; viewer < count_ && !moved.empty(); ++viewer) {
        std::vector<std::uint8_t>& row = rows_[viewer];
        if (row.empty()) continue;
        const auto put = [&](std::size_t target, std::uint8_t seen) {
            changed_[viewer] = changed_[viewer] || row[target] != seen;
            row[target] = seen;
        };
        const auto answer = [&](std::size_t target) -> std::uint8_t {
            if (is_much) return viewer == target ? 0 : kReachesFlag | kShowsFlag;
            return classify_visibility(world, viewer, target);
        };
        if (world.objects()[world.mirrors()[viewer]].has_moved)
            for (std::size_t target = 0; target < count_; ++target) put(target, answer(target));
        else
            for (const std::size_t target : moved) put(target, answer(target));
    }
}

bool MirrorVisibility::may_reach(const VisibilityScene& world, std::size_t viewer,
                                 std::size_t target) {
    if (rows_[viewer].empty()) update_row(world, viewer);
    return (rows_[viewer][target] & kReachesFlag) != 0;
}

bool MirrorVisibility::may_show(const VisibilityScene& world, std::size_t viewer,
                                std::size_t target) {
    if (rows_[viewer].empty()) update_row(world, viewer);
    return (rows_[viewer][target] & kShowsFlag) != 0;
}

} // namespace catoptric::require
