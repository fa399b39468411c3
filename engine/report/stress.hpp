#pragma once

#include "measure/stress.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Reports of the results of `stress`.
namespace catoptric::report {

using measure::name_of;
using measure::NotRun;
using measure::Stress;
using measure::StressCase;
using measure::StressPicture;
using measure::StressRow;
using measure::Verdict;

/// Returns the results as JSON, schema "catoptric/stress/1".
std::string to_json(const Stress& stress);
/// Returns the results as one self-contained HTML page.
std::string to_html(const Stress& stress);
/// Returns the same table as Markdown.
std::string to_markdown(const Stress& stress);
/// Returns "2 of 27 rows: ..." for a run that goes on or was stopped, or an empty text if it is
/// complete.
std::string incomplete_text(const Stress& stress);

/// Writes the results of the finished rows into a folder, which is made as for a comparison. Files:
/// stress.json, stress.html, stress.md and images/ID-*.png. `write` is called again as rows are
/// added and writes each picture once.
class StressWriter {
public:
    explicit StressWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// Writes all files. Throws `cannot_create`, `io`.
    void write(const Stress& stress);

private:
    std::filesystem::path folder_;
    std::size_t rows_ = 0; ///< number of rows whose pictures are written
};

} // namespace catoptric::report
