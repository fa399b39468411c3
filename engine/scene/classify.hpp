#pragma once

#include "scene/scene.hpp"

/// Classification of surfaces: mirrors, smooth dielectrics, rough metals.
namespace catoptric::scene {

/// Least F0 of a mirror, in its largest channel. A surface that reflects less is a dielectric.
inline constexpr float kMinMirrorF0 = .2f;
/// Least share of an object's area that makes the object a mirror or a dielectric.
inline constexpr double kMinMirrorShare = .05;

/// Most objects of glass that are mirrors. Each mirror needs a capture, some MiB at face=256.
inline constexpr std::size_t kMaxGlassMirrors = 64;

/// Returns F0 (the reflectance seen head-on) of a material with this base colour and metallic
/// value, by channel.
vec3 compute_f0(const Material& material, const vec3& colour, float metallic);
float largest_channel(const vec3& colour);

/// Shares of an object's area by kind of surface, 0 to 1. Textures are sampled at about 4000
/// places, the same ones each time. Area that an alpha mask cuts out does not count.
struct SurfaceShares {
    double mirror = 0; ///< F0 at least kMinMirrorF0, roughness up to Scene::mirror_max_roughness
    double smooth_dielectric = 0; ///< reflects less, sharply (shared::kMaxSharpRoughness)
    double rough_dielectric = 0;  ///< reflects less, by a lobe
    /// The part of both dielectrics whose roughness is up to Scene::mirror_max_roughness.
    double mirror_dielectric = 0;
    double rough_metal = 0; ///< too rough for a mirror, metallic above 0
    vec3 mirror_f0{0};      ///< mean F0 of the `mirror` part
    float smoothest = 1;    ///< lowest roughness found
};
SurfaceShares surface_shares(const Scene& scene, const Object& object);

/// Sets Object::mirror of every object whose material is no mirror by itself (Material::mirror).
/// Objects of glass are mirrors, too: their captures show what they reflect and what is behind. If
/// there are more than kMaxGlassMirrors, the largest ones are, and the materials of the others get
/// the unsupported feature "glass-as-diffuse".
/// Adds the unsupported features "smooth-dielectric", "rough-dielectric" and "rough-metal", counted
/// once per material. With `dielectric_mirrors`, dielectrics that are no rougher than mirrors
/// become mirrors and are not listed. Then finds which mirrors are spheres (find_exact_spheres).
/// May be called again.
void find_mirrors(Scene& scene, bool dielectric_mirrors = false);

/// Puts first the unsupported features of light that no technique computes, counted once per
/// material:
///   - "indirect-left-out": light from one diffuse surface to another, if the scene has light.
///   - "environment-unshadowed": the environment's light on diffuse surfaces, which nothing blocks.
/// Then comes "nested-glass": solid glass inside other solid glass (rank_nested_glass).
/// Call it after mirrors, lights and environment are settled.
void add_unsupported_lighting(Scene& scene);

} // namespace catoptric::scene
