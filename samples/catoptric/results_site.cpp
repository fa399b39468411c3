#include "results_site.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "report.hpp"
#include "report/chart.hpp"
#include "report/html.hpp"
#include "report/json.hpp"
#include "report/text.hpp"
#include "site_reports.hpp"
#include "sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace catoptric::cli {

namespace {

namespace fs = std::filesystem;
using report::escape_html;
using SiteJson = nlohmann::ordered_json;

constexpr std::uintmax_t kMaxReportBytes = 256U << 20U;
constexpr std::size_t kMaxHistoryColumns = 12; // only the latest reports get a column
constexpr std::size_t kIdCharacters = 12;
constexpr std::string_view kPagePrefix = "scene-";

/// Comparisons of one scene with one setting, by device, from the oldest to the newest.
struct SitePage {
    std::string scene, setting, file;
    std::vector<std::string>
        sections; ///< values of a sweep's axes, in its order; else one empty text
    std::map<std::string, std::vector<SiteComparison>> devices;
};

std::vector<SitePage> group_by_page(const std::vector<SiteComparison>& comparisons) {
    std::map<std::string, SitePage> pages; // sorted by scene and setting
    for (const SiteComparison& one : comparisons) {
        const bool is_sweep = !one.machine.empty();
        const std::string key = one.scene + "\n" + (is_sweep ? "" : one.hash) + "\n" + one.setting;
        SitePage& page = pages[key];
        page.scene = one.scene;
        page.setting = (is_sweep ? "sweep, " : "hash " + one.hash.substr(0, 8) + ", ") +
                       one.setting;
        page.file = std::string(kPagePrefix) + sha256(key).substr(0, kIdCharacters) + ".html";
        if (std::ranges::find(page.sections, one.section) == page.sections.end())
            page.sections.push_back(one.section);
        page.devices[one.device + ", " + one.driver +
                     (one.machine.empty() ? "" : ", machine " + one.machine)]
            .push_back(one);
    }
    std::vector<SitePage> list;
    for (auto& [key, page] : pages) {
        for (auto& [device, runs] : page.devices)
            std::ranges::stable_sort(runs, {}, [](const SiteComparison& run) {
                return std::pair(run.date, run.commit);
            });
        list.push_back(std::move(page));
    }
    return list;
}

std::string format_cell(double value, int decimals) {
    return report::format_fixed(value, decimals);
}

/// Returns the head row of a table whose first columns hold text and whose other columns hold
/// numbers.
std::string table_head(std::span<const std::string> titles, std::size_t text_columns = 1) {
    std::string html = "<thead><tr>";
    for (std::size_t i = 0; i < titles.size(); ++i)
        html += std::string("<th scope=\"col\"") + (i < text_columns ? " class=\"text\">" : ">") +
                escape_html(titles[i]) + "</th>";
    return html + "</tr></thead>";
}

/// Returns the rows on the front that the plot can show, the fastest first. The plot and the table
/// number them in this order.
std::vector<const SiteRow*> front_rows(const SiteComparison& run) {
    std::vector<const SiteRow*> front;
    for (const SiteRow& row : run.rows)
        if (row.on_front && row.ms > 0 && std::isfinite(row.flip)) front.push_back(&row);
    std::ranges::stable_sort(front, {}, [](const SiteRow* row) { return row->ms; });
    return front;
}

/// Returns a chart of time (logarithmic) against FLIP or RMSE. Marks of rows on the front are
/// filled, and have the rows' numbers.
std::string front_chart(const SiteComparison& run) {
    using report::number_json;
    const std::vector<const SiteRow*> front = front_rows(run);
    SiteJson rows = SiteJson::array(), times = rows, intervals = rows, flips = rows, rmses = rows,
             flip_intervals = rows, unknown = rows;
    for (const SiteRow& row : run.rows) {
        if (!(row.ms > 0) || !std::isfinite(row.flip)) continue;
        const auto place = std::ranges::find(front, &row);
        const bool is_on_front = place != front.end();
        rows.push_back({{"label", row.label},
                        {"name", is_on_front ? std::to_string(place - front.begin() + 1) : ""},
                        {"front", is_on_front}});
        times.push_back(row.ms);
        intervals.push_back(report::interval_json({row.ms_low, row.ms_high}));
        flips.push_back(row.flip);
        flip_intervals.push_back(report::interval_json({row.flip_low, row.flip_high}));
        rmses.push_back(number_json(row.rmse));
        unknown.push_back(nullptr);
    }
    if (rows.empty()) return "";
    const auto column = [](const char* name, const SiteJson& values, const SiteJson& ranges) {
        return SiteJson{{"name", name}, {"values", values}, {"intervals", ranges}};
    };
    const SiteJson data{{"kind", "rows"},
                        {"says", "Time and FLIP of each row; the table has the same values"},
                        {"time", column("device time of a frame, ms", times, intervals)},
                        {"metrics",
                         {column("FLIP over the mirrors", flips, flip_intervals),
                          column("RMSE over the mirrors", rmses, unknown)}},
                        {"rows", rows},
                        {"curves", SiteJson::array()},
                        {"log_x", true},
                        {"log_y", false}};
    return "<figure class=\"plot\">" +
           report::html_chart(data, "<p class=\"note\">The chart needs JavaScript; the table "
                                    "has the same values.</p>") +
           "<figcaption>Each mark is a row. Filled marks are on the front, and have their numbers in "
           "the table; stairs join them. Bars are 95 % intervals.</figcaption></figure>";
}

/// Returns the cell that tells a row's place: its number on the front, "reference", or empty text.
std::string describe_place(const SiteRow& row, const std::vector<const SiteRow*>& front) {
    if (const auto found = std::ranges::find(front, &row); found != front.end())
        return fmt::format("number {}", found - front.begin() + 1);
    return row.is_reference ? "reference" : "";
}

std::string describe_flip_interval(const SiteRow& row) {
    return std::isfinite(row.flip_low)
               ? report::format_error(row.flip_low) + " to " + report::format_error(row.flip_high)
               : std::string(report::kEmptyCell);
}

std::string latest_table(const SiteComparison& run) {
    std::vector<const SiteRow*> rows;
    for (const SiteRow& row : run.rows) rows.push_back(&row);
    std::ranges::stable_sort(rows, [](const SiteRow* a, const SiteRow* b) {
        return (std::isfinite(a->ms) ? a->ms : INFINITY) <
               (std::isfinite(b->ms) ? b->ms : INFINITY);
    });
    const bool has_flip_intervals = std::ranges::any_of(
        run.rows, [](const SiteRow& row) { return std::isfinite(row.flip_low); });
    std::vector<std::string> titles{"Row", "ms", "95 % interval", "FLIP"};
    if (has_flip_intervals) titles.emplace_back("95 % interval of FLIP");
    titles.insert(titles.end(), {"RMSE", "Front"});
    const std::vector<const SiteRow*> front = front_rows(run);
    std::string html = "<div class=\"scroll\" tabindex=\"0\"><table>" + table_head(titles) +
                       "<tbody>";
    for (const SiteRow* row : rows)
        html += fmt::format(
            "<tr{}><th scope=\"row\" class=\"text\">{}</th><td>{}</td><td>{}</td><td>{}</td>"
            "{}<td>{}</td><td>{}</td></tr>",
            row->on_front ? " class=\"front\"" : "", escape_html(row->label),
            format_cell(row->ms, 3),
            std::isfinite(row->ms_low)
                ? format_cell(row->ms_low, 3) + " to " + format_cell(row->ms_high, 3)
                : std::string(report::kEmptyCell),
            report::format_error(row->flip),
            has_flip_intervals ? "<td>" + describe_flip_interval(*row) + "</td>" : std::string(),
            report::format_error(row->rmse), describe_place(*row, front));
    return html + "</tbody></table></div>";
}

/// Returns a table with each row's time and FLIP in the latest reports, from the oldest to the
/// newest.
std::string history_table(const std::vector<SiteComparison>& runs) {
    if (runs.size() < 2) return "";
    const std::span<const SiteComparison> shown(
        runs.end() - static_cast<std::ptrdiff_t>(std::min(runs.size(), kMaxHistoryColumns)),
        runs.end());
    std::vector<std::string> titles{"ms / FLIP"}, labels;
    for (const SiteComparison& run : shown) {
        titles.push_back(run.commit + ", " + run.date.substr(0, std::string("2026-11-24").size()));
        for (const SiteRow& row : run.rows)
            if (std::ranges::find(labels, row.label) == labels.end()) labels.push_back(row.label);
    }
    std::string html = fmt::format("<h4>History: the latest {} of {} reports</h4>", shown.size(),
                                   runs.size()) +
                       "<div class=\"scroll\" tabindex=\"0\"><table>" + table_head(titles) +
                       "<tbody>";
    for (const std::string& label : labels) {
        html += "<tr><th scope=\"row\" class=\"text\">" + escape_html(label) + "</th>";
        for (const SiteComparison& run : shown) {
            const auto row = std::ranges::find(run.rows, label, &SiteRow::label);
            html += row == run.rows.end() ? "<td>" + std::string(report::kEmptyCell) + "</td>"
                                          : "<td>" + format_cell(row->ms, 3) + " / " +
                                                report::format_error(row->flip) + "</td>";
        }
        html += "</tr>";
    }
    return html + "</tbody></table></div>";
}

/// Returns the comparisons of one section, from the oldest to the newest. Comparisons of an earlier
/// version of the scene are left out.
std::vector<SiteComparison> section_runs(const std::vector<SiteComparison>& runs,
                                         const std::string& section) {
    std::vector<SiteComparison> list;
    std::ranges::copy_if(runs, std::back_inserter(list),
                         [&](const SiteComparison& run) { return run.section == section; });
    if (!list.empty())
        std::erase_if(list, [latest = list.back().hash](const SiteComparison& run) {
            return run.hash != latest;
        });
    return list;
}

/// Returns a table of the FLIP of each row in each section of a sweep. Values on the front of their
/// section are bold.
std::string overview_table(const std::vector<std::string>& sections,
                           const std::vector<SiteComparison>& runs) {
    std::vector<std::string> titles{"FLIP over the mirrors; bold: on the front"}, labels;
    std::vector<SiteComparison> latest;
    for (const std::string& section : sections) {
        const std::vector<SiteComparison> list = section_runs(runs, section);
        if (list.empty()) continue; // another device measured this section
        std::string title;          // with spaces at which a long title can be broken
        for (const char c : section) title += c == ',' ? std::string(", ") : std::string(1, c);
        titles.push_back(title);
        latest.push_back(list.back());
        for (const SiteRow& row : latest.back().rows)
            if (std::ranges::find(labels, row.label) == labels.end()) labels.push_back(row.label);
    }
    std::string html = "<div class=\"scroll\" tabindex=\"0\"><table>" + table_head(titles) +
                       "<tbody>";
    for (const std::string& label : labels) {
        html += "<tr><th scope=\"row\" class=\"text\">" + escape_html(label) + "</th>";
        for (const SiteComparison& run : latest) {
            const auto row = std::ranges::find(run.rows, label, &SiteRow::label);
            const std::string flip = row == run.rows.end() ? std::string(report::kEmptyCell)
                                                           : report::format_error(row->flip);
            const bool is_on_front = row != run.rows.end() && row->on_front;
            html += is_on_front ? "<td><b>" + flip + "</b></td>" : "<td>" + flip + "</td>";
        }
        html += "</tr>";
    }
    return html + "</tbody></table></div>";
}

/// Returns the front, the table and the history of comparisons of equal sections on one device.
std::string comparison_parts(const std::vector<SiteComparison>& runs) {
    const SiteComparison& latest = runs.back();
    return "<p>" +
           escape_html(fmt::format("Latest report: {}, commit {}, version {}.", latest.date,
                                   latest.commit, latest.version)) +
           "</p>" + front_chart(latest) + latest_table(latest) + history_table(runs);
}

std::string scene_page(const SitePage& page) {
    std::string html = "<header><p class=\"kicker\"><a href=\"index.html\">All scenes</a></p><h1>" +
                       escape_html(page.scene) + "</h1><p class=\"lede\">" +
                       escape_html(page.setting) + "</p></header><main>";
    for (const auto& [device, runs] : page.devices) {
        std::string parts;
        if (page.sections.size() > 1) parts += overview_table(page.sections, runs);
        for (const std::string& section : page.sections) {
            const std::vector<SiteComparison> list = section_runs(runs, section);
            if (list.empty()) continue;
            if (!section.empty()) parts += "<h3>" + escape_html(section) + "</h3>";
            parts += comparison_parts(list);
        }
        html += report::titled_section(escape_html(device), parts);
    }
    return report::html_page(page.scene, html + "</main>");
}

/// Script of the search field: hides the lines of the table that lack a word of the search text.
constexpr const char* kSearchScript = R"(<script>
document.getElementById('search').addEventListener('input', event => {
  const words = event.target.value.toLowerCase().split(/\s+/);
  for (const line of document.querySelectorAll('tbody tr'))
    line.hidden = !words.every(word => line.textContent.toLowerCase().includes(word));
});
</script>)";

/// Returns the labels of the rows on the front, from the fastest row on. In a sweep, a label on the
/// front of several sections is listed once, with the number of these sections.
std::string join_front_labels(const SitePage& page, const std::vector<SiteComparison>& runs) {
    std::vector<std::pair<std::string, std::size_t>> labels; // with the number of sections
    for (const std::string& section : page.sections) {
        const std::vector<SiteComparison> list = section_runs(runs, section);
        if (list.empty()) continue;
        std::vector<const SiteRow*> front;
        for (const SiteRow& row : list.back().rows)
            if (row.on_front) front.push_back(&row);
        std::ranges::sort(front, {}, [](const SiteRow* row) {
            return std::isfinite(row->ms) ? row->ms : INFINITY;
        });
        for (const SiteRow* row : front) {
            const auto known = std::ranges::find(labels, row->label,
                                                 &std::pair<std::string, std::size_t>::first);
            if (known != labels.end())
                ++known->second;
            else
                labels.emplace_back(row->label, 1);
        }
    }
    std::string text;
    for (const auto& [label, count] : labels) {
        text += (text.empty() ? "" : ", ") + label;
        if (page.sections.size() > 1)
            text += fmt::format(" ({} of {})", count, page.sections.size());
    }
    return text.empty() ? std::string(report::kEmptyCell) : text;
}

std::string index_page(const std::vector<SitePage>& pages, std::size_t reports) {
    std::string html = fmt::format(
        "<header><h1>Reflections compared</h1><p class=\"lede\">{} {} on {} scenes and "
        "settings.</p><p><label>Search <input id=\"search\" type=\"search\"></label></p></header>"
        "<main><div class=\"scroll\" tabindex=\"0\"><table class=\"words\">",
        reports, reports == 1 ? "report" : "reports", pages.size());
    static const std::vector<std::string> kTitles{
        "Scene", "Setting", "Device", "Front of the latest report, fastest first", "Reports"};
    html += table_head(kTitles, kTitles.size() - 1) + "<tbody>";
    for (const SitePage& page : pages)
        for (const auto& [device, runs] : page.devices)
            html += fmt::format(
                "<tr><th scope=\"row\" class=\"text\"><a href=\"{}\">{}</a></th><td "
                "class=\"text\">{}</td><td class=\"text\">{}</td><td "
                "class=\"text\">{}</td><td>{}</td></tr>",
                page.file, escape_html(page.scene), escape_html(page.setting), escape_html(device),
                escape_html(join_front_labels(page, runs)),
                section_runs(runs, runs.back().section).size());
    return report::html_page("all scenes", html + "</tbody></table></div></main>" + kSearchScript);
}

/// Removes the pages of scenes that no report contains any more.
void remove_other_pages(const fs::path& site, const std::vector<SitePage>& pages) {
    std::vector<fs::path> removed;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(site, error)) {
        const std::string name = entry.path().filename().string();
        const bool is_page = name.starts_with(kPagePrefix) && name.ends_with(".html") &&
                             name.size() == kPagePrefix.size() + kIdCharacters + 5;
        if (is_page && std::ranges::find(pages, name, &SitePage::file) == pages.end())
            removed.push_back(entry.path());
    }
    for (const fs::path& page : removed) fs::remove(page, error);
}

} // namespace

AddedReport add_report(const fs::path& file, const fs::path& site) {
    const std::string text = read_json_text(file, "a report", kMaxReportBytes);
    const std::size_t comparisons = read_site_report(file, text).size();
    report::create_folder(site / "reports");
    AddedReport added{sha256(text) + ".json", comparisons, false};
    const fs::path place = site / "reports" / added.name;
    std::error_code ignored;
    added.is_known = fs::exists(place, ignored);
    if (!added.is_known) write_file(place, text);
    return added;
}

BuiltSite build_site(const fs::path& site) {
    std::set<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(site / "reports", error))
        if (entry.path().extension() == ".json") files.insert(entry.path());
    check(!files.empty(), Failure::missing_input, (site / "reports").string(),
          ": wanted reports, found none; 'catoptric results add' adds one");
    std::vector<SiteComparison> comparisons;
    for (const fs::path& file : files)
        for (SiteComparison& one :
             read_site_report(file, read_json_text(file, "a report", kMaxReportBytes)))
            comparisons.push_back(std::move(one));
    const std::vector<SitePage> pages = group_by_page(comparisons);
    remove_other_pages(site, pages);
    for (const SitePage& page : pages) write_file(site / page.file, scene_page(page));
    write_file(site / "index.html", index_page(pages, files.size()));
    return {files.size(), pages.size() + 1};
}

} // namespace catoptric::cli
