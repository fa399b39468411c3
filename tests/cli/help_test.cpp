// Tests of the output of `catoptric help`, `--version` and `list`.
#include "cli/program.hpp"

#include <algorithm>
#include <regex>
#include <set>
#include <span>
#include <sstream>

namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> kProgramVerbs{"compare", "render", "stress", "bench", "diff",
                                             "graph",   "list",   "info",   "views", "choose"};

std::vector<std::string> split_into_lines(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST_F(CommandLineTest, HelpFitsEightyColumns) {
    std::vector<Words> asked{{"--help"}};
    for (const std::string& verb : kProgramVerbs)
        asked.push_back({verb, "--help"}), asked.push_back({verb, "--help-all"});
    for (const Words& words : asked)
        for (const std::string& line : split_into_lines(run_cli(words).out))
            EXPECT_LE(line.size(), 80U) << words.front() << ": " << line;
}

/// Returns the lines of a help that begin with an option.
std::string find_option_lines(const std::string& help) {
    std::string lines;
    for (const std::string& line : split_into_lines(help))
        if (line.starts_with("  -")) lines += line.substr(0, line.find("  ", 2)) + "\n";
    return lines;
}

/// Returns the names of all options in a text, such as "--size".
std::set<std::string> find_option_names(const std::string& text) {
    const std::regex name("--[a-z]+(-[a-z]+)*");
    std::set<std::string> names;
    for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at)
        names.insert(at->str());
    return names;
}

/// The help of a verb with many options describes the common ones, and names all.
TEST_F(CommandLineTest, HelpFitsEightyLinesAndNamesAllOptions) {
    for (const std::string& verb : kProgramVerbs) {
        const std::string help = run_cli({verb, "--help"}).out,
                          all = run_cli({verb, "--help-all"}).out;
        EXPECT_LE(split_into_lines(help).size(), 80U) << verb;
        EXPECT_THAT(find_option_names(help),
                    testing::IsSupersetOf(find_option_names(find_option_lines(all))))
            << verb;
        EXPECT_GE(all.size(), help.size()) << verb;
        EXPECT_THAT(help, HasSubstr("catoptric " + verb)) << "examples of " << verb;
    }
    EXPECT_THAT(run_cli({"compare", "--help"}).out, Not(HasSubstr("largest roughness")));
    EXPECT_THAT(run_cli({"compare", "--help-all"}).out, HasSubstr("largest roughness"));
}

TEST_F(CommandLineTest, HelpNamesOptionsByLowerCaseWords) {
    const std::regex option("(^|[ ,])(--[^ ,=\\]\\[]*)"), name("--[a-z0-9]+(-[a-z0-9]+)*");
    int options = 0;
    for (const std::string& verb : kProgramVerbs)
        for (const std::string& line : split_into_lines(run_cli({verb, "--help-all"}).out)) {
            std::smatch found;
            if (!line.starts_with("  -") || !std::regex_search(line, found, option)) continue;
            EXPECT_TRUE(std::regex_match(found[2].str(), name)) << verb << ": " << line;
            ++options;
        }
    EXPECT_GT(options, 50);
}

TEST_F(CommandLineTest, ExamplesOfTheHelpAreCommands) {
    int examples = 0;
    for (const std::string& verb : kProgramVerbs) {
        const std::vector<std::string> lines = split_into_lines(run_cli({verb, "--help"}).out);
        const auto begin = std::ranges::find(lines, "Examples:");
        if (begin == lines.end()) continue;
        for (const std::string& line : std::span(begin + 1, std::find(begin, lines.end(), ""))) {
            EXPECT_THAT(line, testing::StartsWith("  catoptric ")) << verb;
            ++examples;
        }
    }
    EXPECT_GT(examples, 10);
}

TEST_F(CommandLineTest, HelpShowsCommonOptionsFirst) {
    for (const std::string verb : {"compare", "render"}) {
        const std::string help = run_cli({verb, "--help-all"}).out;
        const std::size_t common = help.find("Common options:"), scene = help.find("The scene:");
        ASSERT_NE(common, std::string::npos) << help;
        ASSERT_NE(scene, std::string::npos) << help;
        for (const char* option : {"--output", "--technique", "--size", "--camera"}) {
            EXPECT_GT(help.find(option, common), common) << option;
            EXPECT_LT(help.find(option, common), scene) << option;
        }
        for (const char* heading : {"Frames, times and errors:", "Device:", "Output:"})
            EXPECT_GT(help.find(heading), common) << heading;
    }
}

TEST_F(CommandLineTest, HelpVerbPrintsTheTextOfTheHelpOption) {
    EXPECT_EQ(run_cli({"help"}).out, run_cli({"--help"}).out);
    for (const std::string& verb : kProgramVerbs) {
        const test::ProcessResult ended = run_cli({"help", verb});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_EQ(ended.out, run_cli({verb, "--help"}).out);
    }
    expect_usage_refused({"help", "rendr"}, 2, {"'rendr'", "did you mean 'render'"});
    expect_usage_refused({"help", "list", "render"}, 2, {"at most one verb", "'render'"});
}

TEST_F(CommandLineTest, ShortVersionFlagPrintsTheVersion) {
    EXPECT_EQ(run_cli({"-V"}).out, run_cli({"--version"}).out);
    EXPECT_THAT(run_cli({"-V"}).out, testing::StartsWith("catoptric "));
}

TEST_F(CommandLineTest, ListOfTechniquesHasOneLinePerTechnique) {
    const std::string text = run_cli({"list", "techniques"}).out;
    EXPECT_THAT(text, HasSubstr("\nparallax "));
    EXPECT_THAT(text, HasSubstr("\nauto "));
    EXPECT_THAT(text, Not(HasSubstr("shadow_map")));
    EXPECT_LE(split_into_lines(text).size(), 16U);
}

TEST_F(CommandLineTest, ListOfOneTechniqueShowsItsKnobs) {
    const std::string text = run_cli({"list", "techniques", "parallax"}).out;
    EXPECT_THAT(text, testing::StartsWith("parallax "));
    EXPECT_THAT(text, HasSubstr("shadow_map"));
    EXPECT_THAT(text, Not(HasSubstr("hybrid ")));
    const auto listed = nlohmann::json::parse(
        run_cli({"list", "techniques", "march", "--json"}).out);
    ASSERT_EQ(listed["techniques"].size(), 1U);
    EXPECT_EQ(listed["techniques"][0]["name"], "march");
    EXPECT_THAT(run_cli({"list", "techniques", "auto"}).out, testing::StartsWith("auto "));
    expect_usage_refused({"list", "techniques", "parralax"}, 2,
                         {"'parralax'", "did you mean 'parallax'"});
    expect_usage_refused({"list", "scenes", "parallax"}, 2, {"list scenes", "'parallax'"});
}

} // namespace
