// Tests of `catoptric completion`, which prints completion scripts for shells. tests/install/deb.sh
// runs the script for bash in a shell.
#include "cli/program.hpp"

#include <regex>
#include <set>

namespace {

using testing::HasSubstr;

TEST_F(CommandLineTest, CompletionsOfferEachOptionOfEachVerb) {
    const std::string bash = run_cli({"completion", "bash"}).out,
                      zsh = run_cli({"completion", "zsh"}).out,
                      fish = run_cli({"completion", "fish"}).out;
    for (const std::string verb : {"compare", "choose", "render", "stress", "bench", "diff",
                                   "graph", "list", "info", "views", "completion"}) {
        EXPECT_THAT(bash, HasSubstr("\n    " + verb + ")\n"));
        EXPECT_THAT(zsh, HasSubstr("\n        " + verb + ":'"));
        EXPECT_THAT(fish, HasSubstr("__fish_use_subcommand -a " + verb + " -d '"));
        const std::string help = run_cli({verb, "--help-all"}).out;
        const std::string of_bash = bash.substr(bash.find("\n    " + verb + ")\n"));
        const std::string words = of_bash.substr(0, of_bash.find(";;"));
        const std::regex names("\n  (?:-[a-zA-Z],)?(--[a-z-]+)");
        std::size_t count = 0;
        for (std::sregex_iterator at(help.begin(), help.end(), names), end; at != end; ++at) {
            const std::string name = (*at)[1];
            EXPECT_THAT(words,
                        testing::AnyOf(HasSubstr(" " + name + " "), HasSubstr("'" + name + " "),
                                       HasSubstr(" " + name + "'"), HasSubstr("'" + name + "'")))
                << verb;
            EXPECT_THAT(fish, HasSubstr("__fish_seen_subcommand_from " + verb + "' -l " +
                                        name.substr(2) + " "));
            ++count;
        }
        EXPECT_GE(count, 1U) << verb;
    }
    EXPECT_THAT(fish, HasSubstr("-l technique -r -f -a 'auto naive "));
    expect_usage_refused({"completion", "fsh"}, 2, {"bash, zsh, fish", "'fsh'"});
    expect_usage_refused({"completion"}, 2, {"SHELL"});
}

} // namespace
