// Errors over drawn views: JSON, table and sentences.
#include "measure/views.hpp"

#include "report/html.hpp"
#include "report/json.hpp"
#include "report/part.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

namespace catoptric::report {

namespace {

struct Figure {
    const measure::Metric* quantity;
    const measure::MetricColumn* column;
};

/// Returns the metrics of differences that the table of rows shows, too.
std::vector<Figure> figures() {
    std::vector<Figure> list;
    for (const measure::Metric& quantity : measure::difference_metrics())
        for (const measure::MetricColumn& column : quantity.columns)
            if (measure::is_number(quantity)) list.push_back({&quantity, &column});
    return list;
}

std::string cell(const Row& row, const Figure& figure) {
    const measure::OverViews over = measure::over_views(row, measure::masks().front(),
                                                        *figure.quantity);
    const measure::MetricColumn& column = *figure.column;
    const std::string median = number_text(over.median, column);
    if (!over.ci95.is_known()) return median;
    return fmt::format("{} [{}–{}]", median, number_text(over.ci95.low, column),
                       number_text(over.ci95.high, column));
}

/// Returns the title of the metric's column without the unit.
std::string_view title_of(const measure::Metric& quantity) {
    const std::string_view title = quantity.columns.front().title;
    return title.substr(0, title.find(','));
}

std::string pairs_of(const measure::Order::Pairs& list) {
    std::vector<std::string> pairs;
    for (const auto& [a, b] : list) pairs.push_back(a->label + " and " + b->label);
    return joined(pairs, "; ");
}

std::string ties_text(const measure::Order& order) {
    const std::size_t pairs = order.rows.size() * (order.rows.size() - 1) / 2;
    if (order.ties.size() == pairs) return "No two of them are apart.";
    std::string text = order.ties.empty()
                           ? "Every two of them are apart."
                           : "Ties: " + pairs_of(order.ties) + ". All other pairs are apart.";
    if (!order.reversed.empty()) text += " The other way round: " + pairs_of(order.reversed) + ".";
    return text;
}

/// Returns all metrics that are one number, over one mask.
Json figures_json(const Row& row, const measure::RowMask& mask) {
    Json figures = Json::object();
    for (const measure::Metric& quantity : measure::difference_metrics()) {
        if (!measure::is_number(quantity)) continue;
        const measure::OverViews over = measure::over_views(row, mask, quantity);
        figures[std::string(quantity.name)] = {{"median", number(over.median)},
                                               {"ci95", interval_json(over.ci95)},
                                               {"values", value_json(over.values)}};
    }
    return figures;
}

/// Returns each row at its worst view.
std::string worst_pictures(const Comparison& comparison, const EncodedPictures& encoded) {
    std::string html = "<p>Each row at its view of the largest FLIP, beside the reference.</p>";
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        if (!row.worst) continue;
        const std::string where = view_text(comparison, *row.worst);
        html += figure(row.worst->display.width, row.worst->display.height, encoded.rows[i].worst,
                       row.label + ", to its right the reference, at " + where,
                       row.label + ": " + where);
    }
    return section("Worst views", html);
}

const RegisteredPart kViewsPart{
    {.name = "views",
     .order = 100,
     .tables = [](const Comparison& comparison) { return std::vector{views_table(comparison)}; },
     .look = "views",
     .sentences = views_in_words,
     .title = "Apart and ties",
     .pictures = worst_pictures}};

} // namespace

Json views_json(const Comparison& comparison) {
    return list_json(comparison.views, [](const measure::View& view) {
        return Json{
            {"camera", camera_json(view.camera)}, {"time", number(view.time)}, {"seed", view.seed}};
    });
}

Json views_json(const Comparison& comparison, const Row& row) {
    if (row.views.empty()) return nullptr;
    Json json = Json::object();
    for (const measure::RowMask& mask : measure::masks())
        json[std::string(mask.field)] = figures_json(row, mask);
    json["worst"] = nullptr;
    if (row.worst)
        json["worst"] = {{"view", row.worst->view},
                         {"flip", number(row.views[row.worst->view].error.flip)},
                         {"image", image_path(comparison, worst_image(row.image))}};
    return json;
}

Table views_table(const Comparison& comparison) {
    Table table{
        fmt::format("Over {} views", comparison.views.size()),
        {text_column("Row")},
        "Cameras drawn from the seed that see a mirror, at drawn instants where the scene "
        "moves; each row's picture as render takes it. Over the pixels whose first hit is "
        "a mirror: median over the views, and its 95 % interval by order statistics. Worst: "
        "the largest FLIP, and the options that render it again."};
    if (comparison.views.empty()) return table;
    const std::vector<Figure> columns = figures();
    for (const Figure& figure : columns)
        table.columns.emplace_back(std::string(figure.column->title));
    table.columns.emplace_back("Worst FLIP");
    table.columns.push_back(text_column("Worst view"));
    for (const Row& row : comparison.rows) {
        std::vector<std::string> cells{row.label};
        for (const Figure& figure : columns) cells.push_back(cell(row, figure));
        cells.push_back(row.worst ? error_text(row.views[row.worst->view].error.flip)
                                  : std::string(kNothing));
        cells.push_back(row.worst ? view_text(comparison, *row.worst) : std::string(kNothing));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

std::vector<std::string> views_in_words(const Comparison& comparison) {
    std::vector<std::string> sentences;
    for (const measure::Order& order : measure::orders_over_views(comparison))
        sentences.push_back(fmt::format("By {}, view by view, the least first: {}. {}",
                                        title_of(*order.figure), labels_of(order.rows),
                                        ties_text(order)));
    if (!sentences.empty())
        sentences.emplace_back(
            "Two rows are apart where the 95 % interval of their difference, view by view, "
            "excludes 0, each pair judged by itself; otherwise they tie.");
    return sentences;
}

} // namespace catoptric::report
