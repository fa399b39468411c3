#include "sight.hpp"

#include "render/views.hpp"
#include "scene/light.hpp"

#include <algorithm>
#include <limits>

namespace scenes {

namespace {

constexpr float kInfiniteDistance = std::numeric_limits<float>::infinity();

vec4 read_stored_texel(const scene::Texture& texture, int x, int y) {
    const std::uint32_t word =
        texture.image->texels[std::size_t(y) * texture.image->size.x + std::size_t(x)];
    return vec4(float(word & 255), float(word >> 8 & 255), float(word >> 16 & 255),
                float(word >> 24)) /
           255.0f;
}

struct TexturePosition {
    float u = 0, v = 0;
};
TexturePosition position_in_texture(const scene::Texture& texture, const vec4& uv) {
    const vec3 place = texture.uv_set ? vec3(uv.z, uv.w, 1) : vec3(uv.x, uv.y, 1);
    return {dot(texture.u_row, place), dot(texture.v_row, place)};
}

/// Returns the index of the nearest texel.
std::uint64_t nearest_texel_index(const scene::Texture& texture, const vec4& uv) {
    const auto [u, v] = position_in_texture(texture, uv);
    const ivec2 size(texture.image->size);
    const int x = f32::nearest_texel_index(u, size.x, std::uint32_t(texture.wrap_u)),
              y = f32::nearest_texel_index(v, size.y, std::uint32_t(texture.wrap_v));
    return std::uint64_t(y) * std::uint64_t(size.x) + std::uint64_t(x);
}

/// Samples a texture with its own filter. Returns stored values as 0 to 1, without sRGB decoding.
vec4 sample_texture_filtered(const scene::Texture& texture, const vec4& uv) {
    const ivec2 size(texture.image->size);
    if (texture.nearest) {
        const std::uint64_t at = nearest_texel_index(texture, uv);
        return read_stored_texel(texture, int(at % std::uint64_t(size.x)),
                                 int(at / std::uint64_t(size.x)));
    }
    const auto [u, v] = position_in_texture(texture, uv);
    int x[2], y[2];
    float across, down;
    f32::find_bilinear_texels(u, size.x, std::uint32_t(texture.wrap_u), x[0], x[1], across);
    f32::find_bilinear_texels(v, size.y, std::uint32_t(texture.wrap_v), y[0], y[1], down);
    return mix(
        mix(read_stored_texel(texture, x[0], y[0]), read_stored_texel(texture, x[1], y[0]), across),
        mix(read_stored_texel(texture, x[0], y[1]), read_stored_texel(texture, x[1], y[1]), across),
        down);
}

} // namespace

SceneSurfaceCaster::SceneSurfaceCaster(const session::Request& request)
    : current_scene_(scene::scene_at(request.scene, request.time)),
      space_(render::make_scene_units(request.scene)),
      geometry_(render::make_geometry(current_scene_, space_)),
      view_(render::make_camera_view(request.camera, space_, request.size, 0,
                                     render::geometry_bounds(geometry_))),
      size_(request.size), lights_(scene::list_lights(current_scene_)) {
    std::vector<bvh::Triangle> all;
    for (std::size_t object = 0; object < geometry_.ranges.size(); ++object) {
        const render::DrawRange& range = geometry_.ranges[object];
        for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count;
             k += 3) {
            const uvec3 corners(geometry_.indices[k], geometry_.indices[k + 1],
                                geometry_.indices[k + 2]);
            triangles_.push_back(corners);
            all.push_back({geometry_.vertices[corners.x].position,
                           geometry_.vertices[corners.y].position,
                           geometry_.vertices[corners.z].position, std::uint32_t(object),
                           (range.seen_by_camera ? 0 : bvh::kHiddenFromCameraFlag) |
                               (range.casts_shadow ? 0 : bvh::kCastsNoShadowFlag) |
                               (range.one_sided ? bvh::kOneSidedFlag : 0)});
        }
    }
    tree_ = bvh::build(all, geometry_.core);
}

std::optional<SceneSurfaceCaster::CutOutSurface>
SceneSurfaceCaster::find_first_solid_hit(f32::Ray ray, float farthest, std::uint32_t skipped,
                                         int& cut) const {
    constexpr int kMaxCutOutSurfaces = 64; // most cut-out surfaces along a ray
    for (cut = 0; cut < kMaxCutOutSurfaces; ++cut) {
        const auto hit = bvh::find_closest_hit<float>(tree_, ray, farthest, skipped);
        if (!hit) return {};
        const render::DrawRange& range = geometry_.ranges[hit->object];
        CutOutSurface met{*hit};
        vec4 colour(1);
        if (range.first_attribute) {
            met.uv = vec4(0), colour = vec4(0);
            for (int i = 0; i < 3; ++i) {
                const shared::VertexAttribute& at =
                    geometry_.attributes[*range.first_attribute + triangles_[hit->triangle][i] -
                                         range.first_vertex];
                met.uv += at.uv * hit->barycentric[i], colour += at.colour * hit->barycentric[i];
            }
        }
        const scene::Material& material = material_of_object(hit->object);
        met.alpha = material.alpha * colour.a;
        if (material.albedo_texture)
            met.alpha *= sample_texture_filtered(*material.albedo_texture, met.uv).a;
        // Shadow rays end at surfaces with an alpha of at least .5. Other rays pass all surfaces
        // that are not opaque.
        // The same value as in shaders/lib/material.glsl.
        constexpr float kOpaqueAlpha = 511.f / 512;
        const bool is_blended = material.blended && skipped != bvh::kCastsNoShadowFlag;
        const float least = is_blended ? kOpaqueAlpha : material.alpha_cutoff;
        if (!(least > 0) || met.alpha >= least) return met;
        ray.origin += ray.direction * hit->t, ray.leaves = hit->triangle + 1;
        farthest -= hit->t;
    }
    return {};
}

std::uint32_t SceneSurfaceCaster::find_lights_hidden_from_place(const SeenSurface& seen,
                                                                std::uint32_t triangle) const {
    std::uint32_t hidden = 0;
    for (std::size_t i = 0; i < lights_.size() && i < 32; ++i) {
        const scene::PointLight& light = lights_[i];
        const vec3 to = light.directional ? -vec3(light.axis)
                                          : space_.to_scene_point(light.position) - seen.place;
        const bool is_dark_side = !light.directional && light.normal != dvec3(0) &&
                                  dot(dvec3(to), light.normal) >= 0;
        if (is_dark_side || dot(to, seen.normal) <= 0) continue;
        const vec3 side = dot(to, seen.facet) > 0 ? seen.facet : -seen.facet;
        int cut = 0;
        if (find_first_solid_hit({seen.place + side * 1e-5f, to, triangle + 1},
                                 light.directional ? kInfiniteDistance : .9999f,
                                 bvh::kCastsNoShadowFlag, cut))
            hidden |= 1u << i;
    }
    return hidden;
}

SeenSurface SceneSurfaceCaster::find_surface_seen_by_ray(const f32::Ray& ray) const {
    SeenSurface seen;
    const auto met = find_first_solid_hit(ray, std::numeric_limits<float>::max(),
                                          bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag,
                                          seen.cut);
    if (!met) return seen;
    const uvec3 corners = triangles_[met->hit.triangle];
    vec3 at[3], normal(0);
    for (int i = 0; i < 3; ++i) {
        at[i] = geometry_.vertices[corners[i]].position;
        seen.place += at[i] * met->hit.barycentric[i];
        normal += geometry_.vertices[corners[i]].normal * met->hit.barycentric[i];
    }
    seen.object = int(met->hit.object);
    seen.distance = length(seen.place - ray.origin);
    seen.facet = normalize(cross(at[1] - at[0], at[2] - at[0]));
    seen.normal = normalize(normal);
    if (geometry_.ranges[met->hit.object].turns &&
        dot(seen.normal, seen.facet) * dot(ray.direction, seen.facet) > 0)
        seen.normal = -seen.normal;
    const scene::Material& material = material_of_object(met->hit.object);
    float roughness = material.roughness;
    if (material.roughness_texture)
        roughness *= sample_texture_filtered(*material.roughness_texture, met->uv).g;
    // Surfaces slightly rougher than the limit count as sharp too, because this code samples
    // roughness with other rounding errors than the device.
    seen.sharp = roughness <= current_scene_.mirror_max_roughness * 1.01f;
    for (const auto& texture :
         {material.albedo_texture, material.emission_texture, material.roughness_texture})
        if (texture && texture->nearest)
            seen.texels = seen.texels * 0x9e3779b97f4a7c15 +
                          nearest_texel_index(*texture, met->uv) + 1;
    if (material.albedo_texture)
        seen.texel = sample_texture_filtered(*material.albedo_texture, met->uv);
    seen.shadowed = find_lights_hidden_from_place(seen, met->hit.triangle);
    return seen;
}

std::vector<SeenSurface> SceneSurfaceCaster::find_surfaces_seen_by_camera() const {
    const uvec2 fine = size_ * kRaysAlongPixelEdge;
    std::vector<SeenSurface> seen;
    for (std::size_t i = 0; i < std::size_t{fine.x} * fine.y; ++i)
        seen.push_back(find_surface_seen_by_ray(session::make_camera_ray(view_, fine, i)));
    return seen;
}

float SceneSurfaceCaster::pixel_at(float distance) const {
    const float across = 2 / (float(size_.y) * length(view_.down));
    return view_.parallel ? across : across * distance;
}

} // namespace scenes
