// Writes one report on several scenes.
#include "measure/causes.hpp"
#include "measure/views.hpp"
#include "report/html.hpp"
#include "report/json.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"

#include <algorithm>
#include <memory>

namespace catoptric::report {

bool ScenesReport::is_complete() const {
    return list.size() == asked.size() && std::ranges::all_of(list, &Comparison::complete);
}

std::string images_folder(std::size_t index, const std::string& scene) {
    constexpr std::size_t kMaxFolderNameLength = 40;
    std::string name;
    for (const char c : scene.substr(0, kMaxFolderNameLength)) {
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                              (c >= '0' && c <= '9') || c == '-' || c == '_';
        name += is_plain ? c : '_';
    }
    return std::to_string(index + 1) + "-" + name + "/";
}

Comparison without_pictures(const Comparison& comparison) {
    Comparison bare = comparison;
    bare.reference_hdr = bare.reference_display = {};
    bare.mirror_hits = {};
    for (Row& row : bare.rows) {
        row.hdr = row.display = {};
        row.flip_map = {};
        if (row.causes) { // copied, because rows share their causes
            row.causes = std::make_shared<measure::Causes>(*row.causes);
            row.causes->largest = {};
        }
        if (row.worst)
            row.worst = std::make_shared<measure::WorstView>(
                measure::WorstView{row.worst->view, {}});
    }
    if (bare.lag) { // copied, because comparisons share it
        bare.lag = std::make_shared<LagResults>(*bare.lag);
        for (LagRow& row : bare.lag->rows)
            if (row.worst)
                row.worst = WorstLag{row.worst->speed, row.worst->seconds, row.worst->flip};
    }
    return bare;
}

std::string to_json(const ScenesReport& scenes) {
    Json json{{"schema", "catoptric/compare-scenes/1"}};
    if (!scenes.list.empty()) {
        const Comparison& first = scenes.list.front();
        json["version"] = first.version, json["commit"] = first.commit;
        json["command"] = first.command;
        json["date"] = first.date;
    }
    json["complete"] = scenes.is_complete();
    json["asked"] = scenes.asked;
    json["scenes"] = Json::array();
    for (const Comparison& comparison : scenes.list)
        json["scenes"].push_back(report_json(comparison));
    return serialise(json);
}

std::string to_csv(const ScenesReport& scenes, CsvColumns which) {
    std::vector<const Comparison*> all;
    for (const Comparison& comparison : scenes.list) all.push_back(&comparison);
    return to_csv(all, which);
}

std::string to_markdown(const ScenesReport& scenes) {
    std::string text;
    for (const Comparison& comparison : scenes.list) text += to_markdown(comparison);
    return text;
}

std::string to_html(const ScenesReport& scenes, const std::vector<std::string>& sections) {
    std::string content = "<nav><ul>";
    for (const Comparison& comparison : scenes.list)
        content += "<li><a href=\"#" + id_prefix(comparison) + "\">" +
                   escape_html(comparison.scene.name) + "</a></li>";
    content += "</ul></nav>\n";
    for (std::size_t i = 0; i < sections.size(); ++i)
        content += "<div class=\"scene\" id=\"" + id_prefix(scenes.list[i]) + "\">" + sections[i] +
                   "</div>\n";
    return html_page(join_texts(scenes.asked, ", "), content);
}

} // namespace catoptric::report
