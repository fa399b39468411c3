#pragma once

#include "sweep_plan.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::cli {

struct SweepState {
    std::size_t pieces = 0, finished = 0;
    std::vector<std::string> missing; ///< ids of pieces that have no result and that no process has
                                      ///< locked
    std::vector<std::pair<std::string, std::string>> broken; ///< ids of pieces with a broken
                                                             ///< result, and the reason
    std::vector<std::string> in_work;                        ///< ids that a process has locked
    std::vector<std::string> unknown; ///< files in results/ that belong to no piece
    /// Each different identity (program, driver and processor) of the results.
    std::vector<SweepJson> identities;

    bool is_complete() const { return finished == pieces; }
};

/// Reads all results in a sweep's folder, and returns which pieces are finished, missing, broken or
/// in work.
SweepState check_sweep(const std::filesystem::path& folder, const SweepPlan& plan);

/// Pixels of the common pictures that differ by more than 1/255 between two identities.
struct IdentityDifference {
    std::size_t pixels = 0; ///< pixels of rows and references, over all pairs of identities
    std::size_t apart = 0;  ///< pixels that differ
    double share() const { return pixels ? double(apart) / double(pixels) : 0; }
};

enum class AcrossIdentities { refused, allowed };

struct MergedSweep {
    /// Names and contents of the merged files: merged.json, errors.csv, summary.csv, and those of
    /// time_tables() if the plan has timing pieces. Except for times, contents depend only on
    /// the results.
    std::vector<std::pair<std::string, std::string>> files;
    /// The identities of the picture pieces, for each device that the sweep's options name.
    std::vector<SweepJson> identities;
    bool is_mixed = false; ///< whether pictures of one device have several identities
    IdentityDifference difference;
};

/// Merges all results. Throws `bad_data` for a sweep that is not complete. If the picture pieces of
/// one device come from several identities, they are refused with what differs, or merged with the
/// share of pixels that differ in the common pictures.
MergedSweep merge_sweep(const std::filesystem::path& folder, const SweepPlan& plan,
                        AcrossIdentities across);

} // namespace catoptric::cli
