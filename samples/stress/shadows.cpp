// Properties of shadows on an open plane, whose edges are known, and of shadows of two lights.
#include "stress/double_tracer.hpp"
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catoptric::stress {

namespace {

const dvec3 kLampPosition(0, 4, 0); // position of the lamp of make_plane_with_lamp()

/// Board that stands on the plane between the lamp and the eye, so that its whole shadow is
/// visible.
struct Board {
    double half_width = 1.5, height = 2.5, z = -1.5;

    void add_to(scene::Scene& scene) const {
        add_quad(scene, 0, {-half_width, 0, z}, {half_width, 0, z}, {half_width, height, z},
                 {-half_width, height, z});
    }
    /// Returns whether the board lies between two points.
    bool hides(const dvec3& a, const dvec3& b) const {
        const double t = (z - a.z) / (b.z - a.z);
        if (!(t > 0 && t < 1)) return false;
        const dvec3 at = a + t * (b - a);
        return std::abs(at.x) <= half_width && at.y <= height && at.y >= 0;
    }
};

/// Point of the plane at a pixel's centre, and whether the board hides the lamp there.
struct ShadowSample {
    /// Whether the pixel shows the plane and is not near the board's outline.
    bool on_plane = false;
    dvec3 place{0};
    bool in_shadow = false;
};

std::vector<ShadowSample> shadow_samples(const scene::Camera& camera, uvec2 size,
                                         const Board& board) {
    constexpr double kPixelRoundingMargin = .02; // pixels
    std::vector<ShadowSample> spots;
    for (std::uint32_t y = 0; y < size.y; ++y)
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const auto place = [&](double dx, double dy) {
                const dvec3 d = ray_direction(camera, size, x + dx, y + dy);
                return camera.eye - camera.eye.y / d.y * d;
            };
            const dvec3 middle = place(0, 0);
            ShadowSample spot{middle.z > camera.eye.z &&
                                  std::max(std::abs(middle.x), std::abs(middle.z)) < 10,
                              middle, board.hides(middle, kLampPosition)};
            for (const double dx : {-kPixelRoundingMargin, kPixelRoundingMargin})
                for (const double dy : {-kPixelRoundingMargin, kPixelRoundingMargin})
                    if (board.hides(place(dx, dy), camera.eye)) spot.on_plane = false;
            spots.push_back(spot);
        }
    return spots;
}

/// Returns the distance from `place` to the shadow's edge in multiples of `unit`, rounded up to a
/// quarter, at most 64.
double shadow_edge_distance(const Board& board, const dvec3& place, double unit) {
    constexpr int kBoardAngleCount = 16;
    const bool in_shadow = board.hides(place, kLampPosition);
    for (int quarters = 1; quarters < 256; ++quarters)
        for (int i = 0; i < kBoardAngleCount; ++i) {
            const double angle = 2 * std::numbers::pi * i / kBoardAngleCount;
            const dvec3 beside = place +
                                 quarters / 4.0 * unit * dvec3(std::cos(angle), 0, std::sin(angle));
            if (board.hides(beside, kLampPosition) != in_shadow) return quarters / 4.0;
        }
    return 64;
}

/// Returns the largest length on the plane that a shadow map texel covers at a place. The map is a
/// cube around the lamp with faces of `edge` texels, in any rotation.
double map_texel_length(const dvec3& place, int edge) {
    const double distance = length(place - kLampPosition);
    return 2 * distance / edge * distance / kLampPosition.y;
}

struct ShadowedPicture {
    measure::Picture with, without;
};

/// Returns the distance to the shadow's edge of the farthest wrong pixel, in texels. A wrong pixel
/// is lit where it should be dark, or the reverse. A half-lit pixel counts as lit.
double farthest_wrong_pixel(const std::vector<ShadowSample>& spots, const ShadowedPicture& shown,
                            const Board& board, const std::function<double(const dvec3&)>& unit) {
    double most = 0;
    for (std::size_t i = 0; i < spots.size(); ++i) {
        const float full = shown.without.pixels[i].x;
        if (!spots[i].on_plane || !(full > 0)) continue;
        const bool dark = !(shown.with.pixels[i].x >= full / 2);
        if (dark == spots[i].in_shadow) continue;
        most = std::max(most, shadow_edge_distance(board, spots[i].place, unit(spots[i].place)));
    }
    return most;
}

ShadowedPicture render_shadow(Bench& bench, const scene::Scene& scene, const std::string& with,
                              const std::string& without) {
    const auto render = [&](const std::string& technique) {
        session::Request request = bench.make_request(scene, technique, 1);
        request.ambient = 0; // without ambient light, only the lamp lights the plane
        return bench.render_technique(request).hdr;
    };
    return {render(with), render(without)};
}

/// Returns the largest edge of a shadow map for which this device has memory.
int largest_map_edge(Bench& bench, const scene::Scene& scene) {
    int edge = 16384;
    while (edge > 1 && !bench.add_attempt(fmt::format("edge {} planned", edge), [&] {
        bench.plan_technique(
            bench.make_request(scene, fmt::format("reuse:shadow_map={}", edge), 1));
    }))
        edge /= 2;
    return edge;
}

/// Judges an open plane, which must not shadow itself.
void judge_self_shadow(Bench& bench, double factor, int edge) {
    const ShadowedPicture shown = render_shadow(
        bench, transform_scene(make_plane_with_lamp(), scale_matrix(factor)),
        fmt::format("reuse:shadow_map={}", edge), "reuse:shadow=none");
    std::size_t lit = 0, judged = 0;
    for (std::size_t i = 0; i < shown.with.pixels.size(); ++i) {
        if (!(shown.without.pixels[i].x > 0)) continue;
        ++judged;
        lit += shown.with.pixels[i].x >= .999f * shown.without.pixels[i].x;
    }
    bench.add_case(
        fmt::format("edge {}, times {}: less than a tenth of the picture is lit", edge, factor),
        judged * 10 < shown.with.pixels.size() ? 1 : 0, 0);
    bench.add_case(fmt::format("edge {}, times {}: plane in shadow of itself", edge, factor),
                   1 - double(lit) / double(judged), .005);
}

/// Returns a plane and a board above it, lit by a tilted lamp. The tilt makes the faces of the
/// shadow map slanted against the plane, so that shadow look-ups are lifted off the plane.
scene::Scene make_board_under_lamp(const Board& board) {
    constexpr double kShadowBoardTilt = .6, kHalfBoardWidth = .2;
    scene::Scene scene = make_plane_with_lamp();
    scene.objects.pop_back();
    const dvec3 along(kHalfBoardWidth, 0, 0),
        up = kHalfBoardWidth * dvec3(0, -std::sin(kShadowBoardTilt), std::cos(kShadowBoardTilt));
    add_quad(scene, 1, kLampPosition - along - up, kLampPosition + along - up,
             kLampPosition + along + up, kLampPosition - along + up);
    board.add_to(scene);
    return scene;
}

/// Judges the shadow of a board on the plane, which must begin at the board's foot and end at the
/// known edge. The tolerance is some texels for shadow maps and a thousandth of the board for rays.
void judge_board_shadow(Bench& bench, double factor, const std::vector<int>& edges) {
    const Board board;
    const scene::Scene scene = make_board_under_lamp(board);
    const std::vector<ShadowSample> spots = shadow_samples(scene.cameras.front(),
                                                           bench.picture_size(), board);
    const auto judged = std::ranges::count_if(
        spots, [](const ShadowSample& spot) { return spot.on_plane && spot.in_shadow; });
    bench.add_case("the board's shadow: less than a fiftieth of the picture",
                   judged * 50 < std::ssize(spots) ? 1 : 0, 0);
    const scene::Scene seen = transform_scene(scene, scale_matrix(factor));
    bench.add_case(
        fmt::format("raytrace, times {}: the shadow's edge is off by thousandths", factor),
        farthest_wrong_pixel(spots, render_shadow(bench, seen, "raytrace", "raytrace:shadow=none"),
                             board, [](const dvec3&) { return .001; }),
        1);
    for (const int edge : edges) {
        const ShadowedPicture shown = render_shadow(
            bench, seen, fmt::format("reuse:shadow_map={}", edge), "reuse:shadow=none");
        bench.add_case(
            fmt::format("edge {}, times {}: the shadow's edge is off by texels", edge, factor),
            farthest_wrong_pixel(spots, shown, board,
                                 [&](const dvec3& place) { return map_texel_length(place, edge); }),
            edge < 1024 ? 1.5 : .75);
    }
}

void judge_shadow_map(Bench& bench) {
    const int largest = largest_map_edge(bench, make_plane_with_lamp());
    for (const double factor : {1e-6, 1.0, 1e6}) {
        std::vector<int> edges{16, 1024};
        // The largest map takes .5 s of processor time each.
        if (factor == 1 || !bench.has_small_pictures()) edges.push_back(largest);
        judge_board_shadow(bench, factor, edges);
        edges.push_back(1);
        for (const int edge : edges) judge_self_shadow(bench, factor, edge);
    }
}

/// Returns a plane with a board and a ball, lit by either or both of two lamps of different colour.
scene::Scene make_lit_plane(bool first, bool second) {
    scene::Scene scene{.name = "two lights"};
    add_quad(scene, add_material(scene, {.name = "grey", .albedo = vec3(.7f)}), {-10, 0, -10},
             {-10, 0, 10}, {10, 0, 10}, {10, 0, -10});
    Board{.half_width = 1, .height = 1.5, .z = -1}.add_to(scene);
    add_ball(scene, add_material(scene, {.name = "mirror", .mirror = true}), {{1.9, .7, -2}, .7});
    const auto add_lamp = [&](double x, const vec3& emission) {
        add_quad(scene, add_material(scene, {.name = "lamp", .emission = emission}),
                 {x - .2, 4, .3}, {x + .2, 4, .3}, {x + .2, 4, .7}, {x - .2, 4, .7});
    };
    if (first) add_lamp(-2, {40, 10, 5});
    if (second) add_lamp(2.5, {5, 10, 40});
    scene.cameras.push_back({.eye = {0, 3, -9}, .target = {0, 0, -1}, .vertical_fov_degrees = 40});
    return scene;
}

/// Judges that light adds up: both lamps together give the sum of each alone. This covers the
/// plane, both shadows and their reflections in the ball.
void judge_two_lights(Bench& bench) {
    const auto render = [&](const scene::Scene& scene, const std::string& technique) {
        session::Request request = bench.make_request(scene, technique, 2);
        request.ambient = 0;
        return bench.render_technique(request);
    };
    for (const std::string technique : {"raytrace", "reuse", "parallax", "pyramid", "layered"}) {
        const session::TechniqueResult both = render(make_lit_plane(true, true), technique),
                                       first = render(make_lit_plane(true, false), technique),
                                       second = render(make_lit_plane(false, true), technique);
        double off = 0;
        std::size_t only_first = 0, only_second = 0;
        for (std::size_t i = 0; i < both.hdr.pixels.size(); ++i) {
            const dvec3 a(first.hdr.pixels[i]), b(second.hdr.pixels[i]);
            const dvec3 missing = abs(dvec3(both.hdr.pixels[i]) - (a + b));
            off = std::max({off, missing.x, missing.y, missing.z});
            only_first += a.x > 0 && b.x == 0, only_second += b.x > 0 && a.x == 0;
        }
        if (count_nonfinite(both.hdr) > 0) off = std::nan("");
        bench.add_case(technique + ": radiance off the sum of either light", off, .0005);
        const std::size_t enough = both.hdr.pixels.size() / 200;
        bench.add_case(technique + ": a light without a shadow of its own",
                       std::min(only_first, only_second) < enough ? 1 : 0, 0);
        if (technique == "reuse")
            bench.add_case("reuse: passes off N + 2 and one for the second light",
                           std::abs(both.scene_passes - 4), 0);
    }
}

const RegisteredProperty kShadowMapProperty{
    {"L2", "shadow map edge 1, 16, 1024, the largest up to 16384; scene times 1e-6, 1, 1e6",
     "no acne on an open plane; a board's shadow begins and ends where it must", judge_shadow_map,
     "shadow_lifted"}};
const RegisteredProperty kTwoLightsProperty{
    {"L3", "two lights, a board and a ball on an open plane",
     "both show what each shows alone, each with its shadow", judge_two_lights,
     "shadows_of_first_light"}};

} // namespace

} // namespace catoptric::stress
