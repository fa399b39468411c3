#pragma once

#include "report/comparison.hpp"

#include <string>
#include <vector>

// Tables of the report as text, before they become Markdown or HTML.
namespace catoptric::report {

struct Column {
    std::string name;
    bool is_number = true; ///< right-aligned
};

struct Table {
    std::string title;
    std::vector<Column> columns;
    std::vector<std::vector<std::string>> rows;
    std::vector<bool> marked; ///< rows to highlight; empty or one entry a row
    std::string note;         ///< meaning of the columns; may be empty
};

/// Returns a pipe table under its title. Its columns also line up as plain text. Empty if the table
/// has no rows.
std::string to_markdown(const Table& table);

/// Returns the seed report's Table 1 beside our measurements.
Table seed_table(const Comparison& comparison);
/// Returns the table of all rows with all its metrics. Rows on the Pareto front are marked.
Table rows_table(const Comparison& comparison);
/// Returns the technique of each mirror, for rows that are plans. Without such rows the table is
/// empty.
Table plan_table(const Comparison& comparison);
/// Returns FLIP of each mirror.
Table mirror_table(const Comparison& comparison);
/// Returns the errors of looked-up directions, for rows that search. Without such rows the table is
/// empty.
Table lookup_table(const Comparison& comparison);
/// Returns the unsupported features of the scene. Empty if there are none.
Table unsupported_table(const SceneFacts& scene);
/// Returns what is done instead of a feature. Empty for an unknown id.
std::string gap_in_words(const std::string& id);
/// Returns the error by cause with four lines a row. Empty if no row has causes.
Table cause_table(const Comparison& comparison);

/// Fact about the run: name and value.
struct Fact {
    std::string name;
    std::string value;
};
std::vector<Fact> facts(const Comparison& comparison);
/// Returns the set-up costs in one line, which stands above the rows.
std::string setup_text(const SetupFacts& setup);
/// Returns cautions for the reader: a processor as device, a run cut short, rows measured together,
/// warnings.
std::vector<std::string> cautions(const Comparison& comparison);

} // namespace catoptric::report
