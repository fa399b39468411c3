#include "measure/settling.hpp"

namespace catoptric::measure {

std::optional<int> find_settled_frame(std::span<const double> errors, double bound) {
    std::size_t first = errors.size();
    while (first > 0 && errors[first - 1] <= bound) --first;
    if (first == errors.size()) return std::nullopt;
    return static_cast<int>(first) + 1;
}

} // namespace catoptric::measure
