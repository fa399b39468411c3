#pragma once

#include "measure/stress.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// What `stress` found, written.
namespace catoptric::report {

using measure::name_of;
using measure::NotRun;
using measure::Stress;
using measure::StressCase;
using measure::StressPicture;
using measure::StressRow;
using measure::Verdict;

/// Schema "catoptric/stress/1".
std::string to_json(const Stress& stress);
/// One self-contained page.
std::string to_html(const Stress& stress);
/// The same table as Markdown.
std::string to_markdown(const Stress& stress);
/// "2 of 27 rows: ..." for a run that goes on or was stopped; empty when it is complete.
std::string incomplete_text(const Stress& stress);

/// Puts what there is into a folder, made as for a comparison: stress.json, stress.html, stress.md
/// and images/ID-*.png. Written again and again as rows are added, each picture once.
class StressWriter {
public:
    explicit StressWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// Throws `cannot_create`, `io`.
    void write(const Stress& stress);

private:
    std::filesystem::path folder_;
    std::size_t rows_ = 0; ///< whose pictures are there
};

} // namespace catoptric::report
