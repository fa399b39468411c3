// Tests of the window's state without a window: plans, cameras, mouse input, commands and settings.
#include "core/error.hpp"
#include "import/load.hpp"
#include "scene/camera_named.hpp"
#include "view/camera.hpp"
#include "view/command.hpp"
#include "view/inputs.hpp"
#include "view/plan_state.hpp"
#include "view/settings.hpp"
#include "view/state.hpp"
#include "view/times.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

namespace {

using namespace catoptric;
using namespace catoptric::view;
using testing::ElementsAre;

const session::KnobInfo& find_knob_info(const std::string& technique, const std::string& name) {
    return *std::ranges::find(technique_info(technique)->knobs, name, &session::KnobInfo::name);
}

TEST(ViewPlan, PlanTextMatchesTheCommandLine) {
    EXPECT_EQ(technique_text(parse_plan("secant:face=64,steps=3")), "secant:face=64,steps=3");
    EXPECT_EQ(technique_text(parse_plan("reuse:face=256")),
              "reuse"); // 256 is the default
    EXPECT_EQ(technique_text(parse_plan("1=planar *=reuse")), "1=planar *=reuse");
    EXPECT_THROW(parse_plan("secand"), Error);
    EXPECT_THAT(plan_words(parse_plan("reuse")), ElementsAre("--technique", "reuse"));
    EXPECT_THAT(plan_words(parse_plan("auto")), ElementsAre("--technique", "auto"));
}

TEST(ViewPlan, EditedMirrorGetsARuleOfItsOwn) {
    EditedPlan plan = parse_plan("reuse");
    plan.own[2] = plan.rest;
    EXPECT_EQ(technique_text(plan), "reuse"); // mirror 2 equals the rest
    plan.own[2] = {"raytrace", {}};
    set(plan.own[2], find_knob_info("raytrace", "depth"), "3");
    set(plan.rest, find_knob_info("reuse", "face"), "64");
    EXPECT_EQ(technique_text(plan), "2=raytrace:depth=3 *=reuse:face=64");
    EXPECT_THAT(plan_words(plan), ElementsAre("--plan", "2=raytrace:depth=3 *=reuse:face=64"));
    set(plan.rest, find_knob_info("reuse", "face"), "256");
    EXPECT_EQ(technique_text(plan), "2=raytrace:depth=3 *=reuse");
    EXPECT_EQ(technique_text(set_knob(parse_plan("hybrid"), "show", "state")), "hybrid:show=state");
    EXPECT_EQ(technique_text(set_knob(plan, "show", "state")),
              technique_text(plan)); // no technique has this knob
}

TEST(ViewPlan, SuggestedPlanBecomesRulesByMirrorNumber) {
    const std::vector<PlanEntry> drawn{
        {1, "ball", "reuse", {{"face", "64", 64, true}, {"colour", "half", {}, false}}, "far"},
        {2, "wall", "planar", {}, "flat"}};
    EXPECT_EQ(technique_text(resolve_plan(parse_plan("auto"), drawn)), "2=planar *=reuse:face=64");
    EXPECT_EQ(technique_text(resolve_plan(parse_plan("reuse"), drawn)), "reuse");
}

class ViewCameraTest : public testing::Test {
protected:
    scene::Camera camera{.name = "c", .eye = {0, 1, 0}, .target = {0, 1, 4}};
    double distance_to_target(const scene::Camera& c) const {
        return glm::length(c.target - c.eye);
    }
};

TEST_F(ViewCameraTest, CameraOrbitsAroundItsTarget) {
    const scene::Camera turned = move_camera(camera, {.turned = {100, 40}}, false, 400, 10);
    EXPECT_EQ(turned.target, camera.target);
    EXPECT_NEAR(distance_to_target(turned), 4, 1e-12);
    // The scene follows the mouse, so the eye moves up and to the picture's left, which is +x.
    EXPECT_NEAR(turned.eye.y, 1 + 4 * std::sin(.2), 1e-12);
    EXPECT_NEAR(turned.eye.x, 4 * std::cos(.2) * std::sin(.5), 1e-12);
    const scene::Camera above = move_camera(camera, {.turned = {0, 1e6}}, false, 400, 10);
    EXPECT_LT(above.eye.y, 5); // the eye never passes over the target
    EXPECT_NEAR(distance_to_target(move_camera(camera, {.wheel = 1}, false, 400, 10)), 3.6, 1e-12);
}

TEST_F(ViewCameraTest, FlightMovesTheEyeAndTurningKeepsIt) {
    const scene::Camera ahead = move_camera(camera, {.flown = {0, 0, 3}}, true, 400, 10);
    EXPECT_NEAR(ahead.eye.z, 10, 1e-12); // a flight of 3 s covers the reach, 10
    const scene::Camera turned = move_camera(camera, {.turned = {100, 0}}, true, 400, 10);
    EXPECT_EQ(turned.eye, camera.eye);
    EXPECT_LT(turned.target.x, -1); // a turn to the right, which is -x
}

TEST_F(ViewCameraTest, ShiftMovesTheSceneByThePixelsDragged) {
    const scene::Camera shifted = move_camera(camera, {.shifted = {400, 0}}, false, 400, 10);
    EXPECT_NEAR(glm::length(shifted.eye - camera.eye), 8 * std::tan(glm::radians(22.5)), 1e-12);
    EXPECT_EQ(shifted.eye - camera.eye, shifted.target - camera.target);
}

/// A camera that is read back from its text is equal to the bit. Without input a camera stays
/// unchanged.
TEST_F(ViewCameraTest, CameraTextGivesTheSameCamera) {
    scene::Camera c = camera;
    EXPECT_EQ(move_camera(c, {}, false, 400, 10), camera);
    for (int i = 0; i < 50; ++i) {
        c = move_camera(c, {.turned = {13.3, -7.1 * (i % 3 - 1)}, .shifted = {1, 2}, .wheel = .1},
                        i % 2, 400, 10);
        scene::Camera typed = scene::find_camera(scene::format_camera(c), {});
        typed.name = c.name;
        ASSERT_EQ(typed, c);
    }
}

/// The camera stays valid however far the wheel turns. A scene's camera with too large a field of
/// view stays unchanged.
TEST_F(ViewCameraTest, CameraStaysValidAtExtremeInput) {
    for (const double wheel : {1e3, -1e5}) {
        scene::Camera c = camera;
        for (int i = 0; i < 10; ++i) c = move_camera(c, {.wheel = wheel}, false, 400, 10);
        EXPECT_NO_THROW(static_cast<void>(scene::find_camera(scene::format_camera(c), {})));
    }
    camera.vertical_fov_degrees = 179.9; // degrees, more than `--camera` accepts
    EXPECT_EQ(move_camera(camera, {.turned = {9, 9}}, false, 400, 10), camera);
}

TEST(ViewHand, MouseDragsTheDividerAndClicksMirrors) {
    ViewState state;
    state.camera = {.eye = {0, 1, 0}, .target = {0, 1, 4}};
    const scene::Camera before = state.camera;
    state.mode = ViewMode::split;
    MouseDrag hand;
    const auto at = [&](double x, double y, bool down) {
        UserInput inputs{.mouse = {x, y}, .down = {down}};
        return hand.apply_drag(inputs, state, {200, 100}, 10);
    };
    at(101, 50, true);
    at(160, 20, true);
    EXPECT_EQ(at(160, 20, false), std::nullopt);
    EXPECT_DOUBLE_EQ(state.divider, .8);
    EXPECT_EQ(state.camera, before);
    at(30, 40, true);
    EXPECT_EQ(at(31, 40, false), uvec2(30, 40)); // one pixel apart is still a click
    EXPECT_EQ(state.camera, before);
    at(30, 40, true);
    at(60, 40, true);
    EXPECT_EQ(at(60, 40, false), std::nullopt);
    EXPECT_NE(state.camera, before);
    const scene::Camera turned = state.camera;
    at(250, 40, true); // the mouse is on the controls, outside the picture
    at(20, 40, true);
    EXPECT_EQ(at(20, 40, false), std::nullopt);
    EXPECT_EQ(state.camera, turned);
}

/// Covers displays with a scale of 2 and displays whose scale is unknown, which counts as 1.
TEST(ViewInputs, MousePositionIsConvertedToPixels) {
    EXPECT_EQ(pixels_per_unit({1744, 1024}, {872, 512}), dvec2(2));
    EXPECT_EQ(pixels_per_unit({300, 200}, {200, 100}), dvec2(1.5, 2));
    EXPECT_EQ(pixels_per_unit({0, 0}, {872, 512}), dvec2(1));
    EXPECT_EQ(pixels_per_unit({872, 512}, {0, 0}), dvec2(1));
}

TEST(ViewInputs, EachKeyIsBoundOnceAndDescribed) {
    std::set<int> codes;
    std::set<std::string> names, descriptions;
    for (const KeyBinding& key : key_bindings()) {
        EXPECT_TRUE(codes.insert(key.code).second) << key.name;
        EXPECT_TRUE(names.insert(key.name).second) << key.name;
        EXPECT_TRUE(descriptions.insert(key.does).second) << key.name;
        EXPECT_STRNE(key.name, "") << key.does;
        EXPECT_STRNE(key.does, "") << key.name;
    }
    EXPECT_FALSE(codes.empty());
}

TEST(ViewState, ModeDecidesWhichTechniquesAreRendered) {
    ViewState state;
    state.plan = parse_plan("hybrid"), state.other = parse_plan("reuse");
    EXPECT_THAT(choose_shown_pictures(state).techniques, ElementsAre("hybrid"));
    state.mode = ViewMode::split;
    EXPECT_THAT(choose_shown_pictures(state).techniques, ElementsAre("hybrid", "reuse"));
    EXPECT_EQ(choose_shown_pictures(state).second, 1u);
    state.other = state.plan; // a frame accepts each technique only once
    EXPECT_THAT(choose_shown_pictures(state).techniques, ElementsAre("hybrid"));
    state.against = ComparisonPicture::reference;
    EXPECT_EQ(choose_shown_pictures(state).second, session::WindowPictures::kCanvasPicture);
    EXPECT_TRUE(needs_host_picture(state));
    state.mode = ViewMode::answers;
    EXPECT_THAT(choose_shown_pictures(state).techniques, ElementsAre("hybrid:show=state"));
    EXPECT_FALSE(needs_host_picture(state));
}

TEST(ViewState, EachMirrorNumberHasItsOwnColour) {
    std::set<std::tuple<int, int, int>> colours;
    for (std::uint32_t mirror = 0; mirror <= 16; ++mirror) {
        const glm::ivec3 c(mirror_colour(mirror) * 16.f);
        colours.insert({c.x, c.y, c.z});
    }
    EXPECT_EQ(colours.size(), 17u);
    const measure::Picture picture = mirror_number_picture({0, 1U | 3U << 16U}, {2, 1});
    EXPECT_EQ(picture.at(0, 0), vec3(0));
    EXPECT_EQ(picture.at(1, 0), mirror_colour(1));
}

TEST(ViewMotion, TimeAdvancesBySpeedWhilePlaying) {
    EXPECT_EQ(advance_time({.time = 2}, .5), 2);
    EXPECT_EQ(advance_time({.time = 2, .plays = true, .speed = -2}, .5), 1);
}

TEST(ViewCommand, CopiedCommandKeepsTheOptionsOfTheScene) {
    ViewState state;
    state.plan = parse_plan("1=planar *=reuse");
    state.motion.time = .25, state.exposure = -1;
    const std::vector<std::string> words{"hall of mirrors.glb",
                                         "--mirror",
                                         "wall*=.9",
                                         "--size=9x9",
                                         "--technique",
                                         "reuse",
                                         "--animate",
                                         "--environment",
                                         "studio",
                                         "--frames",
                                         "9",
                                         "-q",
                                         "--budget-ms",
                                         "4"};
    EXPECT_EQ(
        render_command(words, state, "0,1,2:3,4,5:40", {64, 48}),
        "catoptric render 'hall of mirrors.glb' --mirror 'wall*=.9' --environment studio --plan "
        "'1=planar *=reuse' --camera 0,1,2:3,4,5:40 --time 0.25 --size 64x48 --exposure -1 --model "
        "required -o view.png");
    EXPECT_THAT(render_words({"-qv", "-vv", "--verbose", "--seed", "7", "--", "-q"}, state,
                             "0,1,2:3,4,5:40", {64, 48}),
                testing::AllOf(testing::Not(testing::Contains("-qv")),
                               testing::Not(testing::Contains("-vv")), testing::Contains("7"),
                               testing::Contains("view.png")));
    const std::vector<std::string> odd = render_words({"-q", "--", "-q"}, state, "0", {64, 48});
    EXPECT_EQ(odd.at(1), "--plan");
    EXPECT_THAT(std::vector(odd.end() - 3, odd.end()), ElementsAre("view.png", "--", "-q"));
    EXPECT_EQ(quote_for_shell("it's"), "'it'\\''s'");
    EXPECT_EQ(quote_for_shell(""), "''");
}

TEST(ViewSettings, SettingsAreReadAsTheyWereWritten) {
    const ViewerSettings settings{
        .window = {800, 600}, .shows_panels = false, .flies = true, .speed = -.5, .gain = 16};
    EXPECT_EQ(parse_settings(serialise_settings(settings)), settings);
    for (const char* text :
         {"", "[]", "{\"width\": -4, \"height\": 5}", "{\"gain\": 3}", "{\"speed\": \"x\"}",
          "{\"speed\": 1e999, \"panels\": 7}", "{\"width\": 99999, \"height\": 3}"})
        EXPECT_EQ(parse_settings(text), ViewerSettings()) << text;
}

TEST(ViewState, DifferencePictureIsTheAbsoluteDifferenceTimesTheGain) {
    measure::Picture a(2, 1), b(2, 1);
    a.pixels = {vec3(.5f, .25f, 0), vec3(1)};
    b.pixels = {vec3(.25f, .5f, 0), vec3(0)};
    const measure::Picture difference = difference_picture(a, b, 2);
    EXPECT_THAT(difference.pixels, ElementsAre(vec3(.5f, .5f, 0), vec3(1)));
}

TEST(ViewTimes, TimesOfTheHostAreNamedInTheOrderOfWork) {
    TimeStatistics::FrameSample sample;
    sample.frame.host = {.update = 1, .hierarchy = 2, .compile = 3, .record = 4};
    sample.frame.gpu_ms = 8;
    sample.host_ms = 5, sample.acquire_ms = 6, sample.present_ms = 7;
    TimeStatistics times;
    times.add(sample);
    std::vector<std::string> names;
    std::vector<double> medians;
    for (const TimeRow& row : times.host()) {
        names.push_back(row.name);
        medians.push_back(row.median);
    }
    EXPECT_THAT(names, ElementsAre("update", "hierarchy", "compile", "record", "host, by the clock",
                                   "acquire", "present"));
    EXPECT_THAT(medians, ElementsAre(1, 2, 3, 4, 5, 6, 7));
    EXPECT_EQ(times.gpu().median, 8);
    EXPECT_EQ(times.frame().median, 18);
}

TEST(ViewTimes, MediansCoverFramesWithTheSamePasses) {
    TimeStatistics times;
    const auto sample = [](double ms) {
        TimeStatistics::FrameSample s;
        s.frame.passes = {{"view", 0, ms}};
        s.interval_ms = 20;
        return s;
    };
    for (const double ms : {1., 5., 2., 3., 4., 6., 7.}) times.add(sample(ms));
    EXPECT_EQ(times.list_pass_times().at(0).median, 4);
    EXPECT_EQ(times.list_pass_times().at(0).ci95.low, 1);
    EXPECT_EQ(times.fps(), 50);
    TimeStatistics::FrameSample other = sample(9);
    other.frame.passes[0].name = "trace";
    times.add(other);
    EXPECT_EQ(times.frame_count(), 1u);
}

} // namespace
