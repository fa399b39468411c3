// Tests of reflection: which bindings, constants and images the engine reads from SPIR-V, and which
// errors name the shader.
#include "gpu/shader.hpp"
#include "gpu/specialise.hpp"
#include "session/access.hpp"
#include "support/device.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include <spirv-tools/libspirv.hpp>

namespace {

using namespace catoptric;
using gpu::BindingKind;
using gpu::ImageViewType;

gpu::ShaderReflection reflect_shader(const char* name) {
    return gpu::reflect_spirv(name, gpu::find_shader(name).words);
}

/// Returns what the shader uses if its constants have these values, and all others their defaults.
gpu::ShaderReflection
reflect_specialised_shader(const char* shader,
                           const std::map<std::string, std::uint32_t>& constants) {
    const gpu::ShaderReflection all = reflect_shader(shader);
    std::map<std::uint32_t, std::uint32_t> values;
    for (const auto& [name, value] : constants) {
        const auto constant = std::ranges::find(all.constants, name,
                                                &gpu::SpecialisationConstant::name);
        if (constant == all.constants.end()) ADD_FAILURE() << shader << " has no constant " << name;
        if (constant != all.constants.end()) values[constant->id] = value;
    }
    return gpu::reflect_spirv(
        shader, gpu::specialise_shader(shader, gpu::find_shader(shader).words, values));
}

const gpu::ShaderBinding* find_binding(const gpu::ShaderReflection& reflection,
                                       std::string_view name) {
    const auto found = std::ranges::find(reflection.bindings, name, &gpu::ShaderBinding::name);
    return found == reflection.bindings.end() ? nullptr : &*found;
}

std::vector<std::string> list_constant_texts(const gpu::ShaderReflection& reflection) {
    std::vector<std::string> names;
    for (const gpu::SpecialisationConstant& constant : reflection.constants)
        names.push_back(constant.name);
    std::ranges::sort(names);
    return names;
}

TEST(Reflection, BindingsOfTheRayTracerAreFound) {
    const gpu::ShaderReflection found = reflect_shader("raytrace.comp");
    struct ExpectedBinding {
        const char* name;
        std::uint32_t binding;
        BindingKind kind;
    };
    for (const auto& [name, binding, kind] :
         {ExpectedBinding{"frame", 0, BindingKind::uniform_buffer},
          ExpectedBinding{"Views", 1, BindingKind::storage_buffer},
          ExpectedBinding{"bvh_nodes", 9, BindingKind::texel_buffer},
          ExpectedBinding{"picture", 12, BindingKind::storage_image},
          ExpectedBinding{"counters", 14, BindingKind::storage_buffer}}) {
        const gpu::ShaderBinding* one = find_binding(found, name);
        ASSERT_TRUE(one) << name;
        EXPECT_EQ(one->binding, binding) << name;
        EXPECT_EQ(one->kind, kind) << name;
    }
    EXPECT_EQ(list_constant_texts(found), (std::vector<std::string>{"bvh_in_storage",
                                                                    "count_work",
                                                                    "details",
                                                                    "environment_kind",
                                                                    "environment_shadows",
                                                                    "exact_spheres",
                                                                    "first_raster",
                                                                    "fixed_offset",
                                                                    "groups_in_order",
                                                                    "has_blending",
                                                                    "has_clear_coats",
                                                                    "has_glass",
                                                                    "has_lobes",
                                                                    "has_nested_glass",
                                                                    "has_normal_textures",
                                                                    "has_shadow_map",
                                                                    "light_kinds",
                                                                    "light_probe_content",
                                                                    "masks",
                                                                    "max_depth",
                                                                    "object_spaces",
                                                                    "one_light",
                                                                    "orthographic",
                                                                    "pixels_in_rows",
                                                                    "samples_lamps",
                                                                    "shadow",
                                                                    "soft_shadows",
                                                                    "texels_in_storage",
                                                                    "tints_shadows",
                                                                    "traces_lobes",
                                                                    "traces_paths",
                                                                    "without"}));
}

TEST(Reflection, BindingsThatTheCodeDoesNotUseAreLeftOut) {
    const auto uses_shadow_map = [](const char* shader,
                                    const std::map<std::string, std::uint32_t>& constants) {
        return find_binding(reflect_specialised_shader(shader, constants), "shadow_map") != nullptr;
    };
    EXPECT_FALSE(uses_shadow_map("diffuse.frag", {}));
    EXPECT_TRUE(uses_shadow_map("diffuse.frag", {{"has_shadow_map", 1}}));
    EXPECT_FALSE(uses_shadow_map("raytrace.comp", {{"shadow", 2}}));
    EXPECT_TRUE(uses_shadow_map("raytrace.comp", {{"has_shadow_map", 1}, {"shadow", 1}}));
    for (const char* binding : {"shadow_depths", "LampExtents"}) {
        EXPECT_FALSE(find_binding(
            reflect_specialised_shader("diffuse.frag", {{"has_shadow_map", 1}}), binding));
        EXPECT_TRUE(find_binding(reflect_specialised_shader(
                                     "diffuse.frag", {{"has_shadow_map", 1}, {"soft_shadows", 1}}),
                                 binding));
    }
    EXPECT_FALSE(find_binding(
        reflect_specialised_shader("reflect/naive.frag", {{"has_capture_table", 0}}), "Captures"));
    EXPECT_TRUE(find_binding(
        reflect_specialised_shader("reflect/naive.frag", {{"has_capture_table", 1}}), "Captures"));
    EXPECT_FALSE(find_binding(reflect_specialised_shader("reflect/parallax.frag", {{"peels", 0}}),
                              "first_layer"));
    EXPECT_TRUE(find_binding(reflect_specialised_shader("reflect/parallax.frag", {{"peels", 1}}),
                             "first_layer"));
    EXPECT_FALSE(find_binding(reflect_specialised_shader("reflect/naive.frag", {{"rough", 0}}),
                              "distance_cubes"));
    EXPECT_FALSE(find_binding(reflect_specialised_shader("reflect/naive.frag", {{"rough", 0}}),
                              "rough_cubes"));
    EXPECT_FALSE(find_binding(reflect_specialised_shader("reflect/naive.frag", {{"rough", 2}}),
                              "rough_cubes"))
        << "no surface has a lobe";
    EXPECT_TRUE(
        find_binding(reflect_specialised_shader("reflect/naive.frag",
                                                {{"rough", 2}, {"has_lobes", 1}, {"details", 1}}),
                     "rough_cubes"));
}

TEST(Reflection, ShapesOfImagesAreFound) {
    const gpu::ShaderReflection parallax = reflect_shader("reflect/parallax.frag");
    ASSERT_TRUE(find_binding(parallax, "colour_cubes") && find_binding(parallax, "distance_cubes"));
    EXPECT_EQ(find_binding(parallax, "colour_cubes")->shape, ImageViewType::cube_array);
    EXPECT_EQ(find_binding(parallax, "colour_cubes")->kind, BindingKind::texture);
    EXPECT_EQ(find_binding(parallax, "colour_cubes")->count, shared::kMaxCubeArrays);
    ASSERT_TRUE(find_binding(reflect_shader("reflect/planar.frag"), "mirrored"));
    EXPECT_EQ(find_binding(reflect_shader("reflect/planar.frag"), "mirrored")->kind,
              BindingKind::sampled_image);
    const gpu::ShaderReflection diffuse = reflect_shader("diffuse.frag");
    ASSERT_TRUE(find_binding(diffuse, "shadow_map"));
    EXPECT_EQ(find_binding(diffuse, "shadow_map")->shape, ImageViewType::flat_array);
    EXPECT_EQ(reflect_shader("compose.frag").push_bytes, 4u);
}

TEST(Reflection, InvalidShadersAreRefused) {
    test::expect_error([] { gpu::find_shader("no/such.frag"); }, Failure::internal,
                       {"there is no shader 'no/such.frag'"});
    const std::vector<std::uint32_t> text(10, 0x20202020);
    test::expect_error([&] { gpu::reflect_spirv("text", text); }, Failure::internal,
                       {"'text' is not SPIR-V"});
    const auto words = gpu::find_shader("compose.frag").words;
    test::expect_error([&] { gpu::reflect_spirv("half", words.first(6)); }, Failure::internal,
                       {"'half' is cut off"});
}

TEST(Specialise, CodeUnreachableWithTheConstantsIsRemoved) {
    const auto words = gpu::find_shader("raytrace.comp").words;
    // Values of the specialisation constants: all features off, and all on.
    std::map<std::uint32_t, std::uint32_t> plain, rich;
    for (const gpu::SpecialisationConstant& constant : reflect_shader("raytrace.comp").constants)
        plain[constant.id] = 0, rich[constant.id] = 1;
    const auto without = gpu::specialise_shader("raytrace.comp", words, plain),
               with = gpu::specialise_shader("raytrace.comp", words, rich);
    EXPECT_LT(without.size(), with.size());
    EXPECT_LT(3 * without.size(), 2 * words.size());
    const gpu::ShaderReflection left = gpu::reflect_spirv("specialised", without);
    EXPECT_THAT(left.constants, testing::IsEmpty()) << "the driver has nothing to put in";
    EXPECT_TRUE(find_binding(left, "bvh_nodes"));
    test::expect_error(
        [] { gpu::specialise_shader("text", std::vector<std::uint32_t>(10, 0x20202020), {}); },
        Failure::internal, {"shader 'text' cannot be specialised: "});
}

/// A graph of one dispatch into a buffer of 16 words.
void make_and_run_dispatch(
    const gpu::ComputeState& state,
    const std::function<void(graph::PassCommands&, graph::BufferHandle)>& prepare) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::Graph graph;
    const graph::BufferHandle buffer = graph.add_buffer({"counts", 64});
    graph.add_pass("lonely")
        .writes(buffer, graph::ResourceUse::storage_write)
        .record([&](graph::PassCommands& commands) {
            commands.bind_pipeline(state);
            prepare(commands, buffer);
            commands.dispatch(1, 1);
        });
    graph.output(buffer);
    test::run_graph(runner, graph);
}

TEST(Binding, UnboundNameIsRefusedWithPassAndShader) {
    test::expect_error(
        [] {
            make_and_run_dispatch({"tests/spin.comp", {}},
                                  [](graph::PassCommands& commands, graph::BufferHandle) {
                                      commands.push_constants(1u);
                                  });
        },
        Failure::internal, {"pass 'lonely'", "nothing is bound to 'Counts'", "tests/spin.comp"});
}

TEST(Binding, ImageBoundAsABufferIsRefused) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::Graph graph;
    const graph::ImageHandle image = graph.add_image({"image", TexelFormat::r32f, 8, 8});
    graph.add_pass("mixed")
        .writes(image, graph::ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"tests/spin.comp", {}});
            commands.push_constants(1u);
            commands.bind("Counts", image);
            commands.dispatch(1, 1);
        });
    graph.output(image);
    test::expect_error([&] { test::run_graph(runner, graph); }, Failure::internal,
                       {"pass 'mixed'", "'Counts'", "is a buffer, bound is an image"});
}

TEST(Binding, UndeclaredResourceIsRefused) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::Graph graph;
    const graph::BufferHandle declared = graph.add_buffer({"declared", 64}),
                              other = graph.add_buffer({"other", 64});
    graph.add_pass("sly")
        .writes(declared, graph::ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) { commands.bind("Counts", other); });
    graph.output(declared);
    test::expect_error([&] { test::run_graph(runner, graph); }, Failure::internal,
                       {"pass 'sly'", "'other'", "does not declare it"});
}

TEST(Binding, PushConstantsOfAnotherSizeAreRefused) {
    test::expect_error(
        [] {
            make_and_run_dispatch({"tests/spin.comp", {}},
                                  [](graph::PassCommands& commands, graph::BufferHandle buffer) {
                                      commands.bind("Counts", buffer);
                                      commands.push_constants(uvec2(1, 2));
                                  });
        },
        Failure::internal, {"pass 'lonely'", "wants 4 bytes of push constants, got 8"});
}

/// Push constants stay for the pass, so the next pipeline gets them too, if they have its size.
TEST(Binding, PushConstantsOfThePipelineBeforeAreChecked) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    graph::Graph graph;
    const graph::ImageHandle picture = graph.add_image({"picture", TexelFormat::rgba32f, 8, 8});
    const graph::BufferHandle counts = graph.add_buffer({"counts", 1024});
    graph.add_pass("two")
        .writes(picture, graph::ResourceUse::storage_write)
        .writes(counts, graph::ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) {
            commands.bind("picture", picture);
            for (const char* name : {"Counts", "counters", "arguments", "List"})
                commands.bind(name, counts);
            commands.push_constants(1u);
            for (int turn = 0; turn < 2; ++turn) {
                commands.bind_pipeline(gpu::ComputeState{"tests/spin.comp", {}});
                commands.dispatch(1, 1);
            }
            commands.bind_pipeline(gpu::ComputeState{"trace_list.comp#first", {}});
            commands.dispatch(1, 1);
        });
    graph.output(counts);
    test::expect_error(
        [&] { test::run_graph(runner, graph); }, Failure::internal,
        {"pass 'two'", "trace_list.comp#first wants 8 bytes of push constants, got 4"});
}

TEST(Binding, UnknownConstantIsRefused) {
    test::expect_error(
        [] {
            make_and_run_dispatch({"tests/spin.comp", {{"speed", 1u}}},
                                  [](graph::PassCommands&, graph::BufferHandle) {});
        },
        Failure::internal, {"tests/spin.comp", "has no constant 'speed'"});
}

TEST(SpirvReflectionTest, EveryEmbeddedShaderIsValid) {
    spvtools::ValidatorOptions options;
    options.SetScalarBlockLayout(true);
    for (const gpu::EmbeddedShader& shader : gpu::embedded_shaders()) {
        std::string said;
        spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
        tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&,
                                     const char* message) { said += std::string(message) + "\n"; });
        EXPECT_TRUE(tools.Validate(shader.words.data(), shader.words.size(), options))
            << shader.name << ": " << said;
    }
}

} // namespace
