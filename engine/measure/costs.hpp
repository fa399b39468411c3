#pragma once

#include "core/work.hpp"
#include "measure/comparison.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The unit costs of a device: how many nanoseconds it takes for one unit of each kind of work. The
/// time of a frame is predicted as the sum of its counts times these costs. This linear model
/// ignores caches, overlapping work and bottlenecks, so each fit states its error.
namespace catoptric::measure {

/// Where a cost comes from. fitted: from times measured on the device. literature: from published
/// figures. given: from the user.
enum class CostOrigin : std::uint8_t { fitted, literature, given };
std::string_view cost_origin_name(CostOrigin origin);

/// Cost of one unit of a kind of work, nanoseconds.
struct UnitCost {
    WorkKind kind = WorkKind::fragments;
    double ns = 0;
    Interval range; ///< smallest and largest value that the source supports; unknown if it has none
    std::string source; ///< publication or command from which the value follows
};

/// A row whose time was measured, for a fit.
struct TimedWork {
    std::string name;
    WorkCounts counts;
    double ms = 0;
};

/// How well fitted costs predict times. The time of each row is predicted by costs that were fitted
/// to all other rows.
struct FitQuality {
    std::vector<TimedWork> samples;
    std::vector<double> left_out_ms; ///< predicted time of each sample by a fit without it
    /// Returns the share of samples, 0..1, whose prediction lies within a factor `factor` of the
    /// measured time.
    double share_within(double factor) const;
};

struct DeviceCosts {
    std::string device;
    CostOrigin origin = CostOrigin::given;
    std::string note; ///< what the reader must know of the figures; may be empty
    std::vector<UnitCost> units;
    /// Quality of the fit, if this program fitted the costs. Read from a file, it has no counts.
    std::optional<FitQuality> fit;
};

/// Time that costs predict for a frame, milliseconds, with the smallest and largest costs of their
/// ranges.
struct PredictedTime {
    double ms = 0, low = 0, high = 0;
};
PredictedTime predict_time(const DeviceCosts& costs, const WorkCounts& counts);
/// Times of the same work if rays are cheap and all other work is dear, by the ends of the ranges
/// of the costs, and the other way round, milliseconds.
struct TimesByRays {
    double ms = 0, cheap = 0, dear = 0;
};
TimesByRays predict_by_rays(const DeviceCosts& costs,
                            const std::function<double(WorkKind)>& units_of);
/// Returns the interval of measured by predicted time in which 90 % of the rows of the fit lie.
/// Unknown without a fit.
Interval prediction_error(const DeviceCosts& costs);

/// The rows that no other row beats on a device, by predicted time and by FLIP over the mirrors.
struct PredictedFront {
    std::vector<PredictedTime> times; ///< predicted time of each row; NaN for a row whose work was
                                      ///< not counted
    /// Indices of the rows on the front at the given unit costs, the fastest first.
    std::vector<std::size_t> rows;
    /// The rows on the front if rays have the smallest and all other work the largest cost of its
    /// range, and the other way round. Both equal `rows` if no range is known.
    std::vector<std::size_t> rows_cheap_rays, rows_dear_rays;
};
/// Returns the indices of the rows that no other beats in time and FLIP, the fastest first. A row
/// whose time is NaN is left out.
std::vector<std::size_t> front_of_times(const std::vector<Row>& rows,
                                        const std::vector<double>& ms);
/// Returns the front of the rows that are candidates for ranking and whose work was counted, or
/// whose time on the device is in `measured`, which has an entry for each row or none at all.
PredictedFront predict_front(const DeviceCosts& costs, const std::vector<Row>& rows,
                             const std::vector<std::optional<PredictedTime>>& measured = {});

/// Returns the counts of each sample, divided by its time: the factors of an equation of relative
/// error. Throws `usage` for a time that is not positive.
std::vector<std::vector<double>> relative_counts(const std::vector<TimedWork>& samples,
                                                 std::span<const WorkKind> kinds);

/// Fits the cost of each kind in `kinds` so that the sum of the squared relative errors is least
/// and no cost is negative. Kinds with a cost of 0 are left out of the result. Fits once more
/// without each sample, for FitQuality::left_out_ms. Throws `usage` for fewer samples than kinds,
/// and for a time that is not positive. Costs O(samples kinds^2) and little more.
DeviceCosts fit_costs(std::string device, std::vector<TimedWork> samples,
                      std::span<const WorkKind> kinds);

} // namespace catoptric::measure
