// Tests of the search for the first mirror that a ray meets. Traversal of the mirror tree must find
// the same mirror as a test of all mirrors.
#include "render/mirror_tree.hpp"
#include "render/texels.hpp"
#include "support/device.hpp"
#include "support/numbers.hpp"

#include <array>
#include <bit>
#include <iostream>

namespace {

using namespace catoptric;

/// A ray in the layout that the shader reads.
struct NextMirrorRay {
    vec3 origin{0};
    float end = 0; ///< the shader tells whether the ray meets a mirror before this t
    vec3 direction{0};
    std::uint32_t leaves = 0; ///< the mirror that the ray starts on and ignores, from 0
};
static_assert(sizeof(NextMirrorRay) == 32);

struct NextMirrorAnswer {
    std::uint32_t sphere = 0; ///< number of the first exact sphere, from 1; 0: no sphere is met
    std::uint32_t t = 0;      ///< bits of the float t at the sphere
    std::uint32_t before = 0, unused = 0;
    bool operator==(const NextMirrorAnswer&) const = default;
};

std::vector<NextMirrorAnswer> list_next_mirror_answers(const std::vector<shared::Probe>& probes,
                                                       const std::vector<NextMirrorRay>& rays,
                                                       bool by_tree) {
    auto& [device, pipelines] = test::get_test_device();
    gpu::Buffer input, mirrors, tree, frame;
    upload(device, input, "rays", rays, gpu::BufferUsage::plain);
    upload(device, mirrors, "probes", render::to_texels(probes), gpu::BufferUsage::texels);
    upload(device, tree, "tree", render::build_mirror_tree(probes), gpu::BufferUsage::texels);
    const auto count = static_cast<std::uint32_t>(probes.size());
    upload(device, frame, "frame", std::vector{shared::Frame{.mirror_count = count}},
           gpu::BufferUsage::uniform);
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    const graph::BufferHandle out = graph.add_buffer(
        {"answers", rays.size() * sizeof(NextMirrorAnswer)});
    graph.add_pass("next_mirror")
        .writes(out, graph::ResourceUse::storage_write)
        .record([&](graph::PassCommands& commands) {
            commands.bind("frame", frame);
            commands.bind("probe_texels", mirrors);
            commands.bind("mirror_nodes", tree);
            commands.bind("Rays", input);
            commands.bind("Answers", out);
            commands.bind_pipeline(
                gpu::ComputeState{"tests/next_mirror.comp", {{"mirror_tree", by_tree ? 1u : 0u}}});
            commands.push_constants(static_cast<std::uint32_t>(rays.size()));
            commands.dispatch(static_cast<std::uint32_t>((rays.size() + 63) / 64), 1);
        });
    graph.output(out);
    test::run_graph(runner, graph);
    return test::read_resource_values<NextMirrorAnswer>(runner, out);
}

shared::Probe make_sphere_probe(vec3 centre, float radius) {
    return {.centre = centre,
            .sphere = centre,
            .radius = radius,
            .lowest = centre - radius,
            .highest = centre + radius};
}

/// Returns exact spheres and boxes of many sizes. Some are in the list twice, and some lie inside
/// others.
std::vector<shared::Probe> make_spheres_and_boxes(test::RandomNumbers& numbers, std::size_t count) {
    std::vector<shared::Probe> probes;
    while (probes.size() < count) {
        const vec3 centre = numbers.random_point_in_cube();
        const float size = std::abs(numbers.random_log_uniform_number(-3, -.5f));
        shared::Probe probe = make_sphere_probe(centre, size);
        if (numbers.random_integer_below(3) == 0) {
            probe.radius = 0;
            probe.lowest = centre - size * vec3(1, .5f, 0);
            probe.highest = centre + size * vec3(1, .25f, .1f);
        }
        probes.push_back(probe);
        if (numbers.random_integer_below(8) == 0) probes.push_back(probe);
        if (numbers.random_integer_below(8) == 0)
            probes.push_back(make_sphere_probe(centre, .5f * size));
    }
    return probes;
}

/// Returns rays of several kinds: random rays, rays past a mirror's outline, where rounding
/// decides, rays along an axis, and rays from a mirror.
std::vector<NextMirrorRay> make_rays_among_mirrors(const std::vector<shared::Probe>& probes,
                                                   test::RandomNumbers& numbers,
                                                   std::size_t count) {
    std::vector<NextMirrorRay> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
        NextMirrorRay& ray = rays[i];
        const std::size_t mirror = numbers.random_integer_below(probes.size());
        const shared::Probe& probe = probes[mirror];
        const float size = .5f * (probe.highest.x - probe.lowest.x);
        ray.origin = (i % 2 == 0 ? 1.5f : 100) * numbers.random_point_in_cube();
        ray.direction = numbers.random_unit_direction();
        ray.leaves = static_cast<std::uint32_t>(numbers.random_integer_below(probes.size()));
        ray.end = numbers.random_number_between(0, i % 2 == 0 ? 2 : 200);
        const vec3 aside = normalize(cross(ray.direction, numbers.random_unit_direction()));
        const float nearly = 1 + numbers.random_number_between(-4, 4) * 0x1p-23f;
        if (i % 4 >= 2) // a ray past the outline of a mirror, from far or near
            ray.origin = probe.sphere + size * nearly * aside -
                         numbers.random_number_between(0, i % 8 < 4 ? 2 : 200) * ray.direction;
        if (i % 16 == 15) ray.direction = vec3(i % 3 == 0, i % 3 == 1, i % 3 == 2);
        if (i % 16 == 7)
            ray.origin = probe.sphere + size * aside,
            ray.leaves = static_cast<std::uint32_t>(mirror);
    }
    return rays;
}

TEST(NextMirror, TreeTraversalEqualsATestOfAllMirrors) {
    test::RandomNumbers numbers(14);
    for (const std::size_t count : {1, 2, 9, 30, 200}) {
        const std::vector<shared::Probe> probes = make_spheres_and_boxes(numbers, count);
        const std::vector<NextMirrorRay> rays = make_rays_among_mirrors(probes, numbers, 40000);
        const std::vector<NextMirrorAnswer> all = list_next_mirror_answers(probes, rays, false),
                                            tree = list_next_mirror_answers(probes, rays, true);
        std::size_t different = 0, met = 0, before = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            met += all[i].sphere != 0, before += all[i].before;
            if (all[i] == tree[i] || different++ > 0) continue;
            ADD_FAILURE() << probes.size() << " mirrors, ray " << i << ": one by one sphere "
                          << all[i].sphere << " at " << std::bit_cast<float>(all[i].t)
                          << (all[i].before ? ", one before the end" : "") << "; by the tree "
                          << tree[i].sphere << " at " << std::bit_cast<float>(tree[i].t)
                          << (tree[i].before ? ", one before the end" : "");
        }
        std::cout << "[ MEASURED ] " << probes.size() << " mirrors, " << rays.size()
                  << " rays: " << different << " differ, " << met << " meet a sphere, " << before
                  << " some mirror before their end\n";
        EXPECT_EQ(different, 0u);
        EXPECT_GE(met, count > 1 ? rays.size() / 20 : 0);
        EXPECT_GE(before, count > 1 ? rays.size() / 20 : 0);
    }
}

// Tests twenty equal spheres beside ten other spheres. A ray must meet the nearest sphere. Among
// equal spheres it must meet the sphere with the lowest number, except the sphere on which the ray
// starts.
TEST(NextMirror, LowestNumberWinsAmongEqualSpheres) {
    std::vector<shared::Probe> probes;
    for (int i = 0; i < 10; ++i) probes.push_back(make_sphere_probe({0, float(i - 5), 0}, .25f));
    for (int i = 0; i < 20; ++i) probes.push_back(make_sphere_probe({2, 0, 0}, .5f));
    // The rays of the test: a ray to the equal spheres, the same ray starting on the first of them,
    // a ray to the sixth sphere, the same ray starting on the sixth sphere, and a ray that meets
    // nothing.
    const std::vector<NextMirrorRay> rays{{{6, 0, 0}, 3, {-1, 0, 0}, 0},
                                          {{6, 0, 0}, 9, {-1, 0, 0}, 10},
                                          {{-4, 0, 0}, 3, {1, 0, 0}, 29},
                                          {{-4, 0, 0}, 5, {1, 0, 0}, 5},
                                          {{6, 3, 0}, 9, {1, 0, 0}, 0}};
    const auto met = [](std::uint32_t sphere, float t, std::uint32_t before) {
        return NextMirrorAnswer{sphere, std::bit_cast<std::uint32_t>(t), before, 0};
    };
    const std::vector<NextMirrorAnswer> expected{met(11, 3.5f, 0), met(12, 3.5f, 1),
                                                 met(6, 3.75f, 0), met(11, 5.5f, 0), met(0, 0, 0)};
    for (const bool by_tree : {false, true})
        EXPECT_TRUE(list_next_mirror_answers(probes, rays, by_tree) == expected)
            << (by_tree ? "tree" : "all");
}

} // namespace
