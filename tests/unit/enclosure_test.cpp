// Tests of render::encloses, which tells whether a mirror's triangles enclose a
// point, and of render::is_closed_shell.
#include "render/enclosure.hpp"
#include "scene/build.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

/// The geometry of a scene that contains only one mirror mesh, with scene units equal to world
/// units.
struct PointEnclosureTest {
    explicit PointEnclosureTest(scene::Mesh mesh) {
        scene::Scene scene;
        test::add_mesh(scene, std::move(mesh), test::add_material(scene, {.mirror = true}));
        geometry = render::make_geometry(scene, {});
    }
    bool is_point_enclosed(vec3 point) const {
        return render::encloses(geometry, geometry.ranges.front(), dvec3(point));
    }
    render::FrameGeometry geometry;
};

/// Builds one mesh of the listed walls (0 to 5) of a box with edges of 2 units. Walls share no
/// vertices.
scene::Mesh make_enclosure_box(std::initializer_list<int> walls, bool outwards) {
    scene::Mesh mesh;
    for (const int wall : walls) {
        const scene::Mesh side = outwards ? test::make_box_wall(wall, dvec3(1), dvec3(-1))
                                          : test::make_box_wall(wall, dvec3(-1), dvec3(1));
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), side.positions.begin(), side.positions.end());
        mesh.normals.insert(mesh.normals.end(), side.normals.begin(), side.normals.end());
        for (const uvec3& triangle : side.triangles) mesh.triangles.push_back(triangle + first);
    }
    return mesh;
}

TEST(Shell, ShellIsAClosedMeshThatFacesOutwards) {
    const auto all = {0, 1, 2, 3, 4, 5};
    EXPECT_TRUE(render::is_closed_shell(scene::ball("ball", 3)));
    EXPECT_TRUE(render::is_closed_shell(make_enclosure_box(all, true)));
    EXPECT_FALSE(render::is_closed_shell(make_enclosure_box(all, false))) << "faces in";
    EXPECT_FALSE(render::is_closed_shell(make_enclosure_box({0, 1, 2, 3, 4}, true))) << "open";
    EXPECT_FALSE(render::is_closed_shell(scene::torus("torus", 1, .3, 24)))
        << "not seen from its middle";
    scene::Mesh turned = scene::ball("ball", 2);
    std::swap(turned.triangles[5].x, turned.triangles[5].y);
    EXPECT_FALSE(render::is_closed_shell(turned)) << "one triangle faces in";
}

TEST(Enclosure, BallEnclosesThePointsInside) {
    const PointEnclosureTest ball(scene::ball("ball", 3));
    for (const vec3 inside : {vec3(0), vec3(.5f, -.3f, .2f), vec3(0, 0, -.999f)})
        EXPECT_TRUE(ball.is_point_enclosed(inside));
    for (const vec3 outside : {vec3(.7f, .7f, .7f), vec3(0, 0, -1.001f), vec3(5, 0, 0)})
        EXPECT_FALSE(ball.is_point_enclosed(outside));
    EXPECT_TRUE(ball.is_point_enclosed(vec3(0, 0, -1))) << "a vertex";
}

TEST(Enclosure, ClosedBoxEnclosesPointsWhicheverWayItsFacesPoint) {
    for (const bool outwards : {true, false}) {
        const PointEnclosureTest closed(make_enclosure_box({0, 1, 2, 3, 4, 5}, outwards));
        EXPECT_TRUE(closed.is_point_enclosed(vec3(.2f, .9f, -.9f)));
        EXPECT_TRUE(closed.is_point_enclosed(vec3(1, .1f, .2f))) << "a face";
        EXPECT_FALSE(closed.is_point_enclosed(vec3(1.001f, 0, 0)));
    }
}

TEST(Enclosure, OpenMeshesEncloseNoPoint) {
    const PointEnclosureTest open(make_enclosure_box({0, 1, 2, 3, 4}, false)),
        pane(make_enclosure_box({4}, false));
    EXPECT_FALSE(open.is_point_enclosed(vec3(0)));
    EXPECT_FALSE(pane.is_point_enclosed(vec3(0, 0, 1)));
}

} // namespace
