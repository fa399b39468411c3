#pragma once

#include "command_line.hpp"

#include <string>
#include <vector>

/// Each adds its verb.
namespace catoptric::cli {

/// `command`: the whole command line, for the record.
void add_compare(CommandLine& program, std::vector<std::string> command);
void add_stress(CommandLine& program, std::vector<std::string> command);
void add_bench(CommandLine& program, std::vector<std::string> command);
void add_render(CommandLine& program);
void add_diff(CommandLine& program);
void add_graph(CommandLine& program);
void add_list(CommandLine& program);
void add_info(CommandLine& program);

} // namespace catoptric::cli
