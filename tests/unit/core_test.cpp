// Tests of the core, the bounds of a scene without objects that lie far outside. Scene units are
// chosen from the core.
#include "bvh/closest_hit.hpp"
#include "core/error.hpp"
#include "render/geometry.hpp"
#include "scene/built_in.hpp"
#include "scene/repair.hpp"
#include "scene/scene_core.hpp"
#include "scene/transform.hpp"
#include "support/numbers.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using scene::core_bounds;

scene::Mesh make_triangle_mesh(const std::string& name, const dvec3& at, double size = 1) {
    return {.name = name,
            .positions = {at, at + dvec3(size, 0, 0), at + dvec3(0, size, 0)},
            .normals = std::vector<vec3>(3, vec3(0, 0, 1)),
            .triangles = {{0, 1, 2}}};
}

scene::Scene make_scene_with_distant_triangle(double distance) {
    scene::Scene scene = scene::make_cornell();
    test::add_mesh(scene, make_triangle_mesh("stray", {distance, 0, distance}), 0);
    return scene;
}

void expect_same_core_bounds(const Bounds<double>& found, const Bounds<double>& wanted) {
    EXPECT_EQ(found.lo, wanted.lo);
    EXPECT_EQ(found.hi, wanted.hi);
}

TEST(Core, CoreIsTheWholeSceneIfNothingIsFarOutside) {
    for (const scene::Scene& scene :
         {scene::make_cornell(), test::make_lit_room(3, 2), test::make_furnace_scene(1),
          make_scene_with_distant_triangle(1500)})
        expect_same_core_bounds(core_bounds(scene), scene::bounds(scene));
    EXPECT_TRUE(core_bounds({}).empty());
}

TEST(Core, CoreLeavesOutObjectsFarOutside) {
    const Bounds<double> room = scene::bounds(scene::make_cornell());
    for (const double distance : {1e4, 1e6, 1e9, 1e30})
        expect_same_core_bounds(core_bounds(make_scene_with_distant_triangle(distance)), room);
    scene::Scene many = make_scene_with_distant_triangle(1e5);
    for (int i = 0; i < 3; ++i)
        test::add_mesh(many, make_triangle_mesh("more", dvec3(0, 1e7 * (i + 1), 0), 1e5), 0);
    expect_same_core_bounds(core_bounds(many), room);
}

TEST(Core, CoreLeavesOutAFarTriangleOfTheOnlyMesh) {
    scene::Scene one{.name = "one mesh"};
    test::add_material(one, {.name = "grey"});
    scene::Mesh mesh = scene::ball("everything", 3);
    const Bounds<double> core = [&] {
        scene::Scene alone = one;
        test::add_mesh(alone, mesh, 0);
        return scene::bounds(alone);
    }();
    for (const auto& corner : make_triangle_mesh("", {1e6, 0, 0}).positions)
        mesh.positions.push_back(corner);
    mesh.normals.resize(mesh.positions.size(), vec3(0, 0, 1));
    const auto last = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.triangles.push_back({last - 3, last - 2, last - 1});
    test::add_mesh(one, mesh, 0);
    const Bounds<double> found = core_bounds(one);
    // The core is found from a sample of corners, so the test allows a tolerance.
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(found.lo[axis], core.lo[axis], .1);
        EXPECT_NEAR(found.hi[axis], core.hi[axis], .1);
    }
}

TEST(Core, CoreLeavesOutADistantSkyOfManyTriangles) {
    scene::Scene scene = test::make_lit_room(3, 1);
    const Bounds<double> room = scene::bounds(scene);
    scene::Mesh sky = scene::ball("sky", 6);
    for (dvec3& position : sky.positions) position = 1e6 * position + dvec3(3e5, 0, 0);
    test::add_mesh(scene, sky, 0);
    expect_same_core_bounds(core_bounds(scene), room);
}

TEST(Core, ObjectsFarOutsideDoNotChangeSceneUnits) {
    const render::SceneUnits plain = render::make_scene_units(scene::make_cornell());
    for (const double distance : {1e4, 1e9}) {
        const render::SceneUnits with = render::make_scene_units(
            make_scene_with_distant_triangle(distance));
        EXPECT_EQ(with.origin, plain.origin);
        EXPECT_EQ(with.scale, plain.scale);
        EXPECT_EQ(with.core.lo, plain.core.lo);
        EXPECT_EQ(with.core.hi, plain.core.hi);
    }
}

/// Builds a room about 5 units long with mirror balls of the given radii and places.
scene::Scene make_room_with_mirror_balls(const std::vector<std::pair<double, dvec3>>& mirrors) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    for (const auto& [radius, place] : mirrors)
        test::add_ball(scene, "ball", mirror, place, radius);
    return scene;
}

dvec3 scene_origin_with_mirrors(const std::vector<std::pair<double, dvec3>>& mirrors) {
    return render::make_scene_units(make_room_with_mirror_balls(mirrors)).origin;
}

/// Floats keep 24 bits, so a mirror that is small compared with its distance from the origin loses
/// precision. The origin moves to such a mirror.
TEST(Core, OriginMovesToSmallMirrors) {
    const dvec3 place(1.5, -1, 1), middle = scene::bounds(test::make_lit_room(0, 1)).centre();
    EXPECT_EQ(scene_origin_with_mirrors({{.1, place}}), middle);
    EXPECT_EQ(scene_origin_with_mirrors({{.001, place}}), middle) << "2^-11 of the distance";
    EXPECT_LT(glm::length(scene_origin_with_mirrors({{1e-4, place}}) - place), 1e-5);
    EXPECT_EQ(scene_origin_with_mirrors({{0, place}}), middle) << "a point reflects nothing";
    EXPECT_LT(glm::length(scene_origin_with_mirrors({{1e-4, place}, {.3, -place}}) - place), 1e-5)
        << "whatever larger ones there are";
    EXPECT_LT(
        glm::length(scene_origin_with_mirrors({{1e-4, place}, {1e-4, place + dvec3(.1, 0, 0)}}) -
                    (place + dvec3(.05, 0, 0))),
        1e-5)
        << "neighbours share it";
}

TEST(Core, SmallMirrorsFarApartDoNotMoveTheOrigin) {
    const dvec3 place(1.5, -1, 1), middle = scene::bounds(test::make_lit_room(0, 1)).centre();
    const std::vector<std::pair<double, dvec3>> apart{{1e-4, place}, {1e-4, -place}};
    EXPECT_EQ(scene_origin_with_mirrors(apart), middle);
    const scene::Scene scene = make_room_with_mirror_balls(apart);
    const render::FrameGeometry geometry = render::make_geometry(
        scene, render::make_scene_units(scene), render::VertexSpaces::object_space);
    for (const std::size_t mirror : scene::mirrors(scene))
        EXPECT_TRUE(geometry.ranges[mirror].own) << mirror;
}

/// A mirror far outside the room is small compared with its distance. If the origin moved there,
/// the vertices of the room would lose precision.
TEST(Core, MirrorFarOutsideDoesNotMoveTheOrigin) {
    const scene::Scene scene = make_room_with_mirror_balls({{.5, {1e6, 2e5, 0}}});
    const render::SceneUnits space = render::make_scene_units(scene);
    EXPECT_EQ(space.origin, scene::bounds(test::make_lit_room(0, 1)).centre());
    const render::FrameGeometry geometry = render::make_geometry(
        scene, space, render::VertexSpaces::object_space);
    EXPECT_TRUE(geometry.ranges.back().own);
    for (std::size_t i = 0; i + 1 < geometry.ranges.size(); ++i)
        EXPECT_FALSE(geometry.ranges[i].own) << scene.objects[i].name;
}

TEST(Core, ObjectsBeyondTheReachOfFloatsAreNamed) {
    scene::Scene scene = scene::make_cornell();
    const std::size_t objects = scene.objects.size();
    test::add_mesh(scene, make_triangle_mesh("reachable", dvec3(1e20, 0, 0), 1e19), 0);
    test::add_mesh(scene, make_triangle_mesh("beyond", dvec3(1e22, 0, 0), 1e21), 0);
    try {
        render::make_geometry(scene, render::make_scene_units(scene));
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::exhausted);
        EXPECT_THAT(error.what(), testing::HasSubstr("object 'beyond': wanted every corner within "
                                                     "1e+18 sizes of the scene's core"));
    }
    scene::LoaderNotes notes;
    // finish_scene(), which every loader calls, removes an object whose distance from the
    // core exceeds the range of floats.
    scene::finish_scene(scene, "file.obj", notes);
    EXPECT_EQ(scene.objects.size(), objects + 1);
    EXPECT_THAT(scene.warnings,
                testing::ElementsAre("file.obj: objects farther away than floats reach, left out: "
                                     "1 (first: 'beyond')"));
    render::make_geometry(scene, render::make_scene_units(scene));
}

std::vector<bvh::Triangle> list_bvh_triangles(const render::FrameGeometry& geometry) {
    std::vector<bvh::Triangle> triangles;
    for (std::size_t k = 0; k < geometry.indices.size(); k += 3) {
        const auto corner = [&](std::size_t j) {
            return geometry.vertices[geometry.indices[k + j]].position;
        };
        triangles.push_back({corner(0), corner(1), corner(2)});
    }
    return triangles;
}

/// Rays and the rasteriser tell the front of a lamp by the order of its corners.
/// make_geometry therefore orders the corners by the normals, whatever order the file has.
TEST(Geometry, LampCornersRunCounterClockwiseAroundTheirNormals) {
    scene::Scene scene{.name = "lamp"};
    scene.materials = {{.name = "lamp", .emission = vec3(1)}, {.name = "wall", .albedo = vec3(1)}};
    scene.meshes = {
        scene::quad("quad", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})}; // the quad faces +z
    dmat4 mirrored(1);
    mirrored[0].x = -1;
    for (const std::size_t material : {0, 1})
        for (const dmat4& world : {dmat4(1), mirrored})
            scene.objects.push_back(
                {.name = "quad", .material = material, .world_from_object = world});
    const render::FrameGeometry geometry = render::make_geometry(scene, {});
    const std::vector<bvh::Triangle> all = list_bvh_triangles(geometry);
    ASSERT_EQ(all.size(), 8u);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool is_lamp = i < 4, turned = i % 4 >= 2;
        EXPECT_EQ(geometry.ranges[i / 2].one_sided, is_lamp);
        const vec3 facet = glm::cross(all[i].b - all[i].a, all[i].c - all[i].a);
        EXPECT_EQ(facet.z > 0, is_lamp || !turned) << i;
    }
}

/// The boxes of a BVH are widened by a rounding error that grows with distance. One stray triangle
/// must not widen all boxes, and rays must still find the stray triangle.
TEST(Core, TriangleFarOutsideDoesNotSlowDownOtherRays) {
    const scene::Scene room = scene::make_cornell(), scene = make_scene_with_distant_triangle(1e9);
    const render::FrameGeometry plain = render::make_geometry(room, render::make_scene_units(room)),
                                geometry = render::make_geometry(scene,
                                                                 render::make_scene_units(scene));
    const bvh::Bvh alone = bvh::build(list_bvh_triangles(plain), plain.core),
                   with = bvh::build(list_bvh_triangles(geometry), geometry.core);
    test::RandomNumbers random(3);
    bvh::TraversalCounters steps_alone, steps_with;
    for (int i = 0; i < 2000; ++i) {
        const f32::Ray ray{.4f * random.random_point_in_cube(), random.random_unit_direction(), 0};
        const auto wanted = bvh::find_closest_hit<float>(alone, ray, 1e30f, 0, &steps_alone),
                   found = bvh::find_closest_hit<float>(with, ray, 1e30f, 0, &steps_with);
        ASSERT_EQ(found.has_value(), wanted.has_value());
        ASSERT_EQ(found ? found->triangle : 0, wanted ? wanted->triangle : 0);
    }
    EXPECT_LE(steps_with.total(), steps_alone.total() * 11 / 10);

    const std::vector<bvh::Triangle> all = list_bvh_triangles(geometry);
    const bvh::Triangle& stray = all.back();
    std::size_t missed = 0;
    for (int i = 0; i < 1000; ++i) {
        const vec3 w = random.random_barycentric_weights(),
                   from = .4f * random.random_point_in_cube();
        const vec3 at = w.x * stray.a + w.y * stray.b + w.z * stray.c;
        const f32::Ray ray{from, at - from, 0};
        float t;
        vec3 weights;
        const bool meets = f32::intersect_triangle_watertight(
            stray.a, stray.b, stray.c, ray.origin, f32::make_ray_shear(ray.direction), t, weights);
        const auto hit = bvh::find_closest_hit<float>(with, ray, 1e30f);
        missed += meets && !(hit && (hit->triangle + 1 == all.size() || hit->t <= t));
    }
    EXPECT_EQ(missed, 0u);
}

} // namespace
