// Writes errors over drawn views into reports, as JSON, a table and sentences.
#include "measure/views.hpp"

#include "report/html.hpp"
#include "report/json.hpp"
#include "report/report_part.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace catoptric::report {

namespace {

struct DrawnViewMetric {
    const measure::Metric* metric;
    const measure::MetricColumn* column;
};

/// Returns the metrics of differences that the table of rows shows, too.
std::vector<DrawnViewMetric> view_metrics() {
    std::vector<DrawnViewMetric> list;
    for (const measure::Metric& metric : measure::difference_metrics())
        for (const measure::MetricColumn& column : metric.columns)
            if (measure::is_scalar(metric)) list.push_back({&metric, &column});
    return list;
}

std::string format_view_cell(const Row& row, const DrawnViewMetric& figure) {
    const measure::MetricOverViews over = measure::metric_over_views(
        row, measure::row_masks().front(), *figure.metric);
    const measure::MetricColumn& column = *figure.column;
    const std::string median = format_metric_number(over.median, column);
    if (!over.ci95.is_known()) return median;
    return fmt::format("{} [{}–{}]", median, format_metric_number(over.ci95.low, column),
                       format_metric_number(over.ci95.high, column));
}

/// Returns the effect of shared instants on the row's FLIP over the mirrors.
std::optional<measure::SharedInstants> find_instant_effect(const Comparison& comparison,
                                                           const Row& row) {
    std::vector<double> values;
    for (const measure::Errors& view : row.views) values.push_back(view.error.flip);
    return measure::estimate_shared_instants(comparison.views, values);
}

/// Returns the title of the metric's column without the unit.
std::string_view metric_title(const measure::Metric& metric) {
    const std::string_view title = metric.columns.front().title;
    return title.substr(0, title.find(','));
}

std::string format_pairs(const measure::RowOrder::RowPairs& list) {
    std::vector<std::string> pairs;
    for (const auto& [a, b] : list) pairs.push_back(a->label + " and " + b->label);
    return join_texts(pairs, "; ");
}

std::string format_tied_rows(const measure::RowOrder& order) {
    const std::size_t pairs = order.rows.size() * (order.rows.size() - 1) / 2;
    if (order.ties.size() == pairs) return "No two of them are apart.";
    std::string text = order.ties.empty()
                           ? "Every two of them are apart."
                           : "Ties: " + format_pairs(order.ties) + ". All other pairs are apart.";
    if (!order.reversed.empty())
        text += " The other way round: " + format_pairs(order.reversed) + ".";
    return text;
}

/// Returns a JSON object with the summary over views of each metric that is one number, for one
/// mask of pixels.
Json view_metrics_json(const Row& row, const measure::RowMask& mask) {
    Json figures = Json::object();
    for (const measure::Metric& metric : measure::difference_metrics()) {
        if (!measure::is_scalar(metric)) continue;
        const measure::MetricOverViews over = measure::metric_over_views(row, mask, metric);
        figures[std::string(metric.name)] = {{"median", number_json(over.median)},
                                             {"ci95", interval_json(over.ci95)},
                                             {"values", metric_json(over.values)}};
    }
    return figures;
}

/// Returns HTML with the pictures of each row in its worst view.
std::string worst_pictures(const Comparison& comparison, const EncodedPictures& encoded) {
    std::string html = "<p>Each row at its view of the largest FLIP, beside the reference.</p>";
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        if (!row.worst) continue;
        const std::string where = describe_worst_view(comparison, *row.worst);
        html += html_figure(
            row.worst->display.width, row.worst->display.height, encoded.rows[i].worst,
            row.label + ", to its right the reference, at " + where, row.label + ": " + where, "",
            picture_file(comparison, encoded, worst_view_image(row.image)));
    }
    return titled_section("Worst views", html);
}

const RegisteredPart kDrawnViewsPart{
    {.name = "views",
     .order = 100,
     .tables = [](const Comparison& comparison) { return std::vector{views_table(comparison)}; },
     .look = "views",
     .sentences = describe_drawn_views,
     .title = "Apart and ties",
     .pictures = worst_pictures}};

} // namespace

Json views_json(const Comparison& comparison) {
    return list_json(comparison.views, [](const measure::View& view) {
        return Json{{"camera", camera_json(view.camera)},
                    {"time", number_json(view.time)},
                    {"seed", view.seed}};
    });
}

Json views_json(const Comparison& comparison, const Row& row) {
    if (row.views.empty()) return nullptr;
    Json json = Json::object();
    for (const measure::RowMask& mask : measure::row_masks())
        json[std::string(mask.field)] = view_metrics_json(row, mask);
    json["shared_instants"] = nullptr;
    if (const auto shared = find_instant_effect(comparison, row))
        json["shared_instants"] = {{"instants", shared->instants},
                                   {"flip_design_effect", number_json(shared->design_effect)},
                                   {"effective_views", number_json(shared->effective_views)}};
    json["worst"] = nullptr;
    if (row.worst)
        json["worst"] = {{"view", row.worst->view},
                         {"flip", number_json(row.views[row.worst->view].error.flip)},
                         {"image", image_path(comparison, worst_view_image(row.image))}};
    return json;
}

ReportTable views_table(const Comparison& comparison) {
    ReportTable table{
        fmt::format("Over {} views", comparison.views.size()),
        {text_column("Row")},
        "Cameras drawn from the seed that see a mirror, at drawn instants where the scene "
        "moves; each row's picture as render takes it. Over the pixels whose first hit is "
        "a mirror: median over the views, and its 95 % interval by order statistics. Worst: "
        "the largest FLIP, and the options that render it again."};
    if (comparison.views.empty()) return table;
    const bool shares_instants = std::ranges::any_of(comparison.rows, [&](const Row& row) {
        return find_instant_effect(comparison, row).has_value();
    });
    if (shares_instants)
        table.note +=
            " Neighbouring views share instants and resemble each other. Effective "
            "views: the number of views with an instant each whose mean FLIP would be as "
            "certain (Kish's design effect). Where it is much smaller than the number of "
            "views, the intervals are too narrow and too few rows tie, because both treat "
            "all views as independent.";
    const std::vector<DrawnViewMetric> columns = view_metrics();
    for (const DrawnViewMetric& figure : columns)
        table.columns.emplace_back(std::string(figure.column->title));
    if (shares_instants) table.columns.emplace_back("Effective views");
    table.columns.emplace_back("Worst FLIP");
    table.columns.push_back(text_column("Worst view"));
    for (const Row& row : comparison.rows) {
        std::vector<std::string> cells{row.label};
        for (const DrawnViewMetric& figure : columns)
            cells.push_back(format_view_cell(row, figure));
        if (shares_instants) {
            const auto shared = find_instant_effect(comparison, row);
            cells.push_back(shared ? fmt::format("{:.0f}", shared->effective_views)
                                   : std::string(kEmptyCell));
        }
        cells.push_back(row.worst ? format_flip(row.views[row.worst->view].error)
                                  : std::string(kEmptyCell));
        cells.push_back(row.worst ? describe_worst_view(comparison, *row.worst)
                                  : std::string(kEmptyCell));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

std::vector<std::string> describe_drawn_views(const Comparison& comparison) {
    std::vector<std::string> sentences;
    for (const measure::RowOrder& order : measure::order_rows(comparison))
        sentences.push_back(fmt::format("By {}, view by view, the least first: {}. {}",
                                        metric_title(*order.metric), join_labels(order.rows),
                                        format_tied_rows(order)));
    if (!sentences.empty())
        sentences.emplace_back(
            "Two rows are apart where the 95 % interval of their difference, view by view, "
            "excludes 0, each pair judged by itself; otherwise they tie.");
    return sentences;
}

} // namespace catoptric::report
