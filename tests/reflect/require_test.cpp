// Tests of the rules in engine/require, which say what a picture needs of captures, against real
// captures.
#include "render/captured.hpp"
#include "require/model.hpp"
#include "scene/built_in.hpp"
#include "scene/pose.hpp"
#include "support/drawn_hall.hpp"
#include "support/rendering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

namespace {

using namespace catoptric;

constexpr std::uint32_t kRequireFaceTexels = 32, kRequireShadowMapEdge = 128;

/// Returns a random hall with one mirror and one moving object.
scene::Scene make_hall_of_seed(std::uint64_t seed) {
    scene::Scene scene = test::make_random_hall(seed, 3);
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    for (const std::size_t other : {mirrors[1], mirrors[2]}) scene.objects[other].material = 0;
    test::RandomNumbers numbers(seed + 500);
    scene.objects[mirrors[1 + numbers.random_integer_below(2)]].motion = scene::HarmonicMotion{
        .amplitude = dvec3(numbers.random_unit_direction()), .period = 2};
    const dvec3 centre = scene::bounds(scene, scene.objects[mirrors[0]]).centre();
    scene.cameras[0] = {.eye = centre + 2. * dvec3(numbers.random_unit_direction()),
                        .target = centre};
    return scene;
}

/// Returns the colours and distances of a face as bytes.
std::vector<std::byte> capture_face_bytes(const render::CapturedCubes& captured, std::size_t face) {
    std::vector<std::byte> bytes;
    for (const auto& all : {captured.colour_bytes, captured.distance_bytes}) {
        const std::size_t one = all.size() / 6;
        const auto part = std::span(all).subspan(face * one, one);
        bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return bytes;
}

TEST(Require, FacesWithTheSameContentHashKeepTheirBytes) {
    int stays = 0, changes = 0;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        const scene::Scene scene = make_hall_of_seed(seed);
        require::WorkModelBuilder requirements(scene);
        session::Session session(test::get_test_engine(), scene);
        session::FrameSpec frame_spec{
            .techniques = {"parallax:face=" + std::to_string(kRequireFaceTexels) +
                           ",shadow_map=" + std::to_string(kRequireShadowMapEdge)},
            .camera = scene.cameras[0],
            .size = {16, 16}};
        const auto at = [&](double seconds) {
            frame_spec.time = seconds;
            const scene::Scene now = scene::scene_at(scene, seconds);
            const require::WorkModel model = requirements.model(
                {now, frame_spec.camera, frame_spec.size, kRequireShadowMapEdge});
            return std::pair(model.mirrors[0],
                             session::Access::read_captures(session::Access::render_frame(
                                 session, frame_spec, {.with_captures = true})));
        };
        const auto [needs, captured] = at(.2);
        const auto [needs_later, captured_later] = at(.5);
        if (!needs.is_captured) continue;
        for (std::size_t face = 0; face < 6; ++face) {
            const bool is_kept = needs.content_hashes[face] == needs_later.content_hashes[face];
            const bool is_same = capture_face_bytes(captured, face) ==
                                 capture_face_bytes(captured_later, face);
            EXPECT_TRUE(is_same || !is_kept) << "seed " << seed << ", face " << face;
            stays += is_kept ? 1 : 0, changes += is_same ? 0 : 1;
        }
    }
    EXPECT_GT(stays, 20);
    EXPECT_GT(changes, 20);
    RecordProperty("kept", stays), RecordProperty("changed", changes);
}

/// Returns the cube face that a direction points to.
std::size_t cube_face_of_direction(const vec3& direction) {
    const vec3 size = abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return static_cast<std::size_t>(2 * axis + (direction[axis] < 0 ? 1 : 0));
}

TEST(Require, MirrorsReadNoFaceThatIsLeftOut) {
    std::size_t looked = 0, left_out = 0;
    for (const scene::Scene& scene :
         {scene::make_flat_room(), scene::make_furnished_room(), scene::make_gallery()}) {
        session::Session session(test::get_test_engine(), scene);
        for (const scene::Camera& camera : scene.cameras) {
            if (&camera != &scene.cameras.front() && scene.name == "gallery")
                continue; // skip the other cameras, because the gallery takes long
            const scene::Camera now = scene::camera_at(camera, 0);
            const scene::Scene at_rest = scene::scene_at(scene, 0);
            const require::WorkModel model = require::make_required_model({at_rest, now, {64, 48}});
            for (const require::MirrorRequirements& needs : model.mirrors)
                left_out += needs.faces != require::kAllFaces ? 1 : 0;
            for (const char* technique :
                 {"parallax:face=32", "secant:face=32", "pyramid:face=32"}) {
                SCOPED_TRACE(scene.name + " " + camera.name + " " + technique);
                session::FrameSpec frame_spec{
                    .techniques = {technique}, .camera = camera, .size = {64, 48}};
                frame_spec.with_lookup = true;
                for (const vec4& lookup : session.frame(frame_spec).read().lookup) {
                    if (!(lookup.w > 0)) continue;
                    const auto mirror = static_cast<std::size_t>((lookup.w - 1) / 8);
                    ASSERT_LT(mirror, model.mirrors.size());
                    EXPECT_TRUE(model.mirrors[mirror].is_captured);
                    EXPECT_NE(
                        model.mirrors[mirror].faces >> cube_face_of_direction(vec3(lookup)) & 1, 0);
                    ++looked;
                }
            }
        }
    }
    EXPECT_GT(looked, 3000u);
    EXPECT_GE(left_out, 5u);
    RecordProperty("looked", static_cast<int>(looked));
}

} // namespace
