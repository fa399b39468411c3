#pragma once

#include "cli/program.hpp"
#include "core/error.hpp"
#include "view/display.hpp"
#include "view/loop.hpp"

/// Fixture for tests that open a window.
namespace test {

using namespace catoptric;
using namespace catoptric::view;

class WindowTest : public Cli {
protected:
    static void SetUpTestSuite() { display = std::make_unique<test::Display>(); }
    static void TearDownTestSuite() { display.reset(); }
    void SetUp() override {
        ASSERT_TRUE(display->is_there()) << "Xvfb does not start: apt-get install xvfb";
        Cli::SetUp();
    }

    /// Runs the window program with the given command line and the validation layer. Returns its
    /// exit code.
    static int view(Words words, const TestDriver& driver = {}) {
        words.insert(words.end(), {"--validate", "-q"});
        ViewOptions options;
        parse_view_command(words, [&](const ViewOptions& parsed) {
            options = parsed;
            return 0;
        })();
        return run_view_window(options, driver);
    }
    std::string path(const std::string& name) const { return (folder / name).string(); }
    void expect_rendered(const std::string& picture, Words words) const {
        words.insert(words.begin(), "render");
        words.insert(words.end(), {"-o", "rendered" + picture.substr(picture.rfind('.'))});
        const test::ProcessResult ended = cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_TRUE(read(picture) == read("rendered" + picture.substr(picture.rfind('.'))));
    }

    static inline std::unique_ptr<test::Display> display;
};

} // namespace test
