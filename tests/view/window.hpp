#pragma once

#include "cli/program.hpp"
#include "core/error.hpp"
#include "view/display.hpp"
#include "view/loop.hpp"

/// Fixture for tests that open a window.
namespace test {

using namespace catoptric;
using namespace catoptric::view;

class ViewWindowTest : public CommandLineTest {
protected:
    static void SetUpTestSuite() { display = std::make_unique<test::VirtualDisplay>(); }
    static void TearDownTestSuite() { display.reset(); }
    void SetUp() override {
        ASSERT_TRUE(display->is_display_running()) << "Xvfb does not start: apt-get install xvfb";
        CommandLineTest::SetUp();
    }

    /// Runs the window program with the given command line and the validation layer. Returns its
    /// exit code.
    static int run_view_in_test(Words words, const SimulatedUser& driver = {}) {
        words.insert(words.end(), {"--validate", "-q"});
        ViewOptions options;
        parse_view_command(words, [&](const ViewOptions& parsed) {
            options = parsed;
            return 0;
        })();
        return run_window(options, driver);
    }
    /// Expects that the window program refuses the command line with this failure and text.
    static void expect_view_refused(const Words& words, Failure failure, const std::string& text) {
        try {
            run_view_in_test(words);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, failure);
            EXPECT_THAT(error.what(), testing::HasSubstr(text));
        }
    }
    std::string path_in_test_folder(const std::string& name) const {
        return (folder / name).string();
    }
    void expect_same_as_rendered(const std::string& picture, Words words) const {
        words.insert(words.begin(), "render");
        words.insert(words.end(), {"-o", "rendered" + picture.substr(picture.rfind('.'))});
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_TRUE(read_output_file(picture) ==
                    read_output_file("rendered" + picture.substr(picture.rfind('.'))));
    }

    static inline std::unique_ptr<test::VirtualDisplay> display;
};

} // namespace test
