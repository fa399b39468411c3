#include "scene/gap.hpp"

#include <algorithm>

namespace catoptric::scene {

namespace {

Gap& gap_of(std::vector<Gap>& gaps, const std::string& id, const std::string& first) {
    const auto known = std::ranges::find(gaps, id, &Gap::id);
    if (known != gaps.end()) return *known;
    return gaps.emplace_back(Gap{.id = id, .first = first});
}

} // namespace

void add_gap(std::vector<Gap>& gaps, const std::string& id, const std::string& first,
             std::uint64_t count) {
    if (count > 0) gap_of(gaps, id, first).count += count;
}

void add_material_gap(std::vector<Gap>& gaps, const std::string& id, const std::string& first,
                      std::size_t material) {
    Gap& gap = gap_of(gaps, id, first);
    ++gap.count;
    gap.materials.push_back(material);
}

} // namespace catoptric::scene
