// Tests that C++ and GLSL agree on the layout of every shared structure. Each member must lie at
// its offsetof, and each structure must be as long as its sizeof. The shader reads the second
// element of an array, so a wrong size shifts every member.
#include "gpu/shader.hpp"
#include "shared.h"
#include "support/device.hpp"

#include <cstddef>

namespace {

using namespace catoptric;
using namespace catoptric::shared;

/// A member of a shared structure: its name, offset and size, and the size of its structure, in
/// bytes.
struct SharedStructMember {
    std::string name;
    std::size_t offset, bytes, size_of_struct;
};
#define MEMBER(type, member)                                                                       \
    SharedStructMember {                                                                           \
#type "::" #member, offsetof(type, member), sizeof(type::member), sizeof(type)             \
    }

/// The members, in the order in which shaders/tests/layout.comp writes them.
const std::vector<SharedStructMember> kSharedStructMembers{MEMBER(Vertex, position),
                                                           MEMBER(Vertex, normal),
                                                           MEMBER(Surface, albedo),
                                                           MEMBER(Surface, emission),
                                                           MEMBER(Surface, reflectance),
                                                           MEMBER(Surface, mirror),
                                                           MEMBER(Surface, detail),
                                                           MEMBER(Surface, centre),
                                                           MEMBER(Surface, radius),
                                                           MEMBER(Light, position),
                                                           MEMBER(Light, normal),
                                                           MEMBER(Light, intensity),
                                                           MEMBER(Light, right),
                                                           MEMBER(Light, down),
                                                           MEMBER(Light, forward),
                                                           MEMBER(Light, near),
                                                           MEMBER(Light, reach),
                                                           MEMBER(Light, cos_outer),
                                                           MEMBER(Light, sharpness),
                                                           MEMBER(Light, kind),
                                                           MEMBER(LampExtent, first),
                                                           MEMBER(LampExtent, second),
                                                           MEMBER(LampExtent, third),
                                                           MEMBER(LampExtent, flat_normal),
                                                           MEMBER(Probe, centre),
                                                           MEMBER(Probe, sphere),
                                                           MEMBER(Probe, radius),
                                                           MEMBER(Probe, reflectance),
                                                           MEMBER(Probe, lowest),
                                                           MEMBER(Probe, highest),
                                                           MEMBER(Probe, kind),
                                                           MEMBER(Probe, holds),
                                                           MEMBER(View, eye),
                                                           MEMBER(View, right),
                                                           MEMBER(View, down),
                                                           MEMBER(View, forward),
                                                           MEMBER(View, near),
                                                           MEMBER(View, eye_low),
                                                           MEMBER(View, parallel),
                                                           MEMBER(View, clip),
                                                           MEMBER(LightProbeGrid, first),
                                                           MEMBER(LightProbeGrid, step),
                                                           MEMBER(LightProbeGrid, counts),
                                                           MEMBER(Sky, size),
                                                           MEMBER(Sky, scale),
                                                           MEMBER(Sky, turn),
                                                           MEMBER(Sky, irradiance),
                                                           MEMBER(Sky, level_first),
                                                           MEMBER(Sky, level_width),
                                                           MEMBER(Sky, cell_first),
                                                           MEMBER(Sky, cell_count),
                                                           MEMBER(Sky, cell_threshold),
                                                           MEMBER(Sky, cell_density),
                                                           MEMBER(Frame, ambient),
                                                           MEMBER(Frame, light_count),
                                                           MEMBER(Frame, mirror_count),
                                                           MEMBER(Frame, object_count),
                                                           MEMBER(Frame, shadow_faces),
                                                           MEMBER(DrawParameters, first_view),
                                                           MEMBER(DrawParameters, ablated),
                                                           MEMBER(DrawParameters, shown),
                                                           MEMBER(Placement, x),
                                                           MEMBER(Placement, y),
                                                           MEMBER(Placement, z),
                                                           MEMBER(Placement, centre),
                                                           MEMBER(Placement, centre_low),
                                                           MEMBER(TraceParameters, sample_offset),
                                                           MEMBER(TraceParameters, sample_index),
                                                           MEMBER(TraceParameters, sample_count),
                                                           MEMBER(TraceParameters, size),
                                                           MEMBER(TraceParameters, seed),
                                                           MEMBER(TraceParameters, path_count),
                                                           MEMBER(TraceParameters, first_group),
                                                           MEMBER(Counters, primary_rays),
                                                           MEMBER(Counters, mirror_rays),
                                                           MEMBER(Counters, shadow_rays),
                                                           MEMBER(Counters, longest_walk),
                                                           MEMBER(Counters, exhausted),
                                                           MEMBER(Counters, mirror_pixels),
                                                           MEMBER(Counters, listed)};

/// Returns word `i` of every input buffer. Read as a float, the word is an ordinary number near 1.
constexpr std::uint32_t layout_input_word(std::size_t i) {
    return 0x3f800000u + static_cast<std::uint32_t>(i);
}

TEST(Layout, EveryMemberOfEveryStructureIsReadAtItsOffset) {
    auto& [device, pipelines] = test::get_test_device();
    constexpr std::size_t kLayoutWordCount = 128;
    std::vector<std::uint32_t> words;
    for (std::size_t i = 0; i < kLayoutWordCount; ++i) words.push_back(layout_input_word(i));
    gpu::Buffer input(device, "input", 4 * kLayoutWordCount, gpu::BufferUsage::plain);
    input.write(std::span<const std::uint32_t>(words));
    std::vector<std::uint32_t> expected;
    std::vector<std::string> names;
    for (const SharedStructMember& member : kSharedStructMembers)
        for (std::size_t i = 0; i < member.bytes / 4; ++i) {
            expected.push_back(layout_input_word((member.size_of_struct + member.offset) / 4 + i));
            names.push_back(member.name);
        }

    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    const graph::BufferHandle output = graph.add_buffer({"output", 4 * expected.size()});
    graph.add_pass("layout")
        .writes(output, graph::ResourceUse::storage_write)
        .record([&](graph::PassCommands& commands) {
            for (const char* name :
                 {"Vertices", "Surfaces", "Lights", "Probes", "Views", "Skies", "Frames", "Draws",
                  "Placements", "Traces", "AllCounters", "Grids", "Extents"})
                commands.bind(name, input);
            commands.bind("Words", output);
            commands.bind_pipeline(gpu::ComputeState{"tests/layout.comp", {}});
            commands.dispatch(1, 1);
        });
    graph.output(output);
    test::run_graph(runner, graph);
    const std::vector<std::uint32_t> found = test::read_resource_values<std::uint32_t>(runner,
                                                                                       output);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], expected[i]) << names[i];
}

TEST(Layout, TestedMembersFillTheirStructures) {
    std::map<std::string, std::size_t> sum, size;
    for (const SharedStructMember& member : kSharedStructMembers) {
        const std::string structure = member.name.substr(0, member.name.find(':'));
        sum[structure] += member.bytes;
        size[structure] = member.size_of_struct;
    }
    EXPECT_EQ(sum, size); // scalar layout has no padding, so the members add up to the structure
    EXPECT_EQ(sum.size(), 13u);
}

TEST(Layout, PushConstantsHaveTheSizeOfTheirStructure) {
    const auto push_bytes = [](const char* shader) {
        return gpu::reflect_spirv(shader, gpu::find_shader(shader).words).push_bytes;
    };
    EXPECT_EQ(push_bytes("scene.vert"), sizeof(DrawParameters));
    EXPECT_EQ(push_bytes("diffuse.frag"), sizeof(DrawParameters));
    EXPECT_EQ(push_bytes("raytrace.comp"), sizeof(TraceParameters));
}

} // namespace
