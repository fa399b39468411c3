#include "scene/light_kind.hpp"

#include "core/error.hpp"
#include "core/table.hpp"

#include <algorithm>

namespace catoptric::scene {

RegisteredLightKind::RegisteredLightKind(const LightKind& kind) {
    table_rows<LightKind>().push_back(kind);
}

const std::vector<LightKind>& light_kinds() {
    static const std::vector<LightKind> kSortedLightKinds = [] {
        std::vector<LightKind> rows = sorted_rows<LightKind>(&LightKind::id);
        check(std::ranges::adjacent_find(rows, {}, &LightKind::id) == rows.end(), Failure::internal,
              "two kinds of light have one number");
        return rows;
    }();
    return kSortedLightKinds;
}

const LightKind& find_light_kind(PunctualLight::Kind id) {
    const auto kind = std::ranges::find(light_kinds(), id, &LightKind::id);
    check(kind != light_kinds().end(), Failure::internal, "there is no kind of light ",
          static_cast<int>(id));
    return *kind;
}

std::string_view gltf_type_of(const LightKind& kind) {
    return kind.gltf_type.empty() ? kind.name : kind.gltf_type;
}

bool have_equal_emission(const PunctualLight& a, const PunctualLight& b) {
    const auto& [name, kind, intensity, range, cos_inner, cos_outer, world_from_light, motion] = a;
    return kind == b.kind && intensity == b.intensity && range == b.range &&
           cos_inner == b.cos_inner && cos_outer == b.cos_outer &&
           world_from_light == b.world_from_light;
}

} // namespace catoptric::scene
