#pragma once

#include "../core/export.hpp"
#include "comparison.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

/// What `compare` found, as files and as their text.
namespace catoptric::report {

/// report.json: schema "catoptric/compare/1".
CATOPTRIC_API std::string to_json(const Comparison& comparison);
/// Which columns rows.csv has.
enum class CsvColumns : std::uint8_t {
    table, ///< the figures of the report's table of rows, and what tells runs apart
    all,   ///< every figure over every mask, each mirror, pass and round
};
/// Returns rows.csv: one line a row, header first (RFC 4180). The last field of each says what an
/// incomplete run lacks; without a row one line holds nothing else.
CATOPTRIC_API std::string to_csv(const Comparison& comparison,
                                 CsvColumns which = CsvColumns::table);
/// report.md: the seed report's Table 1 beside ours, errors, what is dominated, and what to make of
/// its guesses.
CATOPTRIC_API std::string to_markdown(const Comparison& comparison);
/// report.html: one self-contained page, table and pictures (data: URIs) side by side, no script.
CATOPTRIC_API std::string to_html(const Comparison& comparison);

/// Makes `folder` with its parents; folders that are there are taken. To be called before long
/// work, whose results would have no place. Throws `cannot_create` where it is a file, or no file
/// can be made in it.
CATOPTRIC_API void create_folder(const std::filesystem::path& folder);

/// All of it once: the files that Writer (report.hpp) puts into a folder.
CATOPTRIC_API void write(const Comparison& comparison, const std::filesystem::path& folder,
                         CsvColumns csv = CsvColumns::table);

} // namespace catoptric::report
