// Tests of the split of an error by cause. The shares must add up to the whole error, and the cause
// that a scene is built for must get its share.
#include "compare.hpp"
#include "core/mirror_id.hpp"
#include "measure/causes.hpp"
#include "report/comparison.hpp"
#include "scene/built_in.hpp"
#include "scene/material_facts.hpp"
#include "study/causes.hpp"
#include "support/boxes.hpp"

#include <iostream>
#include <utility>

namespace {

using namespace catoptric;

constexpr uvec2 kCausesSize{96, 96};
// A small picture is enough for properties that hold at any size, such as a remaining error of 0.
constexpr uvec2 kCausesSmall{48, 48};

struct Split {
    report::Causes causes;
    std::vector<std::uint32_t> hits;

    double share(const std::string& name) const { return find(name).share; }
    double part(const std::string& name) const { return find(name).squared_error; }
    double alone(const std::string& name) const { return find(name).alone / causes.squared_error; }
    const report::Cause& find(const std::string& name) const {
        const auto found = std::ranges::find(causes.list, name, &report::Cause::name);
        if (found == causes.list.end()) throw std::runtime_error("no cause '" + name + "'");
        return *found;
    }
};

Split split(const app::Request& request, const std::string& technique) {
    app::Request reference = request;
    reference.techniques = {app::kReference};
    if (request.animate)
        reference.time = request.instant(request.total()), reference.animate = false;
    const app::TechniqueResult truth = std::move(
        app::run(test::test_engine(), reference).parts.front());
    app::Session session(test::test_engine(), request.scene);
    return {app::ErrorCauseFinder(session, request, truth.hdr, truth.hits).find(technique),
            truth.hits};
}

/// Returns a request for a settled picture. Its 16 warm-up frames let one sequence of frames serve
/// all pictures.
app::Request settled(const scene::Scene& scene, const std::string& technique, uvec2 size) {
    app::Request request = test::make_test_request(scene, {technique}, size);
    request.warmup = 16;
    return request;
}

Split split(const scene::Scene& scene, const std::string& technique, uvec2 size = kCausesSize) {
    return split(settled(scene, technique, size), technique);
}

/// Returns the mean squared error over all mirrors, as `split` reports it, without splitting it.
double squared_error(const scene::Scene& scene, const std::string& technique) {
    const app::TechniqueResult truth = test::render_technique(scene, app::kReference, kCausesSize);
    const app::RunResult row = app::run(test::test_engine(),
                                        settled(scene, technique, kCausesSize));
    return std::pow(test::picture_rmse(row.parts.front().hdr, truth.hdr,
                                       measure::mask_mirror_pixels(truth.hits)),
                    2);
}

/// Expects that the shares of all causes add up to the whole error. The shares of a cause by pixel
/// class, and by mirror, must add up to its whole share.
void expect_adds_up(const Split& found) {
    double all = 0;
    for (const report::Cause& cause : found.causes.list) {
        all += cause.share;
        EXPECT_NEAR(cause.share_first_order + cause.share_mirror_in_mirror, cause.share, 1e-12);
        double mirrors = 0;
        for (const double share : cause.share_per_mirror) mirrors += share;
        EXPECT_NEAR(mirrors, cause.share, 1e-12) << cause.name;
        EXPECT_NEAR(cause.squared_error, cause.share * found.causes.squared_error, 1e-12);
    }
    EXPECT_NEAR(all, 1, 1e-9);
}

/// Returns the techniques that draw captures, which are those with a knob `face`.
std::vector<app::TechniqueInfo> that_capture() {
    std::vector<app::TechniqueInfo> list = app::techniques();
    std::erase_if(list, [](const app::TechniqueInfo& technique) {
        return std::ranges::find(technique.knobs, "face", &app::KnobInfo::name) ==
               technique.knobs.end();
    });
    return list;
}

class EveryCause : public testing::TestWithParam<app::TechniqueInfo> {};
INSTANTIATE_TEST_SUITE_P(Table, EveryCause, testing::ValuesIn(that_capture()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(EveryCause, CausesAddUpToTheWholeErrorOfEachTechnique) {
    const Split found = split(
        test::with_coarse_balls(scene::make_cornell_mirrors()),
        test::technique_with_knobs(GetParam(), {{"face", "32"}, {"shadow_map", "256"}}),
        kCausesSmall);
    std::cout << "[ MEASURED ] " << GetParam().name << ": rmse "
              << std::sqrt(found.causes.squared_error) << ", left " << found.causes.rest_rmse
              << "\n";
    EXPECT_GT(found.causes.squared_error, 1e-6) << "something to split";
    EXPECT_LE(found.causes.rest_rmse, 1e-3);
    EXPECT_LE(std::abs(found.share("silhouettes")), .03)
        << "the last step takes what is true: it must be next to nothing";
    EXPECT_EQ(found.causes.squared_error_per_mirror.size(), 4u);
    expect_adds_up(found);
}

TEST(Causes, CausesAddUpForEveryFormatAndKindOfShadow) {
    const auto expect_whole = [](const Split& found, const std::string& what) {
        EXPECT_LE(found.causes.rest_rmse, 1e-3) << what;
        expect_adds_up(found);
    };
    for (const std::string technique :
         {"parallax:face=32,shadow_map=64,distance=r16f",
          "parallax:face=32,distance=unorm8,shadow=none",
          "hybrid:face=32,shadow_map=64,captures=own,continue=0",
          "march:face=32,shadow_map=64,mirrors=left_out,lookup=object"})
        expect_whole(split(test::with_coarse_balls(scene::make_closed_cornell_mirrors()), technique,
                           kCausesSmall),
                     technique);
    expect_whole(split(test::make_lit_room(2, 3), "parallax:face=32,shadow_map=64", kCausesSmall),
                 "three lights");
    expect_whole(split(test::make_mirror_hall(), "pyramid:face=32,shadow_map=64", kCausesSmall),
                 "mirrors of any shape");
}

// The error that is split must be the error that the report gives for the row.
TEST(Causes, SplitErrorIsTheErrorOfTheRow) {
    app::Request request = test::make_test_request(scene::make_cornell_mirrors(),
                                                   {"parallax:face=32"}, kCausesSize);
    const app::TechniqueResult truth = test::render_technique(request.scene, app::kReference,
                                                              kCausesSize);
    const app::TechniqueResult row = test::render_technique(request.scene, "parallax:face=32",
                                                            kCausesSize);
    const Split found = split(request, "parallax:face=32");
    const auto squared = [&](const measure::Mask& mask) {
        return std::pow(test::picture_rmse(row.hdr, truth.hdr, mask), 2);
    };
    EXPECT_NEAR(found.causes.squared_error, squared(measure::mask_mirror_pixels(truth.hits)),
                1e-12);
    for (std::uint32_t i = 0; i < 4; ++i)
        EXPECT_NEAR(found.causes.squared_error_per_mirror[i],
                    squared(measure::mask_one_mirror(truth.hits, MirrorId(i + 1))), 1e-12);
}

// Distances stored in eight bits must count as storage format, both by their share and alone.
TEST(Causes, EightBitDistancesCountAsStorageFormat) {
    const Split coarse = split(scene::make_cornell_mirrors(), "parallax:face=128,distance=unorm8");
    EXPECT_GT(coarse.share("storage format"), .7);
    EXPECT_GT(coarse.alone("storage format"), .7);
    expect_adds_up(coarse);
    EXPECT_EQ(split(scene::make_cornell_mirrors(), "parallax:face=64", kCausesSmall)
                  .share("storage format"),
              0.0);
}

// Compares two rows that differ in one cause. The difference of their errors must equal the part of
// that cause in the worse row. This check uses no picture with a removed cause.
void expect_part_is_difference(const std::string& cause, const scene::Scene& scene,
                               const std::string& with, const std::string& without) {
    const Split worse = split(scene, with);
    const double gone = worse.causes.squared_error - squared_error(scene, without);
    std::cout << "[ MEASURED ] " << cause << ": part in " << with << " " << worse.part(cause)
              << ", error less in " << without << " " << gone << ", whole "
              << worse.causes.squared_error << "\n";
    EXPECT_GT(gone, .5 * worse.causes.squared_error) << cause << ": little to see";
    EXPECT_NEAR(worse.part(cause), gone, .15 * worse.causes.squared_error) << cause;
}

/// Returns a scene of a ball above a mirror as large as the floor. The ball's centre sees all of
/// that mirror, and everything else is bright.
scene::Scene over_a_mirror() {
    scene::Scene scene{.name = "over a mirror"};
    test::add_bright_box(scene, {-4, -3, -5}, {4, 3, 5});
    test::add_ball(scene, "ball", test::add_halving_mirror(scene, 0), {.5, -.2, 1}, .5, 5);
    test::add_quad(scene, "floor", test::add_halving_mirror(scene, 1), {-3, -2.9, -3},
                   {3, -2.9, -3}, {3, -2.9, 4}, {-3, -2.9, 4});
    scene.cameras.push_back(
        {.eye = {-.8, .8, -3.6}, .target = {.5, -.2, 1}, .vertical_fov_degrees = 12});
    return scene;
}

TEST(CausesBesideRows, DirectionIsTheDifferenceBetweenReuseAndPyramid) {
    expect_part_is_difference("direction", test::make_coloured_box({}),
                              "reuse:face=128,shadow=none", "pyramid:face=128,shadow=none");
}

TEST(CausesBesideRows, HiddenTargetIsTheDifferenceBetweenPyramidAndHybrid) {
    expect_part_is_difference(
        "hidden target",
        test::make_coloured_box({{-1.2, .2, -.6}, {1.9, .6, -.3}, {.2, -1.6, -.4}}),
        "pyramid:face=512,shadow=none", "hybrid:face=512,shadow=none");
}

TEST(CausesBesideRows, TexelsAreTheDifferenceBetweenCoarseAndFineCaptures) {
    expect_part_is_difference("texels", test::make_lit_room(1, 1), "pyramid:face=16",
                              "pyramid:face=256");
}

// With one bounce, mirrors are black in captures.
TEST(CausesBesideRows, MirrorInMirrorIsTheDifferenceBetweenOneAndThreeBounces) {
    expect_part_is_difference("mirror in mirror", over_a_mirror(),
                              "naive:bounces=1,face=64,shadow=none",
                              "naive:bounces=3,face=64,shadow=none");
}

TEST(CausesBesideRows, ShadowMapIsTheDifferenceBetweenNoShadowsAndAMap) {
    expect_part_is_difference("shadow map", test::make_lit_room(1, 1),
                              "pyramid:face=128,shadow=none", "pyramid:face=128");
}

// A cause that cannot occur in a scene must have no share there, whatever other causes occur.
TEST(Causes, CauseThatCannotOccurHasNoShare) {
    constexpr double kRounding = 1e-8;
    const Split one_ball = split(test::make_lit_room(1, 1), "parallax:face=32", kCausesSmall);
    EXPECT_NEAR(one_ball.share("mirror in mirror"), 0, kRounding);
    EXPECT_EQ(one_ball.alone("mirror in mirror"), 0);
    EXPECT_GT(one_ball.share("texels"), .01);
    const Split in_a_box = split(test::make_coloured_box({}), "parallax:face=32,shadow=none",
                                 kCausesSmall);
    EXPECT_NEAR(in_a_box.share("hidden target"), 0, kRounding) << "nothing is before a wall";
    EXPECT_NEAR(in_a_box.share("shadow map"), 0, kRounding) << "what glows has no shadow";
    EXPECT_NEAR(in_a_box.share("mirror in mirror"), 0, 1e-3) << "but for facets at the outline";
    EXPECT_GT(in_a_box.share("direction"), .01);
    EXPECT_GT(in_a_box.share("texels"), .01);
    // In this scene every visible surface except the mirrors emits the same radiance.
    const Split bright = split(test::make_three_ball_scene(), "naive:bounces=1,face=64,shadow=none",
                               kCausesSmall);
    EXPECT_NEAR(bright.share("shadow map"), 0, kRounding);
    EXPECT_GT(bright.share("mirror in mirror"), .5);
    EXPECT_NEAR(bright.find("mirror in mirror").share_first_order, 0, kRounding);
}

TEST(Causes, LargestCausesArePaintedOnlyWhereTheyCanOccur) {
    const Split found = split(scene::make_cornell_mirrors(), "parallax:face=64");
    const auto number_of = [&](const std::string& name) {
        return &found.find(name) - found.causes.list.data() + 1;
    };
    const std::vector<std::uint8_t>& painted = found.causes.largest;
    ASSERT_EQ(painted.size(), found.hits.size());
    std::size_t mirrored = 0, by_direction = 0;
    for (std::size_t i = 0; i < painted.size(); ++i) {
        if (painted[i] == 0) continue;
        EXPECT_TRUE(measure::first_mirror_of_hit(found.hits[i])) << "pixel " << i;
        if (painted[i] == number_of("mirror in mirror")) {
            EXPECT_TRUE(measure::second_mirror_of_hit(found.hits[i])) << "pixel " << i;
            ++mirrored;
        }
        by_direction += painted[i] == number_of("direction");
    }
    EXPECT_GT(mirrored, 20u);
    EXPECT_GT(by_direction, 50u);
    EXPECT_NEAR(found.find("mirror in mirror").share_first_order, 0, 1e-8);
}

TEST(Causes, UncorrectedLookupCountsAsDirection) {
    EXPECT_GT(split(scene::make_cornell_mirrors(), "reuse:face=64").share("direction"), .6);
}

TEST(Causes, MissingShadowsCountAsShadowMap) {
    const Split dark = split(test::make_lit_room(1, 1), "pyramid:face=64,shadow=none"),
                lit = split(test::make_lit_room(1, 1), "pyramid:face=64");
    EXPECT_GT(dark.part("shadow map"), 10 * std::abs(lit.part("shadow map")));
    EXPECT_GT(dark.find("shadow map").alone, 10 * std::abs(lit.find("shadow map").alone));
}

// Two boards at a right angle are one mirror that sees itself. Its own capture leaves out this
// reflection.
TEST(Causes, HollowMirrorsOwnReflectionCountsAsMirrorInMirror) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    test::add_mesh(scene, test::make_hollow_corner(), mirror);
    const Split found = split(scene, "pyramid:face=64");
    EXPECT_GT(found.share("mirror in mirror"), .3);
    EXPECT_LE(found.causes.rest_rmse, 1e-3);
    expect_adds_up(found);
}

TEST(Causes, OnlyMovingScenesHaveLag) {
    app::Request request = test::make_test_request(scene::make_cornell_mirrors(), {}, kCausesSize);
    request.warmup = 7;
    const Split still = split(request, "reuse:face=64");
    EXPECT_EQ(still.share("last frame"), 0.0);
    EXPECT_EQ(still.alone("last frame"), 0.0);
    request.animate = true;
    request.time = 0.7;
    const Split moving = split(request, "reuse:face=64");
    EXPECT_NE(moving.share("last frame"), 0.0);
    EXPECT_NE(moving.alone("last frame"), 0.0);
    EXPECT_LE(moving.causes.rest_rmse, 1e-3);
    expect_adds_up(moving);
}

} // namespace
