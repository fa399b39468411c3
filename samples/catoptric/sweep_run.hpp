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
    OutputOptions output_options;
};

/// Number of pieces by what `run_pieces` found or did.
struct SweepRunCounts {
    std::size_t finished_before = 0, run = 0;
    std::size_t elsewhere = 0; ///< pieces that another process is running
};

/// Runs the pieces of a planned sweep that have no result yet: first picture pieces, then timing
/// pieces. Several processes may run pieces of the same folder at once. A process that is killed
/// loses only the piece in work. Only one process of this user and machine measures times, and only
/// while no process draws pictures. If `pieces` names pieces that other processes run, the function
/// waits for them. Without named pieces, it skips pieces that other processes run. If a piece
/// fails, the function prints the error, runs the other pieces and throws the error at the end. It
/// throws at once if the other pieces would fail as well (no device, no place to write). Throws
/// `usage` for an unknown id, and `bad_data` for a scene that changed after planning.
SweepRunCounts run_pieces(const std::filesystem::path& folder, const SweepPlan& plan,
                          const SweepRunOptions& options);

/// Name of the file that lists the pictures of a common piece. The list is written after the
/// pictures.
inline constexpr const char* kCommonListFile = "pictures.json";
/// Returns the folder for the pictures of a common piece that machines of one identity drew.
std::filesystem::path common_folder(const std::filesystem::path& folder, const SweepJson& identity,
                                    const std::string& piece_id);

} // namespace catoptric::cli
