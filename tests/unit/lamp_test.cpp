// Tests of the light from lamps of several shapes, read from files, against closed-form solutions.
#include "load_fixture.hpp"
#include "scene/build.hpp"
#include "scene/light.hpp"
#include "scene/topology.hpp"
#include "support/special_values.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

namespace {

using namespace test::loading;

/// Builds a surface of revolution with rings at the given (radius, height). A ring of radius 0
/// closes an end. Triangles share no vertices, not even where a ring begins and ends.
Mesh make_surface_of_revolution(const std::vector<dvec2>& profile, int around) {
    Mesh mesh{.name = "lamp"};
    const auto place = [&](std::size_t ring, int k) {
        const double turn = k == around ? 2 * test::kPi : 2 * test::kPi * k / around;
        return dvec3(profile[ring].x * std::cos(turn), profile[ring].y,
                     profile[ring].x * std::sin(turn));
    };
    const auto add = [&](const dvec3& a, const dvec3& b, const dvec3& c) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c});
        mesh.normals.insert(mesh.normals.end(), 3,
                            vec3(glm::normalize(glm::cross(b - a, c - a) + dvec3(0, 1e-300, 0))));
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    };
    for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring)
        for (int k = 0; k < around; ++k) {
            const dvec3 a = place(ring, k), b = place(ring, k + 1), c = place(ring + 1, k + 1),
                        d = place(ring + 1, k);
            if (profile[ring].x > 0) add(a, c, b);
            if (profile[ring + 1].x > 0) add(a, d, c);
        }
    return mesh;
}

/// Builds a sphere whose rings are closer together towards the top.
Mesh make_uneven_sphere_mesh(double radius) {
    std::vector<dvec2> profile;
    constexpr int kRingCountOfLamp = 40;
    for (int i = 0; i <= kRingCountOfLamp; ++i) {
        const double angle = test::kPi *
                             (1 - std::pow(double(kRingCountOfLamp - i) / kRingCountOfLamp, 1.6));
        profile.emplace_back(i == 0 || i == kRingCountOfLamp ? 0 : radius * std::sin(angle),
                             -radius * std::cos(angle));
    }
    return make_surface_of_revolution(profile, 64);
}

Mesh make_uneven_cylinder_mesh(double radius, double height) {
    std::vector<dvec2> profile{{0, 0}, {radius, 0}};
    for (int i = 1; i <= 12; ++i) profile.emplace_back(radius, height * std::sqrt(i / 12.0));
    profile.emplace_back(radius / 3, height), profile.emplace_back(0, height);
    return make_surface_of_revolution(profile, 64);
}

/// Builds a box whose top is finely divided around a fan in the centre. Along the rim of the top,
/// the only vertices are the four corners.
Mesh make_uneven_box_mesh(const dvec3& half) {
    Mesh mesh = scene::box("lamp", -half, half);
    std::erase_if(mesh.triangles, [&](const uvec3& t) { return mesh.normals[t.x].y > .5f; });
    const dvec3 rim[] = {{-half.x, half.y, -half.z},
                         {-half.x, half.y, half.z},
                         {half.x, half.y, half.z},
                         {half.x, half.y, -half.z}};
    const auto vertex = [&](const dvec3& p) {
        mesh.positions.push_back(p), mesh.normals.emplace_back(0, 1, 0);
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    const auto inner = [&](int ring, int k) {
        return vertex(dvec3(rim[k % 4].x, 0, rim[k % 4].z) * (ring / 9.0) + dvec3(0, half.y, 0));
    };
    for (int k = 0; k < 4; ++k) {
        for (int ring = 1; ring < 9; ++ring) {
            const std::uint32_t a = inner(ring, k), b = inner(ring, k + 1), c = inner(ring + 1, k),
                                d = inner(ring + 1, k + 1);
            mesh.triangles.emplace_back(a, c, d), mesh.triangles.emplace_back(a, d, b);
        }
        mesh.triangles.emplace_back(vertex({0, half.y, 0}), inner(1, k), inner(1, k + 1));
    }
    mesh.uv[0].clear();
    return mesh;
}

struct ClosedLampMesh {
    const char* name;
    Mesh mesh;
    double area;
};

/// Returns unevenly divided closed lamps.
std::vector<ClosedLampMesh> make_closed_lamps() {
    return {{"sphere", make_uneven_sphere_mesh(.1), 4 * test::kPi * .01},
            {"box", make_uneven_box_mesh({.1, .05, .08}), 8 * (.005 + .008 + .004)},
            {"cylinder", make_uneven_cylinder_mesh(.06, .2), 2 * test::kPi * .06 * (.06 + .2)}};
}

std::string make_obj_text_of_mesh(const Mesh& mesh) {
    std::ostringstream text;
    text.precision(9);
    text << "mtllib lamp.mtl\no lamp\nusemtl lamp\n";
    for (const dvec3& p : mesh.positions) text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    for (const vec3& n : mesh.normals) text << "vn " << n.x << ' ' << n.y << ' ' << n.z << '\n';
    for (const uvec3& t : mesh.triangles) {
        text << 'f';
        for (int i = 0; i < 3; ++i) text << ' ' << t[i] + 1 << "//" << t[i] + 1;
        text << '\n';
    }
    return text.str();
}

std::string make_glb_of_mesh(const Mesh& mesh, bool double_sided) {
    GltfFileBuilder gltf;
    std::vector<float> positions, normals;
    for (const dvec3& p : mesh.positions)
        for (int i = 0; i < 3; ++i) positions.push_back(static_cast<float>(p[i]));
    for (const vec3& n : mesh.normals) normals.insert(normals.end(), {n.x, n.y, n.z});
    std::vector<std::uint32_t> corners;
    for (const uvec3& t : mesh.triangles) corners.insert(corners.end(), {t.x, t.y, t.z});
    const std::size_t position = gltf.add_accessor(positions, "VEC3", 5126),
                      normal = gltf.add_accessor(normals, "VEC3", 5126),
                      indices = gltf.add_accessor(corners, "SCALAR", 5125);
    gltf.root["nodes"] = {{{"name", "lamp"}, {"mesh", 0}}};
    gltf.root["meshes"] = {{{"primitives",
                             {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                               {"indices", indices},
                               {"material", 0}}}}}};
    gltf.root["materials"] = {
        {{"emissiveFactor", {1, 1, 1}},
         {"doubleSided", double_sided},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 30}}}}}}};
    gltf.root["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    return gltf.glb_bytes();
}

/// Returns the irradiance from all lights on a surface at `place` that faces the origin.
double irradiance_at_place(const Scene& scene, const dvec3& place) {
    double sum = 0;
    for (const PointLight& light : list_lights(scene)) {
        const dvec3 way = place - light.position, along = glm::normalize(way);
        sum += light.emission.x * light.area * light_share(light, along) *
               glm::dot(along, glm::normalize(place)) / glm::dot(way, way);
    }
    return sum;
}

double mean_over_six_axes(const std::function<double(dvec3)>& towards) {
    double sum = 0;
    for (int i = 0; i < 6; ++i) {
        dvec3 direction(0);
        direction[i / 2] = i % 2 == 0 ? 1 : -1;
        sum += towards(direction) / 6;
    }
    return sum;
}

class Lamps : public Load {
protected:
    /// Loads the mesh as a lamp from each kind of file: OBJ, one-sided GLB and two-sided GLB.
    std::vector<std::pair<std::string, Scene>> load_lamp_scenes(const Mesh& mesh) {
        write_loaded_file("lamp.mtl", "newmtl lamp\nKd 0 0 0\nKe 30 30 30\n");
        return {{"obj", load(write_loaded_file("lamp.obj", make_obj_text_of_mesh(mesh)))},
                {"one side", load(write_loaded_file("one.glb", make_glb_of_mesh(mesh, false)))},
                {"two sides", load(write_loaded_file("two.glb", make_glb_of_mesh(mesh, true)))}};
    }
};

TEST_F(Lamps, ClosedLampsShineLikeAQuarterOfTheirSurface) {
    constexpr double kDistanceFromLamp = 2;
    for (const auto& [name, mesh, area] : make_closed_lamps())
        for (const auto& [how, scene] : load_lamp_scenes(mesh)) {
            ASSERT_EQ(list_lights(scene).size(), 1u) << name << ", " << how;
            EXPECT_TRUE(list_lights(scene)[0].closed) << name << ", " << how;
            const dvec3 centre = bounds(scene).centre();
            const double found = mean_over_six_axes([&](const dvec3& direction) {
                return irradiance_at_place(scene, kDistanceFromLamp * direction);
            });
            EXPECT_NEAR(found / (30 * area / 4 / (kDistanceFromLamp * kDistanceFromLamp)), 1, .02)
                << name << ", " << how;
            EXPECT_LT(glm::length(centre), .11);
        }
}

/// Returns the form factor of the rectangle [0,x] x [0,z] at height 1, seen from a surface at the
/// origin that faces it. Negative for one negative side (Siegel and Howell, "Thermal Radiation Heat
/// Transfer", configuration 1).
double corner_form_factor(double x, double z) {
    const double a = std::sqrt(1 + x * x), b = std::sqrt(1 + z * z);
    return (x / a * std::atan(z / a) + z / b * std::atan(x / b)) / (2 * test::kPi);
}

/// Tests a square lamp close to a plane. Many sample points must light the plane as the whole
/// square does. A single point does not.
TEST_F(Lamps, SampledSquareLightsAPlaneByItsFormFactor) {
    const Mesh board = scene::quad("lamp", {-.5, 1, -.5}, {.5, 1, -.5}, {.5, 1, .5}, {-.5, 1, .5});
    for (const bool two_sided : {false, true}) {
        Scene scene = load(write_loaded_file("lamp.glb", make_glb_of_mesh(board, two_sided)));
        const auto largest_error = [&](int samples) {
            scene.light_samples = samples;
            EXPECT_EQ(list_lights(scene).size(), static_cast<std::size_t>(samples));
            double most = 0;
            for (const double x : {0.0, .3, .8, 1.5})
                for (const double z : {0.0, .6, 1.1}) {
                    const double wanted = corner_form_factor(.5 - x, .5 - z) -
                                          corner_form_factor(-.5 - x, .5 - z) -
                                          corner_form_factor(.5 - x, -.5 - z) +
                                          corner_form_factor(-.5 - x, -.5 - z);
                    double found = 0;
                    for (const PointLight& light : list_lights(scene)) {
                        const dvec3 way = dvec3(x, 0, z) - light.position,
                                    along = glm::normalize(way);
                        found += light.area * light_share(light, along) * -along.y /
                                 glm::dot(way, way) / test::kPi;
                    }
                    most = std::max(most, std::abs(found - wanted));
                }
            return most;
        };
        EXPECT_GT(largest_error(1), .03) << two_sided;
        EXPECT_LT(largest_error(64), .002) << two_sided;
    }
}

/// For a lamp of any shape, all sample points must lie on its surface, share its area equally, and
/// shine outwards.
TEST_F(Lamps, SampledClosedLampsShineLikeTheirClosedForms) {
    constexpr double kDistanceFromLamp = 2;
    for (const auto& [name, mesh, area] : make_closed_lamps())
        for (auto& [how, scene] : load_lamp_scenes(mesh)) {
            scene.light_samples = 128;
            double total = 0;
            for (const PointLight& light : list_lights(scene)) {
                total += light.area;
                EXPECT_GT(glm::dot(light.normal, light.position - bounds(scene).centre()), 0)
                    << name << ", " << how;
            }
            EXPECT_NEAR(total / area, 1, .01) << name << ", " << how;
            // Over all directions, a convex body shows a quarter of its surface.
            constexpr int kDirectionCount = 400;
            double found = 0;
            for (int i = 0; i < kDirectionCount; ++i) {
                const double y = 1 - (2 * i + 1.) / kDirectionCount, turn = 2.399963 * i,
                             flat = std::sqrt(1 - y * y);
                found += irradiance_at_place(scene,
                                             kDistanceFromLamp * dvec3(flat * std::cos(turn), y,
                                                                       flat * std::sin(turn))) /
                         kDirectionCount;
            }
            EXPECT_NEAR(found / (30 * area / 4 / (kDistanceFromLamp * kDistanceFromLamp)), 1, .03)
                << name << ", " << how;
        }
}

TEST_F(Lamps, OpenTwoSidedBoardShinesByItsVisibleArea) {
    const Mesh board = scene::quad("lamp", {-.1, .02, -.1}, {-.1, .02, .1}, {.1, .02, .1},
                                   {.1, .02, -.1});
    const Scene scene = load(write_loaded_file("two.glb", make_glb_of_mesh(board, true)));
    ASSERT_EQ(list_lights(scene).size(), 1u);
    const PointLight light = list_lights(scene)[0];
    EXPECT_FALSE(light.closed);
    for (const dvec3& along :
         {dvec3(0, 1, 0), dvec3(0, -1, 0), dvec3(.6, .8, 0), dvec3(0, -.6, .8), dvec3(1, 0, 0)})
        EXPECT_NEAR(light_share(light, along), std::abs(along.y), 1e-7);
    const Scene one = load(write_loaded_file("one.glb", make_glb_of_mesh(board, false)));
    EXPECT_NEAR(light_share(list_lights(one)[0], {.6, .8, 0}), .8, 1e-7);
    EXPECT_EQ(light_share(list_lights(one)[0], {.6, -.8, 0}), 0);
}

TEST_F(Lamps, OpenTwoSidedTubeShinesByTheMeanCosineOfItsFacets) {
    const Scene scene = load(write_loaded_file(
        "two.glb",
        make_glb_of_mesh(make_surface_of_revolution({{.05, -.1}, {.05, .1}}, 64), true)));
    ASSERT_EQ(list_lights(scene).size(), 1u);
    // A facet at the angle a around the tube covers |cos a| times the sine of the angle between
    // view direction and axis. The mean of |cos a| over a full turn is 2 / pi.
    for (const double angle : {0.0, .4, .9, test::kPi / 2})
        EXPECT_NEAR(light_share(list_lights(scene)[0], {std::sin(angle), std::cos(angle), 0}),
                    2 / test::kPi * std::sin(angle), 1e-3);
}

TEST_F(Lamps, SphereWithAHoleIsAnOpenLamp) {
    Mesh mesh = make_uneven_sphere_mesh(.1);
    mesh.triangles.pop_back();
    for (const auto& [how, scene] : load_lamp_scenes(mesh)) {
        ASSERT_EQ(list_lights(scene).size(), 1u) << how;
        EXPECT_FALSE(list_lights(scene)[0].closed) << how;
    }
    // The sphere with a hole shines almost equally in all directions. Its inside shines out
    // through the hole, too, so the lamp is as bright as half of its surface seen head-on.
    const Scene two = load(write_loaded_file("two.glb", make_glb_of_mesh(mesh, true)));
    EXPECT_NEAR(mean_over_six_axes(
                    [&](const dvec3& along) { return light_share(list_lights(two)[0], along); }),
                .5, .01);
}

TEST(Topology, PositionsWithinRoundingErrorsAreMerged) {
    const std::vector<dvec3> places{{1, 0, 0},     {1, 1e-17, -1e-17}, {1 + 2e-7, 0, 0},
                                    {1.01, 0, 0},  {1, 2e-6, 0},       {0, 0, 0},
                                    {0, -1e-9, 0}, {1, 0, 0}};
    EXPECT_THAT(weld_vertices(places), testing::ElementsAre(0, 0, 0, 3, 4, 5, 5, 0));
    EXPECT_TRUE(weld_vertices({}).empty());
    EXPECT_THAT(weld_vertices(std::vector(3, dvec3(0))), testing::ElementsAre(0, 0, 0));
}

TEST(Topology, TriangleWithARepeatedCornerHasNoSides) {
    const std::vector<TriangleCorners> triangles{{0, 1, 2}, {2, 1, 1}, {3, 1, 2}};
    const std::vector<TriangleEdge> sides = triangle_edges(triangles);
    EXPECT_EQ(sides.size(), 6u);
    std::size_t shared = 0;
    for_each_edge(sides, [&](std::span<const TriangleEdge> edge) { shared += edge.size() == 2; });
    EXPECT_EQ(shared, 1u);
}

} // namespace
