#include "report/baseline.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "measure/interval.hpp"
#include "report/html.hpp"
#include "report/json.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

/// Returns a member of an object, or null JSON.
Json find_member(const Json& object, const char* name) {
    return object.is_object() && object.contains(name) ? object.at(name) : Json();
}

/// Returns a number of an object, or NaN.
double read_number(const Json& object, const char* name) {
    const Json value = find_member(object, name);
    return value.is_number() ? value.get<double>() : NAN;
}

/// Numbers that are not stated are NaN.
measure::MedianWithInterval read_median(const Json& summary) {
    measure::MedianWithInterval time{read_number(summary, "median"), {}};
    const Json ci95 = find_member(summary, "ci95");
    if (ci95.is_array() && ci95.size() == 2 && ci95[0].is_number() && ci95[1].is_number())
        time.ci95 = {ci95[0].get<double>(), ci95[1].get<double>()};
    return time;
}

/// Returns the document of the comparison's scene in a report of one or several scenes.
Json find_scene_report(const Json& document, const Comparison& comparison,
                       const std::string& file) {
    if (find_member(document, "schema") == "catoptric/compare/1") return document;
    const Json scenes = find_member(document, "scenes");
    check(find_member(document, "schema") == "catoptric/compare-scenes/1" && scenes.is_array(),
          Failure::bad_data, file, ": wanted a report.json of 'catoptric compare', found schema ",
          describe(find_member(document, "schema")));
    for (const Json& scene : scenes) // two scenes may have one name, but not one hash
        if (find_member(find_member(scene, "scene"), "hash") == comparison.scene.hash) return scene;
    fail(Failure::bad_data, file, ": wanted the scene ", quote(comparison.scene.name),
         " as it is now (", comparison.scene.hash, "), found others");
}

/// Throws unless a member of an object is null or has the wanted kind.
void check_member(const Json& object, const char* name, bool fits, const char* wanted,
                  const std::string& place) {
    const Json value = find_member(object, name);
    check(fits || value.is_null(), Failure::bad_data, place, ".", name, ": wanted ", wanted,
          ", found ", describe(value));
}

/// Throws unless a time is null, or an object with a median and an interval.
void check_time_summary(const Json& object, const char* name, const std::string& place) {
    const Json times = find_member(object, name);
    check_member(object, name, times.is_object(), "an object or null", place);
    const std::string inside = place + "." + name;
    check_member(times, "median", find_member(times, "median").is_number(), "a number", inside);
    const Json ci95 = find_member(times, "ci95");
    check_member(times, "ci95",
                 ci95.is_array() && ci95.size() == 2 && ci95[0].is_number() && ci95[1].is_number(),
                 "two numbers or null", inside);
}

/// Throws unless the row has all members that the verdicts read, or lacks them.
void check_row(const Json& row, const std::string& place) {
    check(row.is_object() && find_member(row, "label").is_string(), Failure::bad_data, place,
          ": wanted a row with a label, found ", describe(row));
    const Json error = find_member(row, "error"), work = find_member(row, "work"),
               passes = find_member(row, "passes");
    check_member(row, "error", error.is_object(), "an object", place);
    check_member(error, "flip", find_member(error, "flip").is_number(), "a number or null",
                 place + ".error");
    for (const char* time : {"gpu_ms", "frame_ms", "cpu_ms"}) check_time_summary(row, time, place);
    check_member(row, "work", work.is_object(), "an object or null", place);
    check_member(row, "passes", passes.is_array(), "a list", place);
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const std::string pass = fmt::format("{}.passes[{}]", place, i);
        check(find_member(passes[i], "name").is_string(), Failure::bad_data, pass,
              ": wanted a pass with a name, found ", describe(passes[i]));
        check_time_summary(passes[i], "gpu_ms", pass);
    }
}

/// Throws unless both comparisons show the same picture against the same reference. Members that
/// are null now are not known yet, and are not compared.
void check_same_settings(const Json& before, const Json& now, const std::string& file) {
    check(find_member(before, "complete") == true && find_member(before, "rows").is_array(),
          Failure::bad_data, file, ": wanted a complete report, found one that was stopped");
    const Json rows = find_member(before, "rows");
    for (std::size_t i = 0; i < rows.size(); ++i)
        check_row(rows[i], fmt::format("{}: rows[{}]", file, i));
    check_time_summary(before, "clear_ms", file);
    const auto check_equal = [&](const std::string& name, const Json& a, const Json& b) {
        const auto write = [](const Json& value) {
            return value.dump(-1, ' ', true, Json::error_handler_t::replace);
        };
        // Other programs may have written the members in another order.
        check(b.is_null() || nlohmann::json(a) == nlohmann::json(b), Failure::bad_data, file,
              ": wanted a baseline with the same ", name, " as now (", write(b), "), found ",
              a.is_null() ? "nothing" : quote(write(a)));
    };
    for (const char* name : {"hash", "camera"})
        check_equal(std::string("scene.") + name, find_member(find_member(before, "scene"), name),
                    find_member(find_member(now, "scene"), name));
    for (const char* name : {"size", "time", "exposure", "ambient", "timing", "together"})
        check_equal(name, find_member(before, name), find_member(now, name));
    check_equal("reference.label", find_member(find_member(before, "reference"), "label"),
                find_member(find_member(now, "reference"), "label"));
}

std::string row_name(const Json& row) {
    const std::string label = find_member(row, "label"), model = ", model=required";
    return find_member(row, "model") != "required" || label.ends_with(model) ? label
                                                                             : label + model;
}

const Json* find_same_row(const Json& rows, const Json& row) {
    for (const Json& other : rows)
        if (find_member(other, "label") == find_member(row, "label") &&
            find_member(other, "model") == find_member(row, "model"))
            return &other;
    return nullptr;
}

// A pass is judged only if it takes at least this share of its row's time. Times of shorter passes
// differ from run to run by more than their intervals.
constexpr double kMinPassShare = .05;

/// Returns the median device time of a row or a pass, ms, or NaN.
double read_median_gpu_ms(const Json& timed) {
    return read_number(find_member(timed, "gpu_ms"), "median");
}

class BaselineJudge {
public:
    BaselineJudge(const Json& before, const Json& now, const BaselineLimits& limits)
        : limits_(limits), judged_time_(find_member(now, "judged_time")),
          same_device_(is_same_device(find_member(before, "device"), find_member(now, "device"))),
          floor_(find_noise_floor(now)) {
        const measure::MedianWithInterval control = measure::ratio_of_medians(
            read_median(find_member(now, "clear_ms")),
            read_median(find_member(before, "clear_ms")));
        if (control.ci95.low > 1) machine_ratio_ = control;
    }

    std::vector<BaselineFinding> judge_row(const Json& before, const Json& now) const {
        const std::string name = row_name(before);
        std::vector<BaselineFinding> findings{judge_flip(name, before, now)};
        for (BaselineFinding& finding : judge_work(name, before, now))
            findings.push_back(std::move(finding));
        const bool noisy = find_member(before, "noisy") == true ||
                           find_member(now, "noisy") == true;
        if (!find_member(before, "gpu_ms").is_object() || !find_member(now, "gpu_ms").is_object())
            return findings; // a picture of another renderer has no time
        // Older reports of moving scenes or processors may lack the time by which rows are judged.
        const bool is_stated = find_member(before, judged_time_.c_str()).is_object() &&
                               find_member(now, judged_time_.c_str()).is_object();
        findings.push_back(
            judge_time(name, "ms", is_stated ? judged_time_ : "gpu_ms", before, now, noisy));
        const double least = kMinPassShare * read_median_gpu_ms(now);
        for (const Json& pass : find_member(before, "passes"))
            for (const Json& other : find_member(now, "passes"))
                if (find_member(pass, "name") == find_member(other, "name") &&
                    read_median_gpu_ms(other) >= least)
                    findings.push_back(
                        judge_time(name, "ms of " + find_member(pass, "name").get<std::string>(),
                                   "gpu_ms", pass, other, noisy));
        return findings;
    }

private:
    static bool is_same_device(const Json& before, const Json& now) {
        for (const char* name : {"name", "driver", "threads"})
            if (find_member(before, name) != find_member(now, name)) return false;
        return true;
    }

    static double find_noise_floor(const Json& report) {
        const double floor = read_number(find_member(find_member(report, "reference"), "noise"),
                                         "flip_floor");
        return std::isnan(floor) ? 0 : floor;
    }

    BaselineFinding judge_flip(const std::string& row, const Json& before, const Json& now) const {
        BaselineFinding finding{.row = row, .quantity = "flip", .says = {}};
        finding.before = read_number(find_member(before, "error"), "flip");
        finding.now = read_number(find_member(now, "error"), "flip");
        if (std::isnan(finding.before) || std::isnan(finding.now)) {
            finding.verdict = BaselineVerdict::unknown;
            finding.says = "FLIP is not known in both reports";
            return finding;
        }
        const double rise = finding.now - finding.before;
        if (rise > limits_.max_flip_rise * std::max(finding.before, 0.0) && rise > floor_)
            finding.verdict = BaselineVerdict::worse;
        finding.says = fmt::format("FLIP {:.5g}, before {:.5g}; at most {:g} % more is allowed",
                                   finding.now, finding.before, 100 * limits_.max_flip_rise);
        return finding;
    }

    /// Judges each kind of counted work that both reports have. Counts are the same in each run, so
    /// no interval is needed.
    std::vector<BaselineFinding> judge_work(const std::string& row, const Json& before,
                                            const Json& now) const {
        std::vector<BaselineFinding> findings;
        const Json work = find_member(before, "work");
        if (!work.is_object()) return findings;
        for (const auto& [kind, count] : work.items()) {
            BaselineFinding finding{.row = row, .quantity = "work: " + kind, .says = {}};
            finding.before = read_number(work, kind.c_str());
            finding.now = read_number(find_member(now, "work"), kind.c_str());
            if (std::isnan(finding.before) || std::isnan(finding.now)) continue;
            if (finding.now > limits_.max_time_ratio * finding.before)
                finding.verdict = BaselineVerdict::worse;
            finding.says = fmt::format("{:g}, before {:g}; at most {:g} times is allowed",
                                       finding.now, finding.before, limits_.max_time_ratio);
            findings.push_back(std::move(finding));
        }
        return findings;
    }

    BaselineFinding judge_time(const std::string& row, const std::string& quantity,
                               const std::string& time, const Json& before, const Json& now,
                               bool noisy) const {
        BaselineFinding finding{.row = row, .quantity = quantity, .says = {}};
        const Json a = find_member(before, time.c_str()), b = find_member(now, time.c_str());
        finding.before = read_number(a, "median"), finding.now = read_number(b, "median");
        const measure::Interval ratio =
            measure::ratio_of_medians(measure::ratio_of_medians(read_median(b), read_median(a)),
                                      machine_ratio_)
                .ci95;
        const std::string times = fmt::format("{} ms{}, before {} ms", format_ms(finding.now),
                                              time == "cpu_ms" ? " of processor time" : "",
                                              format_ms(finding.before));
        const std::string limit = fmt::format("at most {:g} times is allowed",
                                              limits_.max_time_ratio);
        const measure::Order order = same_device_ && !noisy
                                         ? measure::compare_to_limit(ratio, limits_.max_time_ratio)
                                         : measure::Order::unknown;
        if (order == measure::Order::more) finding.verdict = BaselineVerdict::worse;
        if (order == measure::Order::unknown) finding.verdict = BaselineVerdict::unknown;
        const std::string why = !same_device_ ? "the device is another"
                                : noisy       ? "other programs used the processors"
                                : !ratio.is_known()
                                    ? "there are too few rounds"
                                    : fmt::format("{:.2f} to {:.2f} times with 95 % confidence",
                                                  ratio.low, ratio.high);
        finding.says = times + ": " + why + "; " + limit;
        return finding;
    }

    BaselineLimits limits_;
    std::string judged_time_; ///< name of the time by which rows are judged now
    bool same_device_;
    double floor_;
    measure::MedianWithInterval machine_ratio_{1, {1, 1}}; ///< how much slower the machine is now
};

/// Returns the row that takes the place of a row of the baseline which this comparison lacks: a new
/// row of the same technique and model that errs no more, such as the technique with another knob.
/// Null if there is none.
const Json* find_replacement(const Json& rows, const Json& rows_before, const Json& missing) {
    const double flip = read_number(find_member(missing, "error"), "flip");
    for (const Json& row : rows)
        if (find_same_row(rows_before, row) == nullptr &&
            find_member(row, "technique") == find_member(missing, "technique") &&
            find_member(row, "model") == find_member(missing, "model") &&
            read_number(find_member(row, "error"), "flip") <= flip)
            return &row;
    return nullptr;
}

BaselineFinding describe_missing_row(const Json& rows, const Json& rows_before,
                                     const Json& missing) {
    BaselineFinding finding{.row = row_name(missing),
                            .quantity = "row",
                            .verdict = BaselineVerdict::missing,
                            .says = "is in the baseline, and not in this comparison"};
    if (const Json* row = find_replacement(rows, rows_before, missing)) {
        finding.verdict = BaselineVerdict::replaced;
        finding.says = "is in the baseline, and not in this comparison, whose new row " +
                       row_name(*row) + " errs no more";
    }
    return finding;
}

constexpr BaselineVerdict kShownVerdicts[] = {BaselineVerdict::worse, BaselineVerdict::missing,
                                              BaselineVerdict::unknown, BaselineVerdict::replaced,
                                              BaselineVerdict::added};

std::vector<const BaselineFinding*> with_verdict(const std::vector<BaselineFinding>& findings,
                                                 BaselineVerdict verdict) {
    std::vector<const BaselineFinding*> list;
    for (const BaselineFinding& finding : findings)
        if (finding.verdict == verdict) list.push_back(&finding);
    return list;
}

std::size_t count_failures(const std::vector<BaselineFinding>& findings) {
    return static_cast<std::size_t>(std::ranges::count_if(findings, is_failure));
}

/// Returns the number of findings with each verdict. Verdicts on whole rows are left out where
/// there are none.
std::string format_counts(const std::vector<BaselineFinding>& findings) {
    std::string text = "baseline:";
    for (const BaselineVerdict verdict :
         {BaselineVerdict::worse, BaselineVerdict::missing, BaselineVerdict::unknown,
          BaselineVerdict::kept, BaselineVerdict::replaced, BaselineVerdict::added}) {
        const std::size_t count = with_verdict(findings, verdict).size();
        const bool is_of_rows = verdict == BaselineVerdict::missing ||
                                verdict == BaselineVerdict::replaced ||
                                verdict == BaselineVerdict::added;
        if (count > 0 || !is_of_rows)
            text += fmt::format("{} {} {}", text.ends_with(':') ? "" : ",", count,
                                verdict_name(verdict));
    }
    return text;
}

} // namespace

const char* verdict_name(BaselineVerdict verdict) {
    constexpr const char* kBaselineVerdictNames[] = {"kept",    "worse",    "unknown",
                                                     "missing", "replaced", "added"};
    return kBaselineVerdictNames[static_cast<std::size_t>(verdict)];
}

bool is_failure(const BaselineFinding& finding) {
    return finding.verdict == BaselineVerdict::worse || finding.verdict == BaselineVerdict::missing;
}

void check_baseline(const Comparison& comparison, const std::string& json,
                    const std::string& file) {
    check_same_settings(find_scene_report(parse_json<Json>(file, json), comparison, file),
                        report_json(comparison), file);
}

std::vector<BaselineFinding> judge_comparison(const Comparison& comparison, const std::string& json,
                                              const std::string& file,
                                              const BaselineLimits& limits) {
    const Json before = find_scene_report(parse_json<Json>(file, json), comparison, file),
               now = report_json(comparison);
    check_same_settings(before, now, file);
    const BaselineJudge judge(before, now, limits);
    std::vector<BaselineFinding> findings;
    const Json &rows_before = before.at("rows"), &rows = now.at("rows");
    for (const Json& row : rows_before) {
        if (const Json* same = find_same_row(rows, row)) {
            for (BaselineFinding& finding : judge.judge_row(row, *same))
                findings.push_back(std::move(finding));
        } else {
            findings.push_back(describe_missing_row(rows, rows_before, row));
        }
    }
    for (const Json& row : rows)
        if (find_same_row(rows_before, row) == nullptr)
            findings.push_back({row_name(row), "row", BaselineVerdict::added, NAN, NAN,
                                "is not in the baseline, and not judged"});
    return findings;
}

std::string format_findings(const std::vector<BaselineFinding>& findings) {
    std::string text;
    for (const BaselineVerdict verdict : kShownVerdicts)
        for (const BaselineFinding* finding : with_verdict(findings, verdict))
            text += fmt::format("{}: {}, {}: {}\n", verdict_name(verdict), finding->row,
                                finding->quantity, finding->says);
    return text + format_counts(findings) + "\n";
}

std::string to_markdown(const std::vector<BaselineFinding>& findings, const std::string& scene) {
    const bool is_worse = count_failures(findings) > 0;
    std::string text = fmt::format("### {}: {}\n\n{}\n", escape_markdown(scene),
                                   is_worse ? "worse than the baseline"
                                            : "not worse than the baseline",
                                   format_counts(findings));
    std::string table;
    for (const BaselineVerdict verdict : kShownVerdicts)
        for (const BaselineFinding* finding : with_verdict(findings, verdict))
            table += fmt::format("| {} | {} | {} | {} |\n", verdict_name(verdict),
                                 escape_markdown(finding->row), escape_markdown(finding->quantity),
                                 escape_markdown(finding->says));
    if (!table.empty()) text += "\n| verdict | row | quantity | |\n|---|---|---|---|\n" + table;
    return text;
}

std::string to_junit(const std::vector<BaselineFinding>& findings, const std::string& scene) {
    // HTML and XML need the same five characters escaped.
    std::string xml = fmt::format(
        "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n", escape_html(scene),
        findings.size(), count_failures(findings),
        with_verdict(findings, BaselineVerdict::unknown).size());
    for (const BaselineFinding& finding : findings) {
        xml += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escape_html(finding.row),
                           escape_html(finding.quantity));
        const std::string says = escape_html(finding.says);
        switch (finding.verdict) {
        case BaselineVerdict::kept:
        case BaselineVerdict::replaced:
        case BaselineVerdict::added: xml += "/>\n"; break;
        case BaselineVerdict::worse:
        case BaselineVerdict::missing:
            xml += fmt::format("><failure message=\"{}\"/></testcase>\n", says);
            break;
        case BaselineVerdict::unknown:
            xml += fmt::format("><skipped message=\"{}\"/></testcase>\n", says);
            break;
        }
    }
    return xml + "</testsuite>\n";
}

} // namespace catoptric::report
