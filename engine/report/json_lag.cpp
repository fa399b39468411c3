// Writes the field "lag" of report.json.
#include "report/json.hpp"

namespace catoptric::report {

namespace {

Json numbers(const std::vector<double>& values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(number(value));
    return list;
}

Json frames(const std::optional<int>& count) { return count ? Json(*count) : Json(nullptr); }

Json to_json(const Settling& settling) {
    return {{"rmse_settled", frames(settling.rmse_settled)},
            {"max_settled", frames(settling.max_settled)},
            {"rmse", numbers(settling.rmse)},
            {"max", numbers(settling.max)}};
}

/// Adds each headline metric of each instant, and its mean. Names begin with `prefix`.
void add_figures(Json& json, const std::string& prefix,
                 const std::vector<measure::Difference>& errors) {
    using measure::Difference;
    for (const auto& [name, figure] :
         {std::pair("flip", &Difference::flip), std::pair("off", &Difference::off),
          std::pair("mae", &Difference::mae), std::pair("rmse", &Difference::rmse)}) {
        json[prefix + name + "_mean"] = number(measure::mean_of(errors, figure));
        json[prefix + name] = numbers(measure::figures_of(errors, figure));
    }
}

Json to_json(const LagAtSpeed& at) {
    using measure::Difference;
    Json json{{"speed", number(at.speed)}};
    add_figures(json, "", at.errors);
    for (const auto& [name, figure] :
         {std::pair("flip", &Difference::flip), std::pair("rmse", &Difference::rmse)}) {
        const std::string prefix(name);
        json[prefix + "_median"] = number(measure::percentile_of(at.errors, figure, .5));
        json[prefix + "_max"] = number(measure::percentile_of(at.errors, figure, 1));
    }
    add_figures(json, "reference_", at.reference_errors);
    return json;
}

Json to_json(const LagRow& row) {
    Json json{{"label", row.label},
              {"still_frames", row.still_frames},
              {"restless_stills", row.restless_stills},
              {"after_black", to_json(row.after_black)},
              {"after_jump", to_json(row.after_jump)}};
    add_figures(json, "still_reference_", row.still_reference_errors);
    json["speeds"] = Json::array();
    for (const LagAtSpeed& at : row.speeds) json["speeds"].push_back(to_json(at));
    return json;
}

} // namespace

Json to_json(const Lag& lag) {
    Json json{{"mask", "mirrors"},
              {"complete", lag.complete},
              {"path_seconds", number(lag.path)},
              {"jump_from", number(lag.jump_from)},
              {"frame_cap", lag.frame_cap},
              {"seconds", numbers(lag.seconds)},
              {"without_history", lag.without_history}};
    json["rows"] = Json::array();
    for (const LagRow& row : lag.rows) json["rows"].push_back(to_json(row));
    return json;
}

} // namespace catoptric::report
