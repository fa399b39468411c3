#include "scene/unsupported_feature.hpp"

#include "core/text.hpp"

#include <algorithm>

namespace catoptric::scene {

namespace {

UnsupportedFeature& find_or_add_feature(std::vector<UnsupportedFeature>& unsupported,
                                        const std::string& id, const std::string& first) {
    const auto known = std::ranges::find(unsupported, id, &UnsupportedFeature::id);
    if (known != unsupported.end()) return *known;
    return unsupported.emplace_back(UnsupportedFeature{.id = id, .first = first});
}

} // namespace

std::string item_label(std::string_view list, std::size_t index, const std::string& name) {
    return std::string(list) + "[" + std::to_string(index) + "]" +
           (name.empty() ? "" : " " + quote(name));
}

void add_unsupported(std::vector<UnsupportedFeature>& unsupported, const std::string& id,
                     const std::string& first, std::uint64_t count) {
    if (count > 0) find_or_add_feature(unsupported, id, first).count += count;
}

void add_unsupported_material(std::vector<UnsupportedFeature>& unsupported, const std::string& id,
                              const std::string& first, std::size_t material) {
    UnsupportedFeature& gap = find_or_add_feature(unsupported, id, first);
    ++gap.count;
    gap.materials.push_back(material);
}

} // namespace catoptric::scene
