#include "report/stress.hpp"

#include "core/file.hpp"
#include "measure/picture_file.hpp"
#include "report/html_text.hpp"
#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace catoptric::report {

namespace {

/// How much of its limit a case takes: above 1 it does not hold.
double load(const StressCase& one) {
    if (std::isnan(one.measured)) return std::numeric_limits<double>::infinity();
    if (one.limit > 0) return one.measured / one.limit;
    return one.holds() ? 0 : std::numeric_limits<double>::infinity();
}

std::string figure(double value) { return fmt::format("{:.3g}", value); }

std::string to_html(const StressRow& row) {
    const StressCase* worst = row.worst();
    std::string html = fmt::format("<tr><th class=\"text\" scope=\"row\">{}</th><td class=\"text\">{}</td><td class=\"text\">{}</td>"
                                   "<td>{}</td><td>{}</td><td class=\"text\">{}</td><td class=\"text\">{}</td></tr>",
                                   html_escaped(row.id), html_escaped(row.stimulus), html_escaped(row.property),
                                   worst ? figure(worst->measured) : "–", worst ? figure(worst->limit) : "–", name_of(row.verdict),
                                   html_escaped(worst ? worst->what + (row.remark.empty() ? "" : "; " + row.remark) : row.remark));
    return html;
}

} // namespace

std::string name_of(Verdict verdict) {
    switch (verdict) {
    case Verdict::pass: return "pass";
    case Verdict::fail: return "fail";
    case Verdict::quality_warning: return "quality-warning";
    case Verdict::unsupported: return "unsupported";
    case Verdict::waived: return "waived";
    }
    return "";
}

const StressCase* StressRow::worst() const {
    const auto found = std::ranges::max_element(cases, {}, [](const StressCase& one) { return std::pair(!one.holds() && !one.is_quality, load(one)); });
    return found == cases.end() ? nullptr : &*found;
}

bool Stress::failed() const {
    return std::ranges::any_of(rows, [](const StressRow& row) { return row.verdict == Verdict::fail; });
}

std::string to_html(const Stress& stress) {
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
                       "content=\"width=device-width, initial-scale=1\"><title>Rendering at the extremes</title><style>" +
                       std::string(kStyle) + "</style></head>\n<body><header><p class=\"kicker\">Rendering at the extremes</p><h1>Stress</h1>" +
                       fmt::format("<p class=\"lede\">{}, {}x{}, seed {}. Each row: its worst case beside the threshold.</p></header><main>",
                                   html_escaped(stress.device.name), stress.width, stress.height, stress.seed) +
                       "<section><div class=\"scroll\"><table><thead><tr>";
    for (const char* name : {"Id", "Stimulus", "Property", "Measured", "Threshold", "Verdict", "Worst case"})
        html += fmt::format("<th class=\"text\" scope=\"col\">{}</th>", name);
    html += "</tr></thead><tbody>\n";
    for (const StressRow& row : stress.rows) html += to_html(row) + "\n";
    html += "</tbody></table></div></section>\n";
    for (const StressRow& row : stress.rows)
        for (const StressPicture& picture : row.pictures)
            html += fmt::format("<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"{}\"><figcaption>{}</figcaption></figure>\n",
                                picture.display.width, picture.display.height, html_escaped(picture.name), data_uri(picture.display),
                                html_escaped(picture.name));
    return html + "</main></body></html>\n";
}

void write(const Stress& stress, const std::filesystem::path& folder) {
    create_folder(folder);
    for (const StressRow& row : stress.rows)
        for (const StressPicture& picture : row.pictures) measure::write_png(picture.display, folder / "images" / (picture.name + ".png"));
    write_file(folder / "stress.html", to_html(stress));
    write_file(folder / "stress.json", to_json(stress));
}

} // namespace catoptric::report
