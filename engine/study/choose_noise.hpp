#pragma once

#include "compare.hpp"
#include "measure/comparison.hpp"
#include "study/compare_to_target.hpp"

#include <cstddef>
#include <optional>
#include <string>

// Functions that say how the noise of a reference enters a certificate (docs/choose.md).
namespace catoptric::study {

using namespace session;

/// The noise of the references of drawn views: the errors between their halves over the mirrors.
struct ViewNoise {
    double median_floor = 0, largest_floor = 0;
    std::optional<double> wanted_floor; ///< a fifth of the limit of error; none without a limit
    std::size_t views_above = 0;        ///< views whose floor is above the wanted one
};

/// Share of the limit of error that the noise floor of a reference should not exceed.
inline constexpr double kNoiseShareOfLimit = .2;

/// Returns the noise floor that the references of drawn views should reach; none without a limit of
/// error.
std::optional<NoiseFloorTarget> find_noise_target(const ChooseRequest& request);

/// Returns the probability with which noise hides that a view is above the limit of error; 0 for
/// references without noise.
double noise_miss_probability(const ChooseRequest& request);

/// Returns the share of views that must be seen to keep the limit, so that the requested share
/// keeps it. If noise hides a share m of the failures, a failing share f is seen as (1 - m) f or
/// more.
double share_to_prove(const ChooseRequest& request);

/// Returns the noise of the drawn views of a comparison; none if its reference has no noise, or if
/// no view shows a mirror.
std::optional<ViewNoise> find_view_noise(const ChooseRequest& request,
                                         const measure::Comparison& comparison);

/// Returns a clause such as "noise floor of the reference: median 0.004, at most 0.007, wanted 0.01
/// (0 views above)".
std::string describe_noise(const ViewNoise& noise);

/// Returns a clause for the reason why no plan was chosen, or nothing if the noise is small.
std::string describe_noise_cause(const std::optional<ViewNoise>& noise);

} // namespace catoptric::study
