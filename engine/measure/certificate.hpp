#pragma once

#include <cstddef>
#include <span>

// Functions for statements about all views of a scene, derived from independently drawn views: "at
// least a share q of the views keeps a limit, with confidence c". The statements hold for any
// distribution of errors.
namespace catoptric::measure {

/// Returns the probability that at most `most` of `count` independent trials succeed, if each
/// succeeds with probability `p`. O(most).
double binomial_cumulative(std::size_t most, std::size_t count, double p);

/// Returns the largest share of all views, 0 to 1, that is proved to keep a limit with this
/// confidence, 0 to 1, if `failures` of `views` drawn views break the limit (Clopper and Pearson,
/// The Use of Confidence or Fiducial Limits, 1934, one-sided). Returns 0 without views. Takes
/// O(failures).
double passing_share_bound(std::size_t failures, std::size_t views, double confidence);

/// Returns the smallest number of views that proves the share with this confidence although
/// `failures` of them do not keep the limit. `share` and `confidence` lie between 0 and 1.
std::size_t needed_views(double share, double confidence, std::size_t failures);

/// Returns an error that, with this confidence, at least this share of all views does not exceed.
/// The result is the smallest drawn value that is large enough (one-sided tolerance limit; Wilks,
/// Determination of Sample Sizes for Setting Tolerance Limits, 1941). NaN if there are too few
/// values.
double upper_tolerance_limit(std::span<const double> values, double share, double confidence);

} // namespace catoptric::measure
