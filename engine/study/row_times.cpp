#include "study/row_times.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"
#include "report/costs.hpp"
#include "report/text.hpp"
#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace catoptric::study {

namespace {

using report::ReportTable;

constexpr const char* kRowTimesMetricName = "row_times";

/// Throws `usage` if a file of times names a row that is no row of pictures, or if two files state
/// a time for the same row and device.
void check_time_rows(const CompareRequest& request, int /*count*/,
                     report::Comparison& /*comparison*/) {
    std::set<std::pair<std::string, std::string>> seen;
    for (const StudyChoice& choice : request.studies) {
        if (choice.name != "row-times") continue;
        for (const std::string& file : choice.texts) {
            const report::RowTimes times = report::read_row_times(file);
            for (const auto& [row, ms] : times.rows) {
                check(
                    std::ranges::any_of(request.pictures,
                                        [&](const auto& picture) { return picture.first == row; }),
                    Failure::usage, "--row-times ", file,
                    ": wanted the name of a row of --row, found ", quote(row));
                check(seen.emplace(row, times.device).second, Failure::usage, "--row-times ", file,
                      ": wanted one time for each row and device, found a second for ", quote(row),
                      " on ", quote(times.device));
            }
        }
    }
}

/// Returns the times, divided into at most `count` rounds of successive frames.
std::vector<std::vector<double>> split_into_rounds(const std::vector<double>& list,
                                                   std::size_t count) {
    count = std::min(count, list.size());
    std::vector<std::vector<double>> rounds(count);
    for (std::size_t i = 0; i < list.size(); ++i)
        rounds[i * count / list.size()].push_back(list[i]);
    return rounds;
}

/// Adds the stated times to their rows. A row is ranked if its time was measured on the
/// comparison's own device.
void add_row_times(const StudyInput& input) {
    std::vector<report::Row>& rows = input.comparison.rows;
    std::vector<std::vector<measure::MetricParts>> lists(rows.size());
    for (const std::string& file : input.texts) {
        const report::RowTimes times = report::read_row_times(file);
        for (const auto& [name, list] : times.rows) {
            const auto row = std::ranges::find(rows, name, &report::Row::label);
            check(row != rows.end(), Failure::internal, "times of rows: no row ", name);
            const measure::SampleSummary summary = measure::summarise(
                split_into_rounds(list, std::max(static_cast<std::size_t>(input.comparison.rounds),
                                                 measure::kMinIntervalSamples)));
            if (times.device == input.comparison.device.name) row->gpu_ms = row->frame_ms = summary;
            lists[static_cast<std::size_t>(row - rows.begin())].push_back(
                {"device",
                 times.device,
                 {{"ms", summary.median},
                  {"low_ms", summary.ci95.low},
                  {"high_ms", summary.ci95.high},
                  {"frames", static_cast<double>(list.size())}}});
        }
    }
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (!lists[i].empty())
            measure::set_study_metric(rows[i], kRowTimesMetricName, std::move(lists[i]));
    input.tell();
}

std::vector<measure::MetricParts> row_times(const measure::Row& row) {
    const measure::MetricValue value = measure::study_metric(row, kRowTimesMetricName);
    const auto* list = std::get_if<std::vector<measure::MetricParts>>(&value);
    return list != nullptr ? *list : std::vector<measure::MetricParts>();
}

double read_time_part(const measure::MetricParts& parts, std::size_t index) {
    return std::get<double>(parts.values[index].second);
}

std::vector<ReportTable> make_row_time_tables(const report::Comparison& comparison) {
    ReportTable table{
        "Times of other renderers, ms",
        {report::text_column("row"), report::text_column("device"), "ms", "95 %", "frames", "FLIP"},
        "As stated by the files of --row-times. Times on the comparison's own device "
        "rank their rows; others do so on the device of --costs with the same name.",
        {},
        {}};
    for (const report::Row& row : comparison.rows)
        for (const measure::MetricParts& time : row_times(row)) {
            const double low = read_time_part(time, 1), high = read_time_part(time, 2);
            table.rows.push_back(
                {row.label, time.name, report::format_ms(read_time_part(time, 0)),
                 low <= high ? report::format_ms(low) + "–" + report::format_ms(high)
                             : std::string(report::kEmptyCell),
                 fmt::format("{:.0f}", read_time_part(time, 3)), report::format_flip(row.error)});
        }
    return {table};
}

const RegisteredStudy kRowTimesStudy{
    {.name = "row-times",
     .help = "times of rows of --row, as their renderers measured them; may be repeated",
     .order = 40, // before the study `costs`, so that these rows join its fronts
     .words = "FILE",
     .check_words =
         [](const std::vector<std::string>& files) {
             for (const std::string& file : files) report::read_row_times(file);
         },
     .prepare = check_time_rows,
     .run = add_row_times,
     .metrics = {{.name = kRowTimesMetricName,
                  .unit = "ms",
                  .help = "time on each device of --row-times, with its interval",
                  .better = measure::BetterDirection::less,
                  .order = 785,
                  .get = measure::Metric::FromStudy{}}},
     .part = {.order = 690, .tables = make_row_time_tables, .title = "Other renderers"}}};

} // namespace

std::vector<std::optional<measure::PredictedTime>>
find_row_times(const std::vector<measure::Row>& rows, const std::string& device) {
    std::vector<std::optional<measure::PredictedTime>> times(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const measure::MetricParts& time : row_times(rows[i])) {
            if (time.name != device) continue;
            const double ms = read_time_part(time, 0), low = read_time_part(time, 1),
                         high = read_time_part(time, 2);
            times[i] = low <= high ? measure::PredictedTime{ms, low, high}
                                   : measure::PredictedTime{ms, ms, ms};
        }
    return times;
}

} // namespace catoptric::study
