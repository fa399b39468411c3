#pragma once

#include "bvh/closest_hit.hpp"
#include "support/device.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <span>
#include <sstream>
#include <string>
#include <vector>

/// Traces rays of a test through a BVH on the device (shaders/tests/kernel.comp) and on the CPU,
/// and compares the hits. Triangles and rays are used as they are, without centring, scaling or
/// loading.
namespace test {

/// A ray in the layout that the shader reads.
struct DeviceRay {
    vec3 origin{0};
    float t_max = std::numeric_limits<float>::infinity();
    vec3 direction{0};
    std::uint32_t leaves = 0; ///< 1 + number of the triangle that the ray starts on
};
static_assert(sizeof(DeviceRay) == 32);

/// A hit in the layout that the shader writes. Distance, weights and numbers are 0 for a miss.
struct DeviceHit {
    float t = 0;
    vec3 barycentric{0};
    std::uint32_t triangle = 0, object = 0;
    std::uint32_t outcome = 0; ///< bit 0: hit; bit 1: the walk gave up
    std::uint32_t steps = 0;   ///< number of node visits and triangle tests
    bool is_hit() const { return (outcome & 1u) != 0; }
    bool has_reached_step_limit() const { return (outcome & 2u) != 0; }
};
static_assert(sizeof(DeviceHit) == 32);

/// The start of a ray on a triangle: the index of the triangle in the BVH, the weights of its
/// corners, and the ray's direction.
struct SurfacePointQuery {
    vec3 weights{0};
    std::uint32_t place = 0;
    vec3 direction{0};
    std::uint32_t unused = 0;
};
static_assert(sizeof(SurfacePointQuery) == 32);

/// The start of a ray as the shader computes it: the point, the facet's unit normal (0 if it has
/// none), and the ray's origin, which is moved off the surface.
struct LeavingRayOrigin {
    vec3 point{0};
    float unused_0 = 0;
    vec3 normal{0};
    float unused_1 = 0;
    vec3 origin{0};
    float unused_2 = 0;
};
static_assert(sizeof(LeavingRayOrigin) == 48);

/// A BVH on the device, with functions that trace rays through it.
class DeviceRayTracer {
public:
    explicit DeviceRayTracer(bvh::Bvh hierarchy)
        : bvh_(std::move(hierarchy)),
          runner_(get_test_device().device, get_test_device().pipelines) {
        upload(get_test_device().device, nodes_, "nodes", bvh_.nodes, gpu::BufferUsage::texels);
        upload(get_test_device().device, triangles_, "triangles", bvh_.triangles,
               gpu::BufferUsage::texels);
    }
    explicit DeviceRayTracer(std::span<const bvh::Triangle> triangles)
        : DeviceRayTracer(bvh::build(triangles)) {}

    /// Robustness rules that the shader leaves out, as constants of shaders/lib/plain.glsl. Without
    /// a rule, a test shows the errors that the rule prevents.
    gpu::ShaderConstants rules{};

    const bvh::Bvh& traversed_bvh() const { return bvh_; }

    /// Returns the first hit of each ray, at most 4 million rays. Triangles with a flag of
    /// `skipped` are ignored. `lows`: rounding errors of the rays' origins as floats; empty: 0.
    std::vector<DeviceHit> find_closest_hits(const std::vector<DeviceRay>& rays,
                                             std::uint32_t skipped = 0,
                                             const std::vector<vec4>& lows = {}) {
        return trace_rays(rays, skipped, lows, 0);
    }
    /// Returns whether each ray meets anything. Of a hit, only `outcome` and `steps` are set.
    std::vector<DeviceHit> find_any_hits(const std::vector<DeviceRay>& rays,
                                         std::uint32_t skipped = 0,
                                         const std::vector<vec4>& lows = {}) {
        return trace_rays(rays, skipped, lows, 1);
    }
    std::vector<LeavingRayOrigin>
    compute_ray_origins(const std::vector<SurfacePointQuery>& starts) {
        return run_ray_shader<LeavingRayOrigin>("tests/spawn.comp", rules, "Starts", starts,
                                                "Leavings",
                                                std::array{list_size_as_uint32(starts)});
    }

private:
    std::vector<DeviceHit> trace_rays(const std::vector<DeviceRay>& rays, std::uint32_t skipped,
                                      const std::vector<vec4>& lows, std::uint32_t occluded) {
        gpu::ShaderConstants constants = rules;
        const bool object_spaces = bvh_.nodes[2].x > 0; // tree with instances (bvh/tlas.hpp)
        constants.emplace_back("object_spaces", object_spaces ? 1u : 0u);
        constants.emplace_back("exact_spheres", has_sphere_primitives() ? 1u : 0u);
        upload(get_test_device().device, lows_, "lows",
               lows.empty() ? std::vector<vec4>(rays.size(), vec4(0)) : lows,
               gpu::BufferUsage::plain);
        return run_ray_shader<DeviceHit>("tests/kernel.comp", constants, "Rays", rays, "Hits",
                                         std::array{list_size_as_uint32(rays), skipped, occluded});
    }

    bool has_sphere_primitives() const {
        for (std::size_t i = 2; i < bvh_.triangles.size(); i += 3)
            if ((bvh::unpack_number(bvh_.triangles[i].w) & bvh::kSpherePrimitiveFlag) != 0)
                return true;
        return false;
    }

    template <typename In>
    static std::uint32_t list_size_as_uint32(const std::vector<In>& list) {
        return static_cast<std::uint32_t>(list.size());
    }

    template <typename Out, typename In, typename Push>
    std::vector<Out> run_ray_shader(const char* shader, const gpu::ShaderConstants& constants,
                                    const char* input, const std::vector<In>& in,
                                    const char* output, const Push& push) {
        upload(get_test_device().device, input_, "input", in, gpu::BufferUsage::plain);
        graph::Graph graph;
        const graph::BufferHandle out = graph.add_buffer({"output", in.size() * sizeof(Out)});
        graph.add_pass("kernel")
            .writes(out, graph::ResourceUse::storage_write)
            .record([&](graph::PassCommands& commands) {
                commands.bind("bvh_nodes", nodes_);
                commands.bind("bvh_triangles", triangles_);
                commands.bind(input, input_);
                commands.bind("Lows", lows_);
                commands.bind(output, out);
                commands.bind_pipeline(gpu::ComputeState{shader, constants});
                commands.push_constants(push);
                commands.dispatch((list_size_as_uint32(in) + 63) / 64, 1);
            });
        graph.output(out);
        test::run_graph(runner_, graph);
        return read_resource_values<Out>(runner_, out);
    }

    bvh::Bvh bvh_;
    graph::GraphRunner runner_;
    gpu::Buffer nodes_, triangles_, input_, lows_;
};

inline std::uint32_t bits_of_float(float x) { return std::bit_cast<std::uint32_t>(x); }

/// Returns whether two hits are equal bit for bit, except for the number of steps.
inline bool are_equal_hits(const DeviceHit& a, const DeviceHit& b) {
    const auto words = [](const DeviceHit& h) {
        return std::array{bits_of_float(h.t),
                          bits_of_float(h.barycentric.x),
                          bits_of_float(h.barycentric.y),
                          bits_of_float(h.barycentric.z),
                          h.triangle,
                          h.object,
                          h.outcome};
    };
    return words(a) == words(b);
}

/// Returns the hit that the CPU reference finds (bvh/closest_hit.hpp).
inline DeviceHit find_hit_on_cpu(const bvh::Bvh& hierarchy, const DeviceRay& ray,
                                 std::uint32_t skipped = 0, const vec3& low = vec3(0)) {
    bvh::TraversalCounters steps;
    const auto hit = bvh::find_closest_hit<float>(
        hierarchy, {ray.origin, ray.direction, ray.leaves}, ray.t_max, skipped, &steps, low);
    DeviceHit result;
    if (hit) result = {hit->t, hit->barycentric, hit->triangle, hit->object, 1, 0};
    result.steps = static_cast<std::uint32_t>(steps.total());
    return result;
}

inline std::string format_for_message(const DeviceHit& hit) {
    std::ostringstream out;
    if (!hit.is_hit()) return hit.has_reached_step_limit() ? "gave up" : "miss";
    out << std::hexfloat << "t " << hit.t << " weights " << hit.barycentric.x << ' '
        << hit.barycentric.y << ' ' << hit.barycentric.z << " triangle " << hit.triangle
        << " object " << hit.object << (hit.has_reached_step_limit() ? " gave up" : "");
    return out.str();
}

inline std::string format_for_message(const DeviceRay& ray) {
    std::ostringstream out;
    out << std::hexfloat << "origin " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z
        << " direction " << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z
        << " t_max " << ray.t_max << " leaves " << ray.leaves;
    return out.str();
}

/// On a device that does not compute like C++, at most one in so many rays may meet another point
/// than on the CPU, because it passes the edge of a triangle within rounding errors.
constexpr std::size_t kRaysPerOtherHit = 200;

/// Returns whether a hit of the device is the one that the CPU reference finds: to the last bit on
/// a device that computes like C++, otherwise a point of the same object within the
/// rounding errors of t, which are relative to t and to the coordinates of the ray's origin. A ray
/// at an edge may meet either triangle.
inline bool is_hit_of_cpu(const DeviceRay& ray, const DeviceHit& found, const DeviceHit& expected) {
    if (computes_like_cpp()) return are_equal_hits(found, expected);
    const vec3 size = glm::abs(ray.origin), speed = glm::abs(ray.direction);
    const float rounding = std::max({size.x, size.y, size.z}) /
                           std::max({speed.x, speed.y, speed.z});
    return found.outcome == expected.outcome && found.object == expected.object &&
           std::abs(found.t - expected.t) <= 0x1p-12f * std::abs(expected.t) + 0x1p-18f * rounding;
}

/// Returns the number of rays for which the device and the CPU reference differ. On a device that
/// does not compute like C++, one in `kRaysPerOtherHit` rays may differ, and the function then
/// returns 0. The first of too many such rays fails the test with both hits. `stride`: compares
/// only every stride-th ray.
inline std::size_t count_wrong_hits(const DeviceRayTracer& kernel,
                                    const std::vector<DeviceRay>& rays,
                                    const std::vector<DeviceHit>& hits, std::uint32_t skipped = 0,
                                    std::size_t stride = 1, const std::vector<vec4>& lows = {}) {
    std::size_t count = 0;
    std::string first;
    for (std::size_t i = 0; i < rays.size(); i += stride) {
        const DeviceHit expected = find_hit_on_cpu(kernel.traversed_bvh(), rays[i], skipped,
                                                   lows.empty() ? vec3(0) : vec3(lows[i]));
        if (is_hit_of_cpu(rays[i], hits[i], expected)) continue;
        if (count++ == 0)
            first = "ray " + std::to_string(i) + ", " + format_for_message(rays[i]) +
                    "\n  device: " + format_for_message(hits[i]) +
                    "\n  mirror: " + format_for_message(expected);
    }
    if (!computes_like_cpp()) {
        std::cout << "[ MEASURED ] " << count << " of " << rays.size() / stride
                  << " rays meet another point than in C++\n";
        if (count <= rays.size() / stride / kRaysPerOtherHit) return 0;
    }
    if (count > 0) ADD_FAILURE() << first;
    return count;
}

} // namespace test
