#include "core/work.hpp"

namespace catoptric {

WorkCounts sum_work(const std::vector<PassWork>& passes, std::string_view prefix) {
    WorkCounts sum;
    for (const PassWork& pass : passes)
        if (pass.name.starts_with(prefix)) sum += pass.counts;
    return sum;
}

} // namespace catoptric
