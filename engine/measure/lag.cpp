#include "measure/lag.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

double worst_instant(const Lag& lag, const LagAtSpeed& at) {
    const auto found = std::ranges::find(at.rmse, at.max_rmse);
    if (found == at.rmse.end()) return NAN;
    return lag.seconds[static_cast<std::size_t>(found - at.rmse.begin())];
}

} // namespace catoptric::measure
