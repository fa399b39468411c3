#pragma once

#include "compare.hpp"

#include <optional>

// A comparison that reduces the noise of its references as far as a limit of error needs it.
namespace catoptric::study {

using namespace session;

/// Noise floor at which a reference with noise needs no more frames: the error between its two
/// halves over the mirrors.
struct NoiseFloorTarget {
    ErrorQuantity quantity = ErrorQuantity::flip;
    double floor = 0; ///< 0..1
};

/// Compares as `compare` does. Adds frames to the references of the comparison's own view and of
/// all drawn views until they reach the target, or until CompareRequest::reference_seconds are
/// over. Without a target, the errors of the rows decide (measure::target_noise_floor). The
/// noise floor of each drawn view, by the target's quantity, is in ReferenceNoise::view_floors.
measure::Comparison compare_to_noise_target(Engine& engine, const CompareRequest& request,
                                            const std::optional<NoiseFloorTarget>& target);

} // namespace catoptric::study
