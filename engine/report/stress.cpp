#include "report/stress.hpp"

#include "core/file.hpp"
#include "report/html_text.hpp"
#include "report/report.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

namespace catoptric::report {

namespace {

std::string figure(double value) { return fmt::format("{:.3g}", value); }

/// Returns the worst case, the parts that are not covered and those that could not be run. If
/// nothing was run, returns the reason.
std::string words_of(const StressRow& row) {
    const StressCase* worst = row.worst();
    std::string words = worst ? worst->what : "";
    const auto add = [&](const std::string& more) {
        if (!more.empty()) words += (words.empty() ? "" : "; ") + more;
    };
    add(row.remark);
    for (const NotRun& part : row.not_run) add("not run: " + part.what + ": " + part.why);
    return words;
}

/// Returns the table with one line a property: its worst case and the threshold.
Table table_of(const Stress& stress) {
    Table table{"Properties",
                {{"Id", false},
                 {"Verdict", false},
                 {"Measured"},
                 {"Threshold"},
                 {"Stimulus", false},
                 {"Property", false},
                 {"Worst case", false},
                 {"Turned red by", false}},
                {},
                {},
                {}};
    for (const StressRow& row : stress.rows) {
        const StressCase* worst = row.worst();
        table.rows.push_back({row.id, name_of(row.verdict), worst ? figure(worst->measured) : "–",
                              worst ? figure(worst->limit) : "–", row.stimulus, row.property,
                              words_of(row), row.turned_red_by});
    }
    return table;
}

std::string caution_of(const Stress& stress) {
    return stress.complete ? "" : "Incomplete, " + incomplete_text(stress) + ".";
}

std::string lead_of(const Stress& stress) {
    return fmt::format(
        "{}, {}x{}, seed {}. Each row: its worst case beside the threshold, and the wrong "
        "code of tests/mutations that turns it red.",
        stress.device.name, stress.width, stress.height, stress.seed);
}

} // namespace

std::string incomplete_text(const Stress& stress) {
    return stress.complete ? "" : incomplete_text(stress.rows.size(), stress.asked, stress.stopped);
}

std::string to_html(const Stress& stress) {
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\"><title>Rendering at the "
        "extremes</title><style>" +
        std::string(kStyle) +
        "</style></head>\n<body><header><p class=\"kicker\">Rendering at the "
        "extremes</p><h1>Stress</h1>" +
        "<p class=\"lede\">" + html_escaped(lead_of(stress)) + "</p>" +
        (stress.complete ? ""
                         : "<aside class=\"caution\"><ul><li>" + html_escaped(caution_of(stress)) +
                               "</li></ul></aside>") +
        "</header><main><section><div class=\"scroll\"><table class=\"words\"><thead><tr>";
    const Table table = table_of(stress);
    for (const Column& column : table.columns)
        html += fmt::format("<th{} scope=\"col\">{}</th>",
                            column.is_number ? "" : " class=\"text\"", html_escaped(column.name));
    html += "</tr></thead><tbody>\n";
    for (const std::vector<std::string>& row : table.rows) {
        html += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i)
            html += fmt::format("<td{}>{}</td>",
                                table.columns[i].is_number ? "" : " class=\"text\"",
                                html_escaped(row[i]));
        html += "</tr>\n";
    }
    html += "</tbody></table></div></section>\n";
    for (const StressRow& row : stress.rows)
        for (const StressPicture& picture : row.pictures)
            html += fmt::format("<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" "
                                "src=\"{}\"><figcaption>{}</figcaption></figure>\n",
                                picture.width, picture.height, html_escaped(picture.name),
                                data_uri(picture.png), html_escaped(picture.name));
    return html + "</main></body></html>\n";
}

std::string to_markdown(const Stress& stress) {
    return "# Rendering at the extremes\n\n" + lead_of(stress) + "\n\n" +
           (stress.complete ? "" : "> " + caution_of(stress) + "\n\n") +
           to_markdown(table_of(stress));
}

void StressWriter::write(const Stress& stress) {
    create_folder(folder_ / "images");
    for (; rows_ < stress.rows.size(); ++rows_)
        for (const StressPicture& picture : stress.rows[rows_].pictures)
            write_file(folder_ / "images" / (picture.name + ".png"), picture.png);
    write_file(folder_ / "stress.html", to_html(stress));
    write_file(folder_ / "stress.md", to_markdown(stress));
    write_file(folder_ / "stress.json", to_json(stress));
}

} // namespace catoptric::report
