// Tests of a window that is resized, minimised, closed or refused, loses its device, or runs for
// long. The validation layer must print no message, and memory must stay constant.
#include "view/settings.hpp"
#include "view/window.hpp"

#include "places.hpp"
#include "support/process.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <set>

namespace {

using namespace catoptric;
using namespace catoptric::view;
using testing::HasSubstr;

/// Returns the resident memory of this process in bytes.
std::uint64_t read_resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t all = 0, resident = 0;
    statm >> all >> resident;
    return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

class ViewLifetimeTest : public test::ViewWindowTest {};

/// Memory must not grow from frame to frame. A heap that grows in steps stays constant over some
/// fifty frames, but a leak of 1 kB per frame shows in every fifty frames. This test is the first
/// of the file, because memory that other tests free would hide a leak.
TEST_F(ViewLifetimeTest, MemoryStaysConstantOverFrames) {
    constexpr int kWindowFrames = 50;
    std::vector<std::uint64_t> resident, on_device;
    SimulatedUser driver;
    driver.after = [&](const ViewReport& report) {
        if (report.frame < 200 || report.frame % kWindowFrames != 0) return;
        resident.push_back(read_resident_bytes());
        on_device.push_back(session::Access::session_counters(
                                const_cast<SceneViewer&>(report.viewer).viewer_session())
                                .memory_bytes);
    };
    EXPECT_EQ(run_view_in_test({"--technique", "reuse:face=16,shadow_map=16", "--size", "32x32",
                                "--frames", "500", "--animate"},
                               driver),
              0);
    ASSERT_EQ(resident.size(), 7u);
    EXPECT_THAT(on_device, testing::Each(on_device.front()));
    std::int64_t least = 1 << 30;
    for (std::size_t i = 1; i < resident.size(); ++i)
        least = std::min(least, static_cast<std::int64_t>(resident[i] - resident[i - 1]));
    EXPECT_LT(least, kWindowFrames * 1024) << testing::PrintToString(resident);
}

TEST_F(ViewLifetimeTest, InvalidOptionsAndMissingDisplayAreRefused) {
    expect_view_refused({"--screenshot", path_in_test_folder("a.png")}, Failure::usage,
                        "--screenshot is of the last frame: wanted --frames N, found none");
    expect_view_refused({"--frames", "1", "--screenshot", path_in_test_folder("a.gif")},
                        Failure::usage,
                        "--screenshot: wanted a name ending in .exr or .png, found '");
    expect_view_refused({"--technique", "secand"}, Failure::usage, "did you mean 'secant'?");
    expect_view_refused({"--sise", "4x4"}, Failure::usage,
                        "'catoptric-view' has no option '--sise'");
    const std::string shown = std::getenv("DISPLAY");
    ::unsetenv("DISPLAY");
    expect_view_refused(
        {"--frames", "1"}, Failure::no_device,
        "no display: a window needs one (is DISPLAY set?); 'catoptric render' makes pictures");
    ::setenv("DISPLAY", shown.c_str(), 1);
}

/// The program answers signals from its first static initialiser on, before main begins.
TEST_F(ViewLifetimeTest, SignalsAreAnsweredFromTheFirstInitialiserOn) {
    constexpr std::array kTestedSignals{SIGHUP, SIGINT, SIGTERM};
    int answered = 0;
    for (int i = 0; i < 12; ++i) {
        test::ProcessStartOptions process{.command = {CATOPTRIC_VIEW},
                                          .environment = {{"LD_DEBUG", "files"}}};
        process.signal = kTestedSignals[static_cast<std::size_t>(i) % kTestedSignals.size()];
        process.signal_at = "transferring control";
        process.signal_after = std::chrono::milliseconds(4 * i);
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 128 + process.signal);
        answered += ended.err.find("catoptric-view: stopped by signal " +
                                   std::to_string(process.signal)) != std::string::npos;
    }
    EXPECT_GE(answered, 10); // the others came before the first initialiser
}

/// A signal ends the window soon, even while one frame is drawn that takes half a minute.
TEST_F(ViewLifetimeTest, SignalEndsTheWindowDuringALongFrame) {
    constexpr double kMaxSecondsAfterSignal = 4; // the window itself allows 2
    for (const int signal : {SIGTERM, SIGINT}) {
        test::ProcessStartOptions process{.command = {CATOPTRIC_VIEW, "cornell-mirrors", "-v",
                                                      "--technique", "raytrace:samples=1024",
                                                      "--size", "256x256"},
                                          .folder = folder};
        process.signal = signal;
        process.signal_at = "device: ";
        process.signal_after = std::chrono::milliseconds(2000);
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 128 + signal);
        EXPECT_THAT(ended.err, HasSubstr("catoptric-view: stopped by signal "));
        EXPECT_LE(ended.seconds_after_signal, kMaxSecondsAfterSignal);
    }
}

/// The window takes 20 sizes or more. During frames 30 to 33 the window is minimised, so its size
/// is 0.
TEST_F(ViewLifetimeTest, WindowIsResizedMinimisedAndClosed) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> sizes;
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput& inputs, ViewState& state,
                        ViewWindow& window) {
        if (frame % 3 == 1)
            window.resize({400 + 10 * static_cast<std::uint32_t>(frame),
                           60 + 2 * static_cast<std::uint32_t>(frame)});
        if (frame >= 30 && frame < 34) inputs.window = {0, 0};
        if (frame == 40) state.shows_panels = false;
        if (frame == 62) inputs.closes = true;
    };
    driver.after = [&](const ViewReport& report) {
        const uvec2 size = report.viewer.make_frame_spec().size;
        sizes.insert({size.x, size.y});
        EXPECT_LT(report.frame, 62u);
    };
    EXPECT_EQ(run_view_in_test({"--technique", "parallax:face=16,shadow_map=16", "--size", "48x48",
                                "--frames", "99"},
                               driver),
              0);
    EXPECT_GE(sizes.size(), 20u);
}

/// A plan for which the device lacks memory is chosen several times. Each time the window returns
/// to the previous plan and frees the images of the failed plan.
TEST_F(ViewLifetimeTest, PlanWithoutMemoryFallsBackToThePlanBefore) {
    int refused = 0;
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput&, ViewState& state, ViewWindow&) {
        if (!state.said.empty()) ++refused, state.said.clear();
        if (frame % 2 == 0 && refused < static_cast<int>(frame) / 2)
            state.plan = parse_plan("secant:face=16384");
    };
    driver.after = [&](const ViewReport& report) {
        EXPECT_EQ(technique_text(report.state.plan), "reuse:face=16");
    };
    EXPECT_EQ(run_view_in_test(
                  {"--technique", "reuse:face=16", "--size", "32x32", "--frames", "12"}, driver),
              0);
    EXPECT_EQ(refused, 6);
}

/// The next window restores the settings that the user chose. With `--frames`, settings are neither
/// read nor written.
TEST_F(ViewLifetimeTest, SettingsAreKeptForTheNextWindow) {
    const char* before = std::getenv("XDG_CONFIG_HOME");
    const std::string kept = before ? before : "";
    ::setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
    const Words words{"--technique", "reuse:face=16"};
    SimulatedUser driver;
    driver.before = [&](std::size_t frame, UserInput& inputs, ViewState& state,
                        ViewWindow& window) {
        if (frame == 1) window.resize({380, 50});
        state.gain = 32, state.motion.speed = -2, state.flies = true;
        if (frame > 2 && inputs.window == uvec2(380, 50)) inputs.closes = true;
    };
    EXPECT_EQ(run_view_in_test({"--technique", "reuse:face=16", "--size", "32x32"}, driver), 0);
    driver.before = [&](std::size_t frame, UserInput& inputs, ViewState& state, ViewWindow&) {
        EXPECT_EQ(inputs.window, uvec2(380, 50));
        EXPECT_EQ(state.gain, 32);
        EXPECT_EQ(state.motion.speed, -2);
        EXPECT_TRUE(state.flies);
        inputs.closes = frame == 2;
    };
    EXPECT_EQ(run_view_in_test(words, driver), 0);
    Words scripted = words;
    scripted.insert(scripted.end(), {"--frames", "1", "--size", "32x32"});
    driver.before = [&](std::size_t, UserInput&, ViewState& state, ViewWindow&) {
        EXPECT_EQ(state.gain, ViewState().gain);
        state.gain = 64;
    };
    EXPECT_EQ(run_view_in_test(scripted, driver), 0);
    EXPECT_EQ(load_settings(settings_file()).gain, 32);
    if (before)
        ::setenv("XDG_CONFIG_HOME", kept.c_str(), 1);
    else
        ::unsetenv("XDG_CONFIG_HOME");
}

/// Fixture for a window of 60 frames whose device or surface fails during or before these frames.
class ViewFaultTest : public ViewLifetimeTest {
protected:
    test::ProcessResult run_view_with_fault(const std::string& fault) const {
        test::ProcessStartOptions start{
            .command = {CATOPTRIC_VIEW},
            .environment = {{"VK_ADD_LAYER_PATH", CATOPTRIC_FAULTS_LAYER},
                            {"VK_INSTANCE_LAYERS", "VK_LAYER_CATOPTRIC_faults"},
                            {"CATOPTRIC_FAULT_REPORT", path_in_test_folder("calls")},
                            {"CATOPTRIC_FAULT", fault}},
            .folder = folder};
        start.command.insert(start.command.end(), words.begin(), words.end());
        start.command.insert(start.command.end(), {"--frames", "60", "--screenshot", "lost.png"});
        return test::run_process(start);
    }
    const Words words{"--technique", "reuse:face=32", "--size", "64x64"};
};

/// The device is lost in the middle of a frame. A new session keeps the user's state, and the
/// picture equals the picture of `render`.
TEST_F(ViewFaultTest, WindowGoesOnAfterALostDevice) {
    const test::ProcessResult ended = run_view_with_fault("vkQueueSubmit2:30:-4");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("VK_ERROR_DEVICE_LOST (-4); a new session is made"));
    expect_same_as_rendered("lost.png", words);
}

TEST_F(ViewFaultTest, WindowGoesOnAfterALostSurface) {
    const test::ProcessResult ended = run_view_with_fault("vkQueuePresentKHR:40:-1000000000");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("the window's surface was lost; a new session is made"));
    expect_same_as_rendered("lost.png", words);
}

TEST_F(ViewFaultTest, DeviceThatCannotPresentIsRefused) {
    const test::ProcessResult ended = run_view_with_fault(
        "vkGetPhysicalDeviceSurfaceSupportKHR:1:0");
    EXPECT_EQ(ended.exit_code, 69) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("no usable Vulkan device: '"));
    EXPECT_THAT(ended.err, HasSubstr("lacks a way to show pictures in this window"));
}

} // namespace
