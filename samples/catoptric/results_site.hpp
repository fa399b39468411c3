#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

// Functions that write a site of static pages about many reports. The site has a page for each
// scene, with a front for each device and the history of each row.
namespace catoptric::cli {

struct AddedReport {
    std::string name;            ///< file name in SITE/reports
    std::size_t comparisons = 0; ///< of scenes, or of a sweep's combinations and machines
    bool is_known = false;       ///< whether the site had the report before
};

/// Adds a report.json, of one scene or several, or a sweep's results.json, to the site's folder,
/// which is made if it is missing. The file's name is the SHA-256 of its bytes, so a report is
/// added once. Throws `bad_data`, with the member, for a document that is no complete report.
AddedReport add_report(const std::filesystem::path& report, const std::filesystem::path& site);

struct BuiltSite {
    std::size_t reports = 0, pages = 0;
};

/// Writes index.html and a page for each scene, camera, instant, size and reference. Pages depend
/// only on the reports. Throws `bad_data` for a file in SITE/reports that is no report, and
/// `missing_input` without any.
BuiltSite build_site(const std::filesystem::path& site);

} // namespace catoptric::cli
