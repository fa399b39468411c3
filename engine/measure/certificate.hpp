#pragma once

#include <cstddef>
#include <span>

// Statements about all views of a scene from independently drawn ones: "at least a share q of the
// views keeps a limit, with confidence c". They hold for any distribution of the errors.
namespace catoptric::measure {

/// Returns the largest share of views, 0..1, of which it can be said with this confidence, 0..1,
/// that they keep a limit, if `failures` of `views` drawn views did not (Clopper and Pearson, The
/// Use of Confidence or Fiducial Limits, 1934, one-sided). 0 without views. Costs O(failures).
double lower_bound_of_passing_view_share(std::size_t failures, std::size_t views,
                                         double confidence);

/// Returns the smallest number of views that proves the share with this confidence although
/// `failures` of them do not keep the limit. `share` and `confidence` lie between 0 and 1.
std::size_t count_views_needed_for_certificate(double share, double confidence,
                                               std::size_t failures);

/// Returns a limit that at least this share of all views keeps, with this confidence: the smallest
/// drawn value that is large enough (one-sided tolerance limit; Wilks, Determination of Sample
/// Sizes for Setting Tolerance Limits, 1941). NaN if there are too few values for any limit.
double upper_tolerance_limit(std::span<const double> values, double share, double confidence);

} // namespace catoptric::measure
