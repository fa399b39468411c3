// catoptric VERB ...: one file a verb. Errors become exit codes here and nowhere else.
#include "app/engine.hpp"
#include "core/error.hpp"
#include "core/knob.hpp"
#include "output.hpp"
#include "parse.hpp"
#include "verbs.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <new>
#include <sstream>

namespace catoptric::cli {

namespace {

constexpr const char* kExamples = R"(Examples:
  catoptric compare -o out                     every technique against the reference
  catoptric render --technique parallax -o parallax.png
  catoptric diff a.exr b.exr --max-flip 0.01
  catoptric VERB --help                        options of a verb

Exit codes: 0 ok; 1 over a threshold; 2 usage; 65 bad input; 66 input missing; 69 no Vulkan device;
70 internal; 73 cannot create output; 74 I/O error; 75 out of memory or over a device limit;
76 device lost; 129, 130, 143 stopped by a signal (rows so far are kept, after 75 and 76 too))";

void say(const std::string& message) {
    if (!message.empty()) std::cerr << "catoptric: " << message << std::endl;
}

/// The first word is a verb, or asks for help or the version.
void check_verb(const CLI::App& program, const std::string& word) {
    std::vector<std::string> names;
    for (const CLI::App* verb : program.get_subcommands(nullptr)) names.push_back(verb->get_name());
    const std::vector<std::string> flags{"-h", "--help", "--version"};
    for (const auto& known : {names, flags})
        if (std::find(known.begin(), known.end(), word) != known.end()) return;
    fail(Failure::usage, "wanted a verb (", join(names), "), found '", word, "'",
         did_you_mean(word, word.starts_with('-') ? flags : names));
}

/// CLI11's own words, in ours.
void name_parts_of_help(CLI::App& program) {
    program.get_formatter()->label("SUBCOMMAND", "VERB");
    program.set_help_flag("-h,--help", "this text");
    for (CLI::App* verb : program.get_subcommands(nullptr)) {
        verb->group("Verbs");
        verb->set_help_flag("-h,--help", "this text");
    }
}

/// Help without runs of empty lines.
std::string tidy(std::string text) {
    for (std::size_t at; (at = text.find("\n\n\n")) != std::string::npos;) text.erase(at, 1);
    return text;
}

int run(int argc, char** argv) {
    CLI::App program("Measures what each way of rendering mirrors costs and gets wrong.",
                     "catoptric");
    program.require_subcommand(1);
    program.footer(kExamples);
    program.set_version_flag("--version",
                             "catoptric " + app::version() + " (" + app::commit() + ")");
    Run chosen;
    add_compare(program, chosen, {argv, argv + argc});
    add_render(program, chosen);
    add_stress(program, chosen, {argv, argv + argc});
    add_diff(program, chosen);
    add_graph(program, chosen);
    add_list(program, chosen);
    add_info(program, chosen);
    name_parts_of_help(program);
    if (argc < 2) {
        std::cerr << tidy(program.help()) << std::flush;
        return static_cast<int>(Failure::usage);
    }
    check_verb(program, argv[1]);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::ostringstream text, ignored;
        if (program.exit(error, text, ignored) == 0) { // help or version was asked for
            put(tidy(text.str()));
            return 0;
        }
        fail(Failure::usage, error.what(), " (try 'catoptric ", argv[1], " --help')");
    }
    return chosen();
}

/// Runs, and says on stderr what went wrong.
int exit_code(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const Error& error) {
        say(error.what());
        return static_cast<int>(error.failure);
    } catch (const std::bad_alloc&) {
        say("out of memory");
        return static_cast<int>(Failure::exhausted);
    } catch (const std::exception& error) {
        say(std::string("internal error: ") + error.what());
        return static_cast<int>(Failure::internal);
    }
}

} // namespace

} // namespace catoptric::cli

int main(int argc, char** argv) {
    using namespace catoptric;
    cli::prepare_streams();
    const int code = cli::exit_code(argc, argv);
    if (app::any_abandoned()) std::_Exit(code); // nothing is taken down under a driver at work
    return code;
}
