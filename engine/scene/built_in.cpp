#include "scene/built_in.hpp"

#include "core/table.hpp"

#include <utility>

namespace catoptric::scene {

RegisteredBuiltInScene::RegisteredBuiltInScene(BuiltInScene scene) {
    table_rows<BuiltInScene>().push_back(std::move(scene));
}

const std::vector<BuiltInScene>& built_in_scenes() {
    static const std::vector<BuiltInScene> kSortedBuiltInScenes = sorted_rows<BuiltInScene>();
    return kSortedBuiltInScenes;
}

} // namespace catoptric::scene
