#include "measure/lag.hpp"

#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catoptric::measure {

namespace {

std::vector<double> known_values(const std::vector<Difference>& errors,
                                 double Difference::*figure) {
    std::vector<double> known = values_at_instants(errors, figure);
    std::erase_if(known, [](double value) { return std::isnan(value); });
    return known;
}

} // namespace

std::vector<double> values_at_instants(const std::vector<Difference>& errors,
                                       double Difference::*figure) {
    std::vector<double> figures;
    for (const Difference& error : errors) figures.push_back(error.*figure);
    return figures;
}

double mean_over_instants(const std::vector<Difference>& errors, double Difference::*figure) {
    const std::vector<double> known = known_values(errors, figure);
    return std::accumulate(known.begin(), known.end(), 0.0) / static_cast<double>(known.size());
}

double percentile_over_instants(const std::vector<Difference>& errors, double Difference::*figure,
                                double fraction) {
    std::vector<double> known = known_values(errors, figure);
    return known.empty() ? Difference::kNone : percentile(std::move(known), fraction);
}

double find_worst_instant(const LagResults& lag, const LagAtSpeed& at) {
    const std::vector<double> flips = values_at_instants(at.errors, &Difference::flip);
    const auto found = std::ranges::find(flips,
                                         percentile_over_instants(at.errors, &Difference::flip, 1));
    if (found == flips.end()) return NAN;
    return lag.seconds[static_cast<std::size_t>(found - flips.begin())];
}

} // namespace catoptric::measure
