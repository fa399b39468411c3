#pragma once

#include "command_line.hpp"

#include <string>
#include <vector>

/// Functions that each add one verb to the program.
namespace catoptric::cli {

/// `command` is the whole command line, which reports record.
void add_compare(CommandLine& program, std::vector<std::string> command);
void add_stress(CommandLine& program, std::vector<std::string> command);
void add_bench(CommandLine& program, std::vector<std::string> command);
void add_render(CommandLine& program);
void add_diff(CommandLine& program);
void add_graph(CommandLine& program);
void add_list(CommandLine& program);
void add_info(CommandLine& program);

} // namespace catoptric::cli
