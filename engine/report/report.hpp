#pragma once

#include "report/comparison.hpp"

#include <filesystem>
#include <string>

namespace catoptric::report {

/// report.json: schema "catoptric/compare/1".
std::string to_json(const Comparison& comparison);
/// rows.csv: one line a row, header first (RFC 4180).
std::string to_csv(const Comparison& comparison);
/// report.md: the seed report's Table 1 beside ours, errors, what is dominated, and what to make of
/// its guesses.
std::string to_markdown(const Comparison& comparison);
/// report.html: one self-contained page, table and pictures (data: URIs) side by side, no script.
std::string to_html(const Comparison& comparison);

/// Makes `folder` with its parents; folders that are there are taken. For before long work, whose
/// results would have no place. Throws `cannot_create`.
void create_folder(const std::filesystem::path& folder);

/// Makes the folder and `images` in it as above, and writes report.json, report.md, report.html,
/// rows.csv, images/<row>.png and .exr, images/<row>-error.png and images/reference.png. Every file
/// is put into place whole. Throws `cannot_create`, `io`.
void write(const Comparison& comparison, const std::filesystem::path& folder);

} // namespace catoptric::report
