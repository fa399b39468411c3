// Tests of the window under an X server without a screen. Its pictures must equal those of
// `catoptric render`, and the X server must show them.
#include "import/load.hpp"
#include "measure/picture_file.hpp"
#include "view/window.hpp"

#include <algorithm>
#include <cmath>

namespace {

using namespace catoptric;
using namespace catoptric::view;
using testing::HasSubstr;

class ViewPictureTest : public test::ViewWindowTest {};

TEST_F(ViewPictureTest, ScreenshotEqualsThePictureOfRender) {
    const Words words{"--technique", "reuse:face=32", "--size", "64x48", "--frames",
                      "3",           "--animate"};
    for (const std::string name : {"a.png", "a.exr"}) {
        Words with = words;
        with.insert(with.end(), {"--screenshot", path_in_test_folder(name)});
        EXPECT_EQ(run_view_in_test(with), 0);
        Words without = words;
        without.insert(without.end(), {"--warmup", "0"});
        expect_same_as_rendered(name, without);
    }
}

/// In each mode the X server must show the picture that the window writes to a file.
TEST_F(ViewPictureTest, DisplayShowsThePictureOfEachMode) {
    std::vector<std::string> seen;
    std::vector<measure::Picture> first; // pictures of the modes plan, split and difference
    const auto expect_shown = [&](const SceneViewer& viewer, const std::string& name) {
        viewer.write_picture(path_in_test_folder(name));
        const measure::Picture written = measure::to_display(
            measure::read_picture(path_in_test_folder(name)));
        double apart = 1;
        for (int tries = 0; tries < 100 && apart > 0; ++tries) { // the X server draws with a delay
            if (tries > 0) ::usleep(20000);
            apart = 0;
            const measure::Picture shown = display->read_screen_pixels(written.width,
                                                                       written.height);
            for (std::size_t i = 0; i < shown.pixels.size(); ++i) {
                const vec3 d = glm::abs(shown.pixels[i] - written.pixels[i]);
                const bool is_divider = name == "split.png" && i % 64 == 40;
                if (!is_divider) apart = std::max({apart, double(d.x), double(d.y), double(d.z)});
            }
            if (name == "difference.png" && apart < 1.5 / 255) apart = 0; // rounded differently
        }
        EXPECT_EQ(apart, 0) << name;
        seen.push_back(name);
        if (first.size() < 3) first.push_back(written);
    };
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput&, ViewState& state, ViewWindow&) {
        state.other = parse_plan("parallax:face=16,shadow_map=64");
        state.divider = 40.0 / 64, state.gain = 2;
        state.cause = 8;
        state.mode = static_cast<ViewMode>(std::min<std::size_t>(frame / 10, kViewModeCount - 1));
        if (frame >= 60) state.mode = ViewMode::split, state.against = ComparisonPicture::reference;
    };
    driver.after = [&](const ViewReport& report) {
        if (report.frame % 10 == 9)
            expect_shown(report.viewer, report.frame < 60
                                            ? mode_name(report.state.mode) + std::string(".png")
                                            : "split.png");
    };
    EXPECT_EQ(run_view_in_test({"--technique", "secant:face=32,shadow_map=64", "--size", "64x64",
                                "--frames", "69"},
                               driver),
              0);
    EXPECT_EQ(seen.size(), 7u);
    // The split picture has the plan's pixels left of the divider and the other plan's pixels right
    // of it. The difference picture must show their difference, times 2.
    double apart = 0, of_difference = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const vec3 plan = first[0].at(x, y), split = first[1].at(x, y);
            if (x < 40) {
                EXPECT_EQ(split, plan) << x << ' ' << y;
                continue;
            }
            const vec3 d = glm::abs(split - plan);
            apart = std::max({apart, double(d.x), double(d.y), double(d.z)});
            const vec3 off = glm::abs(first[2].at(x, y) - glm::min(2.f * d, vec3(1)));
            of_difference = std::max({of_difference, double(off.x), double(off.y), double(off.z)});
        }
    EXPECT_GT(apart, .1);
    EXPECT_LT(of_difference, 1.5 / 255);
}

/// A change of view, time or size starts the reference picture again.
TEST_F(ViewPictureTest, ReferenceRestartsWhenTheViewChanges) {
    const auto passes = [](const ViewReport& report) {
        return report.viewer.progressive_reference().pass_count();
    };
    std::vector<int> seen;
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput& inputs, ViewState& state,
                        ViewWindow& window) {
        inputs.on_controls = false;
        state.mode = ViewMode::split, state.against = ComparisonPicture::reference;
        inputs.wheel = frame == 7 ? 1 : 0;
        if (frame == 14) state.motion.time = .5;
        if (frame == 21) window.resize({400, 40});
    };
    driver.after = [&](const ViewReport& report) {
        seen.push_back(passes(report));
        const auto made = report.viewer.progressive_reference().displayed_picture();
        if (!made) return;
        EXPECT_EQ(uvec2(made->width, made->height), report.viewer.make_frame_spec().size);
    };
    EXPECT_EQ(run_view_in_test({"--technique", "reuse:face=16,shadow_map=16", "--size", "32x32",
                                "--frames", "30"},
                               driver),
              0);
    EXPECT_GT(seen[5], 1);
    EXPECT_EQ(seen[6], 0);
    EXPECT_GT(seen[12], 1);
    EXPECT_EQ(seen[13], 0);
    EXPECT_THAT(std::vector(seen.begin() + 20, seen.begin() + 26), testing::Contains(0));
    EXPECT_GT(seen.back(), 0);
}

/// Draws every technique and changes up to three of its knobs while the window runs.
TEST_F(ViewPictureTest, EveryTechniqueIsDrawnWhileItsKnobsChange) {
    std::vector<EditedPlan> plans;
    for (const session::TechniqueInfo& technique : session::techniques()) {
        EditedPlan plan;
        plan.rest.technique = technique.name;
        for (const session::KnobInfo& knob : technique.knobs)
            if (knob.name == "face" || knob.name == "shadow_map") set(plan.rest, knob, "16");
        plans.push_back(plan);
        std::size_t turned = 0;
        for (const session::KnobInfo& knob : technique.knobs) {
            if (turned == 3) break;
            if (plan.rest.knobs.contains(knob.name)) continue;
            const std::string value = knob.choices.empty() ? std::to_string(static_cast<int>(
                                                                 std::min(knob.low + 2, knob.high)))
                                      : knob.choices.back() == knob.value ? knob.choices.front()
                                                                          : knob.choices.back();
            set(plan.rest, knob, value);
            plans.push_back(plan);
            ++turned;
        }
        EXPECT_GE(turned, 2u) << technique.name;
    }
    std::size_t drawn = 0;
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput&, ViewState& state, ViewWindow&) {
        state.plan = plans[(frame - 1) / 2];
    };
    driver.after = [&](const ViewReport& report) {
        EXPECT_EQ(report.state.said, "") << technique_text(report.state.plan);
        drawn += report.state.plan == plans[(report.frame - 1) / 2];
    };
    const std::string frames = std::to_string(2 * plans.size());
    EXPECT_EQ(run_view_in_test(
                  {"--technique", "reuse:face=16", "--size", "32x32", "--frames", frames}, driver),
              0);
    EXPECT_EQ(drawn, 2 * plans.size());
}

/// A click on a mirror selects the mirror. The technique that is then set applies to this mirror
/// only.
TEST_F(ViewPictureTest, ClickSelectsTheMirrorUnderTheMouse) {
    const scene::Scene scene = scene::load("cornell-mirrors", {});
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    const scene::Camera& camera = scene.cameras.front();
    const double edge = 96;
    const auto pixel_of = [&](std::size_t mirror) { // where the camera sees the mirror's centre
        const dvec3 at = scene.objects[mirrors[mirror - 1]].sphere->centre - camera.eye;
        const dvec3 forward = glm::normalize(camera.target - camera.eye),
                    right = glm::normalize(glm::cross(forward, camera.up)),
                    up = glm::cross(right, forward);
        const double scale = edge / 2 / std::tan(glm::radians(camera.vertical_fov_degrees) / 2) /
                             glm::dot(at, forward);
        return dvec2(edge / 2 + glm::dot(at, right) * scale, edge / 2 - glm::dot(at, up) * scale);
    };
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput& inputs, ViewState& state, ViewWindow&) {
        inputs.on_controls = false;
        inputs.mouse = pixel_of(frame <= 4 ? 3 : 4);
        inputs.down[0] = frame == 3 || frame == 6;
        if (frame == 5 && state.chosen != 0) state.plan.own[state.chosen] = {"raytrace", {}};
    };
    driver.after = [&](const ViewReport& report) {
        EXPECT_EQ(report.state.chosen, report.frame < 4   ? 0u
                                       : report.frame < 7 ? 3u
                                                          : 4u)
            << report.frame;
        if (report.frame < 8) return;
        EXPECT_THAT(report.command, HasSubstr("--plan '3=raytrace *=reuse:face=16'"));
    };
    EXPECT_EQ(run_view_in_test({"--technique", "reuse:face=16", "--size", "96x96", "--frames", "8"},
                               driver),
              0);
}

/// The test changes camera, knobs and time. Once frames stop changing, the command that the window
/// offers for copying renders the same bytes.
TEST_F(ViewPictureTest, CopiedCommandRendersThePictureShown) {
    std::string command;
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput& inputs, ViewState& state, ViewWindow&) {
        inputs.on_controls = false;
        inputs.mouse = {20. + static_cast<double>(frame), 30};
        inputs.down[0] = frame > 2 && frame < 9;
        inputs.wheel = frame == 10 ? 3 : 0;
        if (frame == 5) state.motion.time = .125;
        if (frame == 12) set(state.plan.rest, technique_info("secant")->knobs.front(), "3");
    };
    driver.after = [&](const ViewReport& report) { command = report.command; };
    EXPECT_EQ(run_view_in_test({"cornell-mirrors", "--technique", "secant:face=auto", "--size",
                                "80x64", "--mirror", "back*=.5", "--frames", "60", "--screenshot",
                                path_in_test_folder("shown.png")},
                               driver),
              0);
    ASSERT_TRUE(command.starts_with("catoptric render cornell-mirrors --mirror 'back*=.5' "))
        << command;
    const test::ProcessResult ended = test::run_process(
        {.command = {"/bin/sh", "-c", CATOPTRIC_CLI + command.substr(9)}, .folder = folder});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_TRUE(read_output_file("shown.png") == read_output_file("view.png")) << command;
}

/// When the user sets the roughness of a mirror, the next picture shows it, and the copied command
/// has an option for it.
TEST_F(ViewPictureTest, RoughnessOfAMirrorIsShownAndCopied) {
    std::string command;
    std::vector<int> passes;
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput& inputs, ViewState& state, ViewWindow&) {
        inputs.on_controls = false;
        state.judges = true;
        if (frame == 8) state.roughness = {{1, .1f}, {3, .2f}};
        if (frame == 12) state.roughness = {{1, .3f}};
    };
    driver.after = [&](const ViewReport& report) {
        command = report.command;
        passes.push_back(report.viewer.progressive_reference().pass_count());
    };
    EXPECT_EQ(
        run_view_in_test({"cornell-mirrors", "--technique", "parallax:face=32", "--size", "64x48",
                          "--frames", "40", "--screenshot", path_in_test_folder("shown.png")},
                         driver),
        0);
    EXPECT_GT(passes[6], 1);
    EXPECT_EQ(passes[7], 0) << "the reference begins again";
    EXPECT_GT(passes[38], 1);
    ASSERT_THAT(command, HasSubstr(" --mirror ball1=1,1,1,roughness=0.3 --technique "));
    const test::ProcessResult ended = test::run_process(
        {.command = {"/bin/sh", "-c", CATOPTRIC_CLI + command.substr(9)}, .folder = folder});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_TRUE(read_output_file("shown.png") == read_output_file("view.png")) << command;
}

/// Errors of rough mirrors are measured against ray tracing with their lobes, and not against sharp
/// mirrors.
TEST_F(ViewPictureTest, ReferenceOfRoughMirrorsIsRough) {
    double error = 0;
    SimulatedUser driver;
    driver.before = [&](std::size_t, UserInput& inputs, ViewState& state, ViewWindow&) {
        inputs.on_controls = false;
        state.judges = true;
    };
    driver.after = [&](const ViewReport& report) {
        if (report.viewer.measured_error()) error = report.viewer.measured_error()->rmse;
    };
    for (const auto& [technique, low, high] :
         {std::tuple("parallax:face=64", .001, .06), {"parallax:face=64,rough=none", .07, 1.}}) {
        EXPECT_EQ(run_view_in_test({"cornell-rough", "--technique", technique, "--size", "64x48",
                                    "--frames", "24"},
                                   driver),
                  0);
        EXPECT_GT(error, low) << technique;
        EXPECT_LT(error, high) << technique;
    }
}

/// A scene file that is dropped on the window is shown. A dropped file that is no scene only leads
/// to a message.
TEST_F(ViewPictureTest, DroppedSceneFileIsLoaded) {
    write_input_file("broken.glb", "no scene");
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput& inputs, ViewState&, ViewWindow&) {
        if (frame == 3) inputs.dropped = {path_in_test_folder("broken.glb")};
        if (frame == 5) inputs.dropped = {"flat"};
    };
    std::vector<std::string> said, scenes;
    std::string command;
    driver.after = [&](const ViewReport& report) {
        said.push_back(report.state.said);
        scenes.push_back(const_cast<SceneViewer&>(report.viewer).viewer_session().scene().name);
        command = report.command;
    };
    EXPECT_EQ(run_view_in_test({"--technique", "reuse:face=16", "--size", "32x32", "--frames", "6",
                                "--ambient", ".5", "--device", "0"},
                               driver),
              0);
    EXPECT_THAT(command, testing::StartsWith("catoptric render flat --device 0 --technique "))
        << "the wishes were for the scene before";
    ASSERT_GE(said.size(), 6u);
    EXPECT_THAT(said[2], HasSubstr("broken.glb"));
    EXPECT_EQ(scenes[3], "cornell-mirrors");
    EXPECT_EQ(said[4], "loaded: flat");
    EXPECT_EQ(scenes[4], "flat");
    // The plan names mirrors that do not exist in the dropped scene.
    EXPECT_EQ(run_view_in_test({"--plan", "ball1=reuse:face=16 *=secant:face=16", "--size", "32x32",
                                "--frames", "6"},
                               driver),
              0);
    EXPECT_EQ(scenes.back(), "flat");
}

} // namespace
