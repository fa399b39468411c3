// Tests of device limits. A scene that exceeds a limit is refused by its counts, before anything is
// allocated.
#include "render/geometry.hpp"
#include "render/limits.hpp"
#include "render/material_parameters.hpp"
#include "support/refusal.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

constexpr render::GeometryLimits kGenerousGeometryLimits{1u << 27, 1u << 27, 1u << 30, 1ull << 31};

std::string geometry_limit_error_text(const render::SceneAmounts& amounts,
                                      const render::GeometryLimits& limits) {
    return test::catch_error_text(Failure::exhausted,
                                  [&] { render::check_limits("s", amounts, limits); });
}

TEST(Limits, AmountsCountTrianglesObjectsAndMirrors) {
    const scene::Scene room = test::make_lit_room(2, 1);
    const render::SceneAmounts amounts = render::count_amounts(room);
    EXPECT_EQ(amounts.triangles, scene::triangle_count(room));
    EXPECT_EQ(amounts.objects, 9u);
    EXPECT_EQ(amounts.mirrors, 2u);
    EXPECT_NO_THROW(render::check_limits("s", amounts, kGenerousGeometryLimits));
}

TEST(Limits, AmountsCountTheTexelsOfTheEnvironment) {
    scene::Scene room = test::make_lit_room(0, 1);
    scene::Environment map;
    map.size = {8, 4};
    map.texels.resize(32);
    room.environment = std::make_shared<const scene::Environment>(map);
    render::GeometryLimits limits = kGenerousGeometryLimits;
    const render::SceneAmounts amounts = render::count_amounts(room);
    EXPECT_EQ(amounts.environment_texels, 32u);
    limits.texels = 63;
    EXPECT_NO_THROW(render::check_limits("s", amounts, limits));
    limits.texels = 31;
    render::SceneAmounts few = amounts;
    few.triangles = 2;
    EXPECT_EQ(geometry_limit_error_text(few, limits),
              "scene 's' wants 32 texels of the environment, the device allows 31");
}

TEST(Limits, MoreImageTexelsThanTheLimitAreRefused) {
    scene::Scene room = test::make_lit_room(0, 1);
    const auto image = std::make_shared<const scene::Image>(
        scene::Image{"wood.png", {8, 4}, std::vector<std::uint32_t>(32)});
    room.materials[room.objects.front().material].albedo_texture = scene::Texture{.image = image};
    const render::SceneUnits space = render::make_scene_units(room);
    const render::FrameGeometry geometry = render::make_geometry(
        room, space, render::VertexSpaces::object_space);
    render::DeviceVertices vertices(std::vector<bool>(room.objects.size()), 1);
    vertices.set_geometry(geometry);
    const auto fill = [&](std::uint64_t most) {
        render::MaterialLists(1).fill(room, space, geometry, vertices, most);
    };
    constexpr std::uint64_t kSharedTableTexels = 256 +
                                                 32 * 32; // sRGB in linear light, albedo of lobes
    EXPECT_NO_THROW(fill(kSharedTableTexels + 32));
    EXPECT_EQ(test::catch_error_text(Failure::exhausted, [&] { fill(kSharedTableTexels + 31); }),
              "scene '" + room.name +
                  "': its images up to 'wood.png' take 1312 texels, the device allows 1311");
}

/// Builds a room with `count` balls that share one mesh of 4096 triangles.
scene::Scene make_room_of_ball_copies(int count) {
    scene::Scene scene = test::make_lit_room(0, 1);
    scene.meshes.push_back(scene::ball("ball", 5));
    for (int i = 0; i < count; ++i)
        scene.objects.push_back({.name = "ball", .mesh = scene.meshes.size() - 1, .material = 0});
    return scene;
}

TEST(Limits, CopiesThatShareAMeshCountOnce) {
    const render::SceneAmounts room = render::count_amounts(make_room_of_ball_copies(0)),
                               few = render::count_amounts(make_room_of_ball_copies(65)),
                               many = render::count_amounts(make_room_of_ball_copies(66));
    EXPECT_EQ(few.triangles, room.triangles + 65 * 4096) << "2^18 and one are put where they are";
    EXPECT_EQ(many.triangles, room.triangles + 4096);
    EXPECT_EQ(many.vertices, room.vertices + 2050);
    EXPECT_EQ(many.objects, room.objects + 66);
    // The last ball is so flat that floats cannot transform rays to its object space.
    scene::Scene flattened = make_room_of_ball_copies(66);
    flattened.objects.back().world_from_object = dmat4(1, 0, 0, 0, 1, 1e-3, 0, 0, 0, 0, 1, 0, 0, 0,
                                                       0, 1);
    EXPECT_EQ(render::count_amounts(flattened).triangles, room.triangles + 2 * 4096);
    render::GeometryLimits tight = kGenerousGeometryLimits;
    tight.memory_bytes = 1 << 20;
    EXPECT_NO_THROW(render::check_limits("s", many, tight));
    EXPECT_THROW(render::check_limits("s", few, tight), Error);
}

/// The counts that are checked against limits equal the counts of the stored geometry.
TEST(Limits, AmountsEqualTheStoredGeometry) {
    for (const int count : {0, 3, 65, 66, 80}) {
        const scene::Scene scene = make_room_of_ball_copies(count);
        const render::FrameGeometry geometry = render::make_geometry(
            scene, render::make_scene_units(scene), render::VertexSpaces::object_space);
        const render::SceneAmounts amounts = render::count_amounts(scene);
        EXPECT_EQ(geometry.vertices.size(), amounts.vertices) << count;
        EXPECT_EQ(geometry.indices.size(), 3 * amounts.triangles) << count;
    }
}

TEST(Limits, ErrorsNameWantedAndAllowedAmounts) {
    const render::SceneAmounts one{
        .vertices = 100, .triangles = 100, .objects = 100, .mirrors = 100};
    render::GeometryLimits limits = kGenerousGeometryLimits;
    limits.texels = 299;
    EXPECT_EQ(geometry_limit_error_text(one, limits),
              "scene 's' wants 300 texels of triangles, the device allows 299");
    limits.texels = 399;
    EXPECT_EQ(geometry_limit_error_text(one, limits),
              "scene 's' wants 400 texels of surfaces, the device allows 399");
    limits.texels = 499;
    EXPECT_EQ(geometry_limit_error_text(one, limits),
              "scene 's' wants 500 texels of mirrors, the device allows 499");
    limits = kGenerousGeometryLimits, limits.storage_bytes = 50483;
    EXPECT_EQ(geometry_limit_error_text(one, limits),
              "scene 's' wants 50484 bytes of views, the device allows 50483");
    limits = kGenerousGeometryLimits, limits.piece_bytes = 2399;
    EXPECT_EQ(geometry_limit_error_text(one, limits),
              "scene 's' wants 2400 bytes of vertices, the device allows 2399");
    limits.piece_bytes = 2400;
    EXPECT_EQ(geometry_limit_error_text({.vertices = 100, .triangles = 201}, limits),
              "scene 's' wants 2412 bytes of indices, the device allows 2400");
    limits = kGenerousGeometryLimits, limits.memory_bytes = 14799;
    EXPECT_EQ(geometry_limit_error_text(one, limits),
              "scene 's' wants 14800 bytes, the device allows 14799");
    EXPECT_EQ(geometry_limit_error_text({.mirrors = 32768}, kGenerousGeometryLimits),
              "scene 's' has 32768 mirrors, 32767 are allowed");
    EXPECT_EQ(geometry_limit_error_text({.vertices = 1ull << 32}, kGenerousGeometryLimits),
              "scene 's' wants 4294967296 vertices, the device allows 4294967295");
}

} // namespace
