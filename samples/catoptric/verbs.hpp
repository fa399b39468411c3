#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

/// Each adds its verb. Parsing leaves in `run` what is to be done; that returns the exit code.
namespace catoptric::cli {

using Run = std::function<int()>;

/// `command`: the whole command line, for the record.
void add_compare(CLI::App& program, Run& run, std::vector<std::string> command);
void add_stress(CLI::App& program, Run& run, std::vector<std::string> command);
void add_render(CLI::App& program, Run& run);
void add_diff(CLI::App& program, Run& run);
void add_graph(CLI::App& program, Run& run);
void add_list(CLI::App& program, Run& run);
void add_info(CLI::App& program, Run& run);

} // namespace catoptric::cli
