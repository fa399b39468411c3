#pragma once

#include "report/comparison.hpp"

#include <string>
#include <vector>

// The report's tables as text, before Markdown or HTML gives them a look.
namespace catoptric::report {

struct Column {
    std::string name;
    bool is_number = true; ///< right-aligned
};

struct Table {
    std::string title;
    std::vector<Column> columns;
    std::vector<std::vector<std::string>> rows;
    std::vector<bool> marked; ///< rows to stand out; empty or one entry a row
    std::string note;         ///< what the columns mean; may be empty
};

/// Under its title, a pipe table whose columns line up as plain text, too; empty without rows.
std::string to_markdown(const Table& table);

/// The seed report's Table 1 beside what was measured here.
Table seed_table(const Comparison& comparison);
/// Every row, every figure; the rows on the Pareto front are marked.
Table rows_table(const Comparison& comparison);
/// What draws each mirror, for rows that are plans; no rows when none is.
Table plan_table(const Comparison& comparison);
/// FLIP by mirror.
Table mirror_table(const Comparison& comparison);
/// Where mirrors looked, for rows that search; no rows when none does.
Table lookup_table(const Comparison& comparison);
/// What of the scene is not shown as its file says; no rows where all is.
Table unsupported_table(const SceneFacts& scene);
/// What is done instead; empty for an id that is not known.
std::string gap_in_words(const std::string& id);
/// Error by cause, four lines a row; no rows when nothing was split.
Table cause_table(const Comparison& comparison);

/// What was measured where: name and value.
struct Fact {
    std::string name;
    std::string value;
};
std::vector<Fact> facts(const Comparison& comparison);
/// What was needed once, in a line; stands above the rows.
std::string setup_text(const SetupFacts& setup);
/// What to keep in mind while reading: a processor as device, a run cut short, rows together,
/// warnings.
std::vector<std::string> cautions(const Comparison& comparison);

} // namespace catoptric::report
