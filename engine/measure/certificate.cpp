#include "measure/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace catoptric::measure {

double binomial_cumulative(std::size_t most, std::size_t count, double p) {
    if (most >= count || p <= 0) return 1;
    if (p >= 1) return 0;
    const double n = static_cast<double>(count);
    double sum = 0;
    for (std::size_t k = 0; k <= most; ++k) {
        const double i = static_cast<double>(k);
        const double log_choices = std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1);
        sum += std::exp(log_choices + i * std::log(p) + (n - i) * std::log1p(-p));
    }
    return std::min(sum, 1.0);
}

double passing_share_bound(std::size_t failures, std::size_t views, double confidence) {
    if (views == 0 || failures >= views) return 0;
    constexpr int kSteps = 60; // halvings of an interval of length 1
    double low = 0, high = 1;  // share of failures
    for (int i = 0; i < kSteps; ++i) {
        const double middle = (low + high) / 2;
        (binomial_cumulative(failures, views, middle) > 1 - confidence ? low : high) = middle;
    }
    return 1 - high;
}

std::size_t needed_views(double share, double confidence, std::size_t failures) {
    std::size_t low = failures, high = failures + 1; // `low` views are too few
    const auto proves = [&](std::size_t views) {
        return binomial_cumulative(failures, views, 1 - share) <= 1 - confidence;
    };
    while (!proves(high)) low = high, high *= 2;
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (proves(middle) ? high : low) = middle;
    }
    return high;
}

double upper_tolerance_limit(std::span<const double> values, double share, double confidence) {
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    // A drawn value is a limit if the number of larger values, counted as failures, still proves
    // the share.
    double limit = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t above = 0; above < sorted.size(); ++above) {
        if (binomial_cumulative(above, sorted.size(), 1 - share) > 1 - confidence) break;
        limit = sorted[sorted.size() - 1 - above];
    }
    return limit;
}

} // namespace catoptric::measure
