#pragma once

#include "output.hpp"
#include "sweep_plan.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace catoptric::cli {

struct SweepRunOptions {
    std::vector<std::string> pieces; ///< ids of the pieces to run; empty: all
    enum class PieceKinds : std::uint8_t { all, pictures, timings };
    PieceKinds kinds = PieceKinds::all;
    OutputOptions manners;
};

/// Number of pieces by what `run_sweep_pieces` found or did.
struct SweepRunCounts {
    std::size_t finished_before = 0, run = 0;
    std::size_t elsewhere = 0; ///< another process works on them
};

/// Runs the pieces of a planned sweep that have no result yet: pictures first, then times. Several
/// processes may share a folder. A process that is killed loses the piece in work. Times are
/// measured by one process of this user and machine at a time, while no other draws pictures. With
/// named pieces the function waits for pieces in work elsewhere; otherwise it leaves them out. A
/// piece that fails is reported, and the others are run before its error is thrown, unless they
/// would fail as well (no device, no place to write). Throws `usage` for an unknown id, and
/// `bad_data` for a scene that changed after planning.
SweepRunCounts run_sweep_pieces(const std::filesystem::path& folder, const SweepPlan& plan,
                                const SweepRunOptions& options);

/// File that lists the pictures of a common piece. It is written last.
inline constexpr const char* kCommonPicturesListFile = "pictures.json";
/// Returns the folder with the pictures that an identity drew for a common piece.
std::filesystem::path find_common_picture_folder(const std::filesystem::path& folder,
                                                 const SweepJson& identity,
                                                 const std::string& piece_id);

} // namespace catoptric::cli
