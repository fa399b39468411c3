#include "measure/proof_order.hpp"

#include "measure/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace catoptric::measure {

namespace {

/// Returns the probability that a variable with Student's t distribution exceeds `t` (Abramowitz
/// and Stegun, Handbook of Mathematical Functions, 1964, 26.7.3 and 26.7.4).
double student_upper_tail(double t, std::size_t degrees_of_freedom) {
    const double angle = std::atan2(t, std::sqrt(static_cast<double>(degrees_of_freedom))),
                 sine = std::sin(angle), cosine = std::cos(angle);
    const bool odd = degrees_of_freedom % 2 != 0;
    double sum = 0, term = odd ? cosine : 1; // of a series in powers of the squared cosine
    for (std::size_t k = odd ? 3 : 2; k <= degrees_of_freedom; k += 2) {
        sum += term;
        term *= static_cast<double>(k - 1) / static_cast<double>(k) * cosine * cosine;
    }
    const double inside = odd ? 2 / std::numbers::pi * (angle + sine * sum) : sine * sum;
    return std::clamp((1 - inside) / 2, 0., 1.);
}

} // namespace

double proof_probability(std::span<const double> errors, double limit, std::size_t views,
                         std::size_t max_failures, double added_deviation) {
    if (errors.size() < 2) return 0;
    if (limit <= 0) return std::ranges::all_of(errors, [](double error) { return error <= 0; });
    // Smaller errors count as this share of the limit. Views without an error would otherwise make
    // the logarithms spread so far that large errors seem likely.
    constexpr double kLeastShareOfLimit = .03;
    const double count = static_cast<double>(errors.size());
    double mean = 0, squares = 0; // of logarithms of error over limit
    for (const double error : errors) {
        const double value = std::log(std::max(error / limit, kLeastShareOfLimit));
        mean += value / count, squares += value * value / count;
    }
    const double variance = std::max(squares - mean * mean, 0.) * count / (count - 1) +
                            added_deviation * added_deviation;
    const double deviation = std::sqrt(variance * (1 + 1 / count)); // of a further value
    if (!std::isfinite(mean)) return 0;
    const double failing = deviation > 0 ? student_upper_tail(-mean / deviation, errors.size() - 1)
                           : mean > 0    ? 1.
                                         : 0.;
    return binomial_cumulative(max_failures, views, failing);
}

std::vector<std::size_t> find_best_order(std::span<const ProofCandidate> candidates,
                                         std::size_t max_count, double no_plan_factor) {
    std::vector<std::size_t> order(candidates.size()); // from the fastest to the slowest
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return candidates[i].ms; });
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    // For each number of further proofs, and for each plan whose proof succeeded: by how much
    // further proofs lower the expected logarithm of the time, and the plan to prove next. Sums of
    // positive numbers alone keep differences between tiny probabilities.
    struct State {
        double gain = 0;
        std::size_t next = kNone; ///< position in `order`
    };
    const std::size_t count = order.size();
    std::vector<std::vector<State>> states(max_count + 1, std::vector<State>(count + 1));
    const auto log_ms = [&](std::size_t at) { return std::log(candidates[order[at]].ms); };
    for (std::size_t left = 1; left <= max_count; ++left)
        for (std::size_t at = 1; at <= count; ++at) { // at == count: no proof succeeded yet
            State& state = states[left][at];
            const double now = at == count ? log_ms(count - 1) + std::log(no_plan_factor)
                                           : log_ms(at);
            for (std::size_t next = 0; next < at; ++next) {
                const double gain = candidates[order[next]].probability *
                                    (now - log_ms(next) + states[left - 1][next].gain);
                if (gain > state.gain) state = {gain, next};
            }
        }
    std::vector<std::size_t> chain;
    for (std::size_t left = max_count, at = count; left > 0 && states[left][at].next != kNone;
         --left) {
        at = states[left][at].next;
        chain.push_back(order[at]);
    }
    return chain;
}

} // namespace catoptric::measure
