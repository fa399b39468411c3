#pragma once

#include "command_line.hpp"

#include <string>
#include <vector>

/// Functions that each add one verb to the program.
namespace catoptric::cli {

/// `command` is the whole command line, which reports record.
void add_compare_verb(CommandLine& program, std::vector<std::string> command);
void add_choose_verb(CommandLine& program, std::vector<std::string> command);
void add_stress_verb(CommandLine& program, std::vector<std::string> command);
void add_bench_verb(CommandLine& program, std::vector<std::string> command);
void add_render_verb(CommandLine& program);
void add_diff_verb(CommandLine& program);
void add_graph_verb(CommandLine& program);
void add_list_verb(CommandLine& program);
void add_info_verb(CommandLine& program);
void add_views_verb(CommandLine& program);
void add_sweep_verb(CommandLine& program);
void add_results_verb(CommandLine& program);
/// Adds the verb `completion`. Add it last, because it completes only the verbs that were added
/// before.
void add_completion_verb(CommandLine& program);

} // namespace catoptric::cli
