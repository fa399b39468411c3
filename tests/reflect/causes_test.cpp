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

constexpr uvec2 kCausesPictureSize{96, 96};
// A small picture is enough for properties that hold at any size, such as a remaining error of 0.
constexpr uvec2 kSmallCausesPictureSize{48, 48};

struct ErrorCauseSplit {
    report::Causes causes;
    std::vector<std::uint32_t> hits;

    double error_share_of_cause(const std::string& name) const { return find_cause(name).share; }
    double error_part_of_cause(const std::string& name) const {
        return find_cause(name).squared_error;
    }
    double error_of_cause_alone(const std::string& name) const {
        return find_cause(name).alone / causes.squared_error;
    }
    const report::CauseShare& find_cause(const std::string& name) const {
        const auto found = std::ranges::find(causes.list, name, &report::CauseShare::name);
        if (found == causes.list.end()) throw std::runtime_error("no cause '" + name + "'");
        return *found;
    }
};

ErrorCauseSplit split_error_by_causes(const session::Request& request,
                                      const std::string& technique) {
    session::Request reference = request;
    reference.techniques = {study::kReference};
    if (request.animate)
        reference.time = request.instant(request.total()), reference.animate = false;
    const session::TechniqueResult truth = std::move(
        session::run(test::get_test_engine(), reference).parts.front());
    session::Session session(test::get_test_engine(), request.scene);
    return {study::CauseFinder(session, request, truth.hdr, truth.hits).find(technique),
            truth.hits};
}

/// Returns a request for a settled picture. Its 16 warm-up frames let one sequence of frames serve
/// all pictures.
session::Request make_request_of_settled_picture(const scene::Scene& scene,
                                                 const std::string& technique, uvec2 size) {
    session::Request request = test::make_test_request(scene, {technique}, size);
    request.warmup = 16;
    return request;
}

ErrorCauseSplit split_error_by_causes(const scene::Scene& scene, const std::string& technique,
                                      uvec2 size = kCausesPictureSize) {
    return split_error_by_causes(make_request_of_settled_picture(scene, technique, size),
                                 technique);
}

/// Returns the mean squared error over all mirrors, as `split_error_by_causes` reports it, without
/// splitting it.
double mean_squared_mirror_error(const scene::Scene& scene, const std::string& technique) {
    const session::TechniqueResult truth = test::render_technique(scene, study::kReference,
                                                                  kCausesPictureSize);
    session::Request request = make_request_of_settled_picture(scene, technique,
                                                               kCausesPictureSize);
    request.until_settled = true;
    const session::RunResult row = session::run(test::get_test_engine(), request);
    return std::pow(
        test::rmse_of_pictures(row.parts.front().hdr, truth.hdr, measure::mask_mirrors(truth.hits)),
        2);
}

/// Expects that the shares of all causes add up to the whole error. The shares of a cause by pixel
/// class, and by mirror, must add up to its whole share.
void expect_cause_shares_add_up(const ErrorCauseSplit& found) {
    double all = 0;
    for (const report::CauseShare& cause : found.causes.list) {
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
std::vector<session::TechniqueInfo> list_capturing_techniques() {
    std::vector<session::TechniqueInfo> list = session::techniques();
    std::erase_if(list, [](const session::TechniqueInfo& technique) {
        return std::ranges::find(technique.knobs, "face", &session::KnobInfo::name) ==
               technique.knobs.end();
    });
    return list;
}

class EveryErrorCauseTest : public testing::TestWithParam<session::TechniqueInfo> {};
INSTANTIATE_TEST_SUITE_P(Table, EveryErrorCauseTest, testing::ValuesIn(list_capturing_techniques()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(EveryErrorCauseTest, CausesAddUpToTheWholeErrorOfEachTechnique) {
    const ErrorCauseSplit found = split_error_by_causes(
        test::replace_balls_by_coarse_balls(scene::make_cornell()),
        test::technique_with_knobs(GetParam(), {{"face", "32"}, {"shadow_map", "256"}}),
        kSmallCausesPictureSize);
    std::cout << "[ MEASURED ] " << GetParam().name << ": rmse "
              << std::sqrt(found.causes.squared_error) << ", left " << found.causes.rest_rmse
              << "\n";
    EXPECT_GT(found.causes.squared_error, 1e-6) << "something to split";
    EXPECT_LE(found.causes.rest_rmse, 1e-3);
    EXPECT_LE(std::abs(found.error_share_of_cause("silhouettes")), .03)
        << "the last step takes what is true: it must be next to nothing";
    EXPECT_EQ(found.causes.squared_error_per_mirror.size(), 4u);
    expect_cause_shares_add_up(found);
}

TEST(Causes, CausesAddUpForEveryFormatAndKindOfShadow) {
    const auto expect_whole = [](const ErrorCauseSplit& found, const std::string& what) {
        EXPECT_LE(found.causes.rest_rmse, 1e-3) << what;
        expect_cause_shares_add_up(found);
    };
    for (const std::string technique :
         {"parallax:face=32,shadow_map=64,distance=r16f",
          "parallax:face=32,distance=unorm8,shadow=none",
          "hybrid:face=32,shadow_map=64,captures=own,continue=0",
          "march:face=32,shadow_map=64,mirrors=left_out,lookup=object"})
        expect_whole(
            split_error_by_causes(test::replace_balls_by_coarse_balls(scene::make_closed_cornell()),
                                  technique, kSmallCausesPictureSize),
            technique);
    expect_whole(split_error_by_causes(test::make_lit_room(2, 3), "parallax:face=32,shadow_map=64",
                                       kSmallCausesPictureSize),
                 "three lights");
    expect_whole(split_error_by_causes(test::make_mirror_hall(), "pyramid:face=32,shadow_map=64",
                                       kSmallCausesPictureSize),
                 "mirrors of any shape");
}

// The split error must equal the error in the row's report. Rays that remove causes of error end at
// blended surfaces and follow only reflections. Therefore no cause is removed in pixels that show a
// blended surface or glass. Removing all causes must not increase the error of these pixels.
TEST(Causes, ErrorBesideGlassAndBlendedSurfacesIsTheRest) {
    const scene::Scene plain = test::make_lit_room(2, 1);
    scene::Scene veiled = plain, glass = plain;
    const std::size_t veil = test::add_material(veiled, {.name = "veil",
                                                         .albedo = {.9f, .5f, .1f},
                                                         .two_sided = true,
                                                         .unlit = true,
                                                         .alpha = .4f,
                                                         .blended = true});
    for (const double x : {-1.7, 1.7}) // outside the camera's view, but visible in the mirrors
        test::add_quad(veiled, "veil", veil, {x, -1.8, -2.8}, {x, -1.8, 1.5}, {x, 1.5, 1.5},
                       {x, 1.5, -2.8});
    scene::add_mesh(glass, scene::ball("glass", 4),
                    test::add_material(glass, {.name = "glass",
                                               .albedo = vec3(1),
                                               .roughness = 0,
                                               .dielectric_f0 = vec3(.04f),
                                               .dielectric_f90 = vec3(1),
                                               .transmission = 1,
                                               .solid = true}));
    glass.objects.back().world_from_object = dmat4(dvec4(.4, 0, 0, 0), dvec4(0, .4, 0, 0),
                                                   dvec4(0, 0, .4, 0), dvec4(.9, -.2, -.7, 1));
    glass.objects.back().mirror = true;
    const auto rest = [](const scene::Scene& scene) {
        const ErrorCauseSplit found = split_error_by_causes(scene, "secant:face=128",
                                                            kSmallCausesPictureSize);
        expect_cause_shares_add_up(found);
        return found.causes.rest_rmse / std::sqrt(found.causes.squared_error);
    };
    const double of_veiled = rest(veiled), of_glass = rest(glass), of_plain = rest(plain);
    std::cout << "[ MEASURED ] share of the rmse that is left: " << of_veiled << " with a veil, "
              << of_glass << " with glass, " << of_plain << " without\n";
    EXPECT_LT(of_plain, .05);
    if (test::has_blended_surfaces())
        EXPECT_GT(of_veiled, of_plain);
    else
        EXPECT_LT(of_veiled, .05); // an opaque surface like others
    EXPECT_LE(of_veiled, 1);
    EXPECT_GT(of_glass, of_plain);
    EXPECT_LE(of_glass, 1);
}

TEST(Causes, SplitErrorIsTheErrorOfTheRow) {
    session::Request request = test::make_test_request(scene::make_cornell(), {"parallax:face=32"},
                                                       kCausesPictureSize);
    const session::TechniqueResult truth = test::render_technique(request.scene, study::kReference,
                                                                  kCausesPictureSize);
    const session::TechniqueResult row = test::render_technique(request.scene, "parallax:face=32",
                                                                kCausesPictureSize);
    const ErrorCauseSplit found = split_error_by_causes(request, "parallax:face=32");
    const auto squared = [&](const measure::Mask& mask) {
        return std::pow(test::rmse_of_pictures(row.hdr, truth.hdr, mask), 2);
    };
    EXPECT_NEAR(found.causes.squared_error, squared(measure::mask_mirrors(truth.hits)), 1e-12);
    for (std::uint32_t i = 0; i < 4; ++i)
        EXPECT_NEAR(found.causes.squared_error_per_mirror[i],
                    squared(measure::mask_one_mirror(truth.hits, MirrorId(i + 1))), 1e-12);
}

// Distances stored in eight bits must count as storage format, both by their share and alone.
TEST(Causes, EightBitDistancesCountAsStorageFormat) {
    const ErrorCauseSplit coarse = split_error_by_causes(scene::make_cornell(),
                                                         "parallax:face=128,distance=unorm8");
    EXPECT_GT(coarse.error_share_of_cause("storage format"), .7);
    EXPECT_GT(coarse.error_of_cause_alone("storage format"), .7);
    expect_cause_shares_add_up(coarse);
    EXPECT_EQ(
        split_error_by_causes(scene::make_cornell(), "parallax:face=64", kSmallCausesPictureSize)
            .error_share_of_cause("storage format"),
        0.0);
}

// Compares two rows that differ in one cause. The difference of their errors must equal the part of
// that cause in the worse row. This check uses no picture with a removed cause.
void expect_cause_part_is_row_difference(const std::string& cause, const scene::Scene& scene,
                                         const std::string& with, const std::string& without) {
    const ErrorCauseSplit worse = split_error_by_causes(scene, with);
    const double gone = worse.causes.squared_error - mean_squared_mirror_error(scene, without);
    std::cout << "[ MEASURED ] " << cause << ": part in " << with << " "
              << worse.error_part_of_cause(cause) << ", error less in " << without << " " << gone
              << ", whole " << worse.causes.squared_error << "\n";
    EXPECT_GT(gone, .5 * worse.causes.squared_error) << cause << ": little to see";
    EXPECT_NEAR(worse.error_part_of_cause(cause), gone, .15 * worse.causes.squared_error) << cause;
}

/// Returns a scene of a ball above a mirror as large as the floor. The ball's centre sees all of
/// that mirror, and everything else is bright.
scene::Scene make_ball_over_mirror_scene() {
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
    expect_cause_part_is_row_difference("direction", test::make_coloured_box({}),
                                        "reuse:face=128,shadow=none",
                                        "pyramid:face=128,shadow=none");
}

TEST(CausesBesideRows, HiddenTargetIsTheDifferenceBetweenPyramidAndHybrid) {
    expect_cause_part_is_row_difference(
        "hidden target",
        test::make_coloured_box({{-1.2, .2, -.6}, {1.9, .6, -.3}, {.2, -1.6, -.4}}),
        "pyramid:face=512,shadow=none", "hybrid:face=512,shadow=none");
}

TEST(CausesBesideRows, TexelsAreTheDifferenceBetweenCoarseAndFineCaptures) {
    expect_cause_part_is_row_difference("texels", test::make_lit_room(1, 1), "pyramid:face=16",
                                        "pyramid:face=256");
}

// With one bounce, mirrors are black in captures.
TEST(CausesBesideRows, MirrorInMirrorIsTheDifferenceBetweenOneAndThreeBounces) {
    expect_cause_part_is_row_difference("mirror in mirror", make_ball_over_mirror_scene(),
                                        "naive:bounces=1,face=64,shadow=none",
                                        "naive:bounces=3,face=64,shadow=none");
}

TEST(CausesBesideRows, ShadowMapIsTheDifferenceBetweenNoShadowsAndAMap) {
    expect_cause_part_is_row_difference("shadow map", test::make_lit_room(1, 1),
                                        "pyramid:face=128,shadow=none", "pyramid:face=128");
}

// A cause that cannot occur in a scene must have no share there, whatever other causes occur.
TEST(Causes, CauseThatCannotOccurHasNoShare) {
    constexpr double kMaxRoundingError = 1e-8;
    const ErrorCauseSplit one_ball = split_error_by_causes(
        test::make_lit_room(1, 1), "parallax:face=32", kSmallCausesPictureSize);
    EXPECT_NEAR(one_ball.error_share_of_cause("mirror in mirror"), 0, kMaxRoundingError);
    EXPECT_EQ(one_ball.error_of_cause_alone("mirror in mirror"), 0);
    EXPECT_GT(one_ball.error_share_of_cause("texels"), .01);
    const ErrorCauseSplit in_a_box = split_error_by_causes(
        test::make_coloured_box({}), "parallax:face=32,shadow=none", kSmallCausesPictureSize);
    EXPECT_NEAR(in_a_box.error_share_of_cause("hidden target"), 0, kMaxRoundingError)
        << "nothing is before a wall";
    EXPECT_NEAR(in_a_box.error_share_of_cause("shadow map"), 0, kMaxRoundingError)
        << "what glows has no shadow";
    EXPECT_NEAR(in_a_box.error_share_of_cause("mirror in mirror"), 0, 1e-3)
        << "but for facets at the outline";
    EXPECT_GT(in_a_box.error_share_of_cause("direction"), .01);
    EXPECT_GT(in_a_box.error_share_of_cause("texels"), .01);
    // In this scene every visible surface except the mirrors emits the same radiance.
    const ErrorCauseSplit bright = split_error_by_causes(test::make_three_ball_scene(),
                                                         "naive:bounces=1,face=64,shadow=none",
                                                         kSmallCausesPictureSize);
    EXPECT_NEAR(bright.error_share_of_cause("shadow map"), 0, kMaxRoundingError);
    EXPECT_GT(bright.error_share_of_cause("mirror in mirror"), .5);
    EXPECT_NEAR(bright.find_cause("mirror in mirror").share_first_order, 0, kMaxRoundingError);
}

TEST(Causes, LargestCausesArePaintedOnlyWhereTheyCanOccur) {
    const ErrorCauseSplit found = split_error_by_causes(scene::make_cornell(), "parallax:face=64");
    const auto read_number = [&](const std::string& name) {
        return &found.find_cause(name) - found.causes.list.data() + 1;
    };
    const std::vector<std::uint8_t>& painted = found.causes.largest;
    ASSERT_EQ(painted.size(), found.hits.size());
    std::size_t mirrored = 0, by_direction = 0;
    for (std::size_t i = 0; i < painted.size(); ++i) {
        if (painted[i] == 0) continue;
        EXPECT_TRUE(measure::first_mirror(found.hits[i])) << "pixel " << i;
        if (painted[i] == read_number("mirror in mirror")) {
            EXPECT_TRUE(measure::second_mirror(found.hits[i])) << "pixel " << i;
            ++mirrored;
        }
        by_direction += painted[i] == read_number("direction");
    }
    EXPECT_GT(mirrored, 20u);
    EXPECT_GT(by_direction, 50u);
    EXPECT_NEAR(found.find_cause("mirror in mirror").share_first_order, 0, 1e-8);
}

TEST(Causes, UncorrectedLookupCountsAsDirection) {
    EXPECT_GT(split_error_by_causes(scene::make_cornell(), "reuse:face=64")
                  .error_share_of_cause("direction"),
              .6);
}

TEST(Causes, MissingShadowsCountAsShadowMap) {
    const ErrorCauseSplit dark = split_error_by_causes(test::make_lit_room(1, 1),
                                                       "pyramid:face=64,shadow=none"),
                          lit = split_error_by_causes(test::make_lit_room(1, 1), "pyramid:face=64");
    EXPECT_GT(dark.error_part_of_cause("shadow map"),
              10 * std::abs(lit.error_part_of_cause("shadow map")));
    EXPECT_GT(dark.find_cause("shadow map").alone,
              10 * std::abs(lit.find_cause("shadow map").alone));
}

// Two boards at a right angle are one mirror that sees itself. Its own capture leaves out this
// reflection.
TEST(Causes, HollowMirrorsOwnReflectionCountsAsMirrorInMirror) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    test::add_mesh(scene, test::make_hollow_corner(), mirror);
    const ErrorCauseSplit found = split_error_by_causes(scene, "pyramid:face=64");
    EXPECT_GT(found.error_share_of_cause("mirror in mirror"), .3);
    EXPECT_LE(found.causes.rest_rmse, 1e-3);
    expect_cause_shares_add_up(found);
}

TEST(Causes, OnlyMovingScenesHaveLag) {
    session::Request request = test::make_test_request(scene::make_cornell(), {},
                                                       kCausesPictureSize);
    request.warmup = 7;
    const ErrorCauseSplit still = split_error_by_causes(request, "reuse:face=64");
    EXPECT_EQ(still.error_share_of_cause("last frame"), 0.0);
    EXPECT_EQ(still.error_of_cause_alone("last frame"), 0.0);
    request.animate = true;
    request.time = 0.7;
    const ErrorCauseSplit moving = split_error_by_causes(request, "reuse:face=64");
    EXPECT_NE(moving.error_share_of_cause("last frame"), 0.0);
    EXPECT_NE(moving.error_of_cause_alone("last frame"), 0.0);
    EXPECT_LE(moving.causes.rest_rmse, 1e-3);
    expect_cause_shares_add_up(moving);
}

} // namespace
