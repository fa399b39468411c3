#include "report/tables.hpp"
#include "report/text.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace catoptric::report {

namespace {

std::string share(double part, double whole) {
    return whole > 0 ? fmt::format("{:.1f}", 100 * part / whole) : std::string(kNothing);
}

/// The row's causes as `goes` tells them.
std::vector<std::string> line(const std::string& name, const Causes& causes, double Cause::*goes) {
    std::vector<std::string> cells{name};
    for (const Cause& cause : causes.list)
        cells.push_back(share(cause.*goes, causes.squared_error));
    return cells;
}

} // namespace

Table cause_table(const Comparison& comparison) {
    Table table{"Error by cause",
                {{"Row", false}},
                {},
                {},
                "Share of a row's squared error over the mirrors, in %, that goes when one thing "
                "is replaced by the "
                "reference's own: in turn, from left to right, and below it each alone. Between "
                "the two lies what "
                "causes do together; a negative share uncovers another's error. storage format: "
                "distances as 32-bit "
                "floats; stored distance: exact ones; search direction: where the ray really ends; "
                "hidden target: what "
                "the capture's centre does not see; texels: the captured surface at the very "
                "point; mirror in mirror, "
                "own reflection: what other mirrors and the mirror itself show there; last frame: "
                "history of this "
                "instant; shadow map: shadow rays; silhouettes: pixels where rasteriser and ray "
                "see different mirrors. "
                "Left: the rmse when all is replaced; near 0, no cause is missing. At light edges: "
                "share of the squared "
                "error in pixels that looked within a texel of a light's outline."};
    const auto split = std::ranges::find_if(comparison.rows,
                                            [](const Row& row) { return row.causes.has_value(); });
    if (split == comparison.rows.end()) return table;
    for (const Cause& cause : split->causes->list) table.columns.push_back({cause.name});
    table.columns.push_back({"Left"});
    table.columns.push_back({"At light edges"});
    for (const Row& row : comparison.rows) {
        if (!row.causes) continue;
        const Causes& causes = *row.causes;
        table.rows.push_back(line(row.label, causes, &Cause::in_turn));
        table.rows.back().push_back(fmt::format("{:.1e}", causes.rest_rmse));
        table.rows.back().push_back(fmt::format("{:.1f}", 100 * causes.at_light_edges));
        table.rows.push_back(line("alone", causes, &Cause::alone));
        table.rows.back().resize(table.columns.size());
    }
    return table;
}

} // namespace catoptric::report
