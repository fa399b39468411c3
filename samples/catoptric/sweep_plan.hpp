#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// Functions for the plan of a sweep, which lists comparisons in pieces that machines run in any
// order.
namespace catoptric::cli {

/// JSON whose members are sorted by name. Equal values therefore have the same text.
using SweepJson = nlohmann::json;

/// A piece of a sweep. A picture piece holds the errors of all rows in one view. A timing piece
/// holds the times of all rows.
struct SweepPiece {
    /// SHA-256 of `content`, in hexadecimal. The hashed text is JSON without white space, with
    /// sorted names.
    std::string id;
    /// "kind" ("picture" or "timing"), "scene", "scene_hash", "options" (of compare), "techniques",
    /// and "view" of a picture piece or "repeat" of a timing piece.
    SweepJson content;

    bool is_timing() const { return content.at("kind") == "timing"; }
};

struct SweepPlan {
    nlohmann::ordered_json sweep;   ///< content of the sweep's file
    std::vector<SweepPiece> pieces; ///< pieces in the order of scenes, axes and views
    /// Indices in `pieces` of the common pieces: for each scene and device, one picture piece that
    /// a machine of each identity draws. `merge` compares the pictures of these pieces.
    std::vector<std::size_t> common;
};

/// Returns the plan of a sweep's file (docs/sweeps.md). Loads each scene once for each value of the
/// axes. `folder` is the plan's folder, to which files of scenes are relative. Throws `bad_data`
/// with the file and the member, and as `compare` does for its options.
SweepPlan make_plan(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Writes plan.json into the folder. Throws `usage` if the folder has the plan of another sweep.
void write_plan(const SweepPlan& plan, const std::filesystem::path& folder);
/// Reads plan.json of the folder. Throws `missing_input` without a plan, and `bad_data` for a piece
/// whose content does not have its id.
SweepPlan read_plan(const std::filesystem::path& folder);

/// Returns the options of a piece that choose the device and the device profile.
SweepJson device_options(const SweepJson& content);
/// Returns the command-line words of `catoptric compare` for a piece. The words do not choose the
/// piece's view.
std::vector<std::string> compare_words(const SweepJson& content,
                                       const std::filesystem::path& folder);

std::filesystem::path result_file(const std::filesystem::path& folder, const std::string& id);
/// Returns the result of a piece, or none if its file does not exist. Throws `bad_data` if the file
/// is not the result of this piece.
std::optional<SweepJson> read_result(const std::filesystem::path& folder, const SweepPiece& piece);

inline constexpr const char* kResultSchema = "catoptric/sweep-result/1";
/// Throws `bad_data`, with `place` in front of the message, unless the document is a complete
/// result of this piece.
void check_result(const SweepJson& result, const SweepPiece& piece, const std::string& place);
/// Returns the metrics of rows, over their mirrors, that each result must have and that `merge`
/// summarises.
std::vector<std::string> sweep_metrics();

/// Returns the SHA-256 of a text, in hexadecimal.
std::string sha256(const std::string& text);

} // namespace catoptric::cli
