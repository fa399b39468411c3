#include "require/plan_work.hpp"

#include "scene/light.hpp"
#include "scene/material_facts.hpp"

#include <algorithm>

namespace catoptric::require {

namespace {

constexpr double kShadowMapEdge = 1024, kShadowMapFaces = 6; // as the knob `shadow_map`
constexpr double kFacesOfCube = 6;

// Work of a texel of a drawn shadow map. A map is cleared and stored as a whole.
constexpr double kShadowFragments = .35, kShadowBytes = 8;
// Draws of a pass, as a share of the objects, and drawn triangles, as a share of all.
constexpr double kPassDraws = .9, kPassTriangles = .9, kViewDraws = .6, kViewTriangles = .4;
// Work of a pixel of a capture, of the view, and of a mirrored view.
constexpr double kCaptureFragments = 2, kCapturePoints = 1.2, kCaptureBytes = 44;
constexpr double kViewFragments = 2.3, kViewPoints = 1.25, kViewBytes = 36;
constexpr double kMirroredFragments = 6, kMirroredPoints = 2, kMirroredBytes = 42;
// Look-ups in shadow maps for each light of a shaded point.
constexpr double kShadowLookups = .7;
// Work of a pixel that searches a capture, and of a pixel with one look-up.
constexpr double kSearchColours = 3.7, kSearchDistances = 41, kSearchSteps = 15;
constexpr double kLookupColours = 2;
// Look-ups that a subgroup executes, for each look-up of a pixel.
constexpr double kLookupLanes = .35;
// Work of a texel of a capture whose bounds are found, or whose levels are filtered.
constexpr double kBoundsInvocations = .34, kBoundsDispatches = 2.7;
constexpr double kFilterInvocations = .4, kFilterColours = 16;
// Rays to a light for each light of a point that a ray meets, and the nodes that they visit, as a
// share of those of other rays.
constexpr double kShadowRays = .75, kShadowNodes = .3;
constexpr double kTrianglesOfNode = .35; // tests of triangles for each visited node

/// Returns whether points of the surface differ in more than their place, so that shaders evaluate
/// the material at each point.
bool has_varying_material(const scene::Scene& now, const scene::Object& object) {
    const scene::Material& material = now.materials[object.material];
    if (!now.meshes[object.mesh].colours.empty() || material.albedo_texture ||
        material.emission_texture || material.normal_texture || material.unlit ||
        scene::has_alpha_mask(material) || scene::is_glass(material) ||
        scene::has_clear_coat(material))
        return true;
    if (material.albedo != vec3(0) && (material.two_sided || scene::is_mirror(now, object)))
        return true; // shaders find the side that is seen
    return material.mirror ? material.albedo != vec3(0) && material.reflectance != vec3(1)
                           : scene::has_specular(material);
}

} // namespace

PictureCounts count_picture(const WorkModelInput& input, const PathCounts& paths) {
    PictureCounts picture{.pixels = 1.0 * input.size.x * input.size.y,
                          .triangles = static_cast<double>(scene::triangle_count(input.now)),
                          .objects = static_cast<double>(input.now.objects.size())};
    for (const scene::PointLight& light : scene::list_lights(input.now)) {
        const bool has_one_face = light.directional || light.axis != dvec3(0);
        picture.lights += 1;
        picture.shadow_faces += has_one_face ? 1 : kShadowMapFaces;
    }
    picture.cleared_shadow_faces = picture.lights * kShadowMapFaces;
    const bool is_textured = std::ranges::any_of(
        input.now.materials, [](const scene::Material& m) { return bool(m.albedo_texture); });
    picture.textures = is_textured ? 1 : 0;
    const bool varies = std::ranges::any_of(input.now.objects, [&](const scene::Object& object) {
        return has_varying_material(input.now, object);
    });
    picture.materials = varies ? 1 : 0;
    picture.pixels_per_path = picture.pixels /
                              static_cast<double>(std::max<std::size_t>(1, paths.count));
    return picture;
}

void FrameWork::add_shaded_pixels(double points) {
    work_[materials] += points * picture_.materials;
    work_[texture_lookups] += points * picture_.textures;
    work_[lights] += points * picture_.lights;
    work_[shadow_lookups] += points * picture_.lights * kShadowLookups;
}

void FrameWork::add_view() {
    constexpr double kTexels = kShadowMapEdge * kShadowMapEdge;
    work_[passes] += picture_.lights + 2; // the view, and the pass that composes the picture
    work_[draws] += picture_.lights * kPassDraws * picture_.objects +
                    kViewDraws * picture_.objects + 1;
    const double drawn = (picture_.lights * kPassTriangles + kViewTriangles) * picture_.triangles;
    work_[vertices] += drawn, work_[primitives] += drawn;
    work_[fragments] += picture_.shadow_faces * kTexels * kShadowFragments +
                        picture_.pixels * (kViewFragments + 1);
    work_[bytes] += picture_.cleared_shadow_faces * kTexels * kShadowBytes +
                    picture_.pixels * kViewBytes;
    add_shaded_pixels(picture_.pixels * kViewPoints);
}

void FrameWork::add_capture(double edge, bool bounds, bool is_filtered) {
    const double pixels = kFacesOfCube * edge * edge;
    work_[passes] += 1;
    work_[draws] += kPassDraws * picture_.objects;
    work_[vertices] += kPassTriangles * picture_.triangles;
    work_[primitives] += kPassTriangles * picture_.triangles;
    work_[fragments] += pixels * kCaptureFragments;
    work_[bytes] += pixels * kCaptureBytes;
    add_shaded_pixels(pixels * kCapturePoints);
    if (bounds) {
        work_[distance_lookups] += pixels;
        work_[invocations] += pixels * kBoundsInvocations;
        work_[dispatches] += kBoundsDispatches;
    }
    if (is_filtered) {
        work_[invocations] += pixels * kFilterInvocations;
        work_[colour_lookups] += pixels * kFilterInvocations * kFilterColours;
        work_[texture_lookups] += pixels * kFilterInvocations * kFilterColours;
    }
}

void FrameWork::add_mirrored_view(double pixels) {
    work_[passes] += 1;
    work_[draws] += kViewDraws * picture_.objects;
    work_[vertices] += kViewTriangles * picture_.triangles;
    work_[primitives] += kViewTriangles * picture_.triangles;
    work_[fragments] += pixels * kMirroredFragments;
    work_[bytes] += pixels * kMirroredBytes;
    add_shaded_pixels(pixels * kMirroredPoints);
}

void FrameWork::add_search(double pixels) {
    work_[colour_lookups] += pixels * kSearchColours;
    work_[colour_lanes] += pixels * kSearchColours * kLookupLanes;
    work_[distance_lookups] += pixels * kSearchDistances;
    work_[distance_lanes] += pixels * kSearchDistances * kLookupLanes;
    work_[search_lanes] += pixels * kSearchSteps;
}

void FrameWork::add_lookup(double pixels) {
    work_[colour_lookups] += pixels * kLookupColours;
    work_[colour_lanes] += pixels * kLookupColours * kLookupLanes;
}

void FrameWork::add_list() {
    work_[passes] += 3;
    work_[dispatches] += 2;
    work_[invocations] += picture_.pixels;
}

void FrameWork::add_rays(const RayWork& rays) {
    work_[rays.kind] += rays.rays;
    work_[materials] += rays.rays * picture_.materials;
    work_[texture_lookups] += rays.rays * picture_.textures;
    const double nodes_of_ray = rays.rays > 0 ? rays.nodes / rays.rays : 0,
                 lanes_of_node = rays.nodes > 0 ? rays.node_lanes / rays.nodes : 0,
                 lit = rays.rays * picture_.lights,
                 to_lights = rays.has_shadow_maps ? 0 : lit * kShadowRays,
                 all_nodes = rays.nodes + to_lights * nodes_of_ray * kShadowNodes;
    work_[lights] += lit;
    work_[shadow_rays] += to_lights;
    if (rays.has_shadow_maps) work_[shadow_lookups] += lit * kShadowLookups;
    work_[nodes] += all_nodes;
    work_[node_lanes] += all_nodes * lanes_of_node;
    work_[triangles] += all_nodes * kTrianglesOfNode;
    work_[triangle_lanes] += all_nodes * lanes_of_node * kTrianglesOfNode;
}

void FrameWork::add_traced_picture() {
    work_[passes] += 2;
    work_[draws] += 1;
    work_[dispatches] += 1;
    work_[invocations] += picture_.pixels;
    work_[fragments] += picture_.pixels;
    work_[bytes] += picture_.pixels * kShadowBytes;
}

} // namespace catoptric::require
