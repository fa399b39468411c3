#include "measure/plan_mix.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catoptric::measure {

namespace {

using MirrorPixelsPerView = std::vector<std::vector<double>>;

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Returns the errors of all views, summed over the mirrors.
std::vector<double> sum_view_errors(const std::vector<MixCandidate>& candidates,
                                    const std::vector<std::size_t>& mix, std::size_t views) {
    std::vector<double> sums(views);
    for (std::size_t view = 0; view < views; ++view)
        for (std::size_t mirror = 0; mirror < mix.size(); ++mirror)
            sums[view] += candidates[mix[mirror]].error_sums[view][mirror];
    return sums;
}

bool are_within_limit(const std::vector<double>& sums, const MirrorPixelsPerView& pixels,
                      double limit) {
    for (std::size_t view = 0; view < sums.size(); ++view)
        if (!(sums[view] <= limit * sum_of(pixels[view]))) return false;
    return true;
}

/// A possible change of the mix: one mirror gets another technique.
struct MixExchange {
    std::size_t mirror = 0, candidate = 0;
    double worth = 0; ///< saved time per added error; 0: no exchange
};

MixExchange find_best_exchange(const std::vector<MixCandidate>& candidates,
                               const std::vector<std::size_t>& mix,
                               const MirrorPixelsPerView& pixels, double limit) {
    constexpr double kLeastError = 1e-9; // an exchange that adds no error counts as adding this
                                         // error
    const std::vector<double> now = sum_view_errors(candidates, mix, pixels.size());
    MixExchange best;
    for (std::size_t mirror = 0; mirror < mix.size(); ++mirror) {
        double share = 0;
        for (const std::vector<double>& view : pixels)
            share += view[mirror] / std::max(sum_of(view), 1.0);
        for (std::size_t other = 0; other < candidates.size(); ++other) {
            const double saving = (candidates[mix[mirror]].ms - candidates[other].ms) * share;
            if (!(saving > 0)) continue;
            std::vector<double> after = now;
            double added = 0;
            for (std::size_t view = 0; view < pixels.size(); ++view) {
                const double change = candidates[other].error_sums[view][mirror] -
                                      candidates[mix[mirror]].error_sums[view][mirror];
                after[view] += change;
                added += std::max(change, 0.0) / std::max(sum_of(pixels[view]), 1.0);
            }
            const double worth = saving / std::max(added, kLeastError);
            if (worth > best.worth && are_within_limit(after, pixels, limit))
                best = {mirror, other, worth};
        }
    }
    return best;
}

} // namespace

std::vector<std::size_t> find_fastest_mix(const std::vector<MixCandidate>& candidates,
                                          const MirrorPixelsPerView& pixels, double limit) {
    if (pixels.empty()) return {};
    const std::size_t mirrors = pixels.front().size();
    std::vector<std::size_t> mix;
    double least = INFINITY;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const std::vector<std::size_t> alone(mirrors, i);
        if (!(candidates[i].ms < least) ||
            !are_within_limit(sum_view_errors(candidates, alone, pixels.size()), pixels, limit))
            continue;
        mix = alone, least = candidates[i].ms;
    }
    if (mix.empty()) return mix;
    // Each exchange lowers the sum of the mirrors' times, so the loop ends.
    for (MixExchange exchange = find_best_exchange(candidates, mix, pixels, limit);
         exchange.worth > 0; exchange = find_best_exchange(candidates, mix, pixels, limit))
        mix[exchange.mirror] = exchange.candidate;
    return mix;
}

} // namespace catoptric::measure
