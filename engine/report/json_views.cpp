// Writes the fields "views" of report.json.
#include "measure/views.hpp"
#include "report/json.hpp"
#include "report/text.hpp"
#include "report/views.hpp"

namespace catoptric::report {

namespace {

Json interval_json(const measure::Interval& interval) {
    if (!interval.is_known()) return nullptr;
    return Json::array({number(interval.low), number(interval.high)});
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

} // namespace

Json views_json(const Comparison& comparison) {
    Json views = Json::array();
    for (const measure::View& view : comparison.views)
        views.push_back({{"camera", camera_json(view.camera)},
                         {"time", number(view.time)},
                         {"seed", view.seed}});
    return views;
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

} // namespace catoptric::report
