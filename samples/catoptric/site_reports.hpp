#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

// Reports as a site of results shows them (results_site.hpp).
namespace catoptric::cli {

struct SiteRow {
    std::string label;
    double ms = NAN, ms_low = NAN, ms_high = NAN; ///< device time of a frame, and its 95 % interval
    double flip = NAN, rmse = NAN;                ///< over the mirrors
    double flip_low = NAN, flip_high = NAN;       ///< 95 % interval of FLIP's median over views
    bool is_reference = false, on_front = false;
};

/// A comparison of one scene on one device, or the rows of a sweep with equal options.
struct SiteComparison {
    std::string scene, device, driver, commit, date, version;
    std::string hash;    ///< of the scene, which options of a sweep may change
    std::string setting; ///< camera, instant, size and reference, as text
    std::string section; ///< the values of a sweep's axes; empty for a report
    std::string machine; ///< on which a sweep measured times; empty for a report
    std::vector<SiteRow> rows;
};

/// Reads a report.json on one scene or several, or the results.json of a sweep. `text`: content of
/// the file. Throws `bad_data`, with file and member, for another document.
std::vector<SiteComparison> read_site_report(const std::filesystem::path& file,
                                             const std::string& text);

} // namespace catoptric::cli
