#pragma once

#include "measure/path_distance.hpp"
#include "study/reference_file.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

// Functions that keep distances to path tracing in small JSON files, one for each key.
namespace catoptric::study {

using namespace session;

/// Returns the file of a distance with this key in a cache folder.
std::filesystem::path find_path_distance_file(const std::filesystem::path& folder,
                                              const ReferenceKey& key);
/// Returns the kept distance; none if there is no file or if it has another key. `warn` gets a
/// sentence if the file is not readable or broken.
std::optional<measure::PathDistance>
read_path_distance(const std::filesystem::path& file, const ReferenceKey& key,
                   const std::function<void(const std::string&)>& warn);
/// Writes a known distance. `warn` gets a sentence if this fails.
void keep_path_distance(const std::filesystem::path& file, const ReferenceKey& key,
                        const measure::PathDistance& distance,
                        const std::function<void(const std::string&)>& warn);

} // namespace catoptric::study
