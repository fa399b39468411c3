// Tests of deciding which materials are mirrors or unsupported features, of texture lookup, and of
// the shapes of mirrors.
#include "scene/build.hpp"
#include "scene/classify.hpp"
#include "scene/mirror_shape.hpp"
#include "scene/motion.hpp"
#include "scene/rough_reflectors.hpp"
#include "scene/shapes.hpp"
#include "scene/texel.hpp"
#include "scene/unsupported_feature.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using namespace catoptric::scene;
using testing::ElementsAre;

/// Builds a 1 x 1 wall of the given material. The texture covers the wall once.
Scene make_panel_scene(Material material) {
    Scene scene{.name = "wall"};
    Mesh mesh = quad("wall", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    mesh.uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    add_mesh(scene, mesh, add_material(scene, std::move(material)));
    return scene;
}

Texture make_test_texture(uvec2 size, std::vector<std::uint32_t> texels, bool srgb = false) {
    Texture made;
    made.image = std::make_shared<Image>(Image{"i", size, std::move(texels)});
    made.srgb = srgb, made.nearest = true;
    return made;
}

Material make_metal_material(float roughness, vec3 colour = vec3(1)) {
    return {.name = "m", .albedo = colour, .metallic = 1, .roughness = roughness};
}

TEST(Classify, SmoothMetalIsAMirrorAndRoughMetalIsUnsupported) {
    for (const auto& [roughness, is] : {std::pair(0.f, true), {.6f, true}, {.61f, false}}) {
        Scene scene = make_panel_scene(make_metal_material(roughness));
        find_mirrors(scene);
        EXPECT_EQ(mirrors(scene).size(), is ? 1u : 0u) << roughness;
        ASSERT_EQ(scene.unsupported.size(), is ? 0u : 1u);
        if (is) continue;
        EXPECT_EQ(scene.unsupported[0].id, "rough-metal");
        EXPECT_EQ(scene.unsupported[0].first, "materials[0] 'm'");
        EXPECT_THAT(scene.unsupported[0].materials, ElementsAre(0u));
        scene.mirror_max_roughness = .7f;
        // Classifies again with a higher roughness limit.
        find_mirrors(scene);
        EXPECT_EQ(mirrors(scene).size(), 1u);
        EXPECT_TRUE(scene.unsupported.empty());
    }
}

TEST(Classify, LargestF0ChannelDecidesWhetherAMetalIsAMirror) {
    for (const auto& [blue, is] : {std::pair(.19f, false), {.2f, true}}) {
        Scene scene = make_panel_scene(make_metal_material(0, {.05f, .1f, blue}));
        find_mirrors(scene);
        EXPECT_EQ(scene.objects[0].mirror, is) << blue;
        EXPECT_EQ(scene.unsupported.size(), is ? 0u : 1u);
    }
}

TEST(Classify, DielectricsAreMirrorsOnlyOnRequestAndIfSmoothEnough) {
    struct ClassifyTestCase {
        float roughness;
        const char* gap;
        bool may_be_mirror;
    };
    for (const auto& [roughness, gap, may_be_mirror] :
         {ClassifyTestCase{.04f, "smooth-dielectric", true},
          ClassifyTestCase{.05f, "rough-dielectric", true},
          ClassifyTestCase{.6f, "rough-dielectric", true},
          ClassifyTestCase{.61f, "rough-dielectric", false}}) {
        Scene scene = make_panel_scene({.name = "lacquer",
                                        .albedo = vec3(.5f),
                                        .roughness = roughness,
                                        .dielectric_f0 = vec3(.04f),
                                        .dielectric_f90 = vec3(1)});
        find_mirrors(scene);
        EXPECT_FALSE(scene.objects[0].mirror);
        ASSERT_EQ(scene.unsupported.size(), 1u);
        EXPECT_EQ(scene.unsupported[0].id, gap);
        find_mirrors(scene, true);
        EXPECT_EQ(scene.objects[0].mirror, may_be_mirror) << roughness;
        EXPECT_EQ(scene.unsupported.empty(), may_be_mirror);
        scene.materials[0].unlit = true;
        find_mirrors(scene, true);
        EXPECT_FALSE(scene.objects[0].mirror);
    }
}

TEST(Classify, LargestObjectsOfGlassAreMirrors) {
    constexpr std::size_t kMost = 64; // kMaxGlassMirrors, which may not change unnoticed
    const Material glass{.name = "glass",
                         .albedo = vec3(1),
                         .roughness = 0,
                         .dielectric_f0 = vec3(.04f),
                         .dielectric_f90 = vec3(1),
                         .transmission = 1};
    Scene scene = make_panel_scene(glass);
    find_mirrors(scene);
    EXPECT_TRUE(scene.objects[0].mirror);
    EXPECT_TRUE(scene.unsupported.empty());
    for (std::size_t i = 1; i <= kMost; ++i) {
        Object object = scene.objects[0];
        // The object in the middle of the list is the smallest.
        const double size = i == kMost / 2 ? .5 : 1 + static_cast<double>(i);
        object.world_from_object = dmat4(size);
        object.world_from_object[3][3] = 1;
        scene.objects.push_back(object);
    }
    find_mirrors(scene);
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        EXPECT_EQ(scene.objects[i].mirror, i != kMost / 2) << i;
    ASSERT_EQ(scene.unsupported.size(), 1u);
    EXPECT_EQ(scene.unsupported[0].id, "glass-as-diffuse");
    scene.objects.pop_back();
    find_mirrors(scene);
    EXPECT_TRUE(scene.unsupported.empty()) << "found again, not added up";
}

TEST(Classify, LambertianSurfacesReflectNothing) {
    Scene scene = make_panel_scene({.name = "wall", .albedo = vec3(.5f), .roughness = .02f});
    find_mirrors(scene, true);
    EXPECT_FALSE(scene.objects[0].mirror);
    EXPECT_TRUE(scene.unsupported.empty());
    EXPECT_FALSE(may_reflect_by_lobe(scene, scene.objects[0]));
}

std::vector<std::string> list_scene_feature_ids(const Scene& scene) {
    std::vector<std::string> list;
    for (const UnsupportedFeature& gap : scene.unsupported) list.push_back(gap.id);
    return list;
}

TEST(SettleGaps, IndirectLightOfDiffuseSurfacesIsListedAsUnsupported) {
    Scene scene = make_panel_scene({.name = "wall", .albedo = vec3(.5f)});
    add_unsupported_lighting(scene);
    EXPECT_THAT(list_scene_feature_ids(scene), testing::IsEmpty()) << "nothing lights it";
    scene.punctual.push_back({.intensity = vec3(1)});
    add_unsupported_lighting(scene);
    ASSERT_THAT(list_scene_feature_ids(scene), ElementsAre("indirect-left-out"));
    EXPECT_EQ(scene.unsupported[0].count, 1u);
    EXPECT_EQ(scene.unsupported[0].first, "materials[0] 'wall'");
    EXPECT_THAT(scene.unsupported[0].materials, ElementsAre(0u));
    scene.punctual.clear();
    scene.environment = std::make_shared<Environment>();
    add_unsupported_lighting(scene);
    EXPECT_THAT(list_scene_feature_ids(scene),
                ElementsAre("indirect-left-out", "environment-unshadowed"));
    // A second call must not list anything twice.
    add_unsupported_lighting(scene);
    EXPECT_THAT(list_scene_feature_ids(scene),
                ElementsAre("indirect-left-out", "environment-unshadowed"));
    for (const Material& none : {Material{.albedo = vec3(0)},
                                 {.albedo = vec3(1), .unlit = true},
                                 make_metal_material(0)}) {
        scene.materials[0] = none;
        add_unsupported_lighting(scene);
        EXPECT_THAT(list_scene_feature_ids(scene), testing::IsEmpty()) << "it has no diffuse part";
    }
}

TEST(Classify, MirrorsOfConstantReflectanceStayMirrors) {
    Scene scene = make_panel_scene({.name = "m", .mirror = true, .reflectance = vec3(.01f)});
    find_mirrors(scene);
    EXPECT_FALSE(scene.objects[0].mirror);
    EXPECT_EQ(mirrors(scene).size(), 1u);
    EXPECT_TRUE(scene.unsupported.empty());
}

/// Builds a metal wall with a roughness texture of `columns` texels, of which one is smooth. The
/// texture stores roughness in green and metallic in blue.
Scene make_partly_smooth_wall(std::uint32_t columns) {
    std::vector<std::uint32_t> texels(columns, 0xffffff00u); // rough metal: green 255, blue 255
    texels[0] = 0xffff0000u;
    Material material = make_metal_material(1);
    material.roughness_texture = make_test_texture({columns, 1}, texels);
    return make_panel_scene(material);
}

TEST(Classify, TexturedMetalIsAMirrorIfATwentiethOfItsAreaIsSmooth) {
    for (const auto& [columns, is] : {std::pair(2u, true), {19u, true}, {21u, false}}) {
        Scene scene = make_partly_smooth_wall(columns);
        EXPECT_NEAR(surface_shares(scene, scene.objects[0]).mirror, 1.0 / columns, .003);
        find_mirrors(scene);
        EXPECT_EQ(scene.objects[0].mirror, is) << columns;
        EXPECT_EQ(scene.unsupported.size(), 1u) << "the rest is rough metal";
    }
}

/// A surface's share of mirror is weighted by triangle area in world space, not by the number of
/// triangles.
TEST(Classify, MirrorShareIsWeightedByWorldArea) {
    Scene scene{.name = "two"};
    Material material = make_metal_material(1);
    material.roughness_texture = make_test_texture(
        {2, 1}, {0xffff0000u, 0xffffff00u}); // the left texel is smooth
    const std::size_t index = add_material(scene, material);
    Mesh mesh = quad("both", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    mesh.uv[0].assign(4, {.25f, .5f});
    const Mesh rough = quad("r", {1, 0, 0}, {1, 0, 3}, {1, 1, 3}, {1, 1, 0});
    for (int i = 0; i < 4; ++i) {
        mesh.positions.push_back(rough.positions[std::size_t(i)]);
        mesh.normals.push_back(rough.normals[std::size_t(i)]);
        mesh.uv[0].push_back({.75f, .5f});
    }
    for (const uvec3& t : rough.triangles) mesh.triangles.push_back(t + 4u);
    add_mesh(scene, mesh, index);
    EXPECT_NEAR(surface_shares(scene, scene.objects[0]).mirror, .25, .001);
    scene.objects[0].world_from_object[2].z = 1.0 / 3; // now both areas are equal, 1 to 1
    EXPECT_NEAR(surface_shares(scene, scene.objects[0]).mirror, .5, .001);
}

TEST(Classify, F0MultipliesMaterialTextureAndVertexColours) {
    Material material = make_metal_material(0, {.5f, .5f, .5f});
    material.albedo_texture = make_test_texture({1, 1}, {0xff808080u},
                                                true); // sRGB 0x80 is .2159 in linear light
    Scene scene = make_panel_scene(material);
    scene.meshes[0].colours.assign(4, vec4(1));
    const float f0 = .5f * linear_from_srgb(0x80);
    EXPECT_NEAR(f0, .1079, 1e-4);
    EXPECT_EQ(surface_shares(scene, scene.objects[0]).mirror, 0);
    scene.materials[0].albedo = vec3(1);
    const SurfaceShares surface = surface_shares(scene, scene.objects[0]);
    EXPECT_EQ(surface.mirror, 1);
    EXPECT_NEAR(surface.mirror_f0.x, .2159, 1e-4);
    scene.meshes[0].colours.assign(4, vec4(.5f, .5f, .5f, 1));
    EXPECT_EQ(surface_shares(scene, scene.objects[0]).mirror, 0);
}

TEST(Classify, CutOutTexelsDoNotCountAsArea) {
    Material material = make_metal_material(1);
    material.alpha_cutoff = .5f;
    material.albedo_texture = make_test_texture(
        {2, 1}, {0xffffffffu, 0x00ffffffu}); // the right texel is cut out
    material.roughness_texture = make_test_texture({2, 1}, {0xffff0000u, 0xffffff00u});
    const Scene scene = make_panel_scene(material);
    EXPECT_EQ(surface_shares(scene, scene.objects[0]).mirror, 1);
}

TEST(Texel, LookupFollowsTheWrapModeOfTheTexture) {
    using enum Texture::Wrap;
    Texture one = make_test_texture({3, 1}, {10, 20, 30});
    const auto red = [&](float u) { return std::lround(255 * read_texel(one, {u, 0}).x); };
    one.wrap_u = repeat;
    EXPECT_EQ(red(.1f), 10);
    EXPECT_EQ(red(1.5f), 20);
    EXPECT_EQ(red(-.1f), 30);
    one.wrap_u = mirrored;
    EXPECT_EQ(red(1.1f), 30);
    EXPECT_EQ(red(1.9f), 10);
    EXPECT_EQ(red(-.4f), 20);
    EXPECT_EQ(red(-.9f), 30);
    one.wrap_u = clamp;
    EXPECT_EQ(red(7), 30);
    EXPECT_EQ(red(-7), 10);
    one.u_row = {0, 0, .5f}; // a texture transform that makes every u equal to .5
    EXPECT_EQ(red(7), 20);
    EXPECT_NEAR(mean_texel(one).x, 20 / 255.0, 1e-6);
}

MirrorShape::Kind classify_shape_of_mesh(Mesh mesh) {
    Scene scene;
    add_mesh(scene, std::move(mesh), add_material(scene, {}));
    return classify_shape(scene, scene.objects[0]).kind;
}

TEST(ShapeOf, MeshesAreClassifiedByShape) {
    using enum MirrorShape::Kind;
    EXPECT_EQ(classify_shape_of_mesh(quad("q", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})), flat);
    EXPECT_EQ(classify_shape_of_mesh(ball("b", 4)), sphere);
    EXPECT_EQ(classify_shape_of_mesh(ball("b", 1)), convex) << "too few facets for a ball";
    Mesh inside = ball("b", 4);
    for (uvec3& t : inside.triangles) std::swap(t.y, t.z);
    Mesh dish = inside;
    std::erase_if(dish.triangles, [&](const uvec3& t) { return dish.positions[t.x].y > -.5; });
    EXPECT_EQ(classify_shape_of_mesh(dish), concave);
    for (uvec3& t : dish.triangles) std::swap(t.y, t.z);
    EXPECT_EQ(classify_shape_of_mesh(dish), convex);
    Mesh step = quad("s", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    step.positions.insert(step.positions.end(), {{2, 0, 1}, {2, 1, 1}, {3, 0, 1}, {3, 1, 1}});
    step.triangles.insert(step.triangles.end(), {{1, 4, 5}, {1, 5, 2}, {4, 6, 7}, {4, 7, 5}});
    EXPECT_EQ(classify_shape_of_mesh(step), other);
}

TEST(ShapeOf, SphereIsFittedToPartOfABall) {
    Scene scene;
    Mesh dish = ball("dish", 4);
    std::erase_if(dish.triangles, [&](const uvec3& t) { return dish.positions[t.x].y > -.5; });
    // Like a loader, the test keeps only vertices that a triangle uses.
    std::vector<dvec3> used;
    for (uvec3& t : dish.triangles)
        for (int k = 0; k < 3; ++k) {
            used.push_back(dish.positions[t[k]]);
            t[k] = static_cast<std::uint32_t>(used.size() - 1);
        }
    dish.positions = used, dish.normals.assign(used.size(), vec3(0, 1, 0));
    add_mesh(scene, dish, add_material(scene, {}));
    dmat4& world = scene.objects[0].world_from_object;
    world = dmat4(3), world[3] = dvec4(100, 5, -7, 1);
    const MirrorShape shape = classify_shape(scene, scene.objects[0]);
    EXPECT_FALSE(shape.is_closed);
    ASSERT_TRUE(shape.fit);
    EXPECT_NEAR(shape.fit->radius, 3, 1e-6);
    EXPECT_NEAR(glm::distance(shape.fit->centre, dvec3(100, 5, -7)), 0, 1e-6);
    EXPECT_LT(shape.tolerance, 1e-6);
}

TEST(ShapeOf, ClosedBoxIsConvexOrConcaveByFacing) {
    Scene scene;
    Mesh box{.name = "box"};
    for (int face = 0; face < 6; ++face) {
        const Mesh side = make_box_wall(face, {-1, -1, -1}, {1, 2, 1});
        const auto first = static_cast<std::uint32_t>(box.positions.size());
        box.positions.insert(box.positions.end(), side.positions.begin(), side.positions.end());
        box.normals.insert(box.normals.end(), side.normals.begin(), side.normals.end());
        for (const uvec3& t : side.triangles) box.triangles.push_back(t + first);
    }
    add_mesh(scene, box, add_material(scene, {}));
    MirrorShape shape = classify_shape(scene, scene.objects[0]);
    EXPECT_EQ(shape.kind, MirrorShape::Kind::concave) << "walls face in";
    EXPECT_TRUE(shape.is_closed);
    for (uvec3& t : scene.meshes[0].triangles) std::swap(t.y, t.z);
    shape = classify_shape(scene, scene.objects[0]);
    EXPECT_EQ(shape.kind, MirrorShape::Kind::convex);
}

/// Scene files do not mark balls. One function recognises a ball by its triangles, for `info`,
/// `auto` and searches that intersect exact spheres.
TEST(Classify, SmoothMirrorBallsGetAnExactSphere) {
    Scene scene{.name = "balls"};
    const std::size_t mirror = add_material(scene, {.name = "m", .mirror = true});
    add_mesh(scene, ball("ball", 5), mirror);
    scene.objects.back().world_from_object = dmat4(.5);
    scene.objects.back().world_from_object[3] = dvec4(3, -2, 1, 1);
    // The same ball, but with normals such that each triangle mirrors as a plane.
    Mesh facets{.name = "facets"};
    const Mesh smooth = ball("ball", 5);
    for (const uvec3& t : smooth.triangles) {
        const auto first = static_cast<std::uint32_t>(facets.positions.size());
        const dvec3 a = smooth.positions[t.x], b = smooth.positions[t.y], c = smooth.positions[t.z];
        for (const dvec3& p : {a, b, c}) {
            facets.positions.push_back(p);
            facets.normals.emplace_back(normalize(cross(b - a, c - a)));
        }
        facets.triangles.push_back({first, first + 1, first + 2});
    }
    add_mesh(scene, facets, mirror);
    add_mesh(scene, ball("grey", 4), add_material(scene, {.name = "grey"}));
    find_mirrors(scene);
    ASSERT_TRUE(scene.objects[0].sphere);
    EXPECT_NEAR(distance(scene.objects[0].sphere->centre, dvec3(3, -2, 1)), 0, 1e-6);
    EXPECT_NEAR(scene.objects[0].sphere->radius, .5, 1e-6);
    EXPECT_EQ(classify_shape(scene, scene.objects[0]).kind, MirrorShape::Kind::sphere);
    EXPECT_FALSE(scene.objects[1].sphere);
    EXPECT_NE(classify_shape(scene, scene.objects[1]).kind, MirrorShape::Kind::sphere);
    EXPECT_FALSE(scene.objects[2].sphere) << "no mirror";
}

/// Returns a mirror ball of radius 1 around the middle of the node of a rig. The node's parent
/// turns, and the node has the given scales at 0 s and 2 s.
Scene make_ball_on_rig(const dvec3& first, const dvec3& last, const dvec3& of_parent = dvec3(1)) {
    Scene scene{.name = "ball"};
    add_mesh(scene, ball("ball", 5), add_material(scene, {.name = "m", .mirror = true}));
    const double half = std::sqrt(.5);
    NodeRig rig;
    rig.nodes.push_back({.translation = {1, 0, 0},
                         .scale = of_parent,
                         .rotations = std::make_shared<const RotationTrack>(RotationTrack{
                             .times = {0, 2}, .values = {{0, 0, 0, 1}, {0, half, 0, half}}})});
    rig.nodes.push_back({.parent = 0,
                         .translation = {5, 2, 0},
                         .scales = std::make_shared<const TranslationTrack>(
                             TranslationTrack{.times = {0, 2}, .values = {first, last}})});
    RigAttachment follows{.rig = std::make_shared<const NodeRig>(std::move(rig)), .node = 1};
    scene.objects[0].world_from_object = node_transforms(*follows.rig, 0)[1];
    scene.objects[0].motion = std::move(follows);
    return scene;
}

TEST(Classify, BallOnARigKeepsAnExactSphereWhileItsScaleIsUniform) {
    Scene scene = make_ball_on_rig(dvec3(1), dvec3(3), dvec3(.5));
    find_mirrors(scene);
    for (const double seconds : {0., .5, 1.25, 2., 7.}) {
        const Scene still = scene_at(scene, seconds);
        const Object& object = still.objects[0];
        ASSERT_TRUE(object.sphere) << seconds;
        EXPECT_NEAR(object.sphere->radius, .5 * (1 + std::min(seconds, 2.)), 1e-6);
        for (const dvec3& position : still.meshes[0].positions) {
            const dvec3 point(object.world_from_object * dvec4(position, 1));
            ASSERT_NEAR(distance(point, object.sphere->centre), object.sphere->radius, 1e-6)
                << seconds;
        }
    }
    for (Scene stretched :
         {make_ball_on_rig(dvec3(1), dvec3(1, 2, 1)), make_ball_on_rig(dvec3(0), dvec3(1)),
          make_ball_on_rig(dvec3(1), dvec3(2), dvec3(1, 1, 2))}) {
        find_mirrors(stretched);
        EXPECT_FALSE(stretched.objects[0].sphere);
    }
    // A program may mark an object as an exact sphere. The mark is removed as soon as an animation
    // stretches the object.
    Scene marked = make_ball_on_rig(dvec3(1), dvec3(1, 2, 1));
    marked.objects[0].sphere = Sphere{dvec3(marked.objects[0].world_from_object[3]), 1};
    EXPECT_TRUE(scene_at(marked, 0).objects[0].sphere);
    EXPECT_FALSE(scene_at(marked, 1).objects[0].sphere);
}

} // namespace
