#include "report/stress.hpp"

#include "core/file.hpp"
#include "report/html.hpp"
#include "report/json.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"

#include <fmt/format.h>

namespace catoptric::report {

namespace {

Json to_json(const StressRow& row) {
    Json json{{"id", row.id},
              {"stimulus", row.stimulus},
              {"property", row.property},
              {"verdict", verdict_name(row.verdict)},
              {"remark", row.remark}};
    const StressCase* worst = row.worst_case();
    json["measured"] = worst ? number_json(worst->measured) : Json();
    json["threshold"] = worst ? number_json(worst->limit) : Json();
    json["cases"] = list_json(row.cases, [](const StressCase& one) {
        return Json{{"what", one.what},
                    {"measured", number_json(one.measured)},
                    {"threshold", number_json(one.limit)},
                    {"holds", one.is_within_limit()},
                    {"quality", one.is_quality},
                    {"seen", one.seen}};
    });
    json["pictures"] = list_json(row.pictures, [](const StressPicture& picture) {
        return "images/" + picture.name + ".png";
    });
    json["seconds"] = number_json(row.seconds);
    json["not_run"] = list_json(row.not_run, [](const SkippedPart& part) {
        return Json{{"what", part.what}, {"why", part.why}};
    });
    json["turned_red_by"] = row.turned_red_by;
    return json;
}

std::string format_short(double value) { return fmt::format("{:.3g}", value); }

/// Returns the worst case, the parts that are not covered and those that could not be run. If
/// nothing was run, returns the reason.
std::string describe_row(const StressRow& row) {
    const StressCase* worst = row.worst_case();
    std::string words = worst ? worst->what : "";
    const auto add = [&](const std::string& more) {
        if (!more.empty()) words += (words.empty() ? "" : "; ") + more;
    };
    if (worst && !worst->is_within_limit()) add(worst->seen);
    add(row.remark);
    for (const SkippedPart& part : row.not_run) add("not run: " + part.what + ": " + part.why);
    return words;
}

/// Returns the table with one line a property: its worst case and the threshold.
ReportTable stress_table(const StressResults& stress) {
    ReportTable table{"Properties",
                      {text_column("Id"), text_column("Verdict"), "Measured", "Threshold",
                       text_column("Stimulus"), text_column("Property"), text_column("Worst case"),
                       text_column("Turned red by")},
                      ""};
    for (const StressRow& row : stress.rows) {
        const StressCase* worst = row.worst_case();
        table.rows.push_back({row.id, verdict_name(row.verdict),
                              worst ? format_short(worst->measured) : "–",
                              worst ? format_short(worst->limit) : "–", row.stimulus, row.property,
                              describe_row(row), row.turned_red_by});
    }
    return table;
}

std::string describe_cautions(const StressResults& stress) {
    return stress.complete ? "" : "Incomplete, " + describe_incomplete_run(stress) + ".";
}

std::string describe_result(const StressResults& stress) {
    return fmt::format(
        "{}, {}x{}, seed {}. Each row: its worst case beside the threshold, and the wrong "
        "code of tests/mutations that turns it red.",
        stress.device.name, stress.width, stress.height, stress.seed);
}

} // namespace

std::string describe_incomplete_run(const StressResults& stress) {
    return stress.complete
               ? ""
               : describe_incomplete_run(stress.rows.size(), stress.asked, stress.stopped);
}

std::string to_json(const StressResults& stress) {
    Json json{{"schema", "catoptric/stress/1"},
              {"version", stress.version},
              {"commit", stress.commit},
              {"command", stress.command},
              {"complete", stress.complete}};
    if (!stress.complete) {
        json["incomplete"] = describe_incomplete_run(stress);
        json["rows_asked"] = stress.asked;
    }
    json["device"] = device_json(stress.device);
    json["size"] = Json::array({stress.width, stress.height});
    json["seed"] = stress.seed;
    json["rows"] = list_json(stress.rows, [](const StressRow& row) { return to_json(row); });
    return serialise(json);
}

std::string to_html(const StressResults& stress) {
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\"><title>Rendering at the "
        "extremes</title><style>" +
        std::string(kStyleSheet) +
        "</style></head>\n<body><header><p class=\"kicker\">Rendering at the "
        "extremes</p><h1>Stress</h1>" +
        "<p class=\"lede\">" + escape_html(describe_result(stress)) + "</p>" +
        (stress.complete ? ""
                         : "<aside class=\"caution\"><ul><li>" +
                               escape_html(describe_cautions(stress)) + "</li></ul></aside>") +
        "</header><main><section><div class=\"scroll\"><table class=\"words\"><thead><tr>";
    const ReportTable table = stress_table(stress);
    for (const TableColumn& column : table.columns)
        html += fmt::format("<th{} scope=\"col\">{}</th>",
                            column.is_number ? "" : " class=\"text\"", escape_html(column.name));
    html += "</tr></thead><tbody>\n";
    for (const std::vector<std::string>& row : table.rows) {
        html += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i)
            html += fmt::format("<td{}>{}</td>",
                                table.columns[i].is_number ? "" : " class=\"text\"",
                                escape_html(row[i]));
        html += "</tr>\n";
    }
    html += "</tbody></table></div></section>\n";
    for (const StressRow& row : stress.rows)
        for (const StressPicture& picture : row.pictures)
            html += html_figure(picture.width, picture.height, picture.png, picture.name,
                                picture.name) +
                    "\n";
    return html + "</main></body></html>\n";
}

std::string to_markdown(const StressResults& stress) {
    return "# Rendering at the extremes\n\n" + describe_result(stress) + "\n\n" +
           (stress.complete ? "" : "> " + describe_cautions(stress) + "\n\n") +
           to_markdown(stress_table(stress));
}

void StressWriter::write(const StressResults& stress) {
    create_folder(folder_ / "images");
    for (; rows_ < stress.rows.size(); ++rows_)
        for (const StressPicture& picture : stress.rows[rows_].pictures)
            write_file(folder_ / "images" / (picture.name + ".png"), picture.png);
    write_file(folder_ / "stress.html", to_html(stress));
    write_file(folder_ / "stress.md", to_markdown(stress));
    write_file(folder_ / "stress.json", to_json(stress));
}

} // namespace catoptric::report
