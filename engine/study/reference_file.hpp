#pragma once

#include "measure/picture_mean.hpp"
#include "session/run.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

// Functions that store the halves of a noisy reference in a file, so that a later comparison can
// add frames to them.
namespace catoptric::study {

using namespace session;

/// Statements that a reference depends on: name and value.
using ReferenceKey = std::vector<std::pair<std::string, std::string>>;
/// Returns the key of a reference at the instant of `base`: scene hash, camera, time, size, ambient
/// light, technique and seed.
ReferenceKey make_reference_key(const Request& base, const std::string& technique);

struct StoredReference {
    measure::PictureMean a, b;
    std::vector<int> seeds;     ///< values of the knob `seed` of all frames
    std::vector<double> gpu_ms; ///< times of the frames
    int rays = 0; ///< value of the knob `rays` of the frames, which may be less than the key's
};

/// Writes the halves as OpenEXR, with the layers A, B, variance_A and variance_B. The variances are
/// those of the means. The key, the seeds and the times stand in the file's ImageDescription as
/// JSON.
void write_reference_file(const StoredReference& reference, const ReferenceKey& key,
                          const std::filesystem::path& path);
/// Reads a file of a noisy reference. Throws `missing_input`. Throws `bad_data` for another kind of
/// file, and for a file with another key, with the part of the key that differs.
StoredReference read_reference_file(const ReferenceKey& key, const std::filesystem::path& path);

} // namespace catoptric::study
