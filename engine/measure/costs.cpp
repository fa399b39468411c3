#include "measure/costs.hpp"

#include "core/error.hpp"
#include "measure/judge.hpp"
#include "measure/least_squares.hpp"
#include "measure/statistics.hpp"
#include "measure/trade_map.hpp"
#include "measure/work.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::measure {

namespace {

double count_of(const WorkCounts& counts, WorkKind kind) {
    return static_cast<double>(counts[kind].value_or(0));
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

TimesByRays predict_by_rays(const DeviceCosts& costs,
                            const std::function<double(WorkKind)>& units_of) {
    TimesByRays times;
    for (const UnitCost& unit : costs.units) {
        const double millions = units_of(unit.kind) * 1e-6; // ns to ms
        const Interval range = unit.range.is_known() ? unit.range : Interval{unit.ns, unit.ns};
        const bool is_ray = is_ray_work(unit.kind);
        times.ms += millions * unit.ns;
        times.cheap += millions * (is_ray ? range.low : range.high);
        times.dear += millions * (is_ray ? range.high : range.low);
    }
    return times;
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
        const TimesByRays times = predict_by_rays(
            costs, [&](WorkKind kind) { return count_of(counts, kind); });
        cheap.push_back(takes_part ? times.cheap : kUnknownFrameTime);
        dear.push_back(takes_part ? times.dear : kUnknownFrameTime);
    }
    front.rows = front_of_times(rows, ms);
    front.rows_cheap_rays = front_of_times(rows, cheap);
    front.rows_dear_rays = front_of_times(rows, dear);
    return front;
}

std::vector<std::vector<double>> relative_counts(const std::vector<TimedWork>& samples,
                                                 std::span<const WorkKind> kinds) {
    std::vector<std::vector<double>> rows;
    for (const TimedWork& sample : samples) {
        check(std::isfinite(sample.ms) && sample.ms > 0, Failure::usage, "row '", sample.name,
              "': wanted a time above 0 ms, found ", sample.ms);
        std::vector<double>& row = rows.emplace_back();
        for (const WorkKind kind : kinds) row.push_back(count_of(sample.counts, kind) / sample.ms);
    }
    return rows;
}

DeviceCosts fit_costs(std::string device, std::vector<TimedWork> samples,
                      std::span<const WorkKind> kinds) {
    check(samples.size() >= kinds.size() && !kinds.empty(), Failure::usage, "fitting the costs of ",
          kinds.size(), " kinds of work: wanted at least as many measured rows, found ",
          samples.size());
    const std::vector<std::vector<double>> rows = relative_counts(samples, kinds);
    LeastSquares all(kinds.size());
    for (const std::vector<double>& row : rows) all.add(row);
    DeviceCosts costs{.device = std::move(device), .origin = CostOrigin::fitted};
    const std::vector<double> found = all.solve();
    for (std::size_t i = 0; i < kinds.size(); ++i)
        if (found[i] > 0) costs.units.push_back({kinds[i], found[i] * 1e6, {}, "fit"});
    costs.fit = {std::move(samples), {}};
    for (std::size_t i = 0; i < rows.size(); ++i)
        costs.fit->left_out_ms.push_back(all.predict_without(rows[i]) * costs.fit->samples[i].ms);
    return costs;
}

} // namespace catoptric::measure
