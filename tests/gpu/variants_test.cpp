// Tests of shader variants that a device profile chooses. Each variant must take effect, and none
// may change a byte of a picture.
#include "gpu/variants.hpp"
#include "render/gpu_scene.hpp"
#include "scene/built_in.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using testing::Contains;
using testing::Not;

/// Returns the names of the bindings of the ray tracing shader when it is built with these
/// constants.
std::vector<std::string> list_bindings_with_constants(const gpu::ShaderConstants& constants) {
    std::vector<std::string> names;
    for (const gpu::ShaderBinding& binding :
         test::get_test_device()
             .pipelines.compute_pipeline({"raytrace.comp", {}, constants})
             .bindings)
        names.push_back(binding.name);
    return names;
}

TEST(Variants, EachVariantIsAConstantOfTheRayTracer) {
    std::vector<std::string> known;
    for (const char* build : {"raytrace.comp", "raytrace.comp#listed"})
        for (const gpu::SpecialisationConstant& constant :
             gpu::reflect_spirv(build, gpu::find_shader(build).words).constants)
            known.push_back(constant.name);
    for (const gpu::ShaderVariant& variant : gpu::shader_variants())
        EXPECT_THAT(known, Contains(std::string(variant.constant)));
}

TEST(Variants, UnusedNodeBuffersAreNotBound) {
    const std::vector<std::string> texels = list_bindings_with_constants({}),
                                   stored = list_bindings_with_constants({{"bvh_in_storage", 1u}});
    if (!test::get_test_device().device.texels_in_storage()) {
        EXPECT_THAT(texels, testing::IsSupersetOf({"bvh_nodes", "bvh_triangles"}));
        EXPECT_THAT(texels, Not(Contains("bvh_nodes_in_storage")));
    }
    EXPECT_THAT(stored,
                testing::IsSupersetOf({"bvh_nodes_in_storage", "bvh_triangles_in_storage"}));
    EXPECT_THAT(stored, Not(Contains("bvh_nodes")));
}

/// Returns the linear picture of a technique under some variants.
std::vector<vec3> render_with_variants(const char* technique,
                                       const session::NamedVariants& variants) {
    session::Engine engine(
        {.device = test::read_wanted_device_name(), .validate = true, .variants = variants});
    for (const auto& variant : variants) EXPECT_THAT(engine.device().variants, Contains(variant));
    session::Session session(engine, test::replace_balls_by_coarse_balls(scene::make_cornell()));
    session::Request request = test::make_test_request(scene::make_cornell(), {technique},
                                                       {61, 53});
    // Render a brighter picture first. If a variant leaves out a pixel, the old value stays in
    // memory and the comparison fails.
    request.ambient += .5, request.frames = 3;
    session::run(session, request);
    request.ambient -= .5, request.frames = 1;
    std::vector<vec3> pixels = session::run(session, request).parts.front().hdr.pixels;
    engine.check_validation();
    return pixels;
}
void expect_same_bytes(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)), 0);
}

TEST(Variants, EachVariantRendersTheSameBytes) {
    const std::vector<vec3> wanted = render_with_variants("raytrace:depth=3", {});
    for (const gpu::ShaderVariant& variant : gpu::shader_variants()) {
        SCOPED_TRACE(variant.name);
        expect_same_bytes(
            wanted, render_with_variants("raytrace:depth=3", {{std::string(variant.name),
                                                               std::string(variant.choices[1])}}));
    }
}

/// Tests all variants together in `hybrid`, which traces only a list of pixels.
TEST(Variants, AllVariantsTraceListedPixelsTheSame) {
    session::NamedVariants all;
    for (const gpu::ShaderVariant& variant : gpu::shader_variants())
        all.emplace_back(variant.name, variant.choices[1]);
    expect_same_bytes(render_with_variants("hybrid:face=16", {}),
                      render_with_variants("hybrid:face=16", all));
}

} // namespace
