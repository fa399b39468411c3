#pragma once

#include "core/export.hpp"
#include "measure/comparison.hpp"

#include <filesystem>
#include <string>

/// Results of `compare` as JSON, CSV, Markdown, HTML and pictures.
namespace catoptric::report {

using measure::Comparison;

/// Returns report.json, schema "catoptric/compare/1".
CATOPTRIC_API std::string to_json(const Comparison& comparison);
/// Returns rows.csv: a header and one line a row (RFC 4180). The last field of each line is empty,
/// or says that the run was stopped and how many rows are missing. If the run has no row, one line
/// holds only that field.
CATOPTRIC_API std::string to_csv(const Comparison& comparison);
/// Returns report.md: the seed report's Table 1 beside the measured times, errors, rows that are
/// not on the front, and a judgement of the seed report's statements.
CATOPTRIC_API std::string to_markdown(const Comparison& comparison);
/// Returns report.html: one self-contained page with tables, pictures (data: URIs) and a comparer.
CATOPTRIC_API std::string to_html(const Comparison& comparison);

/// Makes `folder` with its parents, or accepts it, so that results of long work have a place.
/// Throws `cannot_create` if it is a file or if no file can be made in it.
CATOPTRIC_API void create_folder(const std::filesystem::path& folder);

/// Writes all files that Writer (report/writer.hpp) puts into a folder, once.
CATOPTRIC_API void write(const Comparison& comparison, const std::filesystem::path& folder);

} // namespace catoptric::report
