// Tests of counted work. The counts are compared with independent counts: of the traversal on the
// CPU, of the ray tracer's own ray counters, of masks of pixels, and of the planned frame.
#include "bvh/closest_hit.hpp"
#include "gpu/shader.hpp"
#include "gpu/specialise.hpp"
#include "measure/work.hpp"
#include "render/views.hpp"
#include "scene/light.hpp"
#include "session/access.hpp"
#include "session/rays.hpp"
#include "session/work.hpp"
#include "support/drawn_hall.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kWorkPictureSize{96, 64};
constexpr std::uint64_t kWorkPixelCount = std::uint64_t{kWorkPictureSize.x} * kWorkPictureSize.y;

std::vector<PassWork>
count_work_of_frame(const scene::Scene& scene, const std::string& technique,
                    session::RenderedWork model = session::RenderedWork::everything) {
    session::Request asked = test::make_test_request(scene, {technique}, kWorkPictureSize);
    asked.model = model;
    asked.warmup = technique.starts_with("raytrace") ? 0 : 1; // captures show mirrors from frame 2
    session::Session session(test::get_test_engine(), scene);
    return session::count_frame_work(session, asked);
}

// Which captures a frame draws in turns depends on its number, so a counted frame draws all.
TEST(Work, RowsInTurnsCountAFrameThatDrawsAllCaptures) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    EXPECT_TRUE(count_work_of_frame(scene, "parallax:face=16,shadow_map=16,every=8") ==
                count_work_of_frame(scene, "parallax:face=16,shadow_map=16"));
}

std::uint64_t total_work_of_kind(const std::vector<PassWork>& passes, WorkKind kind) {
    return sum_work(passes)[kind].value_or(0);
}

/// Returns the work of all camera rays, by the traversal on the CPU.
bvh::TraversalCounters count_traversal_work_on_cpu(const scene::Scene& scene) {
    const session::Request asked = test::make_test_request(scene, {"raytrace"}, kWorkPictureSize);
    const render::SceneUnits units = render::make_scene_units(scene);
    const render::FrameGeometry geometry = render::make_geometry(scene, units);
    const bvh::Bvh tree = session::build_bvh_without(geometry, geometry.ranges.size());
    const shared::View view = render::make_camera_view(asked.camera, units, kWorkPictureSize, 0,
                                                       render::geometry_bounds(geometry));
    bvh::TraversalCounters sum;
    for (std::size_t pixel = 0; pixel < kWorkPixelCount; ++pixel) {
        bvh::TraversalCounters one;
        bvh::find_closest_hit<float>(tree, session::make_camera_ray(view, kWorkPictureSize, pixel),
                                     std::numeric_limits<float>::max(),
                                     bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag, &one);
        sum.nodes += one.nodes, sum.triangles += one.triangles;
    }
    return sum;
}

TEST(Work, RaysVisitTheNodesAndTrianglesThatTheTraversalOnTheCpuVisits) {
    // In a scene without lights, every object counts as casting a shadow. The device then has one
    // tree for all triangles, like the CPU.
    for (const char* name : {"cornell-mirrors", "flat"}) {
        scene::Scene scene = scene::load(name);
        for (scene::Material& material : scene.materials)
            material.emission = vec3(0), material.light.reset();
        scene.punctual.clear();
        const auto work = count_work_of_frame(scene, "raytrace:depth=0,shadow=none");
        const bvh::TraversalCounters wanted = count_traversal_work_on_cpu(scene);
        EXPECT_EQ(total_work_of_kind(work, WorkKind::camera_rays), kWorkPixelCount) << name;
        EXPECT_EQ(total_work_of_kind(work, WorkKind::mirror_rays), 0u) << name;
        EXPECT_EQ(total_work_of_kind(work, WorkKind::shadow_rays), 0u) << name;
        // Rounding may differ where the compiler of the shader contracts arithmetic.
        const double slack = 1e-3;
        EXPECT_NEAR(double(total_work_of_kind(work, WorkKind::nodes)), double(wanted.nodes),
                    slack * double(wanted.nodes))
            << name;
        EXPECT_NEAR(double(total_work_of_kind(work, WorkKind::triangles)), double(wanted.triangles),
                    slack * double(wanted.triangles))
            << name;
    }
}

TEST(Work, RaysAreThoseOfTheTracersOwnCounters) {
    const scene::Scene scene = test::make_random_hall(3, 5);
    for (const char* technique : {"raytrace:depth=4", "raytrace:depth=4,first=raster", "hybrid"}) {
        const auto work = count_work_of_frame(scene, technique);
        const int frames = std::string(technique).starts_with("raytrace") ? 1 : 2;
        const session::TechniqueResult drawn = test::render_technique(scene, technique,
                                                                      kWorkPictureSize, frames);
        ASSERT_TRUE(drawn.rays) << technique;
        EXPECT_EQ(total_work_of_kind(work, WorkKind::camera_rays), drawn.rays->primary)
            << technique;
        EXPECT_EQ(total_work_of_kind(work, WorkKind::mirror_rays), drawn.rays->mirror) << technique;
        EXPECT_EQ(total_work_of_kind(work, WorkKind::shadow_rays), drawn.rays->shadow) << technique;
    }
}

TEST(Work, LiveLanesLieBetweenOneAndTheSubgroup) {
    const auto work = count_work_of_frame(scene::load("cornell-mirrors"), "raytrace:depth=4");
    for (const auto& [each, lanes] : {std::pair(WorkKind::nodes, WorkKind::node_lanes),
                                      std::pair(WorkKind::triangles, WorkKind::triangle_lanes)}) {
        const double live = double(total_work_of_kind(work, each)) /
                            double(total_work_of_kind(work, lanes));
        std::cout << "[ MEASURED ] live lanes: " << live << '\n';
        EXPECT_GT(live, 1.5);
        EXPECT_LE(live, 128);
    }
}

TEST(Work, LanesOfLookupsLieBetweenOneAndTheSubgroup) {
    const scene::Scene scene = scene::load("cornell-mirrors");
    for (const char* technique : {"secant", "pyramid", "layered"}) {
        const auto work = count_work_of_frame(scene, technique);
        for (const auto& [each, lanes] :
             {std::pair(WorkKind::distance_lookups, WorkKind::distance_lanes),
              std::pair(WorkKind::colour_lookups, WorkKind::colour_lanes)})
            for (const PassWork& pass : work) {
                // Compute shaders look distances up, too, but count no lanes.
                if (pass.counts[WorkKind::fragments].value_or(0) == 0) continue;
                const std::uint64_t lookups = pass.counts[each].value_or(0),
                                    executed = pass.counts[lanes].value_or(0);
                EXPECT_GE(lookups, executed) << technique << ' ' << pass.name;
                EXPECT_LE(lookups, 128 * executed) << technique << ' ' << pass.name;
            }
        EXPECT_GT(total_work_of_kind(work, WorkKind::colour_lanes), 0u) << technique;
        EXPECT_GT(total_work_of_kind(work, WorkKind::distance_lanes), 0u) << technique;
    }
}

TEST(Work, SearchLanesAreStepsOfSearches) {
    const scene::Scene scene = scene::load("cornell-mirrors");
    for (const char* technique : {"parallax", "raytrace:depth=4"})
        EXPECT_EQ(total_work_of_kind(count_work_of_frame(scene, technique), WorkKind::search_lanes),
                  0u)
            << technique;
    // Each step of the march makes one look-up, and a second one where no surface was captured.
    const auto coarse = count_work_of_frame(scene, "march:steps=4"),
               fine = count_work_of_frame(scene, "march:steps=32");
    const std::uint64_t coarse_steps = total_work_of_kind(coarse, WorkKind::search_lanes),
                        fine_steps = total_work_of_kind(fine, WorkKind::search_lanes);
    EXPECT_GT(coarse_steps, 0u);
    EXPECT_GT(fine_steps, 2 * coarse_steps);
    EXPECT_LE(fine_steps, 8 * coarse_steps);
    EXPECT_GE(total_work_of_kind(fine, WorkKind::distance_lanes), fine_steps);
}

TEST(Work, CountsRepeatToTheLastDigit) {
    const scene::Scene scene = test::make_random_hall(5, 4);
    for (const char* technique : {"parallax", "pyramid", "layered", "hybrid", "raytrace:depth=4",
                                  "raytrace:depth=4,first=raster"})
        EXPECT_EQ(count_work_of_frame(scene, technique, session::RenderedWork::required),
                  count_work_of_frame(scene, technique, session::RenderedWork::required))
            << technique;
}

TEST(Work, CountingChangesNoPixel) {
    const scene::Scene scene = scene::load("cornell-mirrors");
    for (const char* technique : {"parallax", "pyramid", "layered", "hybrid", "raytrace:depth=4",
                                  "raytrace:depth=4,first=raster"}) {
        const session::Request asked = test::make_test_request(scene, {technique},
                                                               kWorkPictureSize);
        session::Session session(test::get_test_engine(), scene);
        const measure::Picture plain = session.frame(asked).hdr();
        session.forget();
        const session::Frame counted = session::Access::render_frame(session, asked,
                                                                     {.counts_work = true});
        EXPECT_FALSE(session::Access::pass_work(counted).empty());
        EXPECT_EQ(counted.hdr().pixels, plain.pixels) << technique;
    }
}

TEST(Work, FrameThatDoesNotCountHasNoWork) {
    const scene::Scene scene = scene::load("flat");
    session::Session session(test::get_test_engine(), scene);
    const session::Frame frame = session.frame(
        test::make_test_request(scene, {"parallax"}, kWorkPictureSize));
    EXPECT_TRUE(session::Access::pass_work(frame).empty());
}

TEST(Work, LookupsFollowFromTheMasks) {
    const scene::Scene scene = scene::load("flat"); // mirrors do not overlap in its view
    const session::TechniqueResult traced = test::render_technique(scene, "raytrace",
                                                                   kWorkPictureSize);
    const measure::Mask mask = measure::mask_mirrors(traced.hits);
    const auto mirror_pixels = static_cast<double>(
        std::ranges::count_if(mask, [](auto in) { return in != 0; }));
    ASSERT_GT(mirror_pixels, 100);
    // Each mirror pixel makes one look-up. Rasterised outlines differ from ray-traced ones by a few
    // pixels.
    EXPECT_NEAR(
        double(total_work_of_kind(count_work_of_frame(scene, "planar"), WorkKind::colour_lookups)),
        mirror_pixels, .05 * mirror_pixels);
    // In a scene with one lamp, each traced point is lit once.
    const auto lit = count_work_of_frame(scene, "raytrace:depth=0,shadow=none");
    EXPECT_LE(total_work_of_kind(lit, WorkKind::lights),
              kWorkPixelCount * scene::list_lights(scene).size());
    EXPECT_GT(total_work_of_kind(lit, WorkKind::lights), kWorkPixelCount / 4);
    // Each step of `march` reads at least one captured distance.
    const auto march = count_work_of_frame(scene, "march"),
               parallax = count_work_of_frame(scene, "parallax");
    EXPECT_GE(double(total_work_of_kind(march, WorkKind::distance_lookups)), 2 * mirror_pixels);
    EXPECT_GE(total_work_of_kind(march, WorkKind::distance_lookups),
              total_work_of_kind(parallax, WorkKind::distance_lookups));
    EXPECT_EQ(total_work_of_kind(count_work_of_frame(scene, "naive:bounces=0,shadow=none"),
                                 WorkKind::shadow_lookups),
              0u);
}

TEST(Work, PassesDrawsAndBytesAreThoseOfThePlan) {
    const scene::Scene scene = scene::load("cornell-mirrors");
    const auto work = count_work_of_frame(scene, "naive:bounces=1");
    session::Session session(test::get_test_engine(), scene);
    const session::Frame frame = session.frame(
        test::make_test_request(scene, {"naive:bounces=1"}, kWorkPictureSize));
    ASSERT_EQ(work.size(), frame.times().passes.size());
    for (std::size_t i = 0; i < work.size(); ++i) {
        EXPECT_EQ(work[i].name, frame.times().passes[i].name);
        EXPECT_EQ(work[i].counts[WorkKind::passes], 1u);
    }
    EXPECT_EQ(total_work_of_kind(work, WorkKind::frames), 1u);
    EXPECT_EQ(total_work_of_kind(work, WorkKind::passes), work.size());
    // The pass `compose` draws one triangle, reads no attachment, and stores 4 bytes a pixel, which
    // are also cleared or loaded.
    const PassWork& compose = work.back();
    EXPECT_EQ(compose.counts[WorkKind::draws], 1u) << compose.name;
    EXPECT_EQ(compose.counts[WorkKind::bytes], 2 * 4 * kWorkPixelCount) << compose.name;
    EXPECT_GE(compose.counts[WorkKind::fragments].value_or(0), kWorkPixelCount);
    // A capture has six faces, and each face draws the objects around the mirror.
    for (const PassWork& pass : work)
        if (pass.name.find("capture") != std::string::npos) {
            EXPECT_GE(pass.counts[WorkKind::draws].value_or(0), 1u) << pass.name;
        }
}

/// Returns whether a shader declares the capability of subgroup operations.
bool has_subgroup_capability(const std::vector<std::uint32_t>& words) {
    constexpr std::uint32_t kCapability = 17, kGroupNonUniform = 61;
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16u)
        if ((words[at] & 0xffffu) == kCapability && words[at + 1] == kGroupNonUniform) return true;
    return false;
}

TEST(Work, SubgroupsAreOnlyInFragmentShadersThatCountLanes) {
    for (const char* name :
         {"reflect/march.frag", "reflect/pyramid.frag", "reflect/layered.frag"}) {
        const gpu::EmbeddedShader& shader = gpu::find_shader(name);
        const auto constants = gpu::reflect_spirv(name, shader.words).constants;
        const auto id_of = [&](const char* constant) {
            return std::ranges::find(constants, constant, &gpu::SpecialisationConstant::name)->id;
        };
        const std::uint32_t count_work = id_of("count_work"), counts_lanes = id_of("counts_lanes");
        EXPECT_TRUE(
            has_subgroup_capability(gpu::specialise_shader(name, shader.words, {{count_work, 1}})))
            << name;
        EXPECT_FALSE(has_subgroup_capability(
            gpu::specialise_shader(name, shader.words, {{count_work, 1}, {counts_lanes, 0}})))
            << name;
        EXPECT_FALSE(has_subgroup_capability(gpu::specialise_shader(name, shader.words, {})))
            << name;
    }
}

TEST(Work, ShadersOfOtherFramesHaveNoCountingCode) {
    for (const char* name : {"reflect/parallax.frag", "reflect/layered.frag", "raytrace.comp",
                             "trace_list.comp", "reflect/pyramid.comp"}) {
        const gpu::EmbeddedShader& shader = gpu::find_shader(name);
        const auto constants = gpu::reflect_spirv(name, shader.words).constants;
        const auto switch_ = std::ranges::find(constants, "count_work",
                                               &gpu::SpecialisationConstant::name);
        ASSERT_NE(switch_, constants.end()) << name;
        const auto has_buffer = [&](std::uint32_t value) {
            const auto words = gpu::specialise_shader(name, shader.words, {{switch_->id, value}});
            const auto bindings = gpu::reflect_spirv(name, words).bindings;
            return std::ranges::count(bindings, "WorkBuffer", &gpu::ShaderBinding::name) > 0;
        };
        EXPECT_FALSE(has_buffer(0)) << name;
        if (std::string(name) != "trace_list.comp") {
            EXPECT_TRUE(has_buffer(1)) << name;
        }
    }
}

} // namespace
