#include "scene/classify.hpp"

#include "scene/mirror_shape.hpp"
#include "scene/moved_sphere.hpp"
#include "scene/nested_glass.hpp"

#include "scene/material_facts.hpp"
#include "scene/texel.hpp"
#include "scene/transform.hpp"
#include "scene/unsupported_feature.hpp"
#include "shared.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace catoptric::scene {

namespace {

constexpr std::size_t kSampleCount = 4096;
constexpr const char* kIndirectGapId = "indirect-left-out";
constexpr const char* kGlassAsDiffuseGapId = "glass-as-diffuse";
constexpr const char* kUnshadowedGapId = "environment-unshadowed";
constexpr const char* kNestedGlassGapId = "nested-glass";

/// The values of a material at one point of a surface.
struct MaterialSample {
    vec4 colour{1}; ///< base colour and alpha
    float metallic = 0, roughness = 1;
};

/// Sums of a surface's sampled values, weighted by area.
struct AreaSums {
    SurfaceShares sums; // shares are still sums
    double all = 0;
    dvec3 mirror_f0{0};

    void add_sample(const Scene& scene, const Material& material, const MaterialSample& spot) {
        if (material.unlit || spot.colour.w < material.alpha_cutoff) return;
        all += 1;
        sums.smoothest = std::min(sums.smoothest, spot.roughness);
        const bool may_be_mirror = spot.roughness <= scene.mirror_max_roughness;
        const vec3 f0 = compute_f0(material, vec3(spot.colour), spot.metallic);
        const bool reflects = f0 != vec3(0) || material.dielectric_f90 != vec3(0);
        if (!may_be_mirror && spot.metallic > 0) sums.rough_metal += 1;
        if (largest_channel(f0) >= kMinMirrorF0) {
            if (may_be_mirror) sums.mirror += 1, mirror_f0 += dvec3(f0);
            return;
        }
        if (!reflects) return;
        (spot.roughness <= shared::kMaxSharpRoughness ? sums.smooth_dielectric
                                                      : sums.rough_dielectric) += 1;
        sums.mirror_dielectric += may_be_mirror;
    }
    SurfaceShares shares() const {
        if (all == 0) return {};
        SurfaceShares shares = sums;
        for (double* share : {&shares.mirror, &shares.smooth_dielectric, &shares.rough_dielectric,
                              &shares.mirror_dielectric, &shares.rough_metal})
            *share /= all;
        if (sums.mirror > 0) shares.mirror_f0 = vec3(mirror_f0 / sums.mirror);
        return shares;
    }
};

/// Returns whether the values that decide the kind of surface may differ between places. The base
/// colour matters only for metals, because F0 of a dielectric has no colour.
bool may_vary(const Material& material, const Mesh& mesh) {
    if (material.roughness_texture) return true;
    return material.metallic > 0 && (material.albedo_texture || !mesh.colours.empty());
}

template <typename Value>
Value interpolate_corners(const std::vector<Value>& at, const uvec3& t, const vec3& weights) {
    return weights.x * at[t.x] + weights.y * at[t.y] + weights.z * at[t.z];
}

vec4 sample_texture(const Texture& texture, const Mesh& mesh, const uvec3& t, const vec3& weights) {
    const std::vector<vec2>& uv = mesh.uv[std::min<std::uint32_t>(texture.uv_set, 1)];
    return read_texel(texture, uv.empty() ? vec2(0) : interpolate_corners(uv, t, weights));
}

MaterialSample sample_material(const Material& material, const Mesh& mesh, const uvec3& t,
                               const vec3& weights) {
    MaterialSample spot{vec4(material.albedo, material.alpha), material.metallic,
                        material.roughness};
    if (!mesh.colours.empty()) spot.colour *= interpolate_corners(mesh.colours, t, weights);
    if (material.albedo_texture)
        spot.colour *= sample_texture(*material.albedo_texture, mesh, t, weights);
    if (material.roughness_texture) {
        const vec4 texel = sample_texture(*material.roughness_texture, mesh, t, weights);
        spot.roughness *= texel.y, spot.metallic *= texel.z;
    }
    return spot;
}

/// Returns barycentric weights of the sample, spread evenly over a triangle by the plastic number's
/// sequence (Roberts 2018).
vec3 sample_weights(std::size_t sample) {
    constexpr double kSampleSequenceStepX = .7548776662466927, kSequenceStepY = .5698402909980532;
    double x = .5 + kSampleSequenceStepX * static_cast<double>(sample),
           y = .5 + kSequenceStepY * static_cast<double>(sample);
    x -= std::floor(x), y -= std::floor(y);
    const double root = std::sqrt(x);
    return {1 - root, root * (1 - y), root * y};
}

std::vector<double> cumulative_areas(const Mesh& mesh, const dmat3& linear) {
    std::vector<double> sums;
    sums.reserve(mesh.triangles.size());
    double sum = 0;
    for (const uvec3& t : mesh.triangles) {
        const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        sum += glm::length(glm::cross(linear * (b - a), linear * (c - a)));
        sums.push_back(sum);
    }
    return sums;
}

/// Sums samples of the surface in equal steps of area, so that each triangle has its share.
AreaSums sum_samples(const Scene& scene, const Object& object) {
    const Material& material = scene.materials[object.material];
    const Mesh& mesh = scene.meshes[object.mesh];
    AreaSums sums;
    if (!may_vary(material, mesh)) {
        sums.add_sample(
            scene, material,
            {vec4(material.albedo, material.alpha), material.metallic, material.roughness});
        return sums;
    }
    const std::vector<double> areas = cumulative_areas(mesh, dmat3(object.world_from_object));
    const double whole = areas.empty() ? 0 : areas.back();
    if (!(whole > 0) || !std::isfinite(whole)) return sums;
    auto triangle = areas.begin();
    for (std::size_t i = 0; i < kSampleCount; ++i) {
        const double wanted = whole * (static_cast<double>(i) + .5) / kSampleCount;
        while (triangle + 1 != areas.end() && *triangle < wanted) ++triangle;
        const auto index = static_cast<std::size_t>(triangle - areas.begin());
        sums.add_sample(scene, material,
                        sample_material(material, mesh, mesh.triangles[index], sample_weights(i)));
    }
    return sums;
}

void add_unsupported_materials(Scene& scene, const char* id,
                               const std::set<std::size_t>& materials) {
    for (const std::size_t i : materials)
        add_unsupported_material(scene.unsupported, id,
                                 item_label("materials", i, scene.materials[i].name), i);
}

/// Keeps only the kMaxGlassMirrors largest objects of glass as mirrors.
void limit_glass_mirrors(Scene& scene) {
    std::vector<std::pair<double, std::size_t>> sizes; // negative length of the bounds, object
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (!object.mirror || !is_glass(scene.materials[object.material])) continue;
        const Bounds<double> box = bounds(scene, object);
        sizes.emplace_back(box.empty() ? 0 : -glm::length(box.extent()), i);
    }
    if (sizes.size() <= kMaxGlassMirrors) return;
    std::ranges::sort(sizes);
    std::set<std::size_t> materials;
    for (std::size_t i = kMaxGlassMirrors; i < sizes.size(); ++i) {
        Object& object = scene.objects[sizes[i].second];
        object.mirror = false;
        materials.insert(object.material);
    }
    add_unsupported_materials(scene, kGlassAsDiffuseGapId, materials);
}

/// Returns whether part of the material reflects the light of surrounding surfaces in all
/// directions.
bool has_diffuse_part(const Material& material) {
    if (material.unlit || material.albedo == vec3(0)) return false;
    return material.mirror || material.metallic < 1 || material.roughness_texture;
}

bool has_light(const Scene& scene) {
    return scene.environment || !scene.punctual.empty() ||
           std::ranges::any_of(scene.objects, [&](const Object& object) {
               return is_visibly_emissive(scene.materials[object.material]);
           });
}

} // namespace

vec3 compute_f0(const Material& material, const vec3& colour, float metallic) {
    return glm::mix(material.dielectric_f0, colour, metallic);
}

float largest_channel(const vec3& colour) { return std::max({colour.x, colour.y, colour.z}); }

SurfaceShares surface_shares(const Scene& scene, const Object& object) {
    return sum_samples(scene, object).shares();
}

void find_mirrors(Scene& scene, bool dielectric_mirrors) {
    std::erase_if(scene.unsupported, [](const UnsupportedFeature& gap) {
        return gap.id == "smooth-dielectric" || gap.id == "rough-dielectric" ||
               gap.id == "rough-metal" || gap.id == kGlassAsDiffuseGapId;
    });
    std::map<std::pair<std::size_t, std::size_t>, SurfaceShares> known; // by mesh and material
    std::set<std::size_t> smooth_dielectrics, rough_dielectrics, rough_metals; // materials
    for (Object& object : scene.objects) {
        object.mirror = false;
        if (scene.materials[object.material].mirror) continue;
        SurfaceShares surface;
        // A uniform scale keeps the shares of areas, which then are those of the mesh.
        if (uniform_scale(dmat3(object.world_from_object))) {
            const auto [entry, is_new] = known.try_emplace({object.mesh, object.material});
            if (is_new) entry->second = surface_shares(scene, object);
            surface = entry->second;
        } else {
            surface = surface_shares(scene, object);
        }
        object.mirror = is_glass(scene.materials[object.material]) ||
                        surface.mirror >= kMinMirrorShare ||
                        (dielectric_mirrors && surface.mirror_dielectric >= kMinMirrorShare);
        if (!object.mirror && surface.smooth_dielectric >= kMinMirrorShare)
            smooth_dielectrics.insert(object.material);
        if (!object.mirror && surface.rough_dielectric >= kMinMirrorShare)
            rough_dielectrics.insert(object.material);
        if (surface.rough_metal > 0) rough_metals.insert(object.material);
    }
    limit_glass_mirrors(scene);
    add_unsupported_materials(scene, "rough-dielectric", rough_dielectrics);
    add_unsupported_materials(scene, "smooth-dielectric", smooth_dielectrics);
    add_unsupported_materials(scene, "rough-metal", rough_metals);
    find_exact_spheres(scene);
}

void add_unsupported_lighting(Scene& scene) {
    std::set<std::size_t> diffuse; // materials
    std::erase_if(scene.unsupported, [](const UnsupportedFeature& gap) {
        return gap.id == kIndirectGapId || gap.id == kUnshadowedGapId ||
               gap.id == kNestedGlassGapId;
    });
    for (const Object& object : scene.objects)
        if (has_diffuse_part(scene.materials[object.material])) diffuse.insert(object.material);
    // Features that are listed first cost most. Features with equal shares of the picture keep this
    // order.
    const std::vector<UnsupportedFeature> others = std::exchange(scene.unsupported, {});
    if (has_light(scene)) add_unsupported_materials(scene, kIndirectGapId, diffuse);
    if (scene.environment) add_unsupported_materials(scene, kUnshadowedGapId, diffuse);
    std::set<std::size_t> nested;
    const std::vector<std::uint32_t> ranks = rank_nested_glass(scene);
    for (std::size_t i = 0; i < ranks.size(); ++i)
        if (ranks[i] > 0) nested.insert(scene.objects[i].material);
    add_unsupported_materials(scene, kNestedGlassGapId, nested);
    scene.unsupported.insert(scene.unsupported.end(), others.begin(), others.end());
}

} // namespace catoptric::scene
