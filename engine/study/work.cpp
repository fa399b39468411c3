// The study `work`: counts the work of one frame of each row.
#include "study/work.hpp"

#include "measure/work.hpp"
#include "report/text.hpp"
#include "session/access.hpp"
#include "session/watcher.hpp"
#include "session/work.hpp"

#include <algorithm>

namespace catoptric::study {

namespace {

using report::ReportTable;

/// Returns the table of the counts of each row. Kinds that no row has are left out.
std::vector<ReportTable> make_work_tables(const report::Comparison& comparison) {
    ReportTable table{"Work of one frame", {report::text_column("row")}, "", {}, {}};
    std::vector<std::size_t> kinds;
    for (std::size_t kind = 0; kind < kWorkKindCount; ++kind)
        for (const report::Row& row : comparison.rows)
            if (measure::total_work(row).values[kind].value_or(0) > 0) {
                kinds.push_back(kind);
                break;
            }
    for (const std::size_t kind : kinds) {
        table.columns.emplace_back(std::string(kWorkKinds[kind].name));
        table.note += (table.note.empty() ? "" : "; ") + std::string(kWorkKinds[kind].name) + ": " +
                      std::string(kWorkKinds[kind].help);
    }
    for (const report::Row& row : comparison.rows) {
        if (!measure::has_counted_work(row)) continue;
        const WorkCounts counts = measure::total_work(row);
        std::vector<std::string> cells{row.label};
        for (const std::size_t kind : kinds)
            cells.push_back(counts.values[kind] ? std::to_string(*counts.values[kind])
                                                : std::string(report::kEmptyCell));
        table.rows.push_back(std::move(cells));
    }
    return {table};
}

const RegisteredStudy kWorkStudy{
    {.name = "work",
     .help = "also count the work of one frame of each row: rays, BVH nodes, look-ups, fragments, "
             "vertices, draws, bytes",
     .order = 40,
     .run = count_work,
     .metrics = measure::work_metrics(),
     .part = {.order = 600, .tables = make_work_tables}}};

} // namespace

void count_work(const StudyInput& input) {
    std::vector<report::Row>& rows = input.comparison.rows;
    for (std::size_t i = 0; i < input.request.base.techniques.size(); ++i) {
        if (measure::has_counted_work(rows[i])) continue;
        report_row(input.request.watcher, rows[i].label + ": work", i, rows.size());
        Request request = input.request.base;
        request.techniques = {input.request.base.techniques[i]};
        request.model = rows[i].model == work_name(RenderedWork::required)
                            ? RenderedWork::required
                            : RenderedWork::everything;
        measure::set_work(rows[i], count_frame_work(input.session, request, input.request.watcher));
        input.tell();
    }
}

void show_work(const CompareRequest&, int, report::Comparison& comparison) {
    if (std::ranges::find(comparison.studies, "work") == comparison.studies.end())
        comparison.studies.emplace_back("work");
}

} // namespace catoptric::study
