#pragma once

#include "measure/stress.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Functions that write reports about the results of `stress`.
namespace catoptric::report {

using measure::SkippedPart;
using measure::StressCase;
using measure::StressPicture;
using measure::StressResults;
using measure::StressRow;
using measure::StressVerdict;
using measure::verdict_name;

/// Returns the results as JSON, schema "catoptric/stress/1".
std::string to_json(const StressResults& stress);
/// Returns the results as one self-contained HTML page.
std::string to_html(const StressResults& stress);
std::string to_markdown(const StressResults& stress);
/// Returns "2 of 27 rows: ..." for a run that goes on or was stopped, or an empty text if it is
/// complete.
std::string describe_incomplete_run(const StressResults& stress);

/// Writes the results of the finished rows into a folder, which is made as for a comparison. Files:
/// stress.json, stress.html, stress.md and images/ID-*.png. `write` is called again as rows are
/// added and writes each picture once.
class StressWriter {
public:
    explicit StressWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// Throws `cannot_create`, `io`.
    void write(const StressResults& stress);

private:
    std::filesystem::path folder_;
    std::size_t rows_ = 0; ///< number of rows whose pictures are written
};

} // namespace catoptric::report
