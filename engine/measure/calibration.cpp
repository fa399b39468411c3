#include "measure/calibration.hpp"

#include "core/error.hpp"
#include "measure/least_squares.hpp"
#include "measure/trade_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace catoptric::measure {

namespace {

using Values = std::vector<double>;

constexpr std::size_t kMinSamples = 8;
enum Group : std::uint8_t { rays, shading, raster, commands, groups };

Group group_of(WorkKind kind) {
    if (is_ray_work(kind)) return rays;
    switch (kind) {
    case WorkKind::frames:
    case WorkKind::passes:
    case WorkKind::draws:
    case WorkKind::dispatches: return commands;
    case WorkKind::vertices:
    case WorkKind::primitives:
    case WorkKind::fragments:
    case WorkKind::invocations:
    case WorkKind::bytes: return raster;
    default: return shading;
    }
}

/// Returns for each sample the time that each typical cost predicts, as a share of the measured
/// time. Unknowns of all fits are factors on typical costs.
std::vector<Values> typical_shares(const std::vector<TimedWork>& samples,
                                   const DeviceCosts& typical) {
    std::vector<WorkKind> kinds;
    for (const UnitCost& unit : typical.units) kinds.push_back(unit.kind);
    std::vector<Values> rows = relative_counts(samples, kinds);
    for (Values& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            row[i] *= typical.units[i].ns * 1e-6; // ns to ms
    return rows;
}

/// Adds an equation that draws each unknown to `target`, more firmly for a smaller `spread`.
void add_ridge(LeastSquares& equations, const Values& target, double spread) {
    for (std::size_t i = 0; i < target.size(); ++i) {
        Values row(target.size());
        row[i] = 1 / (spread * std::max(target[i], std::numeric_limits<double>::min()));
        equations.add(row, 1 / spread);
    }
}

/// Returns a factor for each typical cost, the same for all of a group. A group that no row shows
/// gets the factor of all.
Values group_scales(const std::vector<Values>& rows, const DeviceCosts& typical) {
    constexpr double kGroupSpread = 1000; // so that only a group without rows is held
    constexpr double kLeastGroupScale = 1e-3;
    LeastSquares one(1), each(groups);
    for (const Values& row : rows) {
        Values sums(groups);
        for (std::size_t i = 0; i < row.size(); ++i)
            sums[group_of(typical.units[i].kind)] += row[i];
        one.add(Values{std::accumulate(sums.begin(), sums.end(), 0.0)});
        each.add(sums);
    }
    add_ridge(each, Values(groups, one.solve().front()), kGroupSpread);
    Values found = each.solve();
    // A factor of 0 would keep each of the group's costs at 0, whatever the rows say of it.
    for (double& factor : found) factor = std::max(factor, kLeastGroupScale * one.solve().front());
    Values scales;
    for (const UnitCost& unit : typical.units) scales.push_back(found[group_of(unit.kind)]);
    return scales;
}

LeastSquares make_equations(const std::vector<Values>& rows, const DeviceCosts& typical,
                            double spread) {
    const Values scales = group_scales(rows, typical);
    LeastSquares equations(scales.size());
    for (const Values& row : rows) equations.add(row);
    add_ridge(equations, scales, spread);
    return equations;
}

/// Returns the predicted time of each row by a fit to all others, as a multiple of the measured.
Values predict_left_out(const std::vector<Values>& rows, const DeviceCosts& typical,
                        double spread) {
    Values predicted;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::vector<Values> others = rows;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        const Values found = make_equations(others, typical, spread).solve();
        predicted.push_back(std::inner_product(rows[i].begin(), rows[i].end(), found.begin(), 0.0));
    }
    return predicted;
}

double square_error(const Values& ratios) {
    constexpr double kLeastRatio = 1e-3; // a prediction of 0
    double sum = 0;
    for (const double ratio : ratios) sum += std::pow(std::log(std::max(ratio, kLeastRatio)), 2);
    return sum;
}

} // namespace

DeviceCosts calibrate_costs(std::string device, std::vector<TimedWork> samples,
                            const DeviceCosts& typical) {
    check(samples.size() >= kMinSamples, Failure::usage, "calibrating a device: wanted at least ",
          kMinSamples, " measured rows, found ", samples.size());
    const std::vector<Values> rows = typical_shares(samples, typical);
    double best_spread = 0;
    Values best;
    for (const double spread : {.1, .4, 1.6, 6.4, 25.0, 100.0})
        if (Values ratios = predict_left_out(rows, typical, spread);
            best.empty() || square_error(ratios) < square_error(best))
            best = std::move(ratios), best_spread = spread;
    const Values factors = make_equations(rows, typical, best_spread).solve();
    DeviceCosts costs{.device = std::move(device), .origin = CostOrigin::fitted};
    for (std::size_t i = 0; i < factors.size(); ++i)
        if (factors[i] > 0)
            costs.units.push_back(
                {typical.units[i].kind, typical.units[i].ns * factors[i], {}, "calibration"});
    FitQuality& fit = costs.fit.emplace();
    for (std::size_t i = 0; i < rows.size(); ++i)
        fit.left_out_ms.push_back(best[i] * samples[i].ms);
    fit.samples = std::move(samples);
    return costs;
}

} // namespace catoptric::measure
