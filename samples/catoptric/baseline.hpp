#pragma once

#include "command_line.hpp"
#include "report/baseline.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

/// Options with which `compare` judges its rows against an earlier report.
struct BaselineOptions {
    std::string baseline; ///< report.json of the earlier comparison; empty: none
    std::string summary;  ///< Markdown file to write; empty: none
    std::string junit;    ///< JUnit XML file to write; empty: none
    report::BaselineLimits limits;
};

/// Adds --baseline, --max-flip-rise, --max-time-ratio, --summary and --junit. `options` must
/// outlive the parsing.
void add_baseline_options(Verb& verb, BaselineOptions& options);

/// Throws `usage` if options of the baseline are given without --baseline. Also throws the errors
/// of reading the baseline's file. Call it before measuring.
void check_baseline_options(const BaselineOptions& options);

/// Judges a comparison of one or several scenes against an earlier report (`compare --baseline`).
class BaselineGate {
public:
    /// Reads the baseline, if there is one. `options` must outlive the gate.
    explicit BaselineGate(const BaselineOptions& options);
    /// Throws `bad_data` if the baseline shows another scene or other settings than the comparison,
    /// which may have no row yet.
    void check_scene(const report::Comparison& comparison) const;
    /// Judges the finished comparison of one scene. Throws `bad_data` if the baseline shows another
    /// scene or other settings.
    void judge(const report::Comparison& comparison);
    /// Writes the files and returns the text for the terminal; empty without a baseline.
    std::string finish();
    /// Returns whether no row is worse than in the baseline.
    bool passes() const { return passes_; }

private:
    const BaselineOptions& options_;
    std::string json_, text_, summary_, junit_;
    bool passes_ = true;
};

} // namespace catoptric::cli
