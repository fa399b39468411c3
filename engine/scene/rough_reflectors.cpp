#include "scene/rough_reflectors.hpp"

#include "shared.h"

#include <algorithm>

namespace catoptric::scene {

namespace {

struct RoughnessRange {
    float low = 1, high = 1;
};

/// Returns the range of factors by which a texture multiplies the roughness: its green channel.
RoughnessRange find_texture_range(const Texture& texture) {
    if (texture.image->texels.empty()) return {};
    const auto green = [](std::uint32_t texel) {
        return static_cast<float>(texel >> 8 & 0xFFU) / 255;
    };
    const auto [low, high] = std::ranges::minmax(texture.image->texels, {}, green);
    return {green(low), green(high)};
}

} // namespace

bool reflects_by_lobe(const Scene& scene, const Object& object) {
    const Material& material = scene.materials[object.material];
    if (material.mirror || material.unlit) return false;
    const bool reflects = material.metallic > 0 || material.dielectric_f0 != vec3(0) ||
                          material.dielectric_f90 != vec3(0);
    if (!reflects || !(material.roughness > shared::kMaxSharpRoughness)) return false;
    RoughnessRange factor;
    if (material.roughness_texture) factor = find_texture_range(*material.roughness_texture);
    return factor.high * material.roughness > shared::kMaxSharpRoughness &&
           factor.low * material.roughness <= scene.mirror_max_roughness;
}

bool has_rough_reflector(const Scene& scene) {
    return std::ranges::any_of(
        scene.objects, [&](const Object& object) { return reflects_by_lobe(scene, object); });
}

bool has_rough_mirror(const Scene& scene) {
    return std::ranges::any_of(mirrors(scene), [&](std::size_t index) {
        return reflects_by_lobe(scene, scene.objects[index]);
    });
}

} // namespace catoptric::scene
