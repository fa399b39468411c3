#pragma once

#include "bvh/closest_hit.hpp"
#include "support/device.hpp"

#include <bit>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <vector>

/// Traces rays of a test through a BVH on the device (shaders/tests/kernel.comp) and on the CPU,
/// and compares the hits. Triangles and rays are used as they are, without centring, scaling or
/// loading.
namespace test {

/// A ray in the layout that the shader reads.
struct KernelRay {
    vec3 origin{0};
    float t_max = std::numeric_limits<float>::infinity();
    vec3 direction{0};
    std::uint32_t leaves = 0; ///< 1 + number of the triangle that the ray starts on
};
static_assert(sizeof(KernelRay) == 32);

/// A hit in the layout that the shader writes. Distance, weights and numbers are 0 for a miss.
struct KernelHit {
    float t = 0;
    vec3 barycentric{0};
    std::uint32_t triangle = 0, object = 0;
    std::uint32_t outcome = 0; ///< bit 0: hit; bit 1: the walk gave up
    std::uint32_t steps = 0;   ///< number of node visits and triangle tests
    bool found() const { return (outcome & 1u) != 0; }
    bool exhausted() const { return (outcome & 2u) != 0; }
};
static_assert(sizeof(KernelHit) == 32);

/// The start of a ray on a triangle: the index of the triangle in the BVH, the weights of its
/// corners, and the ray's direction.
struct KernelStart {
    vec3 weights{0};
    std::uint32_t place = 0;
    vec3 direction{0};
    std::uint32_t unused = 0;
};
static_assert(sizeof(KernelStart) == 32);

/// The start of a ray as the shader computes it: the point, the facet's unit normal (0 if it has
/// none), and the ray's origin, which is moved off the surface.
struct KernelLeaving {
    vec3 point{0};
    float unused_0 = 0;
    vec3 normal{0};
    float unused_1 = 0;
    vec3 origin{0};
    float unused_2 = 0;
};
static_assert(sizeof(KernelLeaving) == 48);

/// A BVH on the device, with functions that trace rays through it.
class Kernel {
public:
    explicit Kernel(bvh::Bvh hierarchy)
        : hierarchy_(std::move(hierarchy)), runner_(bench().device, bench().pipelines) {
        upload_to_buffer(bench().device, nodes_, "nodes", hierarchy_.nodes,
                         gpu::BufferUsage::texels);
        upload_to_buffer(bench().device, triangles_, "triangles", hierarchy_.triangles,
                         gpu::BufferUsage::texels);
    }
    explicit Kernel(std::span<const bvh::Triangle> triangles) : Kernel(bvh::build_bvh(triangles)) {}

    /// Robustness rules that the shader leaves out, as constants of shaders/lib/plain.glsl. Without
    /// a rule, a test shows the errors that the rule prevents.
    gpu::ShaderConstants rules{};

    const bvh::Bvh& hierarchy() const { return hierarchy_; }

    /// Returns the first hit of each ray, at most 4 million rays. Triangles with a flag of
    /// `skipped` are ignored. `lows`: rounding errors of the rays' origins as floats; empty: 0.
    std::vector<KernelHit> closest(const std::vector<KernelRay>& rays, std::uint32_t skipped = 0,
                                   const std::vector<vec4>& lows = {}) {
        return walk(rays, skipped, lows, 0);
    }
    /// Returns whether each ray meets anything. Of a hit, only `outcome` and `steps` are set.
    std::vector<KernelHit> any(const std::vector<KernelRay>& rays, std::uint32_t skipped = 0,
                               const std::vector<vec4>& lows = {}) {
        return walk(rays, skipped, lows, 1);
    }
    std::vector<KernelLeaving> leave(const std::vector<KernelStart>& starts) {
        return run<KernelLeaving>("tests/spawn.comp", rules, "Starts", starts, "Leavings",
                                  std::array{size_of(starts)});
    }

private:
    std::vector<KernelHit> walk(const std::vector<KernelRay>& rays, std::uint32_t skipped,
                                const std::vector<vec4>& lows, std::uint32_t occluded) {
        gpu::ShaderConstants constants = rules;
        const bool object_spaces = hierarchy_.nodes[2].x > 0; // tree with instances (bvh/tlas.hpp)
        constants.emplace_back("object_spaces", object_spaces ? 1u : 0u);
        constants.emplace_back("exact_spheres", has_balls() ? 1u : 0u);
        upload_to_buffer(bench().device, lows_, "lows",
                         lows.empty() ? std::vector<vec4>(rays.size(), vec4(0)) : lows,
                         gpu::BufferUsage::plain);
        return run<KernelHit>("tests/kernel.comp", constants, "Rays", rays, "Hits",
                              std::array{size_of(rays), skipped, occluded});
    }

    bool has_balls() const {
        for (std::size_t i = 2; i < hierarchy_.triangles.size(); i += 3)
            if ((bvh::float_word_to_integer(hierarchy_.triangles[i].w) & bvh::kBall) != 0)
                return true;
        return false;
    }

    template <typename In>
    static std::uint32_t size_of(const std::vector<In>& list) {
        return static_cast<std::uint32_t>(list.size());
    }

    template <typename Out, typename In, typename Push>
    std::vector<Out> run(const char* shader, const gpu::ShaderConstants& constants,
                         const char* input, const std::vector<In>& in, const char* output,
                         const Push& push) {
        upload_to_buffer(bench().device, input_, "input", in, gpu::BufferUsage::plain);
        graph::Graph graph;
        const graph::BufferHandle out = graph.buffer({"output", in.size() * sizeof(Out)});
        graph.pass("kernel")
            .writes(out, graph::ResourceUse::storage_write)
            .record([&](graph::PassCommands& commands) {
                commands.bind("bvh_nodes", nodes_);
                commands.bind("bvh_triangles", triangles_);
                commands.bind(input, input_);
                commands.bind("Lows", lows_);
                commands.bind(output, out);
                commands.use(gpu::ComputeState{shader, constants});
                commands.push(push);
                commands.dispatch((size_of(in) + 63) / 64, 1);
            });
        graph.mark_output(out);
        test::run(runner_, graph);
        return read_as<Out>(runner_, out);
    }

    bvh::Bvh hierarchy_;
    graph::GraphRunner runner_;
    gpu::Buffer nodes_, triangles_, input_, lows_;
};

inline std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

/// Returns whether two hits are equal bit for bit, except for the number of steps.
inline bool same(const KernelHit& a, const KernelHit& b) {
    const auto words = [](const KernelHit& h) {
        return std::array{bits(h.t),
                          bits(h.barycentric.x),
                          bits(h.barycentric.y),
                          bits(h.barycentric.z),
                          h.triangle,
                          h.object,
                          h.outcome};
    };
    return words(a) == words(b);
}

/// Returns the hit that the CPU reference finds (bvh/closest_hit.hpp).
inline KernelHit mirror_of(const bvh::Bvh& hierarchy, const KernelRay& ray,
                           std::uint32_t skipped = 0, const vec3& low = vec3(0)) {
    bvh::TraversalCounters steps;
    const auto hit = bvh::find_closest_hit<float>(
        hierarchy, {ray.origin, ray.direction, ray.leaves}, ray.t_max, skipped, &steps, low);
    KernelHit result;
    if (hit) result = {hit->t, hit->barycentric, hit->triangle, hit->object, 1, 0};
    result.steps = static_cast<std::uint32_t>(steps.total());
    return result;
}

inline std::string text(const KernelHit& hit) {
    std::ostringstream out;
    if (!hit.found()) return hit.exhausted() ? "gave up" : "miss";
    out << std::hexfloat << "t " << hit.t << " weights " << hit.barycentric.x << ' '
        << hit.barycentric.y << ' ' << hit.barycentric.z << " triangle " << hit.triangle
        << " object " << hit.object << (hit.exhausted() ? " gave up" : "");
    return out.str();
}

inline std::string text(const KernelRay& ray) {
    std::ostringstream out;
    out << std::hexfloat << "origin " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z
        << " direction " << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z
        << " t_max " << ray.t_max << " leaves " << ray.leaves;
    return out.str();
}

/// Returns the number of rays for which the device and the CPU reference differ. The first such ray
/// fails the test with both hits. `stride`: compares only every stride-th ray.
inline std::size_t differences(const Kernel& kernel, const std::vector<KernelRay>& rays,
                               const std::vector<KernelHit>& hits, std::uint32_t skipped = 0,
                               std::size_t stride = 1, const std::vector<vec4>& lows = {}) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); i += stride) {
        const KernelHit expected = mirror_of(kernel.hierarchy(), rays[i], skipped,
                                             lows.empty() ? vec3(0) : vec3(lows[i]));
        if (same(hits[i], expected)) continue;
        if (count++ == 0)
            ADD_FAILURE() << "ray " << i << ", " << text(rays[i]) << "\n  device: " << text(hits[i])
                          << "\n  mirror: " << text(expected);
    }
    return count;
}

} // namespace test
