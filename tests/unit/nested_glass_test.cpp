// Tests of scene::rank_nested_glass, which ranks solid bodies of glass that share space.
#include "scene/build.hpp"
#include "scene/classify.hpp"
#include "scene/nested_glass.hpp"
#include "scene/shapes.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using namespace catoptric::scene;
using testing::ElementsAre;
using testing::IsEmpty;

Material make_nested_glass_material(const char* name, bool solid = true) {
    return {.name = name,
            .albedo = vec3(1),
            .roughness = 0,
            .dielectric_f0 = vec3(.04f),
            .dielectric_f90 = vec3(1),
            .transmission = 1,
            .solid = solid};
}

std::vector<std::size_t> list_ranked_objects(const Scene& scene) {
    std::vector<std::size_t> ranked;
    const std::vector<std::uint32_t> ranks = rank_nested_glass(scene);
    for (std::size_t i = 0; i < ranks.size(); ++i)
        if (ranks[i] > 0) ranked.push_back(i);
    return ranked;
}

/// Builds a ball of glass with the radius 1 around the origin, and a second body.
Scene make_scene_of_two_glass_bodies(Mesh second, const Material& material) {
    Scene scene{.name = "bodies"};
    add_mesh(scene, ball("outer", 3), add_material(scene, make_nested_glass_material("outer")));
    add_mesh(scene, std::move(second), add_material(scene, material));
    return scene;
}

TEST(NestedGlass, BodiesInsideOrAcrossOthersAreFound) {
    const Material inner = make_nested_glass_material("inner");
    const Mesh inside = box("inside", dvec3(-.3), dvec3(.3)),
               across = box("across", dvec3(.2, -.3, -.3), dvec3(2, .3, .3)),
               around = box("around", dvec3(-2), dvec3(2));
    for (const Mesh& mesh : {inside, across, around})
        EXPECT_THAT(list_ranked_objects(make_scene_of_two_glass_bodies(mesh, inner)),
                    ElementsAre(0u, 1u))
            << mesh.name;
}

/// The inner body replaces the outer one; of two that intersect, the one with the higher index
/// does.
TEST(NestedGlass, RanksFollowEnclosureThenIndex) {
    Material inner = make_nested_glass_material("inner");
    const Mesh inside = box("inside", dvec3(-.3), dvec3(.3)),
               across = box("across", dvec3(.2, -.3, -.3), dvec3(2, .3, .3)),
               around = box("around", dvec3(-2), dvec3(2));
    for (const float ior : {1.2f, 1.5f, 1.9f}) {
        inner.ior = ior;
        EXPECT_THAT(rank_nested_glass(make_scene_of_two_glass_bodies(inside, inner)),
                    ElementsAre(1u, 2u));
        EXPECT_THAT(rank_nested_glass(make_scene_of_two_glass_bodies(around, inner)),
                    ElementsAre(2u, 1u));
        EXPECT_THAT(rank_nested_glass(make_scene_of_two_glass_bodies(across, inner)),
                    ior > 1.5f ? ElementsAre(1u, 2u) : ElementsAre(2u, 1u));
    }
    Scene chain = make_scene_of_two_glass_bodies(inside, inner);
    add_mesh(chain, box("innermost", dvec3(-.1), dvec3(.1)), 0);
    add_mesh(chain, box("apart", dvec3(4), dvec3(5)), 0);
    EXPECT_THAT(rank_nested_glass(chain), ElementsAre(1u, 2u, 3u, 0u));
}

TEST(NestedGlass, SeparateBodiesAreNotFound) {
    const Material inner = make_nested_glass_material("inner");
    // The bounds of the ball and of the body in the bounds' corner overlap, but not the bodies.
    const Mesh apart = box("apart", dvec3(2, -1, -1), dvec3(3, 1, 1)),
               in_the_corner = box("in the corner", dvec3(.8), dvec3(1.2));
    for (const Mesh& mesh : {apart, in_the_corner})
        EXPECT_THAT(list_ranked_objects(make_scene_of_two_glass_bodies(mesh, inner)), IsEmpty())
            << mesh.name;
    Scene touching{.name = "stacked"};
    const std::size_t glass = add_material(touching, inner);
    add_mesh(touching, box("low", dvec3(-1), dvec3(1)), glass);
    add_mesh(touching, box("high", dvec3(-.5, 1, -.5), dvec3(.5, 2, .5)), glass);
    EXPECT_THAT(list_ranked_objects(touching), IsEmpty());
}

TEST(NestedGlass, SheetsAndOpenMeshesAreNoBodies) {
    const Mesh inside = box("inside", dvec3(-.3), dvec3(.3));
    EXPECT_THAT(list_ranked_objects(make_scene_of_two_glass_bodies(
                    inside, make_nested_glass_material("sheet", false))),
                IsEmpty());
    Mesh open = inside;
    open.triangles.pop_back();
    EXPECT_THAT(list_ranked_objects(
                    make_scene_of_two_glass_bodies(open, make_nested_glass_material("inner"))),
                IsEmpty());
    Material diffuse = make_nested_glass_material("stone");
    diffuse.transmission = 0;
    EXPECT_THAT(list_ranked_objects(make_scene_of_two_glass_bodies(inside, diffuse)), IsEmpty());
}

TEST(NestedGlass, BodiesAreComparedInTheWorld) {
    Scene scene = make_scene_of_two_glass_bodies(box("moved", dvec3(-.3), dvec3(.3)),
                                                 make_nested_glass_material("inner"));
    dmat4& place = scene.objects[1].world_from_object;
    place[3] = dvec4(5, 0, 0, 1);
    EXPECT_THAT(list_ranked_objects(scene), IsEmpty());
    scene.objects[0].world_from_object = dmat4(dvec4(-8, 0, 0, 0), dvec4(0, 1, 0, 0),
                                               dvec4(0, 0, 1, 0), dvec4(0, 0, 0, 1));
    EXPECT_THAT(list_ranked_objects(scene), ElementsAre(0u, 1u)) << "mirrored and stretched";
}

TEST(NestedGlass, UnsupportedFeatureListsBothMaterialsOnce) {
    Scene scene = make_scene_of_two_glass_bodies(box("inside", dvec3(-.3), dvec3(.3)),
                                                 make_nested_glass_material("inner"));
    for (int k = 0; k < 2; ++k) {
        add_unsupported_lighting(scene);
        ASSERT_EQ(scene.unsupported.size(), 1u) << "found again, not added up";
        EXPECT_EQ(scene.unsupported[0].id, "nested-glass");
        EXPECT_EQ(scene.unsupported[0].first, "materials[0] 'outer'");
        EXPECT_THAT(scene.unsupported[0].materials, ElementsAre(0u, 1u));
    }
}

} // namespace
