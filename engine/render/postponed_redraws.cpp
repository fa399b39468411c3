#include "render/postponed_redraws.hpp"

#include <algorithm>

namespace catoptric::render {

std::vector<std::uint32_t> choose_postponed(std::vector<RedrawRequest> asking, std::uint32_t most) {
    std::ranges::sort(asking, [](const RedrawRequest& a, const RedrawRequest& b) {
        return a.waited != b.waited ? a.waited > b.waited : a.mirror < b.mirror;
    });
    std::vector<std::uint32_t> later;
    for (std::size_t i = most; i < asking.size(); ++i) later.push_back(asking[i].mirror);
    return later;
}

} // namespace catoptric::render
