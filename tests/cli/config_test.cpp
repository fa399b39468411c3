// Tests of config.json, the user's file of default options.
#include "cli/program.hpp"

namespace {

class ConfigFileTest : public CommandLineTest {
protected:
    /// Runs the program in an environment whose config.json contains `text`.
    test::ProcessResult run_with_config(const std::string& text, const Words& words) const {
        std::filesystem::create_directories(folder / "home" / "catoptric");
        write_input_file("home/catoptric/config.json", text);
        test::ProcessStartOptions start = make_process_start(words);
        start.environment["XDG_CONFIG_HOME"] = (folder / "home").string();
        return test::run_process(start);
    }
    nlohmann::json render_with_config(const std::string& text, Words words) const {
        words.insert(words.end(), {"--frames", "1", "--warmup", "0", "--json", "-o", "x.png"});
        const test::ProcessResult ended = run_with_config(text, words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return nlohmann::json::parse(ended.out, nullptr, false);
    }
};

TEST_F(ConfigFileTest, SetsOptionsThatTheCommandLineDoesNot) {
    const auto size = [](const nlohmann::json& report) { return report["size"]; };
    const nlohmann::json small = {24, 16}, large = {32, 20};
    const std::string both = R"({"size": "24x16", "render": {"technique": "raytrace"}})";
    const nlohmann::json report = render_with_config(both, {"render", "flat"});
    EXPECT_EQ(size(report), small);
    EXPECT_EQ(report["technique"], "raytrace") << report;
    EXPECT_EQ(size(render_with_config(both, {"render", "flat", "--size", "32x20"})), large);
    EXPECT_EQ(size(render_with_config(both, {"render", "flat", "--size=32x20"})), large);
    EXPECT_EQ(size(render_with_config(R"({"size": "9x9", "render": {"size": "24x16"}})",
                                      {"render", "flat", "--technique", "raytrace"})),
              small)
        << "the verb's own value wins";
    EXPECT_NE(size(render_with_config(
                  both, {"render", "flat", "--no-config", "--technique", "raytrace"})),
              small);
    EXPECT_EQ(run_with_config(both, {"list", "scenes"}).exit_code, 0) << "a verb without --size";
}

TEST_F(ConfigFileTest, ListsAndFlagsAreOptions) {
    const test::ProcessResult ended = run_with_config(
        R"({"compare": {"techniques": ["reuse:face=8", "raytrace"], "frames": 6, "warmup": 1,
            "size": "16x16", "json": true, "quiet": true, "verbose": false}})",
        {"compare", "flat", "-o", "out"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const nlohmann::json report = nlohmann::json::parse(ended.out);
    EXPECT_EQ(report["rows"].size(), 2u);
    EXPECT_THAT(report["command"].dump(), testing::HasSubstr("reuse:face=8"))
        << "the report records what was asked for";
}

TEST_F(ConfigFileTest, ErrorsNameFileMemberAndWhatIsWanted) {
    const Words words{"list", "scenes"};
    const auto refused = [&](const std::string& text, const Words& parts) {
        expect_exit_code(run_with_config(text, words), 65, parts);
    };
    refused("{", {"config.json"});
    refused("[1]", {"config.json: wanted an object, found [1]"});
    refused(R"({"sise": "9x9"})", {"'sise': wanted the name of a verb", "did you mean 'size'"});
    refused(R"({"render": 3})", {"'render': wanted an object, found 3"});
    refused(R"({"render": {"techniqe": "reuse"}})",
            {"'render'", "found 'techniqe'", "did you mean 'technique'"});
    refused(R"({"list": {"json": "yes"}})", {"'json': wanted true or false, found \"yes\""});
    expect_exit_code(run_with_config(R"({"size": {}})", {"render", "flat", "-o", "x.png"}), 65,
                     {"'size': wanted a text, a number or a list of them, found {}"});
}

} // namespace
