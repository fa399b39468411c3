// Writes stress.json. New versions add fields and never remove any.
#include "report/json.hpp"
#include "report/stress.hpp"

namespace catoptric::report {

namespace {

Json to_json(const StressRow& row) {
    Json json{{"id", row.id},
              {"stimulus", row.stimulus},
              {"property", row.property},
              {"verdict", name_of(row.verdict)},
              {"remark", row.remark}};
    const StressCase* worst = row.worst();
    json["measured"] = worst ? number(worst->measured) : Json(nullptr);
    json["threshold"] = worst ? number(worst->limit) : Json(nullptr);
    json["cases"] = Json::array();
    for (const StressCase& one : row.cases)
        json["cases"].push_back({{"what", one.what},
                                 {"measured", number(one.measured)},
                                 {"threshold", number(one.limit)},
                                 {"holds", one.holds()},
                                 {"quality", one.is_quality}});
    json["pictures"] = Json::array();
    for (const StressPicture& picture : row.pictures)
        json["pictures"].push_back("images/" + picture.name + ".png");
    json["seconds"] = number(row.seconds);
    json["not_run"] = Json::array();
    for (const NotRun& part : row.not_run)
        json["not_run"].push_back({{"what", part.what}, {"why", part.why}});
    json["turned_red_by"] = row.turned_red_by;
    return json;
}

} // namespace

std::string to_json(const Stress& stress) {
    Json json{{"schema", "catoptric/stress/1"},
              {"version", stress.version},
              {"commit", stress.commit},
              {"command", stress.command},
              {"complete", stress.complete}};
    if (!stress.complete) {
        json["incomplete"] = incomplete_text(stress);
        json["rows_asked"] = stress.asked;
    }
    json["device"] = device_json(stress.device);
    json["size"] = Json::array({stress.width, stress.height});
    json["seed"] = stress.seed;
    json["rows"] = Json::array();
    for (const StressRow& row : stress.rows) json["rows"].push_back(to_json(row));
    return json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

} // namespace catoptric::report
