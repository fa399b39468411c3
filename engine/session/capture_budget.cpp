#include "session/capture_budget.hpp"

#include <fmt/format.h>

namespace catoptric::session {

std::uint32_t CaptureBudget::frames_per_cycle() const {
    return every * (most > 0 ? (mirrors + most - 1) / most : 1);
}

std::string describe_budget(const CaptureBudget& capture_budget) {
    const std::uint32_t round = capture_budget.frames_per_cycle(), oldest = round - 1;
    return fmt::format("captures: at most {} of {} mirror{} a frame; a reflection is at most {} "
                       "frame{} old, and {} more for each further mirror on the light's path",
                       capture_budget.most, capture_budget.mirrors,
                       capture_budget.mirrors == 1 ? "" : "s", oldest, oldest == 1 ? "" : "s",
                       round);
}

} // namespace catoptric::session
