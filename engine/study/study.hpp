#pragma once

#include "compare.hpp"
#include "measure/metric.hpp"
#include "report/report_part.hpp"
#include "study/reference_cache.hpp"

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

/// Table of studies. A study is one row: the option that asks for it, and the function that adds
/// its results to a comparison whose rows are measured. The .cpp of a study registers it, so no
/// other file lists it. `compare`, the command line and the reports read this table.
namespace catoptric::study {

using namespace session;

/// The data that the function `run` of a study gets.
struct StudyInput {
    Engine& engine;   ///< for sessions of other scenes
    Session& session; ///< shows the scene of `request.base`
    /// The request of the comparison. `base.techniques` has the text of each row, in the order of
    /// the rows.
    const CompareRequest& request;
    int count = 1;                  ///< value of StudyChoice::count
    std::vector<std::string> texts; ///< value of StudyChoice::texts
    /// Noise floor at which references need no more frames; none: the errors of the rows decide.
    std::optional<NoiseFloorTarget> noise_target;
    ReferenceCache& truth; ///< reference pictures and first hits of the comparison's camera
    report::Comparison& comparison;
    /// Passes the unfinished comparison to a listener, such as the writer of reports. Call it after
    /// each part of the study's work.
    std::function<void()> tell;
    /// Adds a sentence to the comparison's warnings.
    std::function<void(const std::string&)> warn;
};

struct Study {
    /// Name such as "causes". The option of `compare` is "--" and the name.
    std::string_view name;
    std::string_view help; ///< text of the option
    int order = 1000; ///< place in lists, and order of the runs; equal orders are sorted by name
    /// Symbol of the option's number in the help, such as "N". Empty: the option has no number.
    std::string_view number = {};
    int low = 1, high = 1; ///< limits of the number
    /// Symbol of the option's words in the help, such as "FILE". Empty: the option has no words.
    std::string_view words = {};
    /// Throws `usage` or `bad_data` for words that the study cannot use. May be null.
    void (*check_words)(const std::vector<std::string>& texts) = nullptr;
    /// Throws `usage` for a number that the study cannot use. `option`: name of the option for the
    /// message. May be null.
    void (*check_count)(std::string_view option, int count) = nullptr;
    /// Throws `usage` for a reference that the study cannot use. May be null.
    void (*check_reference)(const std::string& reference) = nullptr;
    /// Checks the request and computes facts that must be known before rows are measured. Throws
    /// `usage`. May be null.
    void (*prepare)(const CompareRequest& request, int count,
                    report::Comparison& comparison) = nullptr;
    /// Adds the results to the rows or to the comparison. After an exception (a signal, a failure
    /// of the engine) the results so far stay. Results without a member of their own go into
    /// measure::set_study_metric, by the name of a metric.
    void (*run)(const StudyInput& input);
    /// Metrics that `run` sets by measure::set_study_metric. JSON, CSV and tables show them
    /// if the study was asked for. Their member `get` is Metric::FromStudy.
    std::vector<measure::Metric> metrics = {};
    /// The study's part of report.md and report.html, if it has `tables`. Its name is that of the
    /// study.
    report::ReportPart part = {};
};

/// Registers a study with its metrics and its part of the report. Define it at namespace scope: the
/// study enters the table while the program starts.
struct RegisteredStudy {
    explicit RegisteredStudy(Study study);
};

/// Returns all studies by `order`, then name.
const std::vector<Study>& studies();
/// Throws `usage` for an unknown name, with the nearest.
const Study& find_study(std::string_view name);
/// Throws `usage` for an unknown study, and for a reference that it cannot use.
void check_study(const StudyChoice& choice, const std::string& reference);

} // namespace catoptric::study
