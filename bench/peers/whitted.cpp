// Compiled with -O3 -march=native. The same code traces single rays and packets of rays. For
// packets, each value is a SIMD vector.
#include "whitted.hpp"

#include "lanes.hpp"
#include "texture.hpp"

#include <atomic>
#include <limits>
#include <stdexcept>
#include <thread>

namespace peers {

namespace {

constexpr int kTileEdgePixels = 16;
constexpr float kPi = 3.14159265358979323846f;

/// Traces the paths of a packet of camera rays from the camera to their ends.
template <typename Kind>
class RayPacketTracer {
    using Real = typename Kind::Real;
    using Mask = typename Kind::Mask;
    using V = PacketVector<Real>;

public:
    RayPacketTracer(const WhittedTracerScene& scene, PeerRayCounts& rays,
                    std::vector<PeerVector3>& pixels)
        : whitted_scene_(scene), rays_(rays), pixels_(pixels) {
        rtcInitIntersectContext(&context_);
        // Reflected packets stay mostly coherent in these scenes. With the flag for coherent rays,
        // a frame takes .9 times as long as with the flag for incoherent rays.
        context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }

    void trace_packet_of_pixel_block(int left, int top) {
        start_camera_ray_packet(left, top);
        for (int bounce = 0; is_any_mask_lane_set(active_); ++bounce) {
            count_active_lanes(bounce == 0 ? rays_.primary : rays_.mirror, active_);
            find_closest_hits_of_packet();
            if (is_any_mask_lane_set(diffuse_)) shade_ray_packet();
            if (bounce == whitted_scene_.depth || !is_any_mask_lane_set(active_)) break;
            start_reflected_ray_packet();
        }
        for (int i = 0; i < Kind::kRaysPerPacket; ++i)
            pixels_[pixel_index_of_packet_lane(left, top, i)] = {
                read_lane(colour_.x, i), read_lane(colour_.y, i), read_lane(colour_.z, i)};
    }

private:
    static bool is_any_mask_lane_set(const Mask& mask) {
        int all = 0;
        for (int i = 0; i < Kind::kRaysPerPacket; ++i) all |= read_lane(mask, i);
        return all != 0;
    }
    static void count_active_lanes(std::uint64_t& sum, const Mask& mask) {
        int lanes = 0;
        for (int i = 0; i < Kind::kRaysPerPacket; ++i) lanes -= read_lane(mask, i);
        sum += static_cast<std::uint64_t>(lanes);
    }
    std::size_t pixel_index_of_packet_lane(int left, int top, int i) const {
        return static_cast<std::size_t>(top + i / Kind::kWidth) *
                   static_cast<std::size_t>(whitted_scene_.width) +
               static_cast<std::size_t>(left + i % Kind::kWidth);
    }

    void start_camera_ray_packet(int left, int top) {
        Real x{}, y{};
        for (int i = 0; i < Kind::kRaysPerPacket; ++i) {
            write_lane(x, i, static_cast<float>(left + i % Kind::kWidth) + .5f);
            write_lane(y, i, static_cast<float>(top + i / Kind::kWidth) + .5f);
        }
        x = x / static_cast<float>(whitted_scene_.width) * 2.0f - 1.0f;
        y = y / static_cast<float>(whitted_scene_.height) * 2.0f - 1.0f;
        origin_ = broadcast_vector<Real>(whitted_scene_.eye);
        direction_ = normalize_vector(broadcast_vector<Real>(whitted_scene_.forward) +
                                      x * broadcast_vector<Real>(whitted_scene_.right) +
                                      y * broadcast_vector<Real>(whitted_scene_.down));
        weight_ = broadcast_vector<Real>({1, 1, 1}), colour_ = broadcast_vector<Real>({});
        active_ = Mask{} - 1;
    }

    /// Traces the packet to its hits. Sets the surface data of each hit, the lanes that are
    /// reflected, and the lanes that are shaded.
    void find_closest_hits_of_packet() {
        typename Kind::Hits hits;
        fill_embree_ray_packet(hits.ray, origin_, direction_,
                               std::numeric_limits<float>::infinity(), active_);
        store_packet_values(hits.hit.geomID, Mask{} + static_cast<int>(RTC_INVALID_GEOMETRY_ID));
        store_packet_values(hits.hit.instID[0], Mask{} + static_cast<int>(RTC_INVALID_GEOMETRY_ID));
        Kind::find_closest_hits(active_, whitted_scene_.tree, &context_, hits);
        const Mask geometry = load_packet_values<Mask>(hits.hit.geomID),
                   number = load_packet_values<Mask>(hits.hit.primID);
        const Real u = load_packet_values<Real>(hits.hit.u),
                   v = load_packet_values<Real>(hits.hit.v);
        point_ = origin_ + load_packet_values<Real>(hits.ray.tfar) * direction_;
        facet_ = {load_packet_values<Real>(hits.hit.Ng_x), load_packet_values<Real>(hits.hit.Ng_y),
                  load_packet_values<Real>(hits.hit.Ng_z)};
        normal_ = albedo_ = emission_ = reflectance_ = broadcast_vector<Real>({});
        diffuse_ = goes_on_ = fades_ = Mask{};
        surface_lift_ = Real{};
        for (int i = 0; i < Kind::kRaysPerPacket; ++i) {
            if (!read_lane(active_, i) || read_lane(geometry, i) < 0) continue;
            const auto primitive = static_cast<std::size_t>(read_lane(number, i));
            if (read_lane(geometry, i) == kSpheres)
                set_lane_hit_on_sphere(primitive, i);
            else
                set_lane_hit_on_triangle(
                    primitive + (read_lane(geometry, i) == kLamps ? whitted_scene_.first_lamp : 0),
                    read_lane(u, i), read_lane(v, i), i);
        }
        active_ = goes_on_;
    }
    void set_lane_hit_on_triangle(std::size_t triangle, float u, float v, int i) {
        write_lane(normal_, i, interpolate_triangle_normal(triangle, u, v));
        write_lane(surface_lift_, i, shadow_terminator_ray_offset(triangle, u, v));
        const PeerSurfaceMaterial& surface =
            whitted_scene_.surfaces[whitted_scene_.triangle_objects[triangle]];
        shade_diffuse_lane(surface, i);
        if (surface.turns) flip_normal_towards_ray(i);
        if (surface.texture)
            apply_texture(surface, texture_coordinates_on_triangle(triangle, u, v), i);
        if (surface.is_sharp) apply_schlick_reflectance(surface, i);
    }
    void shade_diffuse_lane(const PeerSurfaceMaterial& surface, int i) {
        write_lane(surface.is_mirror ? goes_on_ : diffuse_, i, -1);
        if (surface.is_sharp) write_lane(goes_on_, i, -1);
        if (surface.fades) write_lane(fades_, i, -1);
        write_lane(albedo_, i, surface.albedo), write_lane(emission_, i, surface.emission);
        write_lane(reflectance_, i, surface.reflectance);
    }
    /// Turns the normal to the side of the facet from which the ray comes.
    void flip_normal_towards_ray(int i) {
        const PacketVector<float> normal = read_lane(normal_, i), facet = read_lane(facet_, i);
        if (dot_product(normal, facet) * dot_product(read_lane(direction_, i), facet) > 0) {
            write_lane(normal_, i, packet_lane_to_vector(-1.0f * normal));
            // Seen from the back of the facet, the smooth surface is hollow and lies below the
            // facet.
            write_lane(surface_lift_, i, 0.0f);
        }
    }
    void apply_texture(const PeerSurfaceMaterial& surface, UvCoordinates place, int i) {
        const PeerVector3 colour = sample_texture_bilinear(
            whitted_scene_.textures[*surface.texture], place);
        write_lane(albedo_, i,
                   packet_lane_to_vector(read_lane(albedo_, i) * broadcast_vector<float>(colour)));
    }
    /// Sets the reflectance at the ray's angle (Schlick 1994), and reduces the albedo to the light
    /// that is not reflected.
    void apply_schlick_reflectance(const PeerSurfaceMaterial& surface, int i) {
        const float cosine = -dot_product(normalize_vector(read_lane(normal_, i)),
                                          read_lane(direction_, i));
        const float away = 1 - std::min(std::max(cosine, 0.0f), 1.0f);
        const PacketVector<float> all = broadcast_vector<float>({1, 1, 1}),
                                  least = broadcast_vector<float>(surface.reflectance);
        const PacketVector<float> reflected = least +
                                              away * away * away * away * away * (all - least);
        write_lane(reflectance_, i, packet_lane_to_vector(reflected));
        write_lane(albedo_, i, packet_lane_to_vector((all - reflected) * read_lane(albedo_, i)));
    }
    UvCoordinates texture_coordinates_on_triangle(std::size_t triangle, float u, float v) const {
        const auto& [a, b, c] = whitted_scene_.places[triangle];
        const float w = 1 - u - v;
        return {w * a.u + u * b.u + v * c.u, w * a.v + u * b.v + v * c.v};
    }
    PeerVector3 interpolate_triangle_normal(std::size_t triangle, float u, float v) const {
        const auto& [a, b, c] = whitted_scene_.normals[triangle];
        const float w = 1 - u - v;
        return {w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y,
                w * a.z + u * b.z + v * c.z};
    }
    /// Returns how far above its facet a smooth surface with these corner normals lies, as
    /// smooth_surface_offset of shaders/lib/math/leaving.glsl.
    float shadow_terminator_ray_offset(std::size_t triangle, float u, float v) const {
        const auto& corners = whitted_scene_.corners[triangle];
        const auto& normals = whitted_scene_.normals[triangle];
        const std::array<float, 3> weights{1 - u - v, u, v};
        PacketVector<float> point{};
        for (std::size_t k = 0; k < 3; ++k)
            point = point + weights[k] * broadcast_vector<float>(corners[k]);
        float lift = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const PacketVector<float> arm = broadcast_vector<float>(corners[k]) - point;
            lift += weights[k] *
                    std::max(dot_product(arm, broadcast_vector<float>(normals[k])), 0.0f);
        }
        return lift;
    }
    /// Sets the surface data of a hit on a sphere. The point is projected back onto the sphere.
    void set_lane_hit_on_sphere(std::size_t sphere, int i) {
        const auto& [c, radius] = whitted_scene_.spheres[sphere];
        const PeerVector3 arm{read_lane(point_.x, i) - c.x, read_lane(point_.y, i) - c.y,
                              read_lane(point_.z, i) - c.z};
        const float part = radius / std::sqrt(arm.x * arm.x + arm.y * arm.y + arm.z * arm.z);
        write_lane(normal_, i, arm), write_lane(facet_, i, arm);
        write_lane(point_, i, {c.x + part * arm.x, c.y + part * arm.y, c.z + part * arm.z});
        shade_diffuse_lane(whitted_scene_.surfaces[whitted_scene_.sphere_objects[sphere]], i);
    }

    /// Fills Embree's packet with rays. A lane that is not `active` gets an empty range. On
    /// processors without vectors of sixteen, Embree splits packets and knows active rays only by
    /// their range.
    void fill_embree_ray_packet(typename Kind::Rays& rays, V origin, V direction, float end,
                                const Mask& active) {
        store_packet_values(rays.org_x, origin.x), store_packet_values(rays.org_y, origin.y),
            store_packet_values(rays.org_z, origin.z);
        store_packet_values(rays.dir_x, direction.x), store_packet_values(rays.dir_y, direction.y),
            store_packet_values(rays.dir_z, direction.z);
        store_packet_values(rays.tnear, Real{}), store_packet_values(rays.time, Real{});
        store_packet_values(rays.tfar, select_lanes(active, Real{} + end, Real{} - 1.0f));
        store_packet_values(rays.mask, Mask{} - 1), store_packet_values(rays.id, Mask{}),
            store_packet_values(rays.flags, Mask{});
    }

    /// Returns the origin of rays that leave the surface on the side to which `direction` points.
    V offset_reflected_ray_origin(V direction) const {
        const V unit = normalize_vector(facet_);
        const Real side = select_lanes(is_lane_greater(dot_product(direction, facet_), Real{}),
                                       Real{} + whitted_scene_.lift, Real{} - whitted_scene_.lift);
        return point_ + side * unit;
    }

    /// Returns where a shadow ray along `direction` starts. A ray that goes below the facet starts
    /// on the smooth surface (lifted_shadow_ray_origin of shaders/lib/whitted.glsl).
    V offset_shadow_ray_origin(const V& direction, const V& normal) const {
        const V unit = normalize_vector(facet_);
        const V facet = select_lanes(is_lane_greater(Real{}, dot_product(normal, unit)),
                                     broadcast_vector<Real>({}) - unit, unit);
        const V lifted = point_ + surface_lift_ * normal + (Real{} + whitted_scene_.lift) * facet;
        return select_lanes(is_lane_greater(Real{}, dot_product(direction, facet)), lifted,
                            offset_reflected_ray_origin(direction));
    }

    void shade_ray_packet() {
        const V zero = broadcast_vector<Real>({});
        colour_ = colour_ +
                  select_lanes(diffuse_,
                               weight_ * (emission_ + (Real{} + whitted_scene_.ambient) * albedo_),
                               zero);
        const V normal = normalize_vector(normal_);
        for (const PeerSceneLight& light : whitted_scene_.lights) add_light(light, normal);
    }
    void add_light(const PeerSceneLight& light, const V& normal) {
        const V to_light = broadcast_vector<Real>(light.position) - point_;
        const Real distance = square_root(dot_product(to_light, to_light));
        const V direction = (Real{} + 1.0f) / distance * to_light;
        const bool has_cosine = light.normal.x != 0 || light.normal.y != 0 || light.normal.z != 0;
        const Real at_light = has_cosine
                                  ? -dot_product(direction, broadcast_vector<Real>(light.normal))
                                  : Real{} + 1.0f;
        const Real at_surface = dot_product(normal, direction);
        const Real cone = light.is_spot ? spot_light_cone_attenuation(light, direction)
                                        : Real{} + 1.0f;
        const Real whole = select_lanes(fades_, facet_light_share(direction, normal),
                                        Real{} + 1.0f);
        const Mask asks = diffuse_ & is_lane_greater(at_light, Real{}) &
                          is_lane_greater(at_surface, Real{}) & is_lane_greater(cone, Real{}) &
                          is_lane_greater(whole, Real{}) &
                          is_lane_greater(albedo_.x + albedo_.y + albedo_.z, Real{});
        if (!is_any_mask_lane_set(asks)) return;
        count_active_lanes(rays_.shadow, asks);
        alignas(64) typename Kind::Rays rays;
        const V origin = offset_shadow_ray_origin(direction, normal);
        fill_embree_ray_packet(rays, origin, broadcast_vector<Real>(light.position) - origin,
                               whitted_scene_.shadow_end, asks);
        Kind::find_occluded_packet_lanes(asks, whitted_scene_.tree, &context_, rays);
        const Mask lit = asks & is_lane_greater(load_packet_values<Real>(rays.tfar), Real{});
        const Real factor = whole * cone * (at_light / distance) * (at_surface / distance) / kPi;
        colour_ = colour_ +
                  select_lanes(
                      lit, factor * (weight_ * albedo_ * broadcast_vector<Real>(light.intensity)),
                      broadcast_vector<Real>({}));
    }
    /// Returns the share of a light that a facet receives, as facet_light_share of
    /// shaders/lib/math/light.glsl.
    Real facet_light_share(const V& direction, const V& normal) const {
        const V unit = normalize_vector(facet_);
        const Real sine = dot_product(direction, unit), zero{}, one = Real{} + 1.0f;
        const Real at_surface = dot_product(normal, direction),
                   fade = Real{} + whitted_scene_.facet_fade;
        const Real above = select_lanes(is_lane_greater(zero, dot_product(normal, unit)),
                                        zero - sine, sine) /
                           select_lanes(is_lane_greater(fade, at_surface), at_surface, fade);
        const Real positive = select_lanes(is_lane_greater(above, zero), above, zero);
        const Real part = select_lanes(is_lane_greater(positive, one), one, positive);
        return part * part * (3.0f - 2.0f * part);
    }
    /// Returns the share of its intensity that a spot emits towards the surface. `direction` points
    /// from the surface to the light.
    Real spot_light_cone_attenuation(const PeerSceneLight& light, const V& direction) const {
        const Real inside = (-dot_product(direction, broadcast_vector<Real>(light.axis)) -
                             light.cos_outer) *
                            light.sharpness;
        const Real one = Real{} + 1.0f,
                   positive = select_lanes(is_lane_greater(inside, Real{}), inside, Real{});
        const Real part = select_lanes(is_lane_greater(positive, one), one, positive);
        return part * part;
    }

    /// Reflects the packet, as reflect_above_facet of shaders/lib/math/light.glsl.
    void start_reflected_ray_packet() {
        const V normal = normalize_vector(normal_), unit = normalize_vector(facet_);
        const V facet = select_lanes(is_lane_greater(dot_product(direction_, unit), Real{}),
                                     broadcast_vector<Real>({}) - unit, unit);
        const V r = direction_ - 2.0f * dot_product(direction_, normal) * normal;
        const Real height = dot_product(r, facet);
        const V out = select_lanes(is_lane_greater(Real{}, height),
                                   normalize_vector(r - 2.0f * height * facet), r);
        weight_ = weight_ * reflectance_;
        origin_ = offset_reflected_ray_origin(out), direction_ = out;
    }

    const WhittedTracerScene& whitted_scene_;
    PeerRayCounts& rays_;
    std::vector<PeerVector3>& pixels_;
    RTCIntersectContext context_{};
    V origin_, direction_, weight_, colour_;
    V point_, facet_, normal_, albedo_, emission_, reflectance_; ///< normals of any length
    Real surface_lift_; ///< how far the smooth surface lies above point_, scene units
    Mask active_, diffuse_, goes_on_, fades_;
};

template <typename Kind>
void trace_picture_tiles(const WhittedTracerScene& scene, std::atomic<int>& next,
                         PeerRayCounts& rays, std::vector<PeerVector3>& pixels) {
    const int across = scene.width / kTileEdgePixels,
              tiles = across * (scene.height / kTileEdgePixels);
    RayPacketTracer<Kind> block(scene, rays, pixels);
    for (int tile; (tile = next.fetch_add(1, std::memory_order_relaxed)) < tiles;) {
        const int left = tile % across * kTileEdgePixels, top = tile / across * kTileEdgePixels;
        for (int y = 0; y < kTileEdgePixels; y += Kind::kRaysPerPacket / Kind::kWidth)
            for (int x = 0; x < kTileEdgePixels; x += Kind::kWidth)
                block.trace_packet_of_pixel_block(left + x, top + y);
    }
}

} // namespace

PeerTracedPicture trace_whitted_picture(const WhittedTracerScene& scene, int width, int threads) {
    if (scene.width % kTileEdgePixels != 0 || scene.height % kTileEdgePixels != 0)
        throw std::invalid_argument("wanted a picture of whole tiles of 16x16 pixels");
    const auto tiles = width == 1   ? trace_picture_tiles<OneRayPacket>
                       : width == 8 ? trace_picture_tiles<EightRayPacket>
                                    : trace_picture_tiles<SixteenRayPacket>;
    PeerTracedPicture traced;
    traced.pixels.resize(static_cast<std::size_t>(scene.width) *
                         static_cast<std::size_t>(scene.height));
    std::atomic<int> next{0};
    std::vector<PeerRayCounts> counts(static_cast<std::size_t>(threads));
    std::vector<std::thread> workers;
    for (PeerRayCounts& sum : counts)
        workers.emplace_back([&] {
            // On the thread's stack, so that no two threads write to the same cache line.
            PeerRayCounts own;
            tiles(scene, next, own, traced.pixels);
            sum = own;
        });
    for (std::thread& worker : workers) worker.join();
    for (const PeerRayCounts& one : counts)
        traced.rays.primary += one.primary, traced.rays.mirror += one.mirror,
            traced.rays.shadow += one.shadow;
    return traced;
}

} // namespace peers
