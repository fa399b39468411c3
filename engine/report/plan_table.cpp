// Table of which technique draws which mirror, for rows that are plans.
#include "report/tables.hpp"
#include "report/text.hpp"

namespace catoptric::report {

namespace {

/// Returns the technique as the user would write it. Knobs with default values are left out.
std::string technique_text(const PlanEntry& entry) {
    std::vector<std::string> changed;
    for (const Setting& setting : entry.settings)
        if (setting.changed) changed.push_back(setting.name + "=" + setting.text);
    return entry.technique + (changed.empty() ? "" : ":" + joined(changed, ","));
}

} // namespace

Table plan_table(const Comparison& comparison) {
    Table table{"Mirror by mirror, what draws it",
                {{"Row", false}, {"Mirror"}, {"Name", false}, {"Technique", false}, {"Why", false}},
                {},
                {},
                "Rows that are plans. Each of their mirrors has its own technique; the error of "
                "such a row is not split by cause."};
    for (const Row& row : comparison.rows) {
        if (row.technique != "plan") continue;
        for (const PlanEntry& entry : row.plan)
            table.rows.push_back({row.label, std::to_string(entry.mirror), entry.name,
                                  technique_text(entry), entry.why});
    }
    return table;
}

} // namespace catoptric::report
