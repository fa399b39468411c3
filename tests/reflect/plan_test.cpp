// Tests of plans, in which each mirror is drawn by its own technique. Each mirror's pixels must
// equal those of a frame in which one technique draws all mirrors.
#include "core/mirror_id.hpp"
#include "measure/lookup.hpp"
#include "scene/built_in.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

/// Counts of the pixels of one mirror that show no other mirror: compared pixels, pixels with other
/// bytes, and pixels that are off.
struct SamePixelCounts {
    std::size_t compared = 0, other = 0, off = 0; ///< off: a channel differs by more than 1/255
};

bool do_channels_differ(const vec3& a, const vec3& b) {
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(std::clamp(a[i], 0.f, 1.f) - std::clamp(b[i], 0.f, 1.f)) <= 1.f / 255))
            return true;
    return false;
}

/// Returns whether the direction from the capture's centre may show a ball other than `mirror`,
/// with a margin of 1.5 texels. Ignores objects that hide the ball. Mirrors are numbered from 0.
bool may_capture_show_ball(const scene::Scene& scene, std::size_t mirror, const dvec3& direction,
                           int face) {
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    const dvec3 centre = scene::bounds(scene, scene.objects[mirrors[mirror]]).centre();
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        if (i == mirror) continue;
        const scene::Sphere& ball = *scene.objects[mirrors[i]].sphere;
        const dvec3 to_ball = ball.centre - centre;
        const double reach = std::asin(ball.radius / glm::length(to_ball)) + 1.5 * 2.0 / face;
        if (glm::dot(glm::normalize(to_ball), direction) > std::cos(reach)) return true;
    }
    return false;
}

/// Compares the pixels of one mirror in a plan (`mixed`) with those of one technique (`uniform`).
/// Leaves out the pixels that may show another mirror.
SamePixelCounts compare_mirror_of_plan(const scene::Scene& scene,
                                       const session::TechniqueResult& mixed,
                                       const session::TechniqueResult& uniform,
                                       const session::TechniqueResult& truth, MirrorId mirror,
                                       int face) {
    SamePixelCounts result;
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        if (measure::first_mirror(truth.hits[i]) != mirror) continue;
        if (measure::second_mirror(truth.hits[i]) != MirrorId{}) continue;
        if (!uniform.lookup.empty()) {
            const vec4& lookup = uniform.lookup[i];
            const int looked_into = static_cast<int>(lookup.w) / 8;
            if (lookup.w == 0 || looked_into != static_cast<int>(mirror.index())) continue;
            if (may_capture_show_ball(scene, mirror.index(), dvec3(lookup), face)) continue;
        }
        ++result.compared;
        const vec3 &a = mixed.hdr.pixels[i], &b = uniform.hdr.pixels[i];
        if (std::memcmp(&a, &b, sizeof a) != 0) ++result.other;
        if (do_channels_differ(a, b)) ++result.off;
    }
    return result;
}

TEST(Plan, EachMirrorEqualsAFrameOfItsOwnTechnique) {
    constexpr uvec2 kPlanPictureSize{192, 192};
    // Two frames are enough, because pixels with deeper bounces are left out.
    constexpr int kFramesUntilFirstOrder = 2;
    const scene::Scene scene = scene::make_cornell();
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace",
                                                                  kPlanPictureSize);
    session::Request asked = test::make_test_request(
        scene, {"1=reuse:face=64 2=hybrid 3=secant *=raytrace:shadow=map"}, kPlanPictureSize);
    asked.warmup = kFramesUntilFirstOrder - 1;
    const session::TechniqueResult mixed = std::move(
        session::run(test::get_test_engine(), asked).parts.front());
    // Mirror 4 is ray traced. It has a capture nevertheless, because the captures of other mirrors
    // show mirror 4.
    EXPECT_EQ(mixed.scene_passes, 4 + 2);
    const std::vector<std::string> uniform{"reuse:face=64", "hybrid", "secant",
                                           "raytrace:shadow=map"};
    for (std::size_t i = 0; i < uniform.size(); ++i) {
        const bool is_traced = i == 3;
        asked.techniques = {uniform[i]};
        asked.with_lookup = !is_traced;
        const session::TechniqueResult part = std::move(
            session::run(test::get_test_engine(), asked).parts.front());
        const SamePixelCounts found = compare_mirror_of_plan(
            scene, mixed, part, truth, MirrorId::from_index(i), i == 0 ? 64 : 256);
        std::cout << "[ MEASURED ] " << uniform[i] << ": of " << found.compared << " pixels "
                  << found.other << " differ, " << found.off << " by more than 1/255\n";
        EXPECT_GT(found.compared, 100u) << uniform[i];
        EXPECT_LE(found.off, 3u) << uniform[i] << " of " << found.compared;
        if (!is_traced) {
            EXPECT_LE(found.other, 3u) << uniform[i] << " of " << found.compared;
        }
    }
}

/// Returns three balls in a row with boards between them. Each board hides the balls from each
/// other by more than a ball's radius, the tolerance of the searches (shaders/lib/mirror.glsl).
scene::Scene make_balls_between_boards() {
    scene::Scene scene = test::make_lit_room(0, 2);
    scene.name = "walled off";
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    const std::size_t white = add_material(scene, {.name = "board", .albedo = {.6f, .5f, .4f}});
    const std::array<double, 3> places{-1.3, 0, 1.3};
    for (std::size_t i = 0; i < places.size(); ++i)
        test::add_ball(scene, "ball" + std::to_string(i + 1), mirror, {places[i], -.4, .6}, .25);
    for (const double x : {-.65, .65})
        test::add_quad(scene, "board", white, {x, -2, -.8}, {x, -2, 2}, {x, 2, 2}, {x, 2, -.8});
    scene.cameras.front().target = {0, -.4, .6};
    scene.cameras.front().vertical_fov_degrees = 20;
    return scene;
}

TEST(Plan, MirrorsThatDoNotSeeEachOtherKeepTheirBytes) {
    constexpr uvec2 kPlanPictureSize{256, 96};
    const scene::Scene scene = make_balls_between_boards();
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace",
                                                                  kPlanPictureSize);
    session::Request asked = test::make_test_request(scene, {}, kPlanPictureSize);
    asked.warmup = 1;
    asked.with_lookup = true;
    const auto rendered = [&](const std::string& technique) {
        asked.techniques = {technique};
        return std::move(session::run(test::get_test_engine(), asked).parts.front());
    };
    for (const std::vector<std::string>& rows :
         {std::vector<std::string>{"reuse:face=32", "secant:face=64", "pyramid:face=48"},
          {"march:face=40", "layered:face=32", "proxy:face=64,distance=unorm8"},
          {"naive:bounces=2,face=64", "parallax:face=64,distance=r16f",
           "reuse:shadow=none,face=48"},
          {"parallax:shadow_map=256,face=48",
           test::has_float_colour() ? "march:colour=float,face=56" : "march:face=56",
           "pyramid:captures=all,face=64"}}) {
        const session::TechniqueResult mixed = rendered("1=" + rows[0] + " 2=" + rows[1] +
                                                        " *=" + rows[2]);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const session::TechniqueResult uniform = rendered(rows[i]);
            std::size_t pixels = 0, other = 0;
            for (std::size_t p = 0; p < truth.hits.size(); ++p) {
                // Compare only pixels in which both ray tracing and rasterisation show the mirror.
                if (measure::first_mirror(truth.hits[p]) != MirrorId::from_index(i)) continue;
                if (uniform.lookup[p].w == 0) continue;
                ++pixels;
                other += mixed.hdr.pixels[p] != uniform.hdr.pixels[p];
            }
            EXPECT_GT(pixels, 300u);
            EXPECT_EQ(other, 0u) << rows[i] << " of " << pixels << " pixels";
        }
    }
}

/// The scene has a sky and textures, so its shaders use four uniform buffers, the largest number.
TEST(Plan, CapturesOfTwoEdgesWorkUnderASky) {
    const scene::Scene scene = scene::load("courtyard");
    const uvec2 size{48, 48};
    const session::TechniqueResult mixed = test::render_technique(
        scene, "1=parallax:face=32,shadow_map=256 *=parallax:face=16,shadow_map=256", size, 2);
    const session::TechniqueResult alike = test::render_technique(
        scene, "parallax:face=32,shadow_map=256", size, 2);
    const session::TechniqueResult traced = test::render_technique(scene, "raytrace:depth=1", size);
    // Numbers of pixels of no mirror, of mirror 1 and of other mirrors.
    std::array<std::size_t, 3> same{}, other{};
    for (std::size_t i = 0; i < traced.hits.size(); ++i) {
        const std::size_t mirror = std::min(traced.hits[i] & 0xffff, 2u);
        ++(mixed.hdr.pixels[i] == alike.hdr.pixels[i] ? same : other)[mirror];
    }
    EXPECT_EQ(test::count_nonfinite(mixed.hdr), 0u);
    EXPECT_LE(other[0], same[0] / 20) << "outlines, of which rays and triangles may differ";
    EXPECT_GT(same[1], 4 * other[1]) << "all but what it shows of other mirrors";
    EXPECT_GT(other[2], same[2]) << "their captures are coarser";
}

TEST(Plan, PlanOfOneTechniqueEqualsThatTechnique) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    for (const std::string technique : {"hybrid", "naive:bounces=2", "raytrace:shadow=map"}) {
        const session::TechniqueResult alone = test::render_technique(scene, technique, {64, 48},
                                                                      2),
                                       plan = test::render_technique(
                                           scene, "2=" + technique + " *=" + technique, {64, 48},
                                           2);
        EXPECT_TRUE(test::have_equal_pixel_bytes(alone.hdr, plan.hdr)) << technique;
        EXPECT_EQ(alone.scene_passes, plan.scene_passes) << technique;
        EXPECT_EQ(alone.hits, plan.hits) << technique;
    }
}

TEST(Plan, MirrorWithoutACaptureIsBlackInOtherMirrors) {
    const scene::Scene scene = test::make_mirror_hall();
    const uvec2 size{96, 72};
    const session::TechniqueResult shown = test::render_technique(
                                       scene, "1=secant:face=64 *=raytrace", size, 3),
                                   black = test::render_technique(
                                       scene, "1=secant:face=64 *=raytrace:capture=none", size, 3),
                                   truth = test::render_technique(scene, "raytrace", size);
    EXPECT_EQ(shown.scene_passes, black.scene_passes + 2) << "two captures less";
    std::size_t dark = 0, lit = 0;
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        if (measure::first_mirror(truth.hits[i]) != MirrorId(1)) {
            EXPECT_EQ(shown.hdr.pixels[i], black.hdr.pixels[i]);
            continue;
        }
        if (measure::second_mirror(truth.hits[i]) == MirrorId{}) continue;
        dark += black.hdr.pixels[i] == vec3(0);
        lit += shown.hdr.pixels[i] != vec3(0);
    }
    EXPECT_GT(dark, 20u);
    EXPECT_GT(lit, 20u);
}

TEST(Plan, PlanOfTracedMirrorsDrawsNoCaptures) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    const uvec2 size{96, 72};
    const session::TechniqueResult mixed = test::render_technique(
        scene,
        "1=raytrace:depth=1,shadow=map 2=raytrace:depth=3,shadow=map "
        "*=raytrace:depth=8,shadow=map,samples=4",
        size);
    EXPECT_EQ(mixed.scene_passes, 2); // scene passes: the shadow map and the view
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace", size);
    for (const auto& [mirror, technique] : {std::pair{1u, "raytrace:depth=1,shadow=map"},
                                            {2u, "raytrace:depth=3,shadow=map"},
                                            {3u, "raytrace:depth=8,shadow=map,samples=4"}}) {
        const session::TechniqueResult alone = test::render_technique(scene, technique, size);
        std::size_t pixels = 0, off = 0;
        for (std::size_t i = 0; i < truth.hits.size(); ++i) {
            if (measure::first_mirror(truth.hits[i]) != MirrorId(mirror)) continue;
            ++pixels;
            off += do_channels_differ(mixed.hdr.pixels[i], alone.hdr.pixels[i]);
        }
        EXPECT_GT(pixels, 100u);
        EXPECT_LE(off, 3u) << technique << " of " << pixels;
    }
    ASSERT_TRUE(mixed.rays && mixed.traced_fraction);
    EXPECT_EQ(*mixed.traced_fraction, 1);
}

/// Returns a room with `count` small exact balls. With 350 balls, one image array cannot hold all
/// captures.
scene::Scene make_room_of_many_balls(int count) {
    scene::Scene scene = test::make_lit_room(0, 1);
    scene.name = "many balls";
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    for (int i = 0; i < count; ++i)
        test::add_ball(scene, "ball" + std::to_string(i + 1), mirror,
                       {-1.6 + .16 * (i % 21), -1.7 + .18 * (i / 21 % 18), .4 + .3 * (i % 3)}, .06,
                       0);
    return scene;
}

TEST(Plan, CapturesOfManyMirrorsUseSeveralArrays) {
    const scene::Scene scene = make_room_of_many_balls(350);
    const uvec2 size{64, 64};
    const std::vector<std::string> techniques{"parallax:face=4"};
    const session::TechniqueResult part = test::render_technique(scene, techniques.front(), size,
                                                                 1);
    EXPECT_EQ(part.scene_passes, 350 + 2);
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace:depth=1", size);
    // Compare with a scene without the first ten mirrors, whose captures fit into one array. In a
    // first frame, captures show mirrors black. The pictures may therefore differ only where the
    // removed mirrors were seen.
    scene::Scene fewer = scene;
    const std::size_t first = scene::mirrors(scene).front();
    const auto begin = fewer.objects.begin() + static_cast<std::ptrdiff_t>(first);
    fewer.objects.erase(begin, begin + 10);
    const session::TechniqueResult alone = test::render_technique(fewer, techniques.front(), size,
                                                                  1);
    std::size_t pixels = 0, other = 0;
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        const MirrorId mirror = measure::first_mirror(truth.hits[i]);
        if (mirror.number() <= 100) continue; // compare only mirrors far from the removed ones
        ++pixels;
        other += do_channels_differ(part.hdr.pixels[i], alone.hdr.pixels[i]);
    }
    EXPECT_GT(pixels, 100u);
    EXPECT_LT(static_cast<double>(other), .02 * static_cast<double>(pixels)) << other;
}

TEST(Plan, TooManyCaptureEdgesAreEnlargedWithANote) {
    const scene::Scene scene = make_room_of_many_balls(10);
    std::string plan;
    for (int i = 1; i <= 10; ++i)
        plan += std::to_string(i) + "=reuse:face=" + std::to_string(8 + i) + " ";
    const session::TechniqueResult part = test::render_technique(scene, plan, {32, 32});
    ASSERT_EQ(part.notes.size(), 2u);
    EXPECT_EQ(
        part.notes[0],
        "1 mirror is captured with 10 texels an edge instead of 9: a frame has at most 8 arrays "
        "of captures");
    EXPECT_EQ(
        part.notes[1],
        "1 mirror is captured with 12 texels an edge instead of 11: a frame has at most 8 arrays "
        "of captures");
    EXPECT_EQ(part.scene_passes, 12);
    test::expect_error(
        [&] {
            std::string kinds;
            for (int i = 1; i <= 10; ++i)
                kinds += std::to_string(i) +
                         "=parallax:face=8,distance=unorm8,range=" + std::to_string(i) + " ";
            test::render_technique(scene, kinds, {32, 32});
        },
        Failure::exhausted, {"10 arrays", "a frame has at most 8 arrays"});
}

TEST(Plan, PlanThatDoesNotFitTheSceneIsRefused) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    const auto refused = [&](const std::string& plan, const std::vector<std::string>& words) {
        test::expect_error(
            [&] {
                test::render_technique(scene, plan, {16, 16});
            },
            Failure::usage, words);
    };
    refused("1=reuse 2=secant", {"no rule for mirror 3 'ball3'", "'*=TECHNIQUE'"});
    refused("4=reuse *=secant", {"pattern '4' matches no mirror", "3 mirrors", "2 'ball2'"});
    refused("bal1=reuse *=secant", {"pattern 'bal1'", "did you mean 'ball1'"});
}

} // namespace
