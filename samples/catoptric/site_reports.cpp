#include "site_reports.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "report/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

namespace catoptric::cli {

namespace {

using SiteJson = nlohmann::ordered_json;

constexpr double kMaxReportedMs = 1e9;

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
    place.check(object.is_object(), "wanted an object, found ", report::describe(object));
    return object.value(name, SiteJson());
}

std::string read_text_member(const SiteJson& object, const std::string& name,
                             const ReportPlace& place) {
    const SiteJson value = find_member(object, name, place);
    place.at(name).check(value.is_string(), "wanted text, found ", report::describe(value));
    return value.get<std::string>();
}

/// Returns a number from `low` to `high`; NaN for null.
double read_number_member(const SiteJson& object, const std::string& name, const ReportPlace& place,
                          double low, double high) {
    const SiteJson value = find_member(object, name, place);
    const bool fits = value.is_number() && value.get<double>() >= low &&
                      value.get<double>() <= high;
    place.at(name).check(fits || value.is_null(), "wanted a number from ", low, " to ", high,
                         ", found ", report::describe(value));
    return fits ? value.get<double>() : NAN;
}

/// Returns the ends of an interval; NaN if there is none.
std::pair<double, double> read_interval(const SiteJson& json) {
    const bool has_interval = json.is_array() && json.size() == 2 && json[0].is_number() &&
                              json[1].is_number();
    return has_interval ? std::pair(json[0].get<double>(), json[1].get<double>())
                        : std::pair<double, double>(NAN, NAN);
}

/// Returns the name of the time by which a report judges its rows. Reports without it are older,
/// and judge by the device time.
std::string read_judged_time(const SiteJson& json, const ReportPlace& place) {
    const SiteJson name = find_member(json, "judged_time", place);
    if (name.is_null()) return "gpu_ms";
    place.at("judged_time")
        .check(name == "gpu_ms" || name == "frame_ms" || name == "cpu_ms",
               "wanted gpu_ms, frame_ms or cpu_ms, found ", report::describe(name));
    return name.get<std::string>();
}

SiteRow read_site_row(const SiteJson& json, const std::string& time, const ReportPlace& place) {
    SiteRow row;
    row.label = read_text_member(json, "label", place);
    // The label of a row names the model only in reports that compare both models. On a page with
    // reports of both kinds, labels without a model must not be mixed up.
    constexpr std::string_view kModel = ", model=required";
    if (find_member(json, "model", place) == "required" && !row.label.ends_with(kModel))
        row.label += kModel;
    SiteJson times = find_member(json, time, place);
    if (times.is_null()) times = find_member(json, "gpu_ms", place); // a row with a stated time
    if (!times.is_null()) { // null for a row whose pictures come from a file
        row.ms = read_number_member(times, "median", place.at(time), 0, kMaxReportedMs);
        std::tie(row.ms_low,
                 row.ms_high) = read_interval(find_member(times, "ci95", place.at(time)));
    }
    const SiteJson error = find_member(json, "error", place);
    row.flip = read_number_member(error, "flip", place.at("error"), 0, 1);
    // The rmse against a noisy reference is negative if its estimate is below the noise.
    row.rmse = read_number_member(error, "rmse", place.at("error"), -1, 1);
    row.is_reference = find_member(json, "is_reference", place) == true;
    std::tie(row.flip_low, row.flip_high) = read_interval(find_member(json, "flip_ci95", place));
    return row;
}

/// Returns the setting of a comparison as text: camera, instant, size and reference. Only
/// comparisons with equal settings stand on one page.
std::string describe_setting(const SiteJson& json, const ReportPlace& place) {
    const SiteJson size = find_member(json, "size", place);
    place.at("size").check(size.is_array() && size.size() == 2 && size[0].is_number_unsigned() &&
                               size[1].is_number_unsigned(),
                           "wanted two numbers of pixels, found ", report::describe(size));
    const SiteJson scene = find_member(json, "scene", place);
    const SiteJson camera = find_member(scene, "camera", place.at("scene"));
    const auto point = [&](const char* name) {
        const SiteJson value = find_member(camera, name, place.at("scene.camera"));
        place.at(std::string("scene.camera.") + name)
            .check(value.is_array() && value.size() == 3 && value[0].is_number() &&
                       value[1].is_number() && value[2].is_number(),
                   "wanted three numbers, found ", report::describe(value));
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
        read_text_member(find_member(json, "reference", place), "label", place.at("reference")));
    if (const SiteJson timing = find_member(json, "timing", place); timing == "pipelined")
        text += ", pipelined";
    if (find_member(json, "together", place) == true) text += ", all rows in one frame";
    if (read_judged_time(json, place) == "cpu_ms") text += ", by processor time";
    return text;
}

/// Returns whether the text is a date such as "2026-11-24T03:05:10Z", whose order is that of time.
bool is_date(const std::string& text) {
    constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:ddZ";
    return text.size() == kForm.size() &&
           std::ranges::equal(text, kForm, [](char found, char wanted) {
               return wanted == 'd' ? found >= '0' && found <= '9' : found == wanted;
           });
}

/// Reads the members that a comparison and a part of a sweep have in common.
SiteComparison read_common_members(const SiteJson& json, const ReportPlace& place) {
    SiteComparison found;
    const SiteJson scene = find_member(json, "scene", place),
                   device = find_member(json, "device", place);
    found.scene = read_text_member(scene, "name", place.at("scene"));
    found.hash = read_text_member(scene, "hash", place.at("scene"));
    found.device = read_text_member(device, "name", place.at("device"));
    found.driver = read_text_member(device, "driver", place.at("device"));
    found.commit = read_text_member(json, "commit", place);
    found.version = read_text_member(json, "version", place);
    found.date = read_text_member(json, "date", place);
    place.at("date").check(is_date(found.date),
                           "wanted a date such as 2026-11-24T03:05:10Z, found ", quote(found.date));
    const SiteJson rows = find_member(json, "rows", place);
    place.at("rows").check(rows.is_array() && !rows.empty(), "wanted a list of rows, found ",
                           report::describe(rows));
    const std::string time = read_judged_time(json, place);
    for (std::size_t i = 0; i < rows.size(); ++i)
        found.rows.push_back(read_site_row(rows[i], time, place.at(fmt::format("rows[{}]", i))));
    const SiteJson front = find_member(json, "pareto", place);
    place.at("pareto").check(front.is_array(), "wanted a list, found ", report::describe(front));
    for (const SiteJson& index : front) {
        place.at("pareto").check(index.is_number_unsigned() &&
                                     index.get<std::size_t>() < found.rows.size(),
                                 "wanted numbers of rows, found ", report::describe(index));
        found.rows[index.get<std::size_t>()].on_front = true;
    }
    return found;
}

SiteComparison read_site_comparison(const SiteJson& json, const ReportPlace& place) {
    place.check(find_member(json, "schema", place) == "catoptric/compare/1",
                "wanted the schema catoptric/compare/1, found ",
                report::describe(find_member(json, "schema", place)));
    place.check(find_member(json, "complete", place) == true,
                "wanted a complete report; this run was stopped");
    SiteComparison found = read_common_members(json, place);
    found.setting = describe_setting(json, place);
    return found;
}

/// Reads a comparison of results.json, which `sweep merge` writes.
SiteComparison read_sweep_comparison(const SiteJson& json, const ReportPlace& place) {
    SiteComparison found = read_common_members(json, place);
    found.setting = read_text_member(json, "setting", place);
    found.section = read_text_member(json, "section", place);
    found.machine = read_text_member(json, "machine", place);
    return found;
}

/// Reads all elements of a list by `read`.
std::vector<SiteComparison>
read_comparison_list(const SiteJson& json, const std::string& name, const ReportPlace& place,
                     SiteComparison (*read)(const SiteJson&, const ReportPlace&)) {
    const SiteJson elements = find_member(json, name, place);
    place.at(name).check(elements.is_array() && !elements.empty(),
                         "wanted a list with an element, found ", report::describe(elements));
    std::vector<SiteComparison> list;
    for (std::size_t i = 0; i < elements.size(); ++i)
        list.push_back(read(elements[i], place.at(fmt::format("{}[{}]", name, i))));
    return list;
}

} // namespace

std::vector<SiteComparison> read_site_report(const std::filesystem::path& file,
                                             const std::string& text) {
    const auto json = parse_json<SiteJson>(file.string(), text);
    const ReportPlace place(file.string());
    const SiteJson schema = find_member(json, "schema", place);
    if (schema == "catoptric/sweep-results/1")
        return read_comparison_list(json, "comparisons", place, read_sweep_comparison);
    if (schema != "catoptric/compare-scenes/1") return {read_site_comparison(json, place)};
    place.check(find_member(json, "complete", place) == true,
                "wanted a complete report; this run was stopped");
    return read_comparison_list(json, "scenes", place, read_site_comparison);
}

} // namespace catoptric::cli
