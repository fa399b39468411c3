// Tests of mirrors seen in mirrors of any shape, and of searches that read the captures of several
// mirrors.
#include "compare.hpp"
#include "scene/built_in.hpp"
#include "scene/shapes.hpp"
#include "support/numbers.hpp"
#include "support/searches.hpp"

namespace {

using namespace catoptric;

constexpr uvec2 kContinuePictureSize{192, 144};
constexpr int kContinueWarmupFrames = 4;

/// Linear rmse against ray tracing: over all mirror pixels, first-order pixels, and pixels whose
/// reflected ray meets a second mirror.
struct ColourError {
    double all = 0, first_order = 0, mirror_in_mirror = 0;
};

ColourError measure_continued_search_error(const scene::Scene& scene,
                                           const std::string& technique) {
    static std::map<std::string, session::TechniqueResult> truths; // cached by the scene's name
    if (!truths.contains(scene.name))
        truths.emplace(scene.name,
                       test::render_technique(scene, study::kReference, kContinuePictureSize));
    const session::TechniqueResult& truth = truths.at(scene.name);
    const measure::Picture picture =
        test::render_last_frame(test::make_test_request(scene, {technique}, kContinuePictureSize),
                                kContinueWarmupFrames)
            .front()
            .hdr;
    const auto of = [&](const measure::Mask& mask) {
        return test::rmse_of_pictures(picture, truth.hdr, mask);
    };
    const ColourError error{of(measure::mask_mirrors(truth.hits)),
                            of(measure::mask_first_order(truth.hits)),
                            of(measure::mask_mirror_in_mirror(truth.hits))};
    std::cout << "[ MEASURED ] " << scene.name << ", " << technique << ": rmse " << error.all
              << ", first order " << error.first_order << ", mirror in mirror "
              << error.mirror_in_mirror << "\n";
    return error;
}

// In this scene of a ball, a block and a flat mirror, searches also follow rays through mirrors
// that are no exact spheres: the block and the flat mirror. For such mirrors a search uses the
// surfaces in their captures.
TEST(Continue, MirrorsInMirrorsOfAnyShapeAreFollowed) {
    for (const std::string search : {"secant", "march", "pyramid", "layered", "hybrid"}) {
        const ColourError without = measure_continued_search_error(test::make_mirror_hall(),
                                                                   search + ":continue=0"),
                          with = measure_continued_search_error(test::make_mirror_hall(), search);
        EXPECT_LE(with.mirror_in_mirror, .25 * without.mirror_in_mirror) << search;
        // One pixel at the lamp's edge holds nearly all of the first-order error, so this
        // comparison uses a lookup that mixes texels.
        EXPECT_LE(
            measure_continued_search_error(test::make_mirror_hall(), search + ":lookup=bilinear")
                .first_order,
            1.05 * measure_continued_search_error(test::make_mirror_hall(),
                                                  search + ":continue=0,lookup=bilinear")
                       .first_order)
            << search;
        // `march` may step over the edge of a mirror and continue in the wrong mirror, in about
        // twenty pixels.
        const double most = search == "march" ? 1.5 : test::computes_like_cpp() ? 1.05 : 1.1;
        EXPECT_LE(with.first_order, most * without.first_order) << search;
    }
}

// Each mirror reflects half of the light. The colour of a pixel therefore tells how many mirrors
// its ray met.
TEST(Continue, EachMirrorOnTheWayHalvesTheLight) {
    scene::Scene furnace = test::make_furnace_scene(0);
    const std::size_t half = test::add_material(
        furnace, {.name = "half", .mirror = true, .reflectance = {.5f, .5f, .5f}});
    test::add_quad(furnace, "left", half, {-3, -2, 0}, {-3, -2, 4}, {-3, 2, 4}, {-3, 2, 0});
    test::add_quad(furnace, "right", half, {3, -2, 0}, {3, 2, 0}, {3, 2, 4}, {3, -2, 4});
    for (const std::string search : {"march", "pyramid", "layered"}) {
        const measure::Picture picture = test::render_technique(furnace,
                                                                search + ":face=64,continue=8",
                                                                kContinuePictureSize)
                                             .hdr; // one frame, so no history contributes
        std::array<std::size_t, 4> met{};
        for (const vec3& pixel : picture.pixels)
            for (std::size_t k = 0; k < met.size(); ++k)
                met[k] += std::abs(pixel.x - std::exp2(-float(k)) * test::kFurnaceWallRadiance.x) <
                          1e-3f;
        EXPECT_GT(met[1], 200u) << search;
        EXPECT_GT(met[2], 20u) << search << ": both mirrors";
    }
}

TEST(Captures, OtherMirrorsCapturesAnswerUnknownPixels) {
    for (const std::string search : {"pyramid:face=128", "march:face=128", "secant:face=128"}) {
        const auto judged = test::measure_search_errors(scene::make_cornell(),
                                                        test::list_search_test_views().front(),
                                                        {search, search + ",captures=all"});
        const measure::LookupSummary &own = judged[0].lookup, &all = judged[1].lookup;
        EXPECT_LE(all.unknown, .75 * own.unknown) << search;
        EXPECT_LE(all.wrong_object, own.wrong_object)
            << search << ": an answer from elsewhere is no guess";
    }
}

// Tests that a pixel which no capture can answer keeps its colour with `captures=all`. Two screens,
// as many as two layers hold, are in front of the middle of a flat mirror. Rays from the mirror's
// edges end behind the screens. A ball far away has a capture too, but two boxes enclose the ball.
// The inner box is as far from the ball as the second screen is from the mirror.
TEST(Captures, CapturesWithoutAnAnswerChangeNoPixel) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true}),
                      grey = test::add_material(scene, {.name = "grey"}),
                      red = test::add_material(scene, {.name = "red", .albedo = {.8f, .1f, .1f}});
    test::add_quad(scene, "panel", mirror, {-1.5, -1, 1.9}, {1.5, -1, 1.9}, {1.5, 1.2, 1.9},
                   {-1.5, 1.2, 1.9});
    test::add_quad(scene, "near", red, {-.4, -.3, 1.6}, {.4, -.3, 1.6}, {.4, .5, 1.6},
                   {-.4, .5, 1.6});
    test::add_quad(scene, "far", grey, {-.6, -.5, 1.3}, {.6, -.5, 1.3}, {.6, .7, 1.3},
                   {-.6, .7, 1.3});
    const dvec3 shut(10, 0, 0);
    test::add_ball(scene, "ball", mirror, shut, .05);
    for (const double half : {.6, .8})
        for (int face = 0; face < 6; ++face)
            test::add_mesh(scene, test::make_box_wall(face, shut - half, shut + half), grey);
    for (const std::string search : {"pyramid", "layered", "march", "secant"}) {
        session::Request request = test::make_test_request(
            scene, {search + ":face=64,captures=own", search + ":face=64,captures=all"},
            kContinuePictureSize);
        request.with_lookup = true;
        const session::RunResult result = session::run(test::get_test_engine(), request);
        const session::TechniqueResult &own = result.parts[0], &all = result.parts[1];
        std::size_t unknown = 0, changed = 0;
        for (std::size_t i = 0; i < own.lookup.size(); ++i) {
            const auto state = [&](const session::TechniqueResult& part) {
                return (static_cast<int>(part.lookup[i].w) - 1) & 3;
            };
            if (!(own.lookup[i].w > 0) || state(own) != 1 || state(all) != 1) continue;
            ++unknown;
            changed += own.hdr.pixels[i] != all.hdr.pixels[i];
        }
        std::cout << "[ MEASURED ] " << search << ": " << unknown
                  << " pixels that no capture answers, " << changed << " of another colour\n";
        EXPECT_GT(unknown, 20u) << search;
        EXPECT_EQ(changed, 0u) << search;
    }
}

// If rays are followed through all other mirrors, captures may leave out mirrors.
TEST(Mirrors, CapturesMayLeaveOutMirrorsWhereRaysAreFollowed) {
    for (const std::string search : {"secant", "pyramid", "layered"}) {
        const ColourError with = measure_continued_search_error(scene::make_cornell(),
                                                                search + ":continue=4"),
                          without = measure_continued_search_error(
                              scene::make_cornell(), search + ":continue=4,mirrors=left_out");
        EXPECT_LE(without.all, 1.05 * with.all) << search;
    }
    // Captures without mirrors do not depend on the frame before, so the first picture equals the
    // last.
    const std::string settled = "pyramid:face=64,continue=8,mirrors=left_out";
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        test::render_technique(scene::make_cornell(), settled, kContinuePictureSize, 1).hdr,
        test::render_technique(scene::make_cornell(), settled, kContinuePictureSize, 5).hdr));
}

TEST(Show, SearchStateAndResidualArePainted) {
    session::Request request = test::make_test_request(
        scene::make_cornell(), {"pyramid:face=64,captures=own,show=state"}, kContinuePictureSize);
    request.with_lookup = true;
    const session::TechniqueResult part = std::move(
        session::run(test::get_test_engine(), request).parts.front());
    const std::array<vec3, 3> paint{
        {{.1f, .6f, .2f}, {.9f, .3f, .1f}, {.1f, .2f, .8f}}}; // colours of hit, unknown and miss
    std::array<std::size_t, 3> count{};
    for (std::size_t i = 0; i < part.lookup.size(); ++i) {
        if (!(part.lookup[i].w > 0)) continue;
        const auto state = static_cast<std::size_t>(static_cast<int>(part.lookup[i].w) - 1) & 3u;
        ++count[state];
        ASSERT_EQ(part.hdr.pixels[i], paint[state]) << "pixel " << i;
    }
    for (const std::size_t pixels : count) EXPECT_GT(pixels, 10u);
    request.techniques = {"pyramid:face=64,show=residual"};
    const session::TechniqueResult residual = std::move(
        session::run(test::get_test_engine(), request).parts.front());
    for (std::size_t i = 0; i < residual.lookup.size(); ++i) {
        const float code = residual.lookup[i].w;
        if (!(code > 0)) continue;
        ASSERT_NEAR(residual.hdr.pixels[i].x, code - std::floor(code), .005f) << "pixel " << i;
    }
}

} // namespace
