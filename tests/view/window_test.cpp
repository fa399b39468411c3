// The window under an X server without a screen: its pictures are those of `catoptric render`,
// whatever is done to it leaves no message of the validation layer, and memory stays what it was.
#include "cli/program.hpp"
#include "core/error.hpp"
#include "view/display.hpp"
#include "view/loop.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <fstream>

namespace {

using namespace catoptric;
using namespace catoptric::view;
using testing::HasSubstr;

/// Resident memory of this process, bytes.
std::uint64_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t all = 0, resident = 0;
    statm >> all >> resident;
    return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

class WindowTest : public Cli {
protected:
    static void SetUpTestSuite() { display = std::make_unique<test::Display>(); }
    static void TearDownTestSuite() { display.reset(); }
    void SetUp() override {
        ASSERT_TRUE(display->is_there()) << "Xvfb does not start: apt-get install xvfb";
        Cli::SetUp();
    }

    /// Validated; with these words of the command line.
    static int view(Words words, const Driver& driver = {}) {
        words.insert(words.end(), {"--validate", "-q"});
        Options options;
        parse(words, [&](const Options& parsed) {
            options = parsed;
            return 0;
        })();
        return run(options, driver);
    }
    std::string path(const std::string& name) const { return (folder / name).string(); }
    void expect_rendered(const std::string& picture, Words words) const {
        words.insert(words.begin(), "render");
        words.insert(words.end(), {"-o", "rendered" + picture.substr(picture.rfind('.'))});
        const test::Ended ended = cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_TRUE(read(picture) == read("rendered" + picture.substr(picture.rfind('.'))));
    }

    static std::unique_ptr<test::Display> display;
};
std::unique_ptr<test::Display> WindowTest::display;

TEST_F(WindowTest, ItsPictureIsThatOfRender) {
    const Words words{"--technique", "reuse:face=32", "--size", "64x48", "--frames",
                      "3",           "--animate"};
    for (const std::string name : {"a.png", "a.exr"}) {
        Words with = words;
        with.insert(with.end(), {"--screenshot", path(name)});
        EXPECT_EQ(view(with), 0);
        Words without = words;
        without.insert(without.end(), {"--warmup", "0"});
        expect_rendered(name, without);
    }
}

TEST_F(WindowTest, RefusesWhatItCannotDo) {
    const auto refused = [&](const Words& words, Failure failure, const std::string& text) {
        try {
            view(words);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, failure);
            EXPECT_THAT(error.what(), HasSubstr(text));
        }
    };
    refused({"--screenshot", path("a.png")}, Failure::usage,
            "--screenshot is of the last frame: wanted --frames N, found none");
    refused({"--frames", "1", "--screenshot", path("a.gif")}, Failure::usage,
            "--screenshot: wanted a name ending in .exr or .png, found '");
    refused({"--technique", "secand"}, Failure::usage, "did you mean 'secant'?");
    refused({"--sise", "4x4"}, Failure::usage, "'catoptric-view' has no option '--sise'");
    const std::string shown = std::getenv("DISPLAY");
    ::unsetenv("DISPLAY");
    refused({"--frames", "1"}, Failure::no_device,
            "no display: a window needs one (is DISPLAY set?); 'catoptric render' makes pictures");
    ::setenv("DISPLAY", shown.c_str(), 1);
}

/// Sizes that the window has taken, and whether it was hidden meanwhile.
TEST_F(WindowTest, IsResizedMinimisedAndClosed) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> sizes;
    Driver driver;
    driver.before = [&](std::size_t frame, Inputs& inputs, State& state, Window& window) {
        if (frame % 3 == 1)
            window.resize({400 + 10 * static_cast<std::uint32_t>(frame),
                           60 + 2 * static_cast<std::uint32_t>(frame)});
        if (frame >= 30 && frame < 34) inputs.window = {0, 0};
        if (frame == 40) state.shows_panels = false;
        if (frame == 62) inputs.closes = true;
    };
    driver.after = [&](const Report& report) {
        const uvec2 size = report.viewer.spec().size;
        sizes.insert({size.x, size.y});
        EXPECT_LT(report.frame, 62u);
    };
    EXPECT_EQ(
        view({"--technique", "parallax:face=16,shadow_map=16", "--size", "48x48", "--frames", "99"},
             driver),
        0);
    EXPECT_GE(sizes.size(), 20u);
}

/// Memory that frames took once is taken no more.
TEST_F(WindowTest, MemoryStaysFlat) {
    std::uint64_t early = 0, late = 0, device_early = 0, device_late = 0;
    Driver driver;
    driver.after = [&](const Report& report) {
        const auto bytes = [&] {
            return const_cast<Viewer&>(report.viewer).session().counts().memory_bytes;
        };
        if (report.frame == 100) early = resident_bytes(), device_early = bytes();
        if (report.frame == 2000) late = resident_bytes(), device_late = bytes();
        if (report.frame % 200 == 0)
            for (const Line& line : report.viewer.times().host())
                std::printf("  frame %zu: %s %.3f ms\n", report.frame, line.name.c_str(),
                            line.median);
    };
    EXPECT_EQ(view({"--technique", "reuse:face=16,shadow_map=16", "--size", "32x32", "--frames",
                    "2000", "--animate"},
                   driver),
              0);
    EXPECT_EQ(device_early, device_late);
    EXPECT_LT(late, early + (4U << 20)) << early << " bytes after 100 frames";
}

} // namespace
