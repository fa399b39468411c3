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

constexpr int kTile = 16;
constexpr float kPi = 3.14159265358979323846f;

/// Traces the paths of a packet of camera rays from the camera to their ends.
template <typename Kind>
class Block {
    using Real = typename Kind::Real;
    using Mask = typename Kind::Mask;
    using V = Three<Real>;

public:
    Block(const Whitted& scene, RayCounts& rays, std::vector<Vector>& pixels)
        : scene_(scene), rays_(rays), pixels_(pixels) {
        rtcInitIntersectContext(&context_);
        // Reflected packets stay mostly coherent in these scenes. This flag takes .9 times as long
        // as the flag for incoherent rays.
        context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }

    void trace(int left, int top) {
        start(left, top);
        for (int bounce = 0; any(active_); ++bounce) {
            count(bounce == 0 ? rays_.primary : rays_.mirror, active_);
            meet();
            if (any(diffuse_)) shade();
            if (bounce == scene_.depth || !any(active_)) break;
            reflect();
        }
        for (int i = 0; i < Kind::kCount; ++i)
            pixels_[pixel(left, top, i)] = {lane(colour_.x, i), lane(colour_.y, i),
                                            lane(colour_.z, i)};
    }

private:
    static bool any(const Mask& mask) {
        int all = 0;
        for (int i = 0; i < Kind::kCount; ++i) all |= lane(mask, i);
        return all != 0;
    }
    static void count(std::uint64_t& sum, const Mask& mask) {
        int lanes = 0;
        for (int i = 0; i < Kind::kCount; ++i) lanes -= lane(mask, i);
        sum += static_cast<std::uint64_t>(lanes);
    }
    std::size_t pixel(int left, int top, int i) const {
        return static_cast<std::size_t>(top + i / Kind::kWidth) *
                   static_cast<std::size_t>(scene_.width) +
               static_cast<std::size_t>(left + i % Kind::kWidth);
    }

    void start(int left, int top) {
        Real x{}, y{};
        for (int i = 0; i < Kind::kCount; ++i) {
            put(x, i, static_cast<float>(left + i % Kind::kWidth) + .5f);
            put(y, i, static_cast<float>(top + i / Kind::kWidth) + .5f);
        }
        x = x / static_cast<float>(scene_.width) * 2.0f - 1.0f;
        y = y / static_cast<float>(scene_.height) * 2.0f - 1.0f;
        origin_ = same<Real>(scene_.eye);
        direction_ = normalize(same<Real>(scene_.forward) + x * same<Real>(scene_.right) +
                               y * same<Real>(scene_.down));
        weight_ = same<Real>({1, 1, 1}), colour_ = same<Real>({});
        active_ = Mask{} - 1;
    }

    /// Traces the packet to its hits. Sets the surface data of each hit, the lanes that are
    /// reflected, and the lanes that are shaded.
    void meet() {
        typename Kind::Hits hits;
        fill(hits.ray, origin_, direction_, std::numeric_limits<float>::infinity(), active_);
        store(hits.hit.geomID, Mask{} + static_cast<int>(RTC_INVALID_GEOMETRY_ID));
        store(hits.hit.instID[0], Mask{} + static_cast<int>(RTC_INVALID_GEOMETRY_ID));
        Kind::meet(active_, scene_.tree, &context_, hits);
        const Mask geometry = load<Mask>(hits.hit.geomID), number = load<Mask>(hits.hit.primID);
        const Real u = load<Real>(hits.hit.u), v = load<Real>(hits.hit.v);
        point_ = origin_ + load<Real>(hits.ray.tfar) * direction_;
        facet_ = {load<Real>(hits.hit.Ng_x), load<Real>(hits.hit.Ng_y), load<Real>(hits.hit.Ng_z)};
        normal_ = albedo_ = emission_ = reflectance_ = same<Real>({});
        diffuse_ = goes_on_ = fades_ = Mask{};
        surface_lift_ = Real{};
        for (int i = 0; i < Kind::kCount; ++i) {
            if (!lane(active_, i) || lane(geometry, i) < 0) continue;
            const auto primitive = static_cast<std::size_t>(lane(number, i));
            if (lane(geometry, i) == kSpheres)
                put_on_sphere(primitive, i);
            else
                put_on_triangle(primitive + (lane(geometry, i) == kLamps ? scene_.first_lamp : 0),
                                lane(u, i), lane(v, i), i);
        }
        active_ = goes_on_;
    }
    void put_on_triangle(std::size_t triangle, float u, float v, int i) {
        put(normal_, i, normal_of(triangle, u, v));
        put(surface_lift_, i, lift_of(triangle, u, v));
        const Surface& surface = scene_.surfaces[scene_.triangle_objects[triangle]];
        show(surface, i);
        if (surface.turns) turn(i);
        if (surface.texture) texture(surface, place_of(triangle, u, v), i);
        if (surface.is_sharp) sharpen(surface, i);
    }
    void show(const Surface& surface, int i) {
        put(surface.is_mirror ? goes_on_ : diffuse_, i, -1);
        if (surface.is_sharp) put(goes_on_, i, -1);
        if (surface.fades) put(fades_, i, -1);
        put(albedo_, i, surface.albedo), put(emission_, i, surface.emission);
        put(reflectance_, i, surface.reflectance);
    }
    /// Turns the normal to the side of the facet from which the ray comes.
    void turn(int i) {
        const Three<float> normal = lane(normal_, i), facet = lane(facet_, i);
        if (dot(normal, facet) * dot(lane(direction_, i), facet) > 0) {
            put(normal_, i, plain(-1.0f * normal));
            // From this side the smooth surface is hollow, below the facet.
            put(surface_lift_, i, 0.0f);
        }
    }
    void texture(const Surface& surface, Place place, int i) {
        const Vector colour = colour_at(scene_.textures[*surface.texture], place);
        put(albedo_, i, plain(lane(albedo_, i) * same<float>(colour)));
    }
    /// Sets the reflectance at the ray's angle (Schlick 1994), and reduces the albedo to the light
    /// that is not reflected.
    void sharpen(const Surface& surface, int i) {
        const float cosine = -dot(normalize(lane(normal_, i)), lane(direction_, i));
        const float away = 1 - std::min(std::max(cosine, 0.0f), 1.0f);
        const Three<float> all = same<float>({1, 1, 1}), least = same<float>(surface.reflectance);
        const Three<float> reflected = least + away * away * away * away * away * (all - least);
        put(reflectance_, i, plain(reflected));
        put(albedo_, i, plain((all - reflected) * lane(albedo_, i)));
    }
    Place place_of(std::size_t triangle, float u, float v) const {
        const auto& [a, b, c] = scene_.places[triangle];
        const float w = 1 - u - v;
        return {w * a.u + u * b.u + v * c.u, w * a.v + u * b.v + v * c.v};
    }
    Vector normal_of(std::size_t triangle, float u, float v) const {
        const auto& [a, b, c] = scene_.normals[triangle];
        const float w = 1 - u - v;
        return {w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y,
                w * a.z + u * b.z + v * c.z};
    }
    /// Returns how far above its facet a smooth surface with these corner normals lies, as
    /// smooth_surface_offset of shaders/lib/math/leaving.glsl.
    float lift_of(std::size_t triangle, float u, float v) const {
        const auto& corners = scene_.corners[triangle];
        const auto& normals = scene_.normals[triangle];
        const std::array<float, 3> weights{1 - u - v, u, v};
        Three<float> point{};
        for (std::size_t k = 0; k < 3; ++k) point = point + weights[k] * same<float>(corners[k]);
        float lift = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Three<float> arm = same<float>(corners[k]) - point;
            lift += weights[k] * std::max(dot(arm, same<float>(normals[k])), 0.0f);
        }
        return lift;
    }
    /// Sets the surface data of a hit on a sphere. The point is projected back onto the sphere.
    void put_on_sphere(std::size_t sphere, int i) {
        const auto& [c, radius] = scene_.spheres[sphere];
        const Vector arm{lane(point_.x, i) - c.x, lane(point_.y, i) - c.y, lane(point_.z, i) - c.z};
        const float part = radius / std::sqrt(arm.x * arm.x + arm.y * arm.y + arm.z * arm.z);
        put(normal_, i, arm), put(facet_, i, arm);
        put(point_, i, {c.x + part * arm.x, c.y + part * arm.y, c.z + part * arm.z});
        show(scene_.surfaces[scene_.sphere_objects[sphere]], i);
    }

    /// Fills Embree's packet with rays. A lane that is not `active` gets an empty range. On
    /// processors without vectors of sixteen, Embree splits packets and knows active rays only by
    /// their range.
    void fill(typename Kind::Rays& rays, V origin, V direction, float end, const Mask& active) {
        store(rays.org_x, origin.x), store(rays.org_y, origin.y), store(rays.org_z, origin.z);
        store(rays.dir_x, direction.x), store(rays.dir_y, direction.y),
            store(rays.dir_z, direction.z);
        store(rays.tnear, Real{}), store(rays.time, Real{});
        store(rays.tfar, select(active, Real{} + end, Real{} - 1.0f));
        store(rays.mask, Mask{} - 1), store(rays.id, Mask{}), store(rays.flags, Mask{});
    }

    /// Returns the origin of rays that leave the surface on the side to which `direction` points.
    V leaving(V direction) const {
        const V unit = normalize(facet_);
        const Real side = select(greater(dot(direction, facet_), Real{}), Real{} + scene_.lift,
                                 Real{} - scene_.lift);
        return point_ + side * unit;
    }

    /// Returns where a shadow ray along `direction` starts. A ray that goes below the facet starts
    /// on the smooth surface (leaving_lifted of shaders/lib/whitted.glsl).
    V shadow_origin(const V& direction, const V& normal) const {
        const V unit = normalize(facet_);
        const V facet = select(greater(Real{}, dot(normal, unit)), same<Real>({}) - unit, unit);
        const V lifted = point_ + surface_lift_ * normal + (Real{} + scene_.lift) * facet;
        return select(greater(Real{}, dot(direction, facet)), lifted, leaving(direction));
    }

    void shade() {
        const V zero = same<Real>({});
        colour_ = colour_ + select(diffuse_,
                                   weight_ * (emission_ + (Real{} + scene_.ambient) * albedo_),
                                   zero);
        const V normal = normalize(normal_);
        for (const Light& light : scene_.lights) add(light, normal);
    }
    void add(const Light& light, const V& normal) {
        const V to_light = same<Real>(light.position) - point_;
        const Real distance = root(dot(to_light, to_light));
        const V direction = (Real{} + 1.0f) / distance * to_light;
        const bool has_cosine = light.normal.x != 0 || light.normal.y != 0 || light.normal.z != 0;
        const Real at_light = has_cosine ? -dot(direction, same<Real>(light.normal))
                                         : Real{} + 1.0f;
        const Real at_surface = dot(normal, direction);
        const Real cone = light.is_spot ? share(light, direction) : Real{} + 1.0f;
        const Real whole = select(fades_, facet_share(direction, normal), Real{} + 1.0f);
        const Mask asks = diffuse_ & greater(at_light, Real{}) & greater(at_surface, Real{}) &
                          greater(cone, Real{}) & greater(whole, Real{}) &
                          greater(albedo_.x + albedo_.y + albedo_.z, Real{});
        if (!any(asks)) return;
        count(rays_.shadow, asks);
        alignas(64) typename Kind::Rays rays;
        const V origin = shadow_origin(direction, normal);
        fill(rays, origin, same<Real>(light.position) - origin, scene_.shadow_end, asks);
        Kind::block(asks, scene_.tree, &context_, rays);
        const Mask lit = asks & greater(load<Real>(rays.tfar), Real{});
        const Real factor = whole * cone * (at_light / distance) * (at_surface / distance) / kPi;
        colour_ = colour_ + select(lit, factor * (weight_ * albedo_ * same<Real>(light.intensity)),
                                   same<Real>({}));
    }
    /// Returns the share of a light that a facet receives, as facet_light_share of
    /// shaders/lib/math/light.glsl.
    Real facet_share(const V& direction, const V& normal) const {
        const V unit = normalize(facet_);
        const Real sine = dot(direction, unit), zero{}, one = Real{} + 1.0f;
        const Real at_surface = dot(normal, direction), fade = Real{} + scene_.facet_fade;
        const Real above = select(greater(zero, dot(normal, unit)), zero - sine, sine) /
                           select(greater(fade, at_surface), at_surface, fade);
        const Real positive = select(greater(above, zero), above, zero);
        const Real part = select(greater(positive, one), one, positive);
        return part * part * (3.0f - 2.0f * part);
    }
    /// Returns the share of its intensity that a spot emits towards the surface. `direction` points
    /// from the surface to the light.
    Real share(const Light& light, const V& direction) const {
        const Real inside = (-dot(direction, same<Real>(light.axis)) - light.cos_outer) *
                            light.sharpness;
        const Real one = Real{} + 1.0f, positive = select(greater(inside, Real{}), inside, Real{});
        const Real part = select(greater(positive, one), one, positive);
        return part * part;
    }

    /// Reflects the packet, as mirror_direction of shaders/lib/math/light.glsl.
    void reflect() {
        const V normal = normalize(normal_), unit = normalize(facet_);
        const V facet = select(greater(dot(direction_, unit), Real{}), same<Real>({}) - unit, unit);
        const V r = direction_ - 2.0f * dot(direction_, normal) * normal;
        const Real height = dot(r, facet);
        const V out = select(greater(Real{}, height), normalize(r - 2.0f * height * facet), r);
        weight_ = weight_ * reflectance_;
        origin_ = leaving(out), direction_ = out;
    }

    const Whitted& scene_;
    RayCounts& rays_;
    std::vector<Vector>& pixels_;
    RTCIntersectContext context_{};
    V origin_, direction_, weight_, colour_;
    V point_, facet_, normal_, albedo_, emission_, reflectance_; ///< normals of any length
    Real surface_lift_; ///< how far the smooth surface lies above point_, scene units
    Mask active_, diffuse_, goes_on_, fades_;
};

template <typename Kind>
void trace_tiles(const Whitted& scene, std::atomic<int>& next, RayCounts& rays,
                 std::vector<Vector>& pixels) {
    const int across = scene.width / kTile, tiles = across * (scene.height / kTile);
    Block<Kind> block(scene, rays, pixels);
    for (int tile; (tile = next.fetch_add(1, std::memory_order_relaxed)) < tiles;) {
        const int left = tile % across * kTile, top = tile / across * kTile;
        for (int y = 0; y < kTile; y += Kind::kCount / Kind::kWidth)
            for (int x = 0; x < kTile; x += Kind::kWidth) block.trace(left + x, top + y);
    }
}

} // namespace

Traced trace(const Whitted& scene, int width, int threads) {
    if (scene.width % kTile != 0 || scene.height % kTile != 0)
        throw std::invalid_argument("wanted a picture of whole tiles of 16x16 pixels");
    const auto tiles = width == 1   ? trace_tiles<One>
                       : width == 8 ? trace_tiles<Eight>
                                    : trace_tiles<Sixteen>;
    Traced traced;
    traced.pixels.resize(static_cast<std::size_t>(scene.width) *
                         static_cast<std::size_t>(scene.height));
    std::atomic<int> next{0};
    std::vector<RayCounts> counts(static_cast<std::size_t>(threads));
    std::vector<std::thread> workers;
    for (RayCounts& sum : counts)
        workers.emplace_back([&] {
            // On the thread's stack, so that no two threads write to the same cache line.
            RayCounts own;
            tiles(scene, next, own, traced.pixels);
            sum = own;
        });
    for (std::thread& worker : workers) worker.join();
    for (const RayCounts& one : counts)
        traced.rays.primary += one.primary, traced.rays.mirror += one.mirror,
            traced.rays.shadow += one.shadow;
    return traced;
}

} // namespace peers
