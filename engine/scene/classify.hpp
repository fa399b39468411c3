#pragma once

#include "scene/scene.hpp"

/// What surfaces are: mirrors, smooth dielectrics, rough metals.
namespace catoptric::scene {

/// What is sharp and reflects less than this straight on is a smooth dielectric.
inline constexpr float kLeastMirrorF0 = .2f;
/// An object is what so much of its area is.
inline constexpr double kLeastMirrorShare = .05;

/// Reflectance straight on, by channel, where base colour and metallic are these.
vec3 f0_of(const Material& material, const vec3& colour, float metallic);
/// Where one number is needed: the largest channel.
float largest_channel(const vec3& colour);

/// Shares of an object's area, 0..1. Texels are sampled at some 4000 places, the same ones each
/// time; what an alpha mask cuts out is no area.
struct Surface {
    double mirror = 0;            ///< sharp, F0 at least kLeastMirrorF0
    double smooth_dielectric = 0; ///< sharp, F0 below that
    double rough_metal = 0;       ///< not sharp, metallic above 0
    double rough_dielectric = 0;  ///< not sharp, metallic below 1
    vec3 mirror_f0{0};            ///< mean over what is `mirror`
    float smoothest = 1;          ///< the lowest roughness that was found
};
Surface surface_of(const Scene& scene, const Object& object);

/// Sets Object::mirror of every object whose material is no mirror by itself (Material::mirror),
/// and the gaps "smooth-dielectric" (not where `dielectric_mirrors` makes mirrors of them, too) and
/// "rough-metal", a material counted once; then finds which mirrors are spheres (find_spheres). May
/// be called again.
void classify(Scene& scene, bool dielectric_mirrors = false);

/// Puts first the gaps of the light that no technique computes, a material counted once:
/// "indirect-left-out" (light from one diffuse surface to another, where anything lights the
/// scene), "environment-unshadowed" (light of the environment on diffuse surfaces, which nothing
/// blocks) and "specular-left-out": of the materials that a loader listed there since their file
/// gives them a specular lobe, those that are rough, where the lobe is not drawn. Scenes built in
/// code list none: their rough surfaces are Lambertian. Called once sharpness, lights and
/// environment are settled.
void settle_unsupported(Scene& scene);

} // namespace catoptric::scene
