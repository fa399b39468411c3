// Tests of the GGX lobe and of random numbers on the device. The shader must compute the same
// values as the same code in C++.
#include "core/shader_math.hpp"
#include "support/device.hpp"
#include "support/numbers.hpp"

#include <cmath>

namespace {

using namespace catoptric;

struct LobeAnswer {
    vec3 to_light{0};
    float weight = 0, density = 0, lobe = 0, u = 0, v = 0;
};
static_assert(sizeof(LobeAnswer) == 32);

std::vector<vec4> make_random_lobe_inputs(std::size_t count) {
    test::RandomNumbers numbers(11);
    std::vector<vec4> asked;
    while (asked.size() < count) {
        vec3 to_eye = numbers.random_unit_direction();
        to_eye.z = std::abs(to_eye.z);
        const float roughness = asked.size() % 10 == 0 ? 0 : numbers.random_number_between(.02f, 1);
        if (to_eye.z > 1e-3f) asked.emplace_back(to_eye, roughness);
    }
    return asked;
}

std::vector<LobeAnswer> evaluate_lobes_on_device(const std::vector<vec4>& asked) {
    auto& [device, pipelines] = test::get_test_device();
    gpu::Buffer input;
    upload(device, input, "asked", asked, gpu::BufferUsage::plain);
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    const graph::BufferHandle out = graph.add_buffer(
        {"answers", asked.size() * sizeof(LobeAnswer)});
    graph.add_pass("lobe")
        .writes(out, graph::ResourceUse::storage_write)
        .record([&](graph::PassCommands& commands) {
            commands.bind("Asked", input);
            commands.bind("Answers", out);
            commands.bind_pipeline(gpu::ComputeState{"tests/lobe.comp", {}});
            commands.push_constants(static_cast<std::uint32_t>(asked.size()));
            commands.dispatch(static_cast<std::uint32_t>((asked.size() + 63) / 64), 1);
        });
    graph.output(out);
    test::run_graph(runner, graph);
    return test::read_resource_values<LobeAnswer>(runner, out);
}

TEST(Lobe, DeviceGivesWhatTheSameCodeGivesInCpp) {
    const std::vector<vec4> asked = make_random_lobe_inputs(4096);
    const std::vector<LobeAnswer> found = evaluate_lobes_on_device(asked);
    for (std::uint32_t i = 0; i < asked.size(); ++i) {
        const vec3 to_eye(asked[i]), white(1), half(.5f);
        float u, v;
        f32::sample_pattern_point(i % 97, i, i % 5, 7, u, v);
        // Random numbers are computed with integers only, so device and C++ must agree exactly.
        ASSERT_EQ(found[i].u, u) << i;
        ASSERT_EQ(found[i].v, v) << i;
        const float alpha = f32::roughness_to_alpha(asked[i].w);
        const vec3 wanted = f32::sample_lobe(alpha, to_eye, u, v);
        EXPECT_LT(length(found[i].to_light - wanted), 2e-4f) << i << " roughness " << asked[i].w;
        // The test evaluates the C++ functions at the direction that the device drew, so that only
        // their own rounding errors count.
        const vec3 to_light = found[i].to_light;
        const auto near = [](float a, float b) {
            return std::abs(a - b) <= 2e-3f * std::abs(b) + 1e-6f;
        };
        EXPECT_TRUE(
            near(found[i].weight, f32::lobe_sample_weight(alpha, half, white, to_eye, to_light).x))
            << i;
        if (asked[i].w < .1f)
            continue; // in a narrow lobe, rounding errors of the direction change the density by
                      // large factors
        EXPECT_TRUE(near(found[i].density, f32::lobe_pdf(alpha, to_eye, to_light))) << i;
        EXPECT_TRUE(near(found[i].lobe, f32::evaluate_lobe(alpha, half, white, to_eye, to_light).x))
            << i;
    }
}

} // namespace
