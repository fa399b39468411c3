#include "measure/interval.hpp"

#include <algorithm>
#include <vector>

namespace catoptric::measure {

namespace {

/// Returns the largest k, from 1, for which P(Binomial(n, 1/2) < k) <= 2.5 %, or 0 if there is
/// none.
std::size_t interval_rank(std::size_t n) {
    const auto count = static_cast<double>(n);
    double log_term = -count * std::log(2.0); // logarithm of P(Binomial = k)
    double below = 0;                         // P(Binomial < k)
    std::size_t k = 0;
    for (; k < n; ++k) {
        below += std::exp(log_term);
        if (below > .025) break;
        log_term += std::log((count - static_cast<double>(k)) / (static_cast<double>(k) + 1));
    }
    return k;
}

template <typename Pair>
Interval interval_over_pairs(std::span<const double> a, std::span<const double> b, Pair&& pair) {
    std::vector<double> values;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        values.push_back(pair(a[i], b[i]));
    return median_interval(values);
}

} // namespace

Interval median_interval(std::span<const double> values) {
    const std::size_t rank = interval_rank(values.size());
    if (rank == 0 || std::ranges::any_of(values, [](double value) { return std::isnan(value); }))
        return {};
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    return {sorted[rank - 1], sorted[sorted.size() - rank]};
}

Order compare_to_limit(const Interval& interval, double limit) {
    if (!interval.is_known()) return Order::unknown;
    if (interval.high < limit) return Order::less;
    if (interval.low > limit) return Order::more;
    return interval.low == interval.high ? Order::equal : Order::unknown;
}

Interval median_ratio_interval(std::span<const double> a, std::span<const double> b) {
    return interval_over_pairs(a, b, [](double x, double y) { return x / y; });
}

Interval median_difference_interval(std::span<const double> a, std::span<const double> b) {
    return interval_over_pairs(a, b, [](double x, double y) { return x - y; });
}

MedianWithInterval ratio_of_medians(const MedianWithInterval& a, const MedianWithInterval& b) {
    MedianWithInterval ratio{a.median / b.median, {}};
    if (!(a.ci95.low > 0 && b.ci95.low > 0) || !a.ci95.is_known() || !b.ci95.is_known())
        return ratio;
    const double fall = std::hypot(std::log(a.median / a.ci95.low),
                                   std::log(b.ci95.high / b.median)),
                 rise = std::hypot(std::log(a.ci95.high / a.median),
                                   std::log(b.median / b.ci95.low));
    ratio.ci95 = {ratio.median * std::exp(-fall), ratio.median * std::exp(rise)};
    return ratio;
}

} // namespace catoptric::measure
