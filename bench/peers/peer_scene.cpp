#include "peer_scene.hpp"

#include "core/error.hpp"
#include "render/facets.hpp"
#include "render/views.hpp"
#include "scene/light.hpp"
#include "scene/texel.hpp"
#include "spheres.hpp"

#include <algorithm>

namespace peers {

using namespace catoptric;

namespace {

PeerVector3 vec3_to_peer_vector(const vec3& v) { return {v.x, v.y, v.z}; }

PeerSurfaceMaterial make_peer_surface_material(const scene::Scene& scene,
                                               const scene::Object& object,
                                               const render::DrawRange& range) {
    const scene::Material& material = scene.materials[object.material];
    PeerSurfaceMaterial surface{.albedo = vec3_to_peer_vector(material.albedo),
                                .emission = vec3_to_peer_vector(material.emission)};
    surface.is_mirror = scene::is_mirror(scene, object);
    surface.is_sharp = range.varies && !surface.is_mirror &&
                       material.roughness <= scene.mirror_max_roughness;
    surface.turns = range.turns;
    surface.fades = render::normals_differ_from_facets(scene.meshes[object.mesh]);
    if (surface.is_mirror) surface.reflectance = vec3_to_peer_vector(material.reflectance);
    if (surface.is_sharp) surface.reflectance = vec3_to_peer_vector(material.dielectric_f0);
    if (material.albedo_texture) surface.texture = object.material;
    return surface;
}

/// Returns the texture of a material's albedo, or an empty texture if the material has none.
PeerAlbedoTexture make_albedo_texture(const scene::Material& material) {
    if (!material.albedo_texture) return {};
    const scene::Image& image = *material.albedo_texture->image;
    PeerAlbedoTexture texture{{}, static_cast<int>(image.size.x), static_cast<int>(image.size.y)};
    for (const std::uint32_t texel : image.texels)
        texture.texels.push_back({scene::linear_from_srgb(texel & 255),
                                  scene::linear_from_srgb(texel >> 8 & 255),
                                  scene::linear_from_srgb(texel >> 16 & 255)});
    return texture;
}

/// Makes shadow rays pass through the geometry's triangles.
void ignore_geometry_for_shadow_rays(RTCGeometry geometry) {
    rtcSetGeometryOccludedFilterFunction(geometry, [](const RTCFilterFunctionNArguments* asked) {
        std::fill_n(asked->valid, asked->N, 0);
    });
    rtcCommitGeometry(geometry);
}

/// Returns triangle k of the geometry.
bvh::Triangle make_bvh_triangle(const render::FrameGeometry& geometry, std::size_t k) {
    const auto corner = [&](std::size_t i) {
        return geometry.vertices[geometry.indices[3 * k + i]].position;
    };
    return {corner(0), corner(1), corner(2)};
}

} // namespace

EmbreeWhittedTracer::EmbreeWhittedTracer(const EmbreeDevice& device,
                                         const session::Request& request, int depth, bool exact)
    : embree_tree_(device, RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_HIGH) {
    add_objects(device, request, exact);
    add_view(request);
    embree_tree_.build_tree();
    whitted_.tree = embree_tree_.embree_scene_handle();
    whitted_.depth = depth;
    whitted_.shadow_end = f32::kShadowRayEnd;
    whitted_.facet_fade = f32::kFacetFadeSine;
    whitted_.lift = 0x1p-20F; // scene units; a scene is about 1 in size
}

void EmbreeWhittedTracer::add_objects(const EmbreeDevice& device, const session::Request& request,
                                      bool exact) {
    const scene::Scene& scene = request.scene;
    const render::SceneUnits space = render::make_scene_units(scene);
    const render::FrameGeometry geometry = render::make_geometry(
        scene::scene_at(scene, request.time), space);
    std::ranges::transform(scene.materials, std::back_inserter(whitted_.textures),
                           make_albedo_texture);
    std::vector<bvh::Triangle> triangles;
    // Separate, because shadow rays to the point inside a lamp must pass through it.
    std::vector<std::size_t> lamps;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        const render::DrawRange& range = geometry.ranges[i];
        whitted_.surfaces.push_back(make_peer_surface_material(scene, object, range));
        if (exact && object.sphere) {
            whitted_.spheres.push_back(
                {vec3_to_peer_vector(space.to_scene_point(object.sphere->centre)),
                 space.to_scene_length(object.sphere->radius)});
            whitted_.sphere_objects.push_back(static_cast<std::uint32_t>(i));
        } else if (!range.casts_shadow && !range.one_sided) {
            lamps.push_back(i);
        } else {
            add_triangles(geometry, i, triangles);
        }
    }
    whitted_.first_lamp = triangles.size();
    for (const std::size_t lamp : lamps) add_triangles(geometry, lamp, triangles);
    const std::span all(triangles);
    embree_tree_.add_geometry_and_release(
        make_triangle_geometry(device, all.first(whitted_.first_lamp)), kTriangles);
    if (exact)
        embree_tree_.add_geometry_and_release(
            make_sphere_geometry(device.embree_device_handle(), whitted_.spheres), kSpheres);
    if (lamps.empty()) return;
    RTCGeometry geometry_of_lamps = make_triangle_geometry(device,
                                                           all.subspan(whitted_.first_lamp));
    ignore_geometry_for_shadow_rays(geometry_of_lamps);
    embree_tree_.add_geometry_and_release(geometry_of_lamps, kLamps);
}

void EmbreeWhittedTracer::add_triangles(const render::FrameGeometry& geometry, std::size_t object,
                                        std::vector<bvh::Triangle>& triangles) {
    const render::DrawRange& range = geometry.ranges[object];
    const auto place = [&](std::uint32_t vertex) {
        if (!range.first_attribute) return UvCoordinates{};
        const vec4& uv =
            geometry.attributes[*range.first_attribute + vertex - range.first_vertex].uv;
        return UvCoordinates{uv.x, uv.y};
    };
    for (std::size_t k = range.first_index / 3; k < (range.first_index + range.index_count) / 3;
         ++k) {
        const std::uint32_t* const corners = &geometry.indices[3 * k];
        const auto normal = [&](int j) {
            return vec3_to_peer_vector(geometry.vertices[corners[j]].normal);
        };
        const bvh::Triangle triangle = make_bvh_triangle(geometry, k);
        triangles.push_back(triangle);
        whitted_.corners.push_back({vec3_to_peer_vector(triangle.a),
                                    vec3_to_peer_vector(triangle.b),
                                    vec3_to_peer_vector(triangle.c)});
        whitted_.normals.push_back({normal(0), normal(1), normal(2)});
        whitted_.places.push_back({place(corners[0]), place(corners[1]), place(corners[2])});
        whitted_.triangle_objects.push_back(static_cast<std::uint32_t>(object));
    }
}

void EmbreeWhittedTracer::add_view(const session::Request& request) {
    const render::SceneUnits space = render::make_scene_units(request.scene);
    for (const scene::PointLight& light : scene::list_lights(request.scene)) {
        PeerSceneLight& added = whitted_.lights.emplace_back();
        check(light.cosines == dvec3(0), Failure::usage, "a lamp of two sides is closed, or none");
        const bool has_cosine = light.normal != dvec3(0);
        const double share = has_cosine ? 1 : scene::light_share(light, {0, 0, 1});
        const double area = share * light.area * space.scale * space.scale;
        added.position = vec3_to_peer_vector(space.to_scene_point(light.position));
        added.normal = vec3_to_peer_vector(vec3(light.normal));
        added.intensity = vec3_to_peer_vector(light.emission * static_cast<float>(area));
        added.is_spot = light.axis != dvec3(0);
        added.axis = vec3_to_peer_vector(vec3(light.axis));
        added.cos_outer = static_cast<float>(light.cos_outer);
        added.sharpness = static_cast<float>(1 / std::max(.001, light.cos_inner - light.cos_outer));
    }
    whitted_.ambient = static_cast<float>(request.ambient);
    const shared::View view = render::make_camera_view(request.camera, space, request.size, 1);
    whitted_.eye = vec3_to_peer_vector(view.eye),
    whitted_.forward = vec3_to_peer_vector(view.forward);
    whitted_.right = vec3_to_peer_vector(view.right / dot(view.right, view.right));
    whitted_.down = vec3_to_peer_vector(view.down / dot(view.down, view.down));
    whitted_.width = static_cast<int>(request.size.x);
    whitted_.height = static_cast<int>(request.size.y);
}

std::vector<bvh::Triangle> make_bvh_triangles_of_scene(const scene::Scene& scene) {
    const render::FrameGeometry geometry = render::make_geometry(scene::scene_at(scene, 0),
                                                                 render::make_scene_units(scene));
    std::vector<bvh::Triangle> triangles;
    for (std::size_t k = 0; k < geometry.indices.size() / 3; ++k)
        triangles.push_back(make_bvh_triangle(geometry, k));
    return triangles;
}

} // namespace peers
