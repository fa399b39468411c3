// The field "lag" of report.json.
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

Json to_json(const LagAtSpeed& at) {
    return {{"speed", number(at.speed)},
            {"rmse_mean", number(at.mean_rmse)},
            {"rmse_median", number(at.median_rmse)},
            {"rmse_max", number(at.max_rmse)},
            {"reference_rmse_mean", number(at.mean_reference_rmse)},
            {"rmse", numbers(at.rmse)},
            {"reference_rmse", numbers(at.reference_rmse)}};
}

Json to_json(const LagRow& row) {
    Json json{{"label", row.label},
              {"still_frames", row.still_frames},
              {"restless_stills", row.restless_stills},
              {"still_reference_rmse_mean", number(row.mean_still_reference_rmse)},
              {"still_reference_rmse", numbers(row.still_reference_rmse)},
              {"after_black", to_json(row.after_black)},
              {"after_jump", to_json(row.after_jump)}};
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
