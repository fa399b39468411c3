// The program `catoptric VERB ...`, with one file per verb. Only this file turns errors into exit
// codes.
#include "program.hpp"

#include "config_file.hpp"
#include "core/error.hpp"
#include "output.hpp"
#include "session/engine.hpp"
#include "verbs.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>

namespace catoptric::cli {

namespace {

constexpr const char* kProgramExamples = R"(Examples:
  catoptric compare -o out                     every technique, in one table
  catoptric render --technique parallax -o parallax.png
  catoptric diff a.exr b.exr --max-flip 0.01
  catoptric help VERB                          options of a verb

Defaults of options: ~/.config/catoptric/config.json, such as {"size": "256x256",
"compare": {"techniques": ["reuse", "secant"]}}; --no-config leaves it out.

Exit codes: 0 ok; 1 over a threshold; 2 usage; 65 bad input; 66 input missing; 69 no Vulkan device;
70 internal; 73 cannot create output; 74 I/O error; 75 out of memory or over a device limit;
76 device lost; 129, 130, 143 stopped by a signal (finished rows are kept, also after 75 and 76))";

void print_failure(const std::string& name, const std::string& message) {
    if (!message.empty()) print_message(name + ": " + message);
}

/// `command`: the whole command line, which reports record.
void add_all_verbs(CommandLine& program, const std::vector<std::string>& command) {
    add_compare_verb(program, command);
    add_choose_verb(program, command);
    add_render_verb(program);
    add_stress_verb(program, command);
    add_bench_verb(program, command);
    add_diff_verb(program);
    add_graph_verb(program);
    add_list_verb(program);
    add_info_verb(program);
    add_views_verb(program);
    add_sweep_verb(program);
    add_results_verb(program);
    add_completion_verb(program);
}

int run_checked(int argc, char** argv) {
    std::vector<std::string> command(argv, argv + argc);
    const auto make_program = [] {
        return std::make_unique<CommandLine>(
            "catoptric", "Measures the cost and the error of each way of rendering reflections.",
            "catoptric " + session::version() + " (" + session::commit() + ")", kProgramExamples);
    };
    const std::unique_ptr<CommandLine> known = make_program();
    add_all_verbs(*known, command);
    std::vector<std::string> words = add_config_options(
        {command.begin() + std::min(argc, 1), command.end()}, known->completion_verbs());
    command.resize(static_cast<std::size_t>(std::min(argc, 1)));
    command.insert(command.end(), words.begin(), words.end());
    const std::unique_ptr<CommandLine> program = make_program();
    add_all_verbs(*program, command);
    return program->parse(std::move(words))();
}

/// Prints errors of the work to stderr.
int exit_code_of(const std::string& name, const std::function<int()>& work) {
    try {
        return work();
    } catch (const Error& error) {
        print_failure(name, error.what());
        return static_cast<int>(error.failure);
    } catch (const std::bad_alloc&) {
        print_failure(name, "out of memory");
        return static_cast<int>(Failure::exhausted);
    } catch (const std::exception& error) {
        print_failure(name, std::string("internal error: ") + error.what());
        return static_cast<int>(Failure::internal);
    }
}

} // namespace

int run_catching(const std::string& name, const std::function<int()>& work) {
    prepare_streams();
    const int code = exit_code_of(name, work);
    if (session::has_abandoned_device())
        std::_Exit(code); // destroying objects that a driver still uses is unsafe
    return code;
}

int run_program(int argc, char** argv) {
    return run_catching("catoptric", [&] { return run_checked(argc, argv); });
}

} // namespace catoptric::cli
