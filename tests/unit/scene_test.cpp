#include "scene/scene.hpp"

#include "core/error.hpp"
#include "import/load.hpp"
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/default_camera.hpp"
#include "scene/hash.hpp"
#include "scene/light.hpp"
#include "scene/material_facts.hpp"
#include "scene/pose.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace {

using namespace catoptric;
using namespace catoptric::scene;

dvec3 triangle_face_normal(const Mesh& mesh, const uvec3& t) {
    const auto& p = mesh.positions;
    return glm::normalize(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
}

const Object& find_object_by_name(const Scene& scene, const std::string& name) {
    const auto at = std::ranges::find(scene.objects, name, &Object::name);
    if (at == scene.objects.end()) throw std::out_of_range(name);
    return *at;
}

const Mesh& find_mesh_by_name(const Scene& scene, const std::string& name) {
    return scene.meshes[find_object_by_name(scene, name).mesh];
}

void expect_near_vectors(const dvec3& found, const dvec3& wanted, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], wanted[i], tolerance) << "component " << i;
}

/// Returns a scene of one lamp with this mesh, which emits white light.
Scene make_scene_of_glowing_mesh(Mesh mesh, const dmat4& world_from_object = dmat4(1)) {
    Scene scene{.name = "glow"};
    scene.materials.push_back({.name = "light", .emission = vec3(1)});
    scene.objects.push_back({.name = "light", .world_from_object = world_from_object});
    scene.meshes.push_back(std::move(mesh));
    return scene;
}

// ---- shapes

TEST(Ball, BallHasTheDocumentedNumbersOfTrianglesAndVertices) {
    for (int level = 0; level <= 5; ++level) {
        const Mesh mesh = ball("ball", level);
        const auto four = std::size_t(1) << (2 * level);
        EXPECT_EQ(mesh.triangles.size(), 4 * four);
        EXPECT_EQ(mesh.positions.size(), 2 * four + 2);
        EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    }
    EXPECT_EQ(ball("ball", 5).triangles.size(), 4096u);
    EXPECT_EQ(ball("ball", 5).positions.size(), 2050u);
}

TEST(Ball, BallIsAClosedUnitSphereFacingOutwards) {
    const Mesh mesh = ball("ball", 5);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(glm::length(mesh.positions[i]), 1, 4e-16); // 2 ulp
        EXPECT_EQ(mesh.normals[i], vec3(mesh.positions[i]));
    }
    std::map<std::pair<unsigned, unsigned>, int> edges; // count of each directed edge
    for (const uvec3& t : mesh.triangles) {
        EXPECT_GT(glm::dot(triangle_face_normal(mesh, t), mesh.positions[t.x]), 0);
        for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
}

TEST(Ball, BallStartsFromTheDocumentedTetrahedron) {
    const Mesh mesh = ball("ball", 0);
    const double s = std::sqrt(2.0), q = std::sqrt(6.0);
    EXPECT_EQ(mesh.positions[0], dvec3(0, 0, -1));
    EXPECT_EQ(mesh.positions[1], dvec3(0, 2 * s / 3, 1.0 / 3));
    EXPECT_EQ(mesh.positions[2], dvec3(-q / 3, -s / 3, 1.0 / 3));
    EXPECT_EQ(mesh.positions[3], dvec3(q / 3, -s / 3, 1.0 / 3));
}

// ---- the built-in scene

TEST(CornellMirrors, SceneHasTheDocumentedObjectsAndMaterials) {
    const Scene scene = make_cornell();
    std::vector<std::string> objects, materials;
    for (const Object& object : scene.objects) objects.push_back(object.name);
    for (const Material& material : scene.materials) materials.push_back(material.name);
    EXPECT_THAT(objects, testing::ElementsAre("floor", "ceiling", "back", "right", "left", "light",
                                              "ball1", "ball2", "ball3", "ball4"));
    EXPECT_THAT(materials, testing::ElementsAre("white", "green", "red", "light", "mirror"));
    EXPECT_EQ(scene.materials[find_object_by_name(scene, "right").material].name, "green");
    EXPECT_EQ(scene.materials[find_object_by_name(scene, "left").material].name, "red");
    EXPECT_EQ(triangle_count(scene), 6 * 2 + 4 * 4096u);
    EXPECT_THAT(mirrors(scene), testing::ElementsAre(6, 7, 8, 9));
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].eye, dvec3(278, 273, -800));
    EXPECT_EQ(scene.cameras[0].target, dvec3(278, 273, 0));
    EXPECT_EQ(scene.cameras[0].vertical_fov_degrees, 37.5);
}

TEST(CornellMirrors, EveryWallFacesIntoTheBox) {
    const Scene scene = make_closed_cornell();
    const dvec3 middle(278, 274, 280);
    for (const char* name : {"floor", "ceiling", "back", "right", "left", "light", "front"}) {
        const Mesh& mesh = find_mesh_by_name(scene, name);
        for (const uvec3& t : mesh.triangles) {
            EXPECT_GT(glm::dot(triangle_face_normal(mesh, t), middle - mesh.positions[t.x]), 0)
                << name;
            EXPECT_GT(glm::dot(dvec3(mesh.normals[t.x]), middle - mesh.positions[t.x]), 0) << name;
        }
    }
}

TEST(CornellMirrors, LampShinesDown) {
    const std::vector<PointLight> found = list_lights(make_cornell());
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].normal, dvec3(0, -1, 0));
    expect_near_vectors(found[0].position, {278, 548.7, 279.5}, 1e-12);
    EXPECT_NEAR(found[0].area, 130 * 105, 1e-9);
    EXPECT_EQ(found[0].emission, vec3(17, 12, 4));
}

TEST(CornellMirrors, BallsHaveThePlacesOfTheSeedReport) {
    const Scene scene = make_cornell();
    const std::map<std::string, Sphere> wanted = {{"ball1", {{445, 73, 320}, 72}},
                                                  {"ball2", {{90, 100, 110}, 72}},
                                                  {"ball3", {{190, 113, 410}, 110}},
                                                  {"ball4", {{500, 80, 210}, 36}}};
    for (const auto& [name, sphere] : wanted) {
        const Object& object = find_object_by_name(scene, name);
        EXPECT_EQ(object.sphere->centre, sphere.centre);
        EXPECT_EQ(object.sphere->radius, sphere.radius);
        expect_near_vectors(bounds(scene, object).centre(), sphere.centre, 0.01 * sphere.radius);
    }
}

TEST(FlatMirrorRoom, WallsHaveTheirColours) {
    const Scene scene = make_flat_room();
    const std::map<std::string, std::string> paints{{"wall0", "red"},   {"wall1", "blue"},
                                                    {"wall2", "white"}, {"wall3", "wood"},
                                                    {"wall4", "white"}, {"wall5", "white"}};
    std::size_t walls = 0;
    for (const Object& object : scene.objects)
        if (const auto found = paints.find(object.name); found != paints.end()) {
            EXPECT_EQ(scene.materials[object.material].name, found->second) << object.name;
            ++walls;
        }
    EXPECT_EQ(walls, paints.size());
}

TEST(CornellMirrors, ClosedSceneHasAFrontWallThatOnlyTheCameraIgnores) {
    const Scene scene = make_closed_cornell();
    const Object& front = find_object_by_name(scene, "front");
    EXPECT_FALSE(front.seen_by_camera);
    EXPECT_EQ(find_mesh_by_name(scene, "front").normals[0], vec3(0, 0, 1));
    for (const dvec3& p : find_mesh_by_name(scene, "front").positions) EXPECT_EQ(p.z, 0);
    EXPECT_EQ(mirrors(scene), mirrors(make_cornell()));
    EXPECT_EQ(std::ranges::count(scene.objects, false, &Object::seen_by_camera), 1);
}

// ---- motion

TEST(Motion, BallFourMovesUpAndDown) {
    const Scene scene = make_cornell();
    EXPECT_TRUE(is_animated(scene));
    for (const double t : {0.0, 0.3, 1.0, 2.0, 3.7, 4.0, 1e6, -0.25}) {
        const Scene still = scene_at(scene, t);
        const double y = 80 + 50 * (1 - std::cos(2 * M_PI * t / 4));
        const Object& ball4 = find_object_by_name(still, "ball4");
        EXPECT_NEAR(ball4.world_from_object[3].y, y, std::abs(t) > 100 ? 1e-7 : 1e-12) << t;
        EXPECT_EQ(ball4.sphere->centre.y, ball4.world_from_object[3].y);
        EXPECT_EQ(ball4.world_from_object[3].x, 500);
        EXPECT_EQ(find_object_by_name(still, "ball1").sphere->centre, dvec3(445, 73, 320));
        EXPECT_FALSE(is_animated(still));
    }
    EXPECT_EQ(find_object_by_name(scene_at(scene, 0), "ball4").sphere->centre, dvec3(500, 80, 210));
    EXPECT_EQ(find_object_by_name(scene_at(scene, 2), "ball4").sphere->centre,
              dvec3(500, 180, 210));
}

TEST(Motion, PeriodOfASceneIsThatOfItsLongestMotion) {
    Scene scene = make_cornell();
    EXPECT_EQ(scene_period(scene), 4);
    const TranslationTrack keys{.times = {1, 5.5}, .values = {{0, 0, 0}, {1, 0, 0}}};
    scene.objects[0].motion = Keyframes{std::make_shared<const TranslationTrack>(keys)};
    EXPECT_EQ(scene_period(scene), 5.5);
    scene.objects[1].motion = Keyframes{};
    EXPECT_EQ(scene_period(scene), 5.5);
    EXPECT_EQ(scene_period(scene_at(scene, 1)), 0) << "nothing moves any more";
}

dvec3 position_on_track(const TranslationTrack& keys, double seconds) {
    Scene scene = make_scene_of_glowing_mesh(quad("q", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}));
    scene.objects[0].motion = Keyframes{std::make_shared<const TranslationTrack>(keys)};
    return dvec3(scene_at(scene, seconds).objects[0].world_from_object[3]);
}

TEST(Motion, KeyframesInterpolateByStepsOrLinearlyAndRepeat) {
    TranslationTrack keys{.times = {1, 2, 4}, .values = {{0, 0, 0}, {2, 0, 0}, {6, 1, 0}}};
    EXPECT_EQ(position_on_track(keys, 0.5), dvec3(0)); // the time is before the first key
    EXPECT_EQ(position_on_track(keys, 1.5), dvec3(1, 0, 0));
    EXPECT_EQ(position_on_track(keys, 3), dvec3(4, 0.5, 0));
    EXPECT_EQ(position_on_track(keys, 4), dvec3(6, 1, 0));   // the time is that of the last key
    EXPECT_EQ(position_on_track(keys, 5.5), dvec3(1, 0, 0)); // 4 s after t = 1.5, so the same place
    keys.interpolation = TranslationTrack::Interpolation::step;
    EXPECT_EQ(position_on_track(keys, 1.99), dvec3(0));
    EXPECT_EQ(position_on_track(keys, 2), dvec3(2, 0, 0));
}

TEST(Motion, CubicKeysReproduceACubic) {
    // p(t) = t^3 - 2 t has the tangent 3 t^2 - 2. A cubic Hermite spline reproduces p exactly.
    const auto p = [](double t) { return dvec3(t * t * t - 2 * t, 0, 0); };
    TranslationTrack keys{.interpolation = TranslationTrack::Interpolation::cubic};
    for (const double t : {0.0, 0.5, 2.0}) {
        keys.times.push_back(t);
        keys.values.push_back(p(t));
        keys.in_tangents.emplace_back(3 * t * t - 2, 0, 0);
    }
    keys.out_tangents = keys.in_tangents;
    for (const double t : {0.1, 0.5, 0.9, 1.7})
        expect_near_vectors(position_on_track(keys, t), p(t), 1e-14);
}

TEST(Motion, LightsWithoutASurfaceMoveToo) {
    Scene scene;
    scene.punctual.push_back(
        {.world_from_light = dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1),
         .motion = HarmonicMotion{{0, 4, 0}, 2}});
    EXPECT_TRUE(is_animated(scene));
    EXPECT_EQ(scene_period(scene), 2);
    const Scene still = scene_at(scene, 1);
    EXPECT_EQ(list_lights(still).at(0).position, dvec3(1, 10, 3));
    EXPECT_FALSE(is_animated(still));
    EXPECT_EQ(scene_at(scene, 2).punctual[0].world_from_light, scene.punctual[0].world_from_light);
}

TEST(Motion, SceneTimeMustBeFinite) { EXPECT_THROW(scene_at(make_cornell(), std::nan("")), Error); }

// ---- lights

TEST(Lights, EachConnectedPieceOfALampIsOneLight) {
    Mesh two = quad("a", {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
    const Mesh other = quad("b", {5, 0, 0}, {5, 0, 2}, {7, 0, 2}, {7, 0, 0});
    two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
    two.normals.insert(two.normals.end(), other.normals.begin(), other.normals.end());
    for (const uvec3& t : other.triangles) two.triangles.push_back(t + 4u);
    const auto found = list_lights(make_scene_of_glowing_mesh(two));
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].position, dvec3(0.5, 0, 0.5));
    EXPECT_EQ(found[0].area, 1);
    EXPECT_EQ(found[1].position, dvec3(6, 0, 1));
    EXPECT_EQ(found[1].area, 4);
}

TEST(Lights, LampTrianglesWithEqualPositionsAreConnected) {
    Mesh unshared{.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0, 0, 0}, {1, 0, 1}, {1, 0, 0}},
                  .normals = std::vector<vec3>(6, vec3(0, 1, 0)),
                  .triangles = {{0, 1, 2}, {3, 4, 5}}};
    const auto found = list_lights(make_scene_of_glowing_mesh(unshared));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].position, dvec3(0.5, 0, 0.5));
    EXPECT_EQ(found[0].area, 1);
}

TEST(Lights, LightOfAClosedLampHasNoDirection) {
    dmat4 world(3);
    world[3] = dvec4(1, 2, 3, 1);
    const auto found = list_lights(make_scene_of_glowing_mesh(ball("ball", 4), world));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].normal, dvec3(0));
    expect_near_vectors(found[0].position, {1, 2, 3}, 1e-12);
    EXPECT_NEAR(found[0].area, 4 * M_PI * 9, 1);
    EXPECT_TRUE(found[0].closed);
    EXPECT_EQ(light_share(found[0], {0, 1, 0}), .25);
}

TEST(Lights, TwoSidedLampShinesBothWays) {
    Scene scene = make_scene_of_glowing_mesh(quad("a", {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}));
    EXPECT_TRUE(is_one_sided(scene.materials[0]));
    EXPECT_EQ(list_lights(scene).at(0).normal, dvec3(0, 1, 0));
    const std::string before = hash_scene(scene);
    scene.materials[0].two_sided = true;
    EXPECT_FALSE(is_one_sided(scene.materials[0]));
    EXPECT_EQ(list_lights(scene).at(0).normal, dvec3(0));
    EXPECT_NEAR(light_share(list_lights(scene).at(0), {0, .6, .8}), .6, 1e-12);
    EXPECT_NEAR(light_share(list_lights(scene).at(0), {0, -.6, .8}), .6, 1e-12);
    EXPECT_NE(hash_scene(scene), before);
}

TEST(Lights, OnlyLampMaterialsAreOneSided) {
    const Scene scene = make_cornell();
    for (const Material& material : scene.materials)
        EXPECT_EQ(is_one_sided(material), material.name == "light") << material.name;
}

TEST(Lights, LampTrianglesWithoutAreaContributeNothing) {
    Mesh mesh = quad("a", {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
    mesh.positions.insert(mesh.positions.end(), {{9, 9, 9}, {8, 8, 8}});
    mesh.normals.resize(6, vec3(1, 0, 0));
    mesh.triangles.emplace_back(0, 4, 4);
    mesh.triangles.emplace_back(5, 5, 5);
    const auto found = list_lights(make_scene_of_glowing_mesh(mesh));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].position, dvec3(0.5, 0, 0.5));
    EXPECT_EQ(found[0].normal, dvec3(0, 1, 0));
}

TEST(Lights, LampNormalAndAreaFollowTheTransform) {
    // Rotates and scales by axis, so that a normal transformed like a position would be wrong.
    dmat4 world(1);
    world[0] = dvec4(2, 0, 0, 0);
    world[1] = dvec4(0, 0, 3, 0);
    world[2] = dvec4(0, -1, 0, 0);
    const auto found = list_lights(
        make_scene_of_glowing_mesh(quad("a", {0, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0, 0, 1}), world));
    ASSERT_EQ(found.size(), 1u);
    // The edges of the square become (2,0,3) and (0,-1,0). The normal is along (b-a) x (c-a).
    const dvec3 normal = glm::normalize(glm::cross(dvec3(2, 0, 3), dvec3(2, -1, 3)));
    expect_near_vectors(found[0].normal, normal, 1e-6);
    EXPECT_NEAR(found[0].area, std::sqrt(13.0), 1e-12);
}

// ---- default camera and scene hash

/// Returns the largest distance of a corner of the scene's bounds from the middle of the picture. 1
/// is the distance of the picture's edge.
double max_corner_distance_in_picture(const Scene& scene, const Camera& camera, double aspect) {
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    const dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    const dvec3 up = glm::cross(right, forward);
    const double slope = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    const Bounds<double> box = bounds(scene);
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 p(corner & 1 ? box.lo.x : box.hi.x, corner & 2 ? box.lo.y : box.hi.y,
                      corner & 4 ? box.lo.z : box.hi.z);
        const dvec3 view = p - camera.eye;
        const double depth = glm::dot(view, forward);
        EXPECT_GT(depth, 0);
        most = std::max({most, std::abs(glm::dot(view, right)) / (slope * aspect * depth),
                         std::abs(glm::dot(view, up)) / (slope * depth)});
    }
    return most;
}

/// The default camera is 30 degrees to the right and 20 degrees above. It is as near as possible
/// while the scene's bounds stay within 90 % of the picture's width and height.
TEST(DefaultCamera, DefaultCameraIsAThreeQuarterViewOfTheBounds) {
    const Scene scene = scene_at(make_cornell(), 0);
    const dvec3 to_eye(std::sin(M_PI / 6) * std::cos(M_PI / 9), std::sin(M_PI / 9),
                       std::cos(M_PI / 6) * std::cos(M_PI / 9));
    for (const double aspect : {.25, 1.0, 16.0 / 9}) {
        const Camera camera = default_camera(scene, aspect);
        expect_near_vectors(camera.target, bounds(scene).centre(), 1e-3);
        EXPECT_EQ(camera.vertical_fov_degrees, 40);
        EXPECT_EQ(camera.up, dvec3(0, 1, 0));
        expect_near_vectors(glm::normalize(camera.eye - camera.target), to_eye, 1e-5);
        EXPECT_NEAR(max_corner_distance_in_picture(scene, camera, aspect), .9, 1e-5) << aspect;
    }
}

TEST(DefaultCamera, DefaultCameraExistsForAnEmptyScene) {
    const Camera camera = default_camera(Scene());
    EXPECT_GT(glm::distance(camera.eye, camera.target), 0);
}

/// Holds a scene with data in every field. Tests change one field at a time and expect another
/// hash.
class SceneHashTest : public testing::Test {
protected:
    SceneHashTest() {
        scene_ = make_cornell();
        const TranslationTrack keys{.interpolation = TranslationTrack::Interpolation::cubic,
                                    .times = {0, 1},
                                    .values = {{1, 2, 3}, {4, 5, 6}},
                                    .in_tangents = {{1, 0, 0}, {0, 1, 0}},
                                    .out_tangents = {{2, 0, 0}, {0, 2, 0}}};
        scene_.objects[7].motion = Keyframes{
            .keys = std::make_shared<const TranslationTrack>(keys)};
        hashes_ = {hash_scene(scene_)};
    }

    static Keyframes& motion_of_scene(Scene& scene) {
        return std::get<Keyframes>(scene.objects[7].motion);
    }

    /// Changes a copy of the scene with `change`. Expects a hash that no earlier scene had.
    template <typename Change>
    void expect_new_hash(const char* what, Change&& change) {
        Scene other = scene_;
        change(other);
        EXPECT_TRUE(hashes_.insert(hash_scene(other)).second) << what;
    }
    /// Changes each component of the vector that `get` returns, one at a time.
    template <typename Get>
    void expect_new_hash_for_each_component(const char* what, Get&& get) {
        for (int i = 0; i < 3; ++i)
            expect_new_hash(what, [&](Scene& scene) { get(scene)[i] += .125f; });
    }
    template <typename Change>
    void expect_new_hash_of_keys(const char* what, Change&& change) {
        expect_new_hash(what, [&](Scene& scene) {
            TranslationTrack keys = *motion_of_scene(scene).keys;
            change(keys);
            motion_of_scene(scene).keys = std::make_shared<const TranslationTrack>(keys);
        });
    }

    Scene scene_;
    std::set<std::string> hashes_;
};

TEST_F(SceneHashTest, SceneHashChangesWithMeshes) {
    expect_new_hash("a bit",
                    [](Scene& s) { s.meshes[0].positions[0].x = std::nextafter(552.8, 0); });
    expect_new_hash_for_each_component(
        "position", [](Scene & s) -> auto& { return s.meshes.back().positions.back(); });
    expect_new_hash_for_each_component(
        "normal", [](Scene & s) -> auto& { return s.meshes[0].normals.back(); });
    expect_new_hash(
        "order", [](Scene& s) { std::swap(s.meshes[0].triangles[0], s.meshes[0].triangles[1]); });
    for (int i = 0; i < 3; ++i)
        expect_new_hash("index", [&](Scene& s) { s.meshes.back().triangles.back()[i] ^= 1; });
    expect_new_hash("name", [](Scene& s) { s.meshes[1].name += "'"; });
    expect_new_hash("count", [](Scene& s) { s.meshes.push_back(s.meshes[0]); });
    expect_new_hash("text that runs over", [](Scene& s) {
        s.meshes[0].name += "a", s.materials[0].name = "b" + s.materials[0].name;
    });
}

TEST_F(SceneHashTest, SceneHashChangesWithMaterials) {
    expect_new_hash_for_each_component(
        "albedo", [](Scene & s) -> auto& { return s.materials.back().albedo; });
    expect_new_hash_for_each_component(
        "emission", [](Scene & s) -> auto& { return s.materials.back().emission; });
    expect_new_hash_for_each_component(
        "reflectance", [](Scene & s) -> auto& { return s.materials.back().reflectance; });
    expect_new_hash("mirror",
                    [](Scene& s) { s.materials.back().mirror = !s.materials.back().mirror; });
    expect_new_hash("sides",
                    [](Scene& s) { s.materials[0].two_sided = !s.materials[0].two_sided; });
    expect_new_hash("name", [](Scene& s) { s.materials.back().name += "'"; });
}

TEST_F(SceneHashTest, SceneHashChangesWithObjects) {
    expect_new_hash("name", [](Scene& s) { s.objects[6].name = "other"; });
    expect_new_hash("mesh", [](Scene& s) { s.objects[6].mesh = 0; });
    expect_new_hash("material", [](Scene& s) { s.objects[6].material = 0; });
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            expect_new_hash(
                "place", [&](Scene& s) { s.objects.back().world_from_object[column][row] += .5; });
    expect_new_hash("no sphere", [](Scene& s) { s.objects[6].sphere.reset(); });
    expect_new_hash_for_each_component(
        "centre", [](Scene & s) -> auto& { return s.objects[6].sphere->centre; });
    expect_new_hash("radius", [](Scene& s) { s.objects[6].sphere->radius += 1; });
    expect_new_hash("seen", [](Scene& s) { s.objects[6].seen_by_camera = false; });
    EXPECT_TRUE(hashes_.insert(hash_scene(make_closed_cornell())).second);
}

TEST_F(SceneHashTest, SceneHashChangesWithMotions) {
    expect_new_hash("none", [](Scene& s) { s.objects[7].motion = {}; });
    expect_new_hash("harmonic", [](Scene& s) {
        s.objects[7].motion = HarmonicMotion{{0, 50, 0}, 5};
    });
    expect_new_hash("period", [](Scene& s) {
        s.objects[7].motion = HarmonicMotion{{0, 50, 0}, 6};
    });
    for (int i = 0; i < 3; ++i)
        expect_new_hash("amplitude", [&](Scene& s) {
            HarmonicMotion motion{{1, 50, 1}, 5};
            motion.amplitude[i] = 9;
            s.objects[7].motion = motion;
        });
    expect_new_hash_of_keys("kind", [](TranslationTrack& keys) {
        keys.interpolation = TranslationTrack::Interpolation::linear;
    });
    expect_new_hash_of_keys("time", [](TranslationTrack& keys) { keys.times[1] = 2; });
    expect_new_hash_of_keys("value", [](TranslationTrack& keys) { keys.values[1].z = 9; });
    expect_new_hash_of_keys("in", [](TranslationTrack& keys) { keys.in_tangents[1].z = 9; });
    expect_new_hash_of_keys("out", [](TranslationTrack& keys) { keys.out_tangents[1].z = 9; });
    expect_new_hash_for_each_component(
        "rest", [](Scene & s) -> auto& { return motion_of_scene(s).rest; });
    for (int column = 0; column < 3; ++column)
        expect_new_hash_for_each_component(
            "turn", [&](Scene & s) -> auto& { return motion_of_scene(s).world_from_keys[column]; });
}

TEST_F(SceneHashTest, SceneHashChangesWithCameras) {
    expect_new_hash_for_each_component(
        "eye", [](Scene & s) -> auto& { return s.cameras[0].eye; });
    expect_new_hash_for_each_component(
        "target", [](Scene & s) -> auto& { return s.cameras[0].target; });
    expect_new_hash_for_each_component(
        "up", [](Scene & s) -> auto& { return s.cameras[0].up; });
    expect_new_hash("angle", [](Scene& s) { s.cameras[0].vertical_fov_degrees = 38; });
    expect_new_hash("name", [](Scene& s) { s.cameras[0].name += "'"; });
    expect_new_hash("another", [](Scene& s) { s.cameras.push_back(s.cameras[0]); });
}

/// The hash uses the values of animation keys, not their address, so a copied file has the same
/// hash.
TEST_F(SceneHashTest, SceneHashIgnoresNameFilesAndWarnings) {
    const std::string whole = hash_scene(scene_);
    EXPECT_EQ(whole.size(), 16u);
    Scene copy = scene_;
    copy.name = "copy";
    copy.warnings = {"a warning"};
    copy.files = {"/elsewhere/copy.glb"};
    copy.objects[7].motion = Keyframes{
        .keys = std::make_shared<const TranslationTrack>(*motion_of_scene(scene_).keys),
        .world_from_keys = motion_of_scene(scene_).world_from_keys,
        .rest = motion_of_scene(scene_).rest};
    EXPECT_EQ(hash_scene(copy), whole);
}

} // namespace
