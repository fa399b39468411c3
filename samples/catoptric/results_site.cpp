#include "results_site.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "report.hpp"
#include "report/html.hpp"
#include "report/json.hpp"
#include "report/text.hpp"
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
constexpr double kMaxReportedMs = 1e9;
constexpr std::size_t kMaxHistoryColumns = 12; // only the latest reports get a column
constexpr std::size_t kIdCharacters = 12;
constexpr std::string_view kPagePrefix = "scene-";

/// A row of a report.
struct SiteRow {
    std::string label;
    double ms = NAN, ms_low = NAN, ms_high = NAN; ///< device time of a frame, and its 95 % interval
    double flip = NAN, rmse = NAN;                ///< over the mirrors
    bool is_reference = false, on_front = false;
};

/// A comparison of one scene on one device.
struct SiteComparison {
    std::string scene, hash, device, driver, commit, date, version;
    std::string setting; ///< camera, instant, size and reference, as text
    std::vector<SiteRow> rows;
};

/// A place in a report, for messages.
class ReportPlace {
public:
    ReportPlace(std::string file, std::string member = {})
        : file_(std::move(file)), member_(std::move(member)) {}

    ReportPlace at(const std::string& member) const {
        return {file_, member_.empty() ? member : member_ + "." + member};
    }
    template <typename... Parts>
    void check(bool ok, const Parts&... parts) const {
        catoptric::check(ok, Failure::bad_data, file_, ": ", member_, member_.empty() ? "" : ": ",
                         parts...);
    }

private:
    std::string file_, member_;
};

SiteJson find_member(const SiteJson& object, const std::string& name, const ReportPlace& place) {
    place.check(object.is_object(), "wanted an object, found ",
                report::describe_json_value(object));
    return object.value(name, SiteJson());
}

std::string read_text_member_of_report(const SiteJson& object, const std::string& name,
                                       const ReportPlace& place) {
    const SiteJson value = find_member(object, name, place);
    place.at(name).check(value.is_string(), "wanted text, found ",
                         report::describe_json_value(value));
    return value.get<std::string>();
}

/// Returns a number from `low` to `high`; NaN for null.
double read_number_member_within(const SiteJson& object, const std::string& name,
                                 const ReportPlace& place, double low, double high) {
    const SiteJson value = find_member(object, name, place);
    const bool fits = value.is_number() && value.get<double>() >= low &&
                      value.get<double>() <= high;
    place.at(name).check(fits || value.is_null(), "wanted a number from ", low, " to ", high,
                         ", found ", report::describe_json_value(value));
    return fits ? value.get<double>() : NAN;
}

SiteRow read_site_row(const SiteJson& json, const ReportPlace& place) {
    SiteRow row;
    row.label = read_text_member_of_report(json, "label", place);
    // The label of a row names the model only in reports that compare both models. On a page with
    // reports of both kinds, labels without a model must not be mixed up.
    constexpr std::string_view kModel = ", model=required";
    if (find_member(json, "model", place) == "required" && !row.label.ends_with(kModel))
        row.label += kModel;
    const SiteJson times = find_member(json, "gpu_ms", place);
    if (!times.is_null()) { // null for a row whose pictures come from a file
        row.ms = read_number_member_within(times, "median", place.at("gpu_ms"), 0, kMaxReportedMs);
        const SiteJson interval = find_member(times, "ci95", place.at("gpu_ms"));
        const bool has_interval = interval.is_array() && interval.size() == 2 &&
                                  interval[0].is_number() && interval[1].is_number();
        if (has_interval) row.ms_low = interval[0], row.ms_high = interval[1];
    }
    const SiteJson error = find_member(json, "error", place);
    row.flip = read_number_member_within(error, "flip", place.at("error"), 0, 1);
    // The rmse against a noisy reference is negative if its estimate is below the noise.
    row.rmse = read_number_member_within(error, "rmse", place.at("error"), -1, 1);
    row.is_reference = find_member(json, "is_reference", place) == true;
    return row;
}

/// Returns the setting of a comparison as text: camera, instant, size and reference. Only
/// comparisons with equal settings stand on one page.
std::string describe_setting(const SiteJson& json, const ReportPlace& place) {
    const SiteJson size = find_member(json, "size", place);
    place.at("size").check(size.is_array() && size.size() == 2 && size[0].is_number_unsigned() &&
                               size[1].is_number_unsigned(),
                           "wanted two numbers of pixels, found ",
                           report::describe_json_value(size));
    const SiteJson scene = find_member(json, "scene", place);
    const SiteJson camera = find_member(scene, "camera", place.at("scene"));
    const auto point = [&](const char* name) {
        const SiteJson value = find_member(camera, name, place.at("scene.camera"));
        place.at(std::string("scene.camera.") + name)
            .check(value.is_array() && value.size() == 3 && value[0].is_number() &&
                       value[1].is_number() && value[2].is_number(),
                   "wanted three numbers, found ", report::describe_json_value(value));
        return fmt::format("{} {} {}", value[0].get<double>(), value[1].get<double>(),
                           value[2].get<double>());
    };
    const auto number = [](const SiteJson& object, const char* name) {
        const SiteJson value = object.is_object() ? object.value(name, SiteJson()) : SiteJson();
        return value.is_number() ? fmt::format("{}", value.get<double>()) : std::string("0");
    };
    const std::string height = number(camera, "orthographic_height");
    std::string text = fmt::format(
        "{}x{}, {} s, camera from {} to {}, up {}, {}, exposure {}, ambient {}, reference {}",
        size[0].get<unsigned>(), size[1].get<unsigned>(), number(json, "time"), point("eye"),
        point("target"), point("up"),
        height == "0" ? number(camera, "vertical_fov_degrees") + " degrees" : height + " high",
        number(json, "exposure"), number(json, "ambient"),
        read_text_member_of_report(find_member(json, "reference", place), "label",
                                   place.at("reference")));
    if (const SiteJson timing = find_member(json, "timing", place); timing == "pipelined")
        text += ", pipelined";
    if (find_member(json, "together", place) == true) text += ", all rows in one frame";
    return text;
}

/// Returns whether the text is a date such as "2026-11-24T03:05:10Z", whose order is that of time.
bool is_report_date(const std::string& text) {
    constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:ddZ";
    return text.size() == kForm.size() &&
           std::ranges::equal(text, kForm, [](char found, char wanted) {
               return wanted == 'd' ? found >= '0' && found <= '9' : found == wanted;
           });
}

SiteComparison read_site_comparison(const SiteJson& json, const ReportPlace& place) {
    place.check(find_member(json, "schema", place) == "catoptric/compare/1",
                "wanted the schema catoptric/compare/1, found ",
                report::describe_json_value(find_member(json, "schema", place)));
    place.check(find_member(json, "complete", place) == true,
                "wanted a complete report; this run was stopped");
    SiteComparison found;
    const SiteJson scene = find_member(json, "scene", place),
                   device = find_member(json, "device", place);
    found.scene = read_text_member_of_report(scene, "name", place.at("scene"));
    found.hash = read_text_member_of_report(scene, "hash", place.at("scene"));
    found.device = read_text_member_of_report(device, "name", place.at("device"));
    found.driver = read_text_member_of_report(device, "driver", place.at("device"));
    found.commit = read_text_member_of_report(json, "commit", place);
    found.version = read_text_member_of_report(json, "version", place);
    found.date = read_text_member_of_report(json, "date", place);
    place.at("date").check(is_report_date(found.date),
                           "wanted a date such as "
                           "2026-11-24T03:05:10Z, found ",
                           quote_text_with_escapes(found.date));
    found.setting = describe_setting(json, place);
    const SiteJson rows = find_member(json, "rows", place);
    place.at("rows").check(rows.is_array() && !rows.empty(), "wanted a list of rows, found ",
                           report::describe_json_value(rows));
    for (std::size_t i = 0; i < rows.size(); ++i)
        found.rows.push_back(read_site_row(rows[i], place.at(fmt::format("rows[{}]", i))));
    const SiteJson front = find_member(json, "pareto", place);
    place.at("pareto").check(front.is_array(), "wanted a list, found ",
                             report::describe_json_value(front));
    for (const SiteJson& index : front) {
        place.at("pareto").check(
            index.is_number_unsigned() && index.get<std::size_t>() < found.rows.size(),
            "wanted numbers of rows, found ", report::describe_json_value(index));
        found.rows[index.get<std::size_t>()].on_front = true;
    }
    return found;
}

/// Returns the comparisons of a report on one scene or several.
std::vector<SiteComparison> read_report(const fs::path& file, const std::string& text) {
    const auto json = parse_json<SiteJson>(file.string(), text);
    const ReportPlace place(file.string());
    std::vector<SiteComparison> list;
    if (find_member(json, "schema", place) != "catoptric/compare-scenes/1") {
        list.push_back(read_site_comparison(json, place));
        return list;
    }
    place.check(find_member(json, "complete", place) == true,
                "wanted a complete report; this run was stopped");
    const SiteJson scenes = find_member(json, "scenes", place);
    place.at("scenes").check(scenes.is_array() && !scenes.empty(), "wanted a list, found ",
                             report::describe_json_value(scenes));
    for (std::size_t i = 0; i < scenes.size(); ++i)
        list.push_back(read_site_comparison(scenes[i], place.at(fmt::format("scenes[{}]", i))));
    return list;
}

/// Comparisons of one scene with one setting, by device, from the oldest to the newest.
struct SitePage {
    std::string scene, setting, file;
    std::map<std::string, std::vector<SiteComparison>> devices;
};

std::vector<SitePage> group_comparisons_by_page(const std::vector<SiteComparison>& comparisons) {
    std::map<std::string, SitePage> pages; // sorted by scene and setting
    for (const SiteComparison& one : comparisons) {
        const std::string key = one.scene + "\n" + one.hash + "\n" + one.setting;
        SitePage& page = pages[key];
        page.scene = one.scene;
        page.setting = "hash " + one.hash.substr(0, 8) + ", " + one.setting;
        page.file = std::string(kPagePrefix) + compute_sha256(key).substr(0, kIdCharacters) +
                    ".html";
        page.devices[one.device + ", " + one.driver].push_back(one);
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
std::string make_table_head(std::span<const std::string> titles, std::size_t text_columns = 1) {
    std::string html = "<thead><tr>";
    for (std::size_t i = 0; i < titles.size(); ++i)
        html += std::string("<th scope=\"col\"") + (i < text_columns ? " class=\"text\">" : ">") +
                escape_html(titles[i]) + "</th>";
    return html + "</tr></thead>";
}

/// Returns the rows on the front that the plot can show, the fastest first. The plot and the table
/// number them in this order.
std::vector<const SiteRow*> list_front_rows(const SiteComparison& run) {
    std::vector<const SiteRow*> front;
    for (const SiteRow& row : run.rows)
        if (row.on_front && row.ms > 0 && std::isfinite(row.flip)) front.push_back(&row);
    std::ranges::stable_sort(front, {}, [](const SiteRow* row) { return row->ms; });
    return front;
}

/// Returns a plot of time (logarithmic) against FLIP. Points of the front are filled and joined.
std::string make_front_plot(const SiteComparison& run) {
    constexpr double kWidth = 720, kHeight = 320, kLeft = 56, kRight = 24, kTop = 16, kBottom = 44;
    double low = INFINITY, high = 0, most = 0;
    for (const SiteRow& row : run.rows)
        if (row.ms > 0 && std::isfinite(row.flip)) {
            low = std::min(low, row.ms), high = std::max(high, row.ms);
            most = std::max(most, row.flip);
        }
    if (!(high > 0)) return "";
    low = std::log10(low / 1.2), high = std::log10(high * 1.2), most = std::max(most * 1.1, 1e-6);
    const auto x = [&](double ms) {
        return kLeft + (std::log10(ms) - low) / (high - low) * (kWidth - kLeft - kRight);
    };
    const auto y = [&](double flip) {
        return kHeight - kBottom - flip / most * (kHeight - kTop - kBottom);
    };
    std::string svg = fmt::format(
        "<figure class=\"plot scroll\" tabindex=\"0\"><svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Time and FLIP "
        "of each row\" font-size=\"11\" fill=\"currentColor\"><g stroke=\"currentColor\" "
        "stroke-opacity=\".25\"><path d=\"M{} {}V{}H{}\" fill=\"none\"/></g>",
        kWidth, kHeight, kLeft, kTop, kHeight - kBottom, kWidth - kRight);
    for (int power = static_cast<int>(std::floor(low)); power <= std::floor(high); ++power)
        for (const double step : {1.0, 2.0, 5.0})
            if (const double at = step * std::pow(10, power);
                std::log10(at) >= low && std::log10(at) <= high)
                svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g}</text>",
                                   x(at), kHeight - kBottom + 16, at);
    for (const double share : {0.0, .5, 1.0})
        svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:.3g}</text>",
                           kLeft - 6, y(share * most / 1.1) + 4, share * most / 1.1);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">device time of a frame, ms "
                       "(logarithmic)</text><text x=\"{}\" y=\"{}\">FLIP over the mirrors</text>",
                       (kLeft + kWidth - kRight) / 2, kHeight - 8, kLeft + 6, kTop + 4);
    const std::vector<const SiteRow*> front = list_front_rows(run);
    std::string path;
    for (const SiteRow* row : front)
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(row->ms), y(row->flip));
    svg += "<path d=\"" + path + "\" fill=\"none\" stroke=\"var(--accent)\"/>";
    for (const SiteRow& row : run.rows) {
        if (!(row.ms > 0) || !std::isfinite(row.flip)) continue;
        const std::string says = fmt::format("{}: {} ms, FLIP {}", row.label,
                                             format_cell(row.ms, 3),
                                             report::format_picture_error(row.flip));
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\" "
                           "stroke=\"var(--accent)\"><title>{}</title></circle>",
                           x(row.ms), y(row.flip), row.on_front ? "var(--accent)" : "var(--card)",
                           escape_html(says));
    }
    // Writes the numbers of the front's rows above their circles. A number that would cover the
    // previous number moves up.
    dvec2 last(-INFINITY);
    for (std::size_t i = 0; i < front.size(); ++i) {
        dvec2 at(x(front[i]->ms), y(front[i]->flip) - 8);
        if (at.x - last.x < 12) at.y = std::min(at.y, last.y - 12);
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", at.x,
                           at.y, i + 1);
        last = at;
    }
    return svg + "</svg></figure>";
}

/// Returns the cell that tells a row's place: its number on the front, "reference", or empty text.
std::string describe_place_on_front(const SiteRow& row, const std::vector<const SiteRow*>& front) {
    if (const auto found = std::ranges::find(front, &row); found != front.end())
        return fmt::format("number {}", found - front.begin() + 1);
    return row.is_reference ? "reference" : "";
}

std::string make_latest_table(const SiteComparison& run) {
    std::vector<const SiteRow*> rows;
    for (const SiteRow& row : run.rows) rows.push_back(&row);
    std::ranges::stable_sort(rows, [](const SiteRow* a, const SiteRow* b) {
        return (std::isfinite(a->ms) ? a->ms : INFINITY) <
               (std::isfinite(b->ms) ? b->ms : INFINITY);
    });
    static const std::vector<std::string> kTitles{"Row",  "ms",   "95 % interval",
                                                  "FLIP", "RMSE", "Front"};
    const std::vector<const SiteRow*> front = list_front_rows(run);
    std::string html = "<div class=\"scroll\" tabindex=\"0\"><table>" + make_table_head(kTitles) +
                       "<tbody>";
    for (const SiteRow* row : rows)
        html += fmt::format(
            "<tr{}><th scope=\"row\" class=\"text\">{}</th><td>{}</td><td>{}</td><td>{}</td>"
            "<td>{}</td><td>{}</td></tr>",
            row->on_front ? " class=\"front\"" : "", escape_html(row->label),
            format_cell(row->ms, 3),
            std::isfinite(row->ms_low)
                ? format_cell(row->ms_low, 3) + " to " + format_cell(row->ms_high, 3)
                : std::string(report::kEmptyCellText),
            report::format_picture_error(row->flip), report::format_picture_error(row->rmse),
            describe_place_on_front(*row, front));
    return html + "</tbody></table></div>";
}

/// Returns a table with each row's time and FLIP in the latest reports, from the oldest to the
/// newest.
std::string make_history_table(const std::vector<SiteComparison>& runs) {
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
    std::string html = fmt::format("<h3>History: the latest {} of {} reports</h3>", shown.size(),
                                   runs.size()) +
                       "<div class=\"scroll\" tabindex=\"0\"><table>" + make_table_head(titles) +
                       "<tbody>";
    for (const std::string& label : labels) {
        html += "<tr><th scope=\"row\" class=\"text\">" + escape_html(label) + "</th>";
        for (const SiteComparison& run : shown) {
            const auto row = std::ranges::find(run.rows, label, &SiteRow::label);
            html += row == run.rows.end() ? "<td>" + std::string(report::kEmptyCellText) + "</td>"
                                          : "<td>" + format_cell(row->ms, 3) + " / " +
                                                report::format_picture_error(row->flip) + "</td>";
        }
        html += "</tr>";
    }
    return html + "</tbody></table></div>";
}

std::string make_scene_page(const SitePage& page) {
    std::string html = "<header><p class=\"kicker\"><a href=\"index.html\">All scenes</a></p><h1>" +
                       escape_html(page.scene) + "</h1><p class=\"lede\">" +
                       escape_html(page.setting) + "</p></header><main>";
    for (const auto& [device, runs] : page.devices) {
        const SiteComparison& latest = runs.back();
        html += report::make_html_titled_section(
            escape_html(device),
            "<p>" +
                escape_html(fmt::format("Latest report: {}, commit {}, version {}.", latest.date,
                                        latest.commit, latest.version)) +
                "</p>" + make_front_plot(latest) + make_latest_table(latest) +
                make_history_table(runs));
    }
    return report::make_html_page(page.scene, html + "</main>");
}

/// Script of the search field: hides the lines of the table that lack a word of the search text.
constexpr const char* kSearchScript = R"(<script>
document.getElementById('search').addEventListener('input', event => {
  const words = event.target.value.toLowerCase().split(/\s+/);
  for (const line of document.querySelectorAll('tbody tr'))
    line.hidden = !words.every(word => line.textContent.toLowerCase().includes(word));
});
</script>)";

std::string join_labels_of_front_rows(const SiteComparison& run) {
    std::vector<const SiteRow*> front;
    for (const SiteRow& row : run.rows)
        if (row.on_front) front.push_back(&row);
    std::ranges::sort(front, {}, [](const SiteRow* row) {
        return std::isfinite(row->ms) ? row->ms : kMaxReportedMs;
    });
    std::string text;
    for (const SiteRow* row : front) text += (text.empty() ? "" : ", ") + row->label;
    return text.empty() ? std::string(report::kEmptyCellText) : text;
}

std::string make_index_page(const std::vector<SitePage>& pages, std::size_t reports) {
    std::string html = fmt::format(
        "<header><h1>Reflections compared</h1><p class=\"lede\">{} reports on {} scenes and "
        "settings.</p><p><label>Search <input id=\"search\" type=\"search\"></label></p></header>"
        "<main><div class=\"scroll\" tabindex=\"0\"><table class=\"words\">",
        reports, pages.size());
    static const std::vector<std::string> kTitles{
        "Scene", "Setting", "Device", "Front of the latest report, fastest first", "Reports"};
    html += make_table_head(kTitles, kTitles.size() - 1) + "<tbody>";
    for (const SitePage& page : pages)
        for (const auto& [device, runs] : page.devices)
            html += fmt::format(
                "<tr><th scope=\"row\" class=\"text\"><a href=\"{}\">{}</a></th><td "
                "class=\"text\">{}</td><td class=\"text\">{}</td><td "
                "class=\"text\">{}</td><td>{}</td></tr>",
                page.file, escape_html(page.scene), escape_html(page.setting), escape_html(device),
                escape_html(join_labels_of_front_rows(runs.back())), runs.size());
    return report::make_html_page("all scenes",
                                  html + "</tbody></table></div></main>" + kSearchScript);
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

AddedReport add_report_to_site(const fs::path& file, const fs::path& site) {
    const std::string text = read_json_text(file, "a report", kMaxReportBytes);
    const std::size_t scenes = read_report(file, text).size();
    report::create_folder(site / "reports");
    AddedReport added{compute_sha256(text) + ".json", scenes, false};
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
             read_report(file, read_json_text(file, "a report", kMaxReportBytes)))
            comparisons.push_back(std::move(one));
    const std::vector<SitePage> pages = group_comparisons_by_page(comparisons);
    remove_other_pages(site, pages);
    for (const SitePage& page : pages) write_file(site / page.file, make_scene_page(page));
    write_file(site / "index.html", make_index_page(pages, files.size()));
    return {files.size(), pages.size() + 1};
}

} // namespace catoptric::cli
