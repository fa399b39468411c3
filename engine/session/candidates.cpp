#include "session/candidates.hpp"

#include "scene/classify.hpp"
#include "scene/material_facts.hpp"
#include "scene/scene_overrides.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace catoptric::session {

namespace {

struct MirrorCandidate {
    float roughness = 1;
    double area = 0; ///< surface area of its bounds: cheap, and enough to tell a wall from a screw
    std::string name;
};

double box_area(const Bounds<double>& box) {
    const dvec3 side = box.extent();
    return side.x * side.y + side.y * side.z + side.z * side.x;
}

} // namespace

std::string quote_for_shell(const std::string& text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::vector<std::string> suggest_mirror_options(const scene::Scene& scene, std::size_t most) {
    constexpr std::size_t kMaxExaminedObjects = 20'000;
    std::vector<MirrorCandidate> candidates;
    std::map<std::pair<std::size_t, std::size_t>, float> smoothest; // by mesh and material
    for (std::size_t i = 0; i < std::min(scene.objects.size(), kMaxExaminedObjects); ++i) {
        const scene::Object& object = scene.objects[i];
        const scene::Material& material = scene.materials[object.material];
        const std::string& name = object.name.empty() ? material.name : object.name;
        // An object that emits light only in parts, by a texture, may still be a candidate.
        const bool lights = scene::emitted_radiance(material) != vec3(0);
        if (material.mirror || object.mirror || !object.seen_by_camera || lights) continue;
        const auto [entry, is_new] = smoothest.try_emplace({object.mesh, object.material}, 1.f);
        if (is_new) entry->second = scene::surface_shares(scene, object).smoothest;
        candidates.push_back({entry->second, box_area(scene::bounds(scene, object)), name});
    }
    std::ranges::stable_sort(candidates, [](const MirrorCandidate& a, const MirrorCandidate& b) {
        return a.roughness != b.roughness ? a.roughness < b.roughness : a.area > b.area;
    });
    std::vector<std::string> options;
    std::set<std::string> known;
    for (const MirrorCandidate& candidate : candidates)
        if (options.size() < most && known.insert(candidate.name).second)
            options.push_back("--mirror " +
                              quote_for_shell(candidate.name.empty()
                                                  ? "*" // selects all other objects, too
                                                  : scene::mirror_pattern(candidate.name)));
    return options;
}

} // namespace catoptric::session
