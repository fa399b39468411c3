#include "render/alias_table.hpp"

namespace catoptric::render {

std::vector<AliasCell> make_alias_table(std::vector<double> weights) {
    std::vector<AliasCell> cells(weights.size());
    std::vector<std::uint32_t> small, large;
    for (std::uint32_t i = 0; i < weights.size(); ++i)
        (weights[i] < 1 ? small : large).push_back(i);
    while (!small.empty() && !large.empty()) {
        const std::uint32_t less = small.back(), more = large.back();
        small.pop_back();
        cells[less] = {weights[less], more};
        weights[more] -= 1 - weights[less];
        if (weights[more] < 1) large.pop_back(), small.push_back(more);
    }
    return cells; // entries that remain because of rounding have the share 1
}

} // namespace catoptric::render
