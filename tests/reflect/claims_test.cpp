// Tests of rays between mirrors: objects that hide the mirror to which a search would continue a
// ray, and answers from captures of other mirrors.
#include "core/mirror_id.hpp"
#include "support/paths.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kClaimsPictureSize{64, 64};
constexpr vec3 kClaimsBoardColour{0, 0, .25f};

/// Returns a scene of two mirror balls of radius .7 in a bright box and a board. The camera looks
/// at the ball with index `seen`. A board of half width `half` between the balls is further from
/// either ball than its radius.
scene::Scene make_two_ball_scene(std::size_t seen, const dvec3& board, double half, bool exact) {
    scene::Scene scene{.name = "two balls"};
    test::add_bright_box(scene, {-6, -3, -4}, {6, 3, 4});
    const std::array<dvec3, 2> places{{{-1.6, 0, 0}, {1.6, .2, .1}}};
    for (int i = 0; i < 2; ++i)
        test::add_ball(scene, "ball", test::add_halving_mirror(scene, i),
                       places[static_cast<std::size_t>(i)], .7, 5);
    for (scene::Object& object : scene.objects)
        if (!exact) object.sphere.reset();
    test::add_glowing_board(scene, kClaimsBoardColour, board, {0, 0, half}, {0, half, 0});
    const double side = seen == 0 ? 1 : -1;
    scene.cameras.push_back({.eye = places[seen] + dvec3(1.1 * side, .9, -1.3),
                             .target = places[seen] + dvec3(.3 * side, .1, -.2),
                             .vertical_fov_degrees = 30});
    return scene;
}

/// Wrong pixels of a search, by what the traced ray meets after one reflection: the board (`board`)
/// or the other ball (`ball`).
struct WrongPixelsByReflectedObject {
    test::PixelComparison board, ball;
};

WrongPixelsByReflectedObject count_wrong_pixels_by_reflected_object(
    const scene::Scene& scene, const session::TechniqueResult& truth, const std::string& search) {
    const measure::Picture picture = test::render_technique(
                                         scene, search + ":face=128,shadow=none,continue=8",
                                         kClaimsPictureSize)
                                         .hdr;
    const WrongPixelsByReflectedObject found{
        test::compare_pixels_of_mirrors(picture, truth,
                                        [](std::uint32_t hit, const vec3& colour) {
                                            return !measure::second_mirror(hit) && colour.x < .01f;
                                        }),
        test::compare_pixels_of_mirrors(picture, truth, [](std::uint32_t hit, const vec3&) {
            return bool(measure::second_mirror(hit));
        })};
    std::cout << "[ MEASURED ] " << search << ": board " << found.board << ", other ball "
              << found.ball << "\n";
    return found;
}

session::TechniqueResult ray_trace_scene_for_claims(const scene::Scene& scene, bool exact) {
    return test::render_technique(
        scene, std::string("raytrace:depth=9,shadow=none,sphere=") + (exact ? "exact" : "mesh"),
        kClaimsPictureSize);
}

TEST(Claims, BoardBetweenTwoMirrorsIsSeenInBoth) {
    for (const bool exact : {true, false})
        for (const std::size_t seen : {0u, 1u}) {
            const scene::Scene scene = make_two_ball_scene(seen, {.02, .1, .05}, .6, exact);
            const session::TechniqueResult truth = ray_trace_scene_for_claims(scene, exact);
            for (const std::string search : {"march", "pyramid", "layered"}) {
                const WrongPixelsByReflectedObject found = count_wrong_pixels_by_reflected_object(
                    scene, truth, search);
                EXPECT_GT(found.board.pixels, 100u);
                EXPECT_LE(found.board.share_of_off_mirror_pixels(), .25) << search << exact << seen;
            }
        }
}

TEST(Claims, BoardBesideOrBehindAMirrorHidesNothingOfIt) {
    for (const bool exact : {true, false})
        for (const dvec3& board : {dvec3(0, 1.1, 0), dvec3(-4, 0, 0), dvec3(4, 0, 0)}) {
            // Selects the ball that has the board behind the other ball, as seen from the camera.
            const std::size_t seen = board.x > 0 ? 0 : 1;
            const scene::Scene scene = make_two_ball_scene(seen, board, .35, exact);
            const session::TechniqueResult truth = ray_trace_scene_for_claims(scene, exact);
            for (const std::string search : {"march", "pyramid", "layered"}) {
                const WrongPixelsByReflectedObject found = count_wrong_pixels_by_reflected_object(
                    scene, truth, search);
                EXPECT_GT(found.ball.pixels, 80u);
                EXPECT_LE(found.ball.share_of_off_mirror_pixels(), .2)
                    << search << exact << board.x;
            }
        }
}

/// Returns three balls in a row, of which the camera sees the first. `near_first`: the nearer of
/// the other two balls has the lower number.
scene::Scene make_row_of_balls(bool near_first) {
    scene::Scene scene{.name = "row"};
    test::add_bright_box(scene, {-6, -3, -4}, {6, 3, 4});
    test::add_ball(scene, "seen", test::add_halving_mirror(scene, 0), {-1.6, 0, 0}, .9, 5);
    const dvec3 places[2]{{.5, .2, -.2}, {2.6, .4, -.3}};
    for (const int i : {near_first ? 0 : 1, near_first ? 1 : 0})
        test::add_ball(scene, "ball", test::add_halving_mirror(scene, i + 1), places[i],
                       i ? 1.1 : .6, 5);
    scene.cameras.push_back(
        {.eye = {-.6, .9, -1.6}, .target = {-1.3, .1, -.2}, .vertical_fov_degrees = 36});
    return scene;
}

TEST(Claims, NearerOfTwoMirrorsOnARayIsMet) {
    for (const bool near_first : {true, false}) {
        const scene::Scene scene = make_row_of_balls(near_first);
        const session::TechniqueResult truth = ray_trace_scene_for_claims(scene, true);
        for (const std::string search : {"secant", "pyramid"}) {
            const test::PixelComparison found =
                count_wrong_pixels_by_reflected_object(scene, truth, search).ball;
            EXPECT_GT(found.pixels, 100u);
            EXPECT_LE(found.share_of_off_mirror_pixels(), .15) << search << near_first;
        }
    }
}

/// Returns a scene of a ball beside two flat mirrors. The second layer of the ball's capture holds
/// the surfaces that the edges of the flat mirrors hide from the ball's centre.
scene::Scene make_flat_mirrors_beside_ball() {
    scene::Scene scene{.name = "beside"};
    test::add_bright_box(scene, {-4, -3, -5}, {4, 3, 4});
    test::add_ball(scene, "seen", test::add_halving_mirror(scene, 0), {0, 0, .5}, 1.2, 5);
    for (int i = 0; i < 2; ++i) {
        const double x = i ? 1.1 : -1.1, z = -1.7;
        test::add_quad(scene, "flat", test::add_halving_mirror(scene, i + 1), {x - .4, -1, z},
                       {x - .4, 1, z}, {x + .4, 1, z}, {x + .4, -1, z});
    }
    scene.cameras.push_back(
        {.eye = {0, .4, -3.5}, .target = {0, 0, .5}, .vertical_fov_degrees = 40});
    return scene;
}

TEST(Claims, SurfaceInTheSecondLayerBehindAMirrorIsNoMirror) {
    const scene::Scene scene = make_flat_mirrors_beside_ball();
    const session::TechniqueResult truth = ray_trace_scene_for_claims(scene, true);
    const measure::Picture picture = test::render_technique(
                                         scene, "layered:face=128,shadow=none,continue=8",
                                         kClaimsPictureSize)
                                         .hdr;
    const test::PixelComparison once = test::compare_pixels_of_mirrors(
        picture, truth, [](std::uint32_t hit, const vec3&) {
            return measure::first_mirror(hit) == MirrorId(1) && !measure::second_mirror(hit);
        });
    std::cout << "[ MEASURED ] no second mirror: " << once << "\n";
    EXPECT_GT(once.pixels, 1000u);
    EXPECT_LE(once.share_of_off_mirror_pixels(), .02);
}

/// Returns a scene of a flat mirror, a second mirror behind a board, and a ball aside. The first
/// mirror's centre does not see the second mirror, but the ball sees both. `from_aside`: the camera
/// sees the second mirror past the board.
scene::Scene make_screened_mirror_scene(bool exact, bool from_aside) {
    scene::Scene scene{.name = "screened"};
    test::add_bright_box(scene, {-4, -3, -5}, {4, 3, 4});
    std::array<std::size_t, 3> mirror{};
    for (int i = 0; i < 3; ++i)
        mirror[static_cast<std::size_t>(i)] = test::add_halving_mirror(scene, i);
    test::add_quad(scene, "panel", mirror[0], {-2, -1.5, 2}, {2, -1.5, 2}, {2, 1.5, 2},
                   {-2, 1.5, 2});
    test::add_glowing_board(scene, kClaimsBoardColour, {0, 0, 1}, {.5, 0, 0}, {0, .8, 0});
    test::add_ball(scene, "hidden", mirror[1], {0, 0, -.3}, .6, 5);
    if (!exact) scene.objects.back().sphere.reset();
    test::add_ball(scene, "aside", mirror[2], {2.5, .8, -.6}, .6, 5);
    scene.cameras.push_back({.eye = from_aside ? dvec3(-3, .3, -1) : dvec3(-1.5, 1, -3.2),
                             .target = from_aside ? dvec3(-1, 0, 2) : dvec3(0, 0, 2),
                             .vertical_fov_degrees = 50});
    return scene;
}

/// Numbers of pixels for which the mirror's own capture has no answer, but the capture of another
/// mirror has one. `off`: wrong pixels. `mirrors`: pixels whose ray meets a second mirror.
/// `mirrors_off`: wrong pixels among `mirrors`. `black`: pixels that became black, because the
/// other capture shows a mirror without history.
struct CaptureAnswerCounts {
    std::size_t all = 0, off = 0, mirrors = 0, mirrors_off = 0, black = 0;
};

CaptureAnswerCounts count_capture_answers(const scene::Scene& scene, const std::string& search,
                                          const std::string& hops) {
    const session::TechniqueResult truth = test::render_technique(
        scene, "raytrace:shadow=none,sphere=exact,depth=" + std::string(hops == "0" ? "1" : "9"),
        kClaimsPictureSize);
    const std::string technique = search + ":face=128,shadow=none,continue=" + hops + ",captures=";
    session::Request request = test::make_test_request(
        scene, {technique + "own", technique + "all"}, kClaimsPictureSize);
    request.with_lookup = true;
    const session::RunResult result = session::run(test::get_test_engine(), request);
    const auto is_unknown = [&](std::size_t part, std::size_t i) {
        return ((static_cast<int>(result.parts[part].lookup[i].w) - 1) & 3) == 1;
    };
    CaptureAnswerCounts found;
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        if (!measure::first_mirror(truth.hits[i])) continue;
        if (!is_unknown(0, i) || is_unknown(1, i)) continue;
        const vec3 own = result.parts[0].hdr.pixels[i], all = result.parts[1].hdr.pixels[i];
        const bool is_off = test::do_pixel_channels_differ(all, truth.hdr.pixels[i]),
                   meets = bool(measure::second_mirror(truth.hits[i]));
        ++found.all, found.off += is_off;
        found.mirrors += meets, found.mirrors_off += meets && is_off;
        found.black += all == vec3(0) && own != vec3(0);
    }
    std::cout << "[ MEASURED ] " << search << ", " << hops << " hops: answered " << found.all
              << ", off " << found.off << "; of " << found.mirrors << " that meet a mirror "
              << found.mirrors_off << "; black " << found.black << "\n";
    return found;
}

TEST(Claims, OtherCapturesAnswerRightAndNeverWithAMirror) {
    for (const auto& [exact, from_aside] :
         {std::pair(true, false), std::pair(false, false), std::pair(false, true)})
        for (const std::string hops : {"0", "8"})
            for (const std::string search : {"secant", "march", "pyramid", "layered"}) {
                const CaptureAnswerCounts found = count_capture_answers(
                    make_screened_mirror_scene(exact, from_aside), search, hops);
                EXPECT_GT(found.all, from_aside ? 100u : 200u) << search;
                EXPECT_LE(found.off, found.all / 10) << search;
                EXPECT_LE(found.mirrors_off, 2u) << search;
                EXPECT_LE(found.black, 2u) << search << " shows a mirror without history";
            }
}

} // namespace
