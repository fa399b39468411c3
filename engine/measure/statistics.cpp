#include "measure/statistics.hpp"

#include "core/error.hpp"
#include "measure/interval.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace catoptric::measure {

double percentile(std::vector<double> values, double fraction) {
    check(!values.empty(), Failure::internal, "a percentile wants at least one value, found none");
    check(fraction >= 0 && fraction <= 1, Failure::internal,
          "a percentile wants a fraction in [0,1], found ", fraction);
    const double position = fraction * static_cast<double>(values.size() - 1);
    const auto rank = static_cast<std::ptrdiff_t>(position);
    const auto low = values.begin() + rank;
    std::nth_element(values.begin(), low, values.end());
    const double rest = position - static_cast<double>(rank);
    if (rest == 0) return *low;
    const double high = *std::min_element(low + 1, values.end());
    return *low + rest * (high - *low);
}

SampleSummary summarise(std::span<const double> samples) {
    check(!samples.empty(), Failure::internal, "a summary wants at least one sample, found none");
    for (std::size_t i = 0; i < samples.size(); ++i)
        check(std::isfinite(samples[i]), Failure::internal,
              "a summary wants finite samples, found ", samples[i], " at index ", i);
    SampleSummary summary;
    summary.samples.assign(samples.begin(), samples.end());
    summary.n = samples.size();
    summary.median = percentile(summary.samples, 0.5);
    summary.p05 = percentile(summary.samples, 0.05);
    summary.p95 = percentile(summary.samples, 0.95);
    std::vector<double> deviations;
    deviations.reserve(summary.n);
    for (const double sample : samples) deviations.push_back(std::abs(sample - summary.median));
    summary.mad = percentile(std::move(deviations), 0.5);
    return summary;
}

SampleSummary summarise(std::span<const std::vector<double>> rounds) {
    std::vector<double> samples, medians;
    for (const std::vector<double>& round : rounds) {
        samples.insert(samples.end(), round.begin(), round.end());
        medians.push_back(percentile(round, 0.5));
    }
    SampleSummary summary = summarise(samples);
    summary.median = percentile(medians, 0.5);
    summary.ci95 = median_interval(medians);
    summary.rounds = std::move(medians);
    return summary;
}

} // namespace catoptric::measure
