#pragma once

#include "report/comparison.hpp"
#include "report/encoded.hpp"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace catoptric::report {

/// report.json: schema "catoptric/compare/1".
std::string to_json(const Comparison& comparison);
/// rows.csv: one line a row, header first (RFC 4180). The last field of each says what an
/// incomplete run lacks; without a row one line holds nothing else.
std::string to_csv(const Comparison& comparison);
/// report.md: the seed report's Table 1 beside ours, errors, what is dominated, and what to make of
/// its guesses.
std::string to_markdown(const Comparison& comparison);
/// report.html: one self-contained page, table and pictures (data: URIs) side by side, no script.
std::string to_html(const Comparison& comparison);

/// Makes `folder` with its parents; folders that are there are taken. For before long work, whose
/// results would have no place. Throws `cannot_create`.
void create_folder(const std::filesystem::path& folder);

/// Puts what there is into a folder, made as above: report.json, report.md, report.html, rows.csv,
/// images/<row>.png and .exr, images/<row>-error.png and images/reference.png; of rows with causes
/// images/causes-<row>.png, with drawn views images/worst-<row>.png. Written again and again as
/// rows are added: pictures only where they are others than before, all else anew, every file put
/// into place whole.
class Writer {
public:
    explicit Writer(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// Rows that were there the last time are the same now. Throws `cannot_create`, `io`.
    void write(const Comparison& comparison);

private:
    void write_pictures(const Comparison& comparison);

    std::filesystem::path folder_;
    EncodedPictures pictures_;
    bool has_reference_ = false; ///< its picture is there
    std::vector<int> written_;   ///< by row: Row::pictured of the pictures that are there
    std::set<std::size_t> rows_with_causes_;        ///< whose picture by cause is there
    std::vector<std::optional<std::size_t>> worst_; ///< by row: view whose picture is there
};

/// The files that a writer of rows with these `Row::image`s may put into its folder, relative to
/// it.
std::vector<std::filesystem::path> files_of(const std::vector<std::string>& images);

/// All of it once.
void write(const Comparison& comparison, const std::filesystem::path& folder);

} // namespace catoptric::report
