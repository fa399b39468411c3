#pragma once

#include "measure/path_distance.hpp"
#include "session/run.hpp"

#include <functional>
#include <optional>
#include <string>

namespace catoptric::study {

using namespace session;

inline constexpr const char* kPathDistanceStudyName = "path-distance";
/// Pixels of the picture in which the distance is measured, at most.
inline constexpr unsigned kPathDistancePixels = 64 * 64;

/// Returns the limit of time in seconds if the user gave none: 10, or 0 for a picture of at most
/// kPathDistancePixels, whose rows would take less time than the paths.
int choose_path_seconds(const uvec2& size);

/// Returns how far the reference is from path tracing, in a picture of the shape of `base` with at
/// most 64x64 pixels, at the last instant of `base`. Nothing if the reference traces paths itself.
/// Adds paths until the result is precise or the next would exceed `seconds` of processor time (of
/// time on the clock on a device that is no processor). Results are kept in the engine's cache
/// folder, by scene, view and reference. A reference with samples is taken without them. The
/// distance is not known if the time is too short for two frames of few paths, or if the paths
/// cannot be traced. The session must show `base.scene`. Its exposure must be known. Throws as the
/// watcher does. `warn` gets a sentence on a broken file in the cache.
std::optional<measure::PathDistance>
measure_path_distance(Engine& engine, Session& session, const Request& base,
                      const std::string& reference, double seconds, const Watcher& watcher,
                      const std::function<void(const std::string&)>& warn);

} // namespace catoptric::study
