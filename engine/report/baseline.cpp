#include "report/baseline.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "report/html.hpp"
#include "report/json.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

/// Returns a member of an object, or null JSON.
Json member_of(const Json& object, const char* name) {
    return object.is_object() && object.contains(name) ? object.at(name) : Json();
}

/// Returns a number of an object, or NaN.
double number_of(const Json& object, const char* name) {
    const Json value = member_of(object, name);
    return value.is_number() ? value.get<double>() : NAN;
}

measure::Interval interval_of(const Json& summary) {
    const Json ci95 = member_of(summary, "ci95");
    if (!ci95.is_array() || ci95.size() != 2 || !ci95[0].is_number() || !ci95[1].is_number())
        return {};
    return {ci95[0].get<double>(), ci95[1].get<double>()};
}

/// Returns the document of the comparison's scene in a report of one or several scenes.
Json find_scene_report(const Json& document, const Comparison& comparison,
                       const std::string& file) {
    if (member_of(document, "schema") == "catoptric/compare/1") return document;
    const Json scenes = member_of(document, "scenes");
    check(member_of(document, "schema") == "catoptric/compare-scenes/1" && scenes.is_array(),
          Failure::bad_data, file, ": wanted a report.json of 'catoptric compare', found schema ",
          describe_json_value(member_of(document, "schema")));
    for (const Json& scene : scenes) // two scenes may have one name, but not one hash
        if (member_of(member_of(scene, "scene"), "hash") == comparison.scene.hash) return scene;
    fail(Failure::bad_data, file, ": wanted the scene ",
         quote_as_printable_text(comparison.scene.name), " as it is now (", comparison.scene.hash,
         "), found others");
}

/// Throws unless both comparisons show the same picture against the same reference.
void check_same_question(const Json& before, const Json& now, const std::string& file) {
    check(member_of(before, "complete") == true && member_of(before, "rows").is_array(),
          Failure::bad_data, file, ": wanted a complete report, found one that was stopped");
    const auto check_equal = [&](const std::string& name, const Json& a, const Json& b) {
        // Other programs may have written the members in another order.
        check(nlohmann::json(a) == nlohmann::json(b), Failure::bad_data, file,
              ": wanted a baseline with the same ", name, " as now (",
              b.dump(-1, ' ', true, Json::error_handler_t::replace), "), found ",
              describe_json_value(a));
    };
    for (const char* name : {"hash", "camera"})
        check_equal(std::string("scene.") + name, member_of(member_of(before, "scene"), name),
                    member_of(member_of(now, "scene"), name));
    for (const char* name : {"size", "time", "exposure", "ambient", "timing", "together"})
        check_equal(name, member_of(before, name), member_of(now, name));
    check_equal("reference.label", member_of(member_of(before, "reference"), "label"),
                member_of(member_of(now, "reference"), "label"));
}

std::string baseline_row_name(const Json& row) {
    const std::string label = member_of(row, "label"), model = ", model=required";
    return member_of(row, "model") != "required" || label.ends_with(model) ? label : label + model;
}

const Json* find_equal_row(const Json& rows, const Json& row) {
    for (const Json& other : rows)
        if (member_of(other, "label") == member_of(row, "label") &&
            member_of(other, "model") == member_of(row, "model"))
            return &other;
    return nullptr;
}

/// Returns the smallest and the largest ratio of two quantities from their intervals.
measure::Interval ratio_of_intervals(const measure::Interval& now,
                                     const measure::Interval& before) {
    if (!now.is_known() || !before.is_known() || !(before.low > 0)) return {};
    return {now.low / before.high, now.high / before.low};
}

// Share of a row's time that a pass must take to be judged. Times of shorter passes differ from run
// to run by more than their intervals say.
constexpr double kMinJudgedPassShare = .05;

/// Returns the median device time of a row or a pass, ms, or NaN.
double median_of_time(const Json& timed) { return number_of(member_of(timed, "gpu_ms"), "median"); }

class BaselineJudge {
public:
    BaselineJudge(const Json& before, const Json& now, const BaselineLimits& limits)
        : limits_(limits),
          same_device_(is_same_device(member_of(before, "device"), member_of(now, "device"))),
          floor_(find_noise_floor(now)) {
        const measure::Interval control = ratio_of_intervals(
            interval_of(member_of(now, "clear_ms")), interval_of(member_of(before, "clear_ms")));
        if (control.low > 1) machine_ratio_ = control;
    }

    std::vector<BaselineFinding> judge_row(const Json& before, const Json& now) const {
        const std::string name = baseline_row_name(before);
        std::vector<BaselineFinding> findings{judge_flip(name, before, now)};
        for (BaselineFinding& finding : judge_work(name, before, now))
            findings.push_back(std::move(finding));
        const bool noisy = member_of(before, "noisy") == true || member_of(now, "noisy") == true;
        if (!member_of(before, "gpu_ms").is_object() || !member_of(now, "gpu_ms").is_object())
            return findings; // a picture of another renderer has no time
        findings.push_back(judge_time(name, "ms", before, now, noisy));
        const double least = kMinJudgedPassShare * median_of_time(now);
        for (const Json& pass : member_of(before, "passes"))
            for (const Json& other : member_of(now, "passes"))
                if (member_of(pass, "name") == member_of(other, "name") &&
                    median_of_time(other) >= least)
                    findings.push_back(
                        judge_time(name, "ms of " + member_of(pass, "name").get<std::string>(),
                                   pass, other, noisy));
        return findings;
    }

private:
    static bool is_same_device(const Json& before, const Json& now) {
        for (const char* name : {"name", "driver", "threads"})
            if (member_of(before, name) != member_of(now, name)) return false;
        return true;
    }

    static double find_noise_floor(const Json& report) {
        const double floor = number_of(member_of(member_of(report, "reference"), "noise"),
                                       "flip_floor");
        return std::isnan(floor) ? 0 : floor;
    }

    BaselineFinding judge_flip(const std::string& row, const Json& before, const Json& now) const {
        BaselineFinding finding{.row = row, .quantity = "flip", .says = {}};
        finding.before = number_of(member_of(before, "error"), "flip");
        finding.now = number_of(member_of(now, "error"), "flip");
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

    /// Judges each kind of counted work that both reports have. Counts repeat exactly, so no
    /// interval is needed.
    std::vector<BaselineFinding> judge_work(const std::string& row, const Json& before,
                                            const Json& now) const {
        std::vector<BaselineFinding> findings;
        const Json work = member_of(before, "work");
        if (!work.is_object()) return findings;
        for (const auto& [kind, count] : work.items()) {
            BaselineFinding finding{.row = row, .quantity = "work: " + kind, .says = {}};
            finding.before = number_of(work, kind.c_str());
            finding.now = number_of(member_of(now, "work"), kind.c_str());
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
                               const Json& before, const Json& now, bool noisy) const {
        BaselineFinding finding{.row = row, .quantity = quantity, .says = {}};
        const Json a = member_of(before, "gpu_ms"), b = member_of(now, "gpu_ms");
        finding.before = number_of(a, "median"), finding.now = number_of(b, "median");
        measure::Interval ratio = ratio_of_intervals(interval_of(b), interval_of(a));
        ratio = {ratio.low / machine_ratio_.high, ratio.high / machine_ratio_.low};
        const std::string times = fmt::format("{} ms, before {} ms", format_ms(finding.now),
                                              format_ms(finding.before));
        const std::string limit = fmt::format("at most {:g} times is allowed",
                                              limits_.max_time_ratio);
        const bool can_tell = same_device_ && !noisy && ratio.is_known();
        if (can_tell && ratio.low > limits_.max_time_ratio)
            finding.verdict = BaselineVerdict::worse;
        else if (!can_tell || ratio.high > limits_.max_time_ratio)
            finding.verdict = BaselineVerdict::unknown;
        const std::string why = !same_device_ ? "the device is another"
                                : noisy       ? "other programs used the processors"
                                : !ratio.is_known()
                                    ? "there are too few rounds"
                                    : fmt::format("{:.2f} to {:.2f} times by both 95 % intervals",
                                                  ratio.low, ratio.high);
        finding.says = times + ": " + why + "; " + limit;
        return finding;
    }

    BaselineLimits limits_;
    bool same_device_;
    double floor_;
    measure::Interval machine_ratio_{1, 1}; ///< how much slower the machine itself is now
};

std::vector<const BaselineFinding*> list_findings_of(const std::vector<BaselineFinding>& findings,
                                                     BaselineVerdict verdict) {
    std::vector<const BaselineFinding*> list;
    for (const BaselineFinding& finding : findings)
        if (finding.verdict == verdict) list.push_back(&finding);
    return list;
}

std::string format_counts(const std::vector<BaselineFinding>& findings) {
    return fmt::format("baseline: {} worse, {} unknown, {} kept",
                       list_findings_of(findings, BaselineVerdict::worse).size(),
                       list_findings_of(findings, BaselineVerdict::unknown).size(),
                       list_findings_of(findings, BaselineVerdict::kept).size());
}

} // namespace

const char* baseline_verdict_name(BaselineVerdict verdict) {
    constexpr const char* kNames[] = {"kept", "worse", "unknown"};
    return kNames[static_cast<std::size_t>(verdict)];
}

void check_baseline_fits(const Comparison& comparison, const std::string& json,
                         const std::string& file) {
    check_same_question(find_scene_report(parse_json<Json>(file, json), comparison, file),
                        make_report_json(comparison), file);
}

std::vector<BaselineFinding> judge_against_baseline(const Comparison& comparison,
                                                    const std::string& json,
                                                    const std::string& file,
                                                    const BaselineLimits& limits) {
    const Json before = find_scene_report(parse_json<Json>(file, json), comparison, file),
               now = make_report_json(comparison);
    check_same_question(before, now, file);
    const BaselineJudge judge(before, now, limits);
    std::vector<BaselineFinding> findings;
    for (const Json& row : before.at("rows")) {
        check(member_of(row, "label").is_string(), Failure::bad_data, file,
              ": wanted rows with a label, found ", describe_json_value(row));
        if (const Json* same = find_equal_row(now.at("rows"), row)) {
            for (BaselineFinding& finding : judge.judge_row(row, *same))
                findings.push_back(std::move(finding));
        } else {
            findings.push_back({baseline_row_name(row), "row", BaselineVerdict::worse, NAN, NAN,
                                "is in the baseline, and not in this comparison"});
        }
    }
    return findings;
}

std::string format_baseline_findings(const std::vector<BaselineFinding>& findings) {
    std::string text;
    for (const BaselineVerdict verdict : {BaselineVerdict::worse, BaselineVerdict::unknown})
        for (const BaselineFinding* finding : list_findings_of(findings, verdict))
            text += fmt::format("{}: {}, {}: {}\n", baseline_verdict_name(verdict), finding->row,
                                finding->quantity, finding->says);
    return text + format_counts(findings) + "\n";
}

std::string make_baseline_markdown(const std::vector<BaselineFinding>& findings,
                                   const std::string& scene) {
    const bool is_worse = !list_findings_of(findings, BaselineVerdict::worse).empty();
    std::string text = fmt::format("### {}: {}\n\n{}\n", escape_markdown(scene),
                                   is_worse ? "worse than the baseline"
                                            : "not worse than the baseline",
                                   format_counts(findings));
    std::string table;
    for (const BaselineVerdict verdict : {BaselineVerdict::worse, BaselineVerdict::unknown})
        for (const BaselineFinding* finding : list_findings_of(findings, verdict))
            table += fmt::format("| {} | {} | {} | {} |\n", baseline_verdict_name(verdict),
                                 escape_markdown(finding->row), escape_markdown(finding->quantity),
                                 escape_markdown(finding->says));
    if (!table.empty()) text += "\n| verdict | row | quantity | |\n|---|---|---|---|\n" + table;
    return text;
}

std::string make_baseline_junit(const std::vector<BaselineFinding>& findings,
                                const std::string& scene) {
    // HTML and XML need the same five characters escaped.
    std::string xml = fmt::format(
        "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n", escape_html(scene),
        findings.size(), list_findings_of(findings, BaselineVerdict::worse).size(),
        list_findings_of(findings, BaselineVerdict::unknown).size());
    for (const BaselineFinding& finding : findings) {
        xml += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escape_html(finding.row),
                           escape_html(finding.quantity));
        const std::string says = escape_html(finding.says);
        switch (finding.verdict) {
        case BaselineVerdict::kept: xml += "/>\n"; break;
        case BaselineVerdict::worse:
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
