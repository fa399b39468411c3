// Tests that GLSL reads from texel lists the same structures that C++ wrote, member by member.
#include "render/texels.hpp"
#include "support/device.hpp"

#include <cstring>

namespace {

using namespace catoptric;

/// Returns a structure whose words are all different. Read as floats, the words are ordinary
/// numbers near 1.
template <typename T>
T make_struct_of_distinct_words(std::uint32_t& next) {
    std::array<std::uint32_t, sizeof(T) / 4> words{};
    for (std::uint32_t& word : words) word = 0x3f800000u + next++;
    T value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return value;
}

template <typename T>
void append_words_of(const T& value, std::vector<std::uint32_t>& words) {
    const std::size_t before = words.size();
    words.resize(before + sizeof value / 4);
    std::memcpy(&words[before], &value, sizeof value);
}

TEST(Texels, EveryMemberOfAStructureIsRead) {
    constexpr std::uint32_t kAskedStructCount = 2;
    std::uint32_t next = 0;
    std::vector<shared::Surface> surfaces;
    std::vector<shared::Probe> probes;
    std::vector<shared::MaterialParameters> details;
    std::vector<shared::VertexAttribute> attributes;
    std::vector<std::uint32_t> texels;
    for (std::uint32_t i = 0; i < kAskedStructCount + 2; ++i) {
        surfaces.push_back(make_struct_of_distinct_words<shared::Surface>(next));
        surfaces.back().mirror = 1000 + i, surfaces.back().detail = 2000 + i;
        probes.push_back(make_struct_of_distinct_words<shared::Probe>(next));
        probes.back().kind = i % 3, probes.back().holds = 1 - i % 2;
        details.push_back(make_struct_of_distinct_words<shared::MaterialParameters>(next));
        // Read as a float, this word is a denormal number, which some devices flush to zero.
        details.back().flags = 1 + i;
        attributes.push_back(make_struct_of_distinct_words<shared::VertexAttribute>(next));
        texels.push_back(0x7fc00001u + i); // read as a float, this is NaN
    }
    std::vector<std::uint32_t> expected;
    append_words_of(surfaces[kAskedStructCount], expected),
        append_words_of(probes[kAskedStructCount], expected);
    append_words_of(details[kAskedStructCount], expected);
    expected.resize(expected.size() - 4 * shared::kQuadsPerMaterial + shared::kWordsPerMaterial);
    append_words_of(attributes[kAskedStructCount], expected);
    append_words_of(texels[kAskedStructCount], expected);

    auto& [device, pipelines] = test::get_test_device();
    gpu::Buffer surface_list, probe_list, detail_list, attribute_list, texture_list;
    using gpu::BufferUsage;
    upload(device, surface_list, "surfaces", render::to_texels(surfaces), BufferUsage::texels);
    upload(device, probe_list, "probes", render::to_texels(probes), BufferUsage::texels);
    upload(device, detail_list, "details", details, BufferUsage::quads);
    upload(device, attribute_list, "attributes", attributes, BufferUsage::texels);
    upload(device, texture_list, "texels", texels, BufferUsage::words);
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    const graph::BufferHandle output = graph.add_buffer({"output", 4 * expected.size()});
    graph.add_pass("texels")
        .writes(output, graph::ResourceUse::storage_write)
        .record([&](graph::PassCommands& commands) {
            commands.bind("surface_texels", surface_list);
            commands.bind("probe_texels", probe_list);
            commands.bind("detail_quads", detail_list);
            commands.bind("attribute_texels", attribute_list);
            commands.bind("texture_words", texture_list);
            commands.bind("Words", output);
            commands.bind_pipeline(gpu::ComputeState{"tests/texels.comp", {}});
            commands.push_constants(kAskedStructCount);
            commands.dispatch(1, 1);
        });
    graph.output(output);
    test::run_graph(runner, graph);
    EXPECT_EQ(test::read_resource_values<std::uint32_t>(runner, output), expected);
}

} // namespace
