#include "measure/costs.hpp"

#include "core/error.hpp"
#include "measure/judge.hpp"
#include "measure/statistics.hpp"
#include "measure/trade_map.hpp"
#include "measure/work.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::measure {

namespace {

using KindValues = std::vector<double>; // one number for each fitted kind

/// Normal equations of the relative errors: minimise w' G w - 2 h' w over w >= 0.
struct NormalEquations {
    std::vector<KindValues> matrix;
    KindValues right;

    explicit NormalEquations(std::size_t kinds) : matrix(kinds, KindValues(kinds)), right(kinds) {}
    /// Adds a sample `sign` times. `row` has the sample's counts divided by its time.
    void add_sample(const KindValues& row, double sign) {
        for (std::size_t i = 0; i < right.size(); ++i) {
            right[i] += sign * row[i];
            for (std::size_t j = 0; j < right.size(); ++j) matrix[i][j] += sign * row[i] * row[j];
        }
    }
};

/// Solves for the unit costs by coordinate descent. Each step sets one cost to its best value that
/// is not negative.
KindValues solve_nonnegative(const NormalEquations& equations) {
    constexpr int kMaxSolverSweeps = 200'000;
    constexpr double kFitConvergenceLimit = 1e-12;
    const std::size_t count = equations.right.size();
    KindValues found(count);
    for (int sweep = 0; sweep < kMaxSolverSweeps; ++sweep) {
        double change = 0, size = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double diagonal = equations.matrix[i][i];
            if (!(diagonal > 0)) continue; // no sample has this kind of work
            double rest = equations.right[i];
            for (std::size_t j = 0; j < count; ++j)
                if (j != i) rest -= equations.matrix[i][j] * found[j];
            const double next = std::max(0.0, rest / diagonal);
            // The change of a cost is weighted by its effect on the predicted times.
            change = std::max(change, std::abs(next - found[i]) * std::sqrt(diagonal));
            size = std::max(size, next * std::sqrt(diagonal));
            found[i] = next;
        }
        if (change <= kFitConvergenceLimit * size) break;
    }
    return found;
}

double count_of(const WorkCounts& counts, WorkKind kind) {
    return static_cast<double>(counts[kind].value_or(0));
}

/// Returns the predicted time with each unit cost at an end of its range: rays at the low end and
/// all other work at the high end, or the other way round.
double predict_at_bounds(const DeviceCosts& costs, const WorkCounts& counts, bool rays_are_cheap) {
    double ms = 0;
    for (const UnitCost& unit : costs.units) {
        const bool low = is_ray_work(unit.kind) == rays_are_cheap;
        const double ns = !unit.range.is_known() ? unit.ns : low ? unit.range.low : unit.range.high;
        ms += count_of(counts, unit.kind) * ns * 1e-6;
    }
    return ms;
}

} // namespace

std::string_view cost_origin_name(CostOrigin origin) {
    constexpr std::string_view kCostOriginNames[] = {"fitted", "literature", "given"};
    return kCostOriginNames[static_cast<std::size_t>(origin)];
}

double FitQuality::share_within(double factor) const {
    std::size_t within = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        within += left_out_ms[i] <= samples[i].ms * factor &&
                  left_out_ms[i] >= samples[i].ms / factor;
    return samples.empty() ? 0 : static_cast<double>(within) / static_cast<double>(samples.size());
}

PredictedTime predict_time(const DeviceCosts& costs, const WorkCounts& counts) {
    PredictedTime time;
    for (const UnitCost& unit : costs.units) {
        const double millions = count_of(counts, unit.kind) * 1e-6; // ns to ms
        time.ms += millions * unit.ns;
        time.low += millions * (unit.range.is_known() ? unit.range.low : unit.ns);
        time.high += millions * (unit.range.is_known() ? unit.range.high : unit.ns);
    }
    return time;
}

Interval prediction_error(const DeviceCosts& costs) {
    constexpr double kTail = .05;
    std::vector<double> ratios;
    for (std::size_t i = 0; costs.fit && i < costs.fit->samples.size(); ++i)
        if (costs.fit->left_out_ms[i] > 0)
            ratios.push_back(costs.fit->samples[i].ms / costs.fit->left_out_ms[i]);
    if (ratios.empty()) return {};
    return {percentile(ratios, kTail), percentile(ratios, 1 - kTail)};
}

std::vector<std::size_t> front_of_times(const std::vector<Row>& rows,
                                        const std::vector<double>& ms) {
    const auto beats = [&](std::size_t a, std::size_t b) {
        const double flip_a = rows[a].error.flip, flip_b = rows[b].error.flip;
        return ms[a] <= ms[b] && flip_a <= flip_b && (ms[a] < ms[b] || flip_a < flip_b);
    };
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        bool is_beaten = std::isnan(ms[i]);
        for (std::size_t other = 0; other < rows.size() && !is_beaten; ++other)
            is_beaten = !std::isnan(ms[other]) && beats(other, i);
        if (!is_beaten) front.push_back(i);
    }
    std::ranges::stable_sort(front, {}, [&](std::size_t i) { return ms[i]; });
    return front;
}

PredictedFront predict_front(const DeviceCosts& costs, const std::vector<Row>& rows,
                             const std::vector<std::optional<PredictedTime>>& measured) {
    constexpr double kUnknownFrameTime = std::numeric_limits<double>::quiet_NaN();
    PredictedFront front;
    std::vector<double> ms, cheap, dear;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Row& row = rows[i];
        if (i < measured.size() && measured[i]) {
            front.times.push_back(*measured[i]);
            for (std::vector<double>* times : {&ms, &cheap, &dear})
                times->push_back(is_rankable(row) ? measured[i]->ms : kUnknownFrameTime);
            continue;
        }
        const WorkCounts counts = total_work(row);
        const bool is_known = has_counted_work(row);
        front.times.push_back(
            is_known ? predict_time(costs, counts)
                     : PredictedTime{kUnknownFrameTime, kUnknownFrameTime, kUnknownFrameTime});
        const bool takes_part = is_known && is_rankable(row);
        ms.push_back(takes_part ? front.times.back().ms : kUnknownFrameTime);
        cheap.push_back(takes_part ? predict_at_bounds(costs, counts, true) : kUnknownFrameTime);
        dear.push_back(takes_part ? predict_at_bounds(costs, counts, false) : kUnknownFrameTime);
    }
    front.rows = front_of_times(rows, ms);
    front.rows_cheap_rays = front_of_times(rows, cheap);
    front.rows_dear_rays = front_of_times(rows, dear);
    return front;
}

DeviceCosts fit_costs(std::string device, std::vector<TimedWork> samples,
                      std::span<const WorkKind> kinds) {
    check(samples.size() >= kinds.size() && !kinds.empty(), Failure::usage, "fitting the costs of ",
          kinds.size(), " kinds of work: wanted at least as many measured rows, found ",
          samples.size());
    std::vector<KindValues> rows;
    NormalEquations all(kinds.size());
    for (const TimedWork& sample : samples) {
        check(std::isfinite(sample.ms) && sample.ms > 0, Failure::usage, "row '", sample.name,
              "': wanted a time above 0 ms, found ", sample.ms);
        KindValues& row = rows.emplace_back();
        for (const WorkKind kind : kinds) row.push_back(count_of(sample.counts, kind) / sample.ms);
        all.add_sample(row, 1);
    }
    DeviceCosts costs{.device = std::move(device), .origin = CostOrigin::fitted};
    const KindValues found = solve_nonnegative(all);
    for (std::size_t i = 0; i < kinds.size(); ++i)
        if (found[i] > 0) costs.units.push_back({kinds[i], found[i] * 1e6, {}, "fit"});
    FitQuality& fit = costs.fit.emplace();
    for (const KindValues& row : rows) {
        NormalEquations others = all;
        others.add_sample(row, -1);
        const KindValues without = solve_nonnegative(others);
        double relative = 0;
        for (std::size_t k = 0; k < row.size(); ++k) relative += without[k] * row[k];
        fit.left_out_ms.push_back(relative * samples[fit.left_out_ms.size()].ms);
    }
    fit.samples = std::move(samples);
    return costs;
}

} // namespace catoptric::measure
