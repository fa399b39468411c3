#include "graph/timestamps.hpp"

namespace catoptric::graph {

std::vector<double> to_milliseconds(std::span<const std::uint64_t> stamps, std::uint32_t valid_bits,
                                    double tick_ns) {
    // Differences modulo the number of valid bits are right even if the counter wraps once.
    const std::uint64_t mask = valid_bits >= 64 ? ~std::uint64_t{0}
                                                : (std::uint64_t{1} << valid_bits) - 1;
    std::vector<double> times;
    for (const std::uint64_t stamp : stamps)
        times.push_back(static_cast<double>((stamp - stamps.front()) & mask) * tick_ns * 1e-6);
    return times;
}

std::vector<double> remove_gaps(std::span<const double> times,
                                std::span<const std::size_t> begins) {
    std::vector<double> left;
    left.reserve(times.size());
    double gaps = 0;
    for (std::size_t i = 0, next = 0; i < times.size(); ++i) {
        if (next < begins.size() && i + 1 == begins[next]) continue;
        if (next < begins.size() && i == begins[next]) {
            gaps += times[i] - times[i - 1];
            ++next;
            continue;
        }
        left.push_back(times[i] - gaps);
    }
    return left;
}

} // namespace catoptric::graph
