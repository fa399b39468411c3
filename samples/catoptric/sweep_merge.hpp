#pragma once

#include "sweep_plan.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::cli {

/// State of the pieces of a sweep.
struct SweepState {
    std::size_t pieces = 0, finished = 0;
    std::vector<std::string> missing; ///< ids of pieces without a result, not in work
    std::vector<std::pair<std::string, std::string>> broken; ///< id and what is wrong
    std::vector<std::string> in_work;                        ///< ids that a process has locked
    std::vector<std::string> unknown; ///< files in results/ that belong to no piece
    /// Program, driver and processor of the results, each once.
    std::vector<SweepJson> identities;

    bool is_complete() const { return finished == pieces; }
};

/// Reads all results of a sweep's folder.
SweepState check_sweep(const std::filesystem::path& folder, const SweepPlan& plan);

/// Pixels of the common pictures that differ by more than 1/255 between two identities.
struct IdentityDifference {
    std::size_t pixels = 0; ///< pixels of rows and references, over all pairs of identities
    std::size_t apart = 0;  ///< those that differ
    double share() const { return pixels ? double(apart) / double(pixels) : 0; }
};

enum class AcrossIdentities { refused, allowed };

struct MergedSweep {
    /// Files by name: merged.json, errors.csv and summary.csv, and times.json and times.csv if the
    /// plan has timing pieces. All but the times depend only on the results' content.
    std::vector<std::pair<std::string, std::string>> files;
    /// Identities of the picture pieces, for each device that the options name.
    std::vector<SweepJson> identities;
    bool is_mixed = false; ///< one device has several identities
    IdentityDifference difference;
};

/// Merges all results. Throws `bad_data` for a sweep that is not complete. If the picture pieces of
/// one device come from several identities, they are refused with what differs, or merged with the
/// share of pixels that differ in the common pictures.
MergedSweep merge_sweep(const std::filesystem::path& folder, const SweepPlan& plan,
                        AcrossIdentities across);

} // namespace catoptric::cli
