// Tests of textured surfaces and materials: rasterisation and ray tracing against known answers and
// against each other.
#include "core/shader_math.hpp"
#include "scene/light.hpp"
#include "shared.h"
#include "support/rendering.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

namespace {

using namespace catoptric;
using glm::dvec2, glm::ivec2;
using scene::Texture;

constexpr const char* kSurfacesWorlds[] = {"naive:bounces=0,shadow_map=512", "raytrace"};

/// Converts an sRGB value (IEC 61966-2-1) to linear light.
double srgb_to_linear(double encoded) {
    return encoded <= .04045 ? encoded / 12.92 : std::pow((encoded + .055) / 1.055, 2.4);
}

/// Returns an image of random texels, alpha included.
std::shared_ptr<scene::Image> make_random_image(uvec2 size, std::uint32_t seed) {
    std::mt19937 random(seed);
    auto image = std::make_shared<scene::Image>();
    image->name = "drawn";
    image->size = size;
    for (std::uint32_t i = 0; i < size.x * size.y; ++i)
        image->texels.push_back(static_cast<std::uint32_t>(random()));
    return image;
}

/// Returns the value of a texture at (u, v), computed in doubles.
dvec4 sample_texture_in_double(const Texture& texture, dvec2 uv) {
    const dvec2 at(texture.u_row.x * uv.x + texture.u_row.y * uv.y + texture.u_row.z,
                   texture.v_row.x * uv.x + texture.v_row.y * uv.y + texture.v_row.z);
    const auto wrapped = [](int i, int size, Texture::Wrap wrap) {
        if (wrap == Texture::Wrap::clamp) return std::clamp(i, 0, size - 1);
        const int round = ((i % size) + size) % size;
        const bool is_odd = ((i - round) / size) % 2 != 0;
        return wrap == Texture::Wrap::mirrored && is_odd ? size - 1 - round : round;
    };
    const ivec2 size(texture.image->size);
    const auto texel = [&](int x, int y) {
        const int column = wrapped(x, size.x, texture.wrap_u),
                  row = wrapped(y, size.y, texture.wrap_v);
        const std::uint32_t bits =
            texture.image->texels[static_cast<std::size_t>(row * size.x + column)];
        dvec4 value;
        for (int c = 0; c < 4; ++c) {
            value[c] = static_cast<double>(bits >> (8 * c) & 255u) / 255;
            if (texture.srgb && c < 3) value[c] = srgb_to_linear(value[c]);
        }
        return value;
    };
    const dvec2 place = at * dvec2(size) - (texture.nearest ? 0.0 : .5), low = glm::floor(place),
                share = place - low;
    const ivec2 i(low);
    if (texture.nearest) return texel(i.x, i.y);
    return glm::mix(glm::mix(texel(i.x, i.y), texel(i.x + 1, i.y), share.x),
                    glm::mix(texel(i.x, i.y + 1), texel(i.x + 1, i.y + 1), share.x), share.y);
}

/// Returns a camera in front of the unit square at z = 0, which fills the picture. (u, v) = (0, 0)
/// is at the top left.
scene::Camera make_camera_before_square() {
    const double degrees = 2 * glm::degrees(std::atan(.5));
    return {.name = "before",
            .eye = {.5, .5, 1},
            .target = {.5, .5, 0},
            .vertical_fov_degrees = degrees};
}

/// Returns the unit square with texture coordinates from `low` to `high`, v downwards.
scene::Mesh make_unit_square(vec2 low, vec2 high) {
    scene::Mesh mesh = scene::quad("square", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    mesh.uv[0] = {{low.x, high.y}, {high.x, high.y}, {high.x, low.y}, {low.x, low.y}};
    return mesh;
}

/// Returns a scene of one mesh with a material, in front of the camera.
scene::Scene make_scene_showing_mesh(scene::Mesh mesh, const scene::Material& material) {
    scene::Scene scene{.name = "square"};
    test::add_mesh(scene, std::move(mesh), test::add_material(scene, material));
    scene.cameras.push_back(make_camera_before_square());
    return scene;
}

/// Returns the largest difference of a channel from `wanted(u, v)`, with u and v from 0 to 1.
template <typename Wanted>
double largest_difference_from_formula(const measure::Picture& picture, Wanted&& wanted) {
    double result = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const dvec2 at((x + .5) / picture.width, (y + .5) / picture.height);
            const dvec3 difference = abs(dvec3(picture.at(x, y)) - dvec3(wanted(at)));
            result = std::max({result, difference.x, difference.y, difference.z});
        }
    return result;
}

struct TextureCase {
    const char* name;
    Texture::Wrap wrap_u, wrap_v;
    bool nearest, srgb;
    vec3 u_row, v_row;
    friend void PrintTo(const TextureCase& which, std::ostream* out) { *out << which.name; }
};

class Textures : public testing::TestWithParam<TextureCase> {};
constexpr vec3 kTestSquareUAxis{1, 0, 0}, kTestSquareVAxis{0, 1, 0};
using enum Texture::Wrap;
INSTANTIATE_TEST_SUITE_P(
    Kinds, Textures,
    testing::Values(
        TextureCase{"repeated", repeat, repeat, false, false, kTestSquareUAxis, kTestSquareVAxis},
        TextureCase{"mirrored", mirrored, mirrored, false, true, kTestSquareUAxis,
                    kTestSquareVAxis},
        TextureCase{"clamped", clamp, clamp, false, false, kTestSquareUAxis, kTestSquareVAxis},
        TextureCase{"one_of_each", clamp, mirrored, false, true, kTestSquareUAxis,
                    kTestSquareVAxis},
        TextureCase{"nearest", mirrored, repeat, true, true, kTestSquareUAxis, kTestSquareVAxis},
        TextureCase{"turned", repeat, repeat, false, true, {.8f, .6f, .3f}, {-.6f, .8f, -.2f}}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(Textures, TexturesEqualTheDoublePrecisionComputation) {
    const TextureCase& which = GetParam();
    // The image's edges are no powers of two. With 36 pixels, no pixel lies at the centre of a
    // texel of 5 x 3.
    const Texture texture{.image = make_random_image({5, 3}, 7),
                          .wrap_u = which.wrap_u,
                          .wrap_v = which.wrap_v,
                          .nearest = which.nearest,
                          .srgb = which.srgb,
                          .u_row = which.u_row,
                          .v_row = which.v_row};
    const vec2 low(-1.3f, -2.2f), high(2.45f, 1.9f);
    const scene::Scene scene = make_scene_showing_mesh(
        make_unit_square(low, high),
        {.name = "page", .albedo = vec3(1), .unlit = true, .albedo_texture = texture});
    for (const char* world : kSurfacesWorlds) {
        const measure::Picture picture = test::render_technique(scene, world, {36, 36}).hdr;
        int off = 0;
        for (int y = 0; y < 36; ++y)
            for (int x = 0; x < 36; ++x) {
                const dvec2 at((x + .5) / 36, (y + .5) / 36);
                const dvec3 wanted(
                    sample_texture_in_double(texture, glm::mix(dvec2(low), dvec2(high), at)));
                const dvec3 apart = abs(dvec3(picture.at(x, y)) - wanted);
                off += std::max({apart.x, apart.y, apart.z}) > 1e-4;
            }
        // At the border of two texels, rounding decides which one is nearest.
        EXPECT_LE(off, which.nearest ? 4 : 0) << world;
    }
}

TEST(TexelCentres, TexelCentresShowTheirTexels) {
    const Texture texture{.image = make_random_image({8, 8}, 3), .srgb = true};
    const scene::Scene scene = make_scene_showing_mesh(
        make_unit_square({0, 0}, {1, 1}),
        {.albedo = {1, .5f, .25f}, .unlit = true, .albedo_texture = texture});
    for (const char* world : kSurfacesWorlds) {
        const measure::Picture picture = test::render_technique(scene, world, {8, 8}).hdr;
        for (int i = 0; i < 64; ++i) {
            const std::uint32_t texel = texture.image->texels[static_cast<std::size_t>(i)];
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(picture.at(i % 8, i / 8)[c],
                            srgb_to_linear((texel >> (8 * c) & 255u) / 255.0) / (1 << c), 2e-5)
                    << world << ' ' << i;
        }
    }
}

TEST(SecondTextureSpace, SecondSetOfTextureCoordinatesIsUsed) {
    scene::Mesh mesh = make_unit_square({0, 0}, {1, 1});
    // In the second set of coordinates, u increases upwards.
    mesh.uv[1] = {{0, 0}, {0, 0}, {1, 0}, {1, 0}};
    const Texture texture{.image = make_random_image({4, 1}, 5), .wrap_u = clamp, .uv_set = 1};
    const scene::Scene scene = make_scene_showing_mesh(
        mesh, {.albedo = vec3(1), .unlit = true, .albedo_texture = texture});
    for (const char* world : kSurfacesWorlds)
        EXPECT_LE(largest_difference_from_formula(
                      test::render_technique(scene, world, {16, 16}).hdr,
                      [&](dvec2 at) {
                          return sample_texture_in_double(texture, {1 - at.y, .5});
                      }),
                  1e-4)
            << world;
}

TEST(VertexColours, VertexColoursAreInterpolatedAndMultiplied) {
    scene::Mesh mesh = make_unit_square({0, 0}, {1, 1});
    mesh.colours = {{1, 0, 0, 1}, {1, 0, 1, 1}, {1, 1, 1, 1}, {1, 1, 0, 1}};
    const scene::Scene scene = make_scene_showing_mesh(mesh,
                                                       {.albedo = {.5f, 1, 1}, .unlit = true});
    for (const char* world : kSurfacesWorlds)
        EXPECT_LE(
            largest_difference_from_formula(test::render_technique(scene, world, {16, 16}).hdr,
                                            [](dvec2 at) { return dvec3(.5, 1 - at.y, at.x); }),
            1e-5)
            << world;
}

/// An emission texture is visible but lights nothing. It must not affect the light of other
/// objects.
TEST(EmissionTexture, EmissionTextureIsVisibleAndLightsNothing) {
    const Texture texture{.image = make_random_image({4, 4}, 9)};
    scene::Scene scene = make_scene_showing_mesh(
        make_unit_square({0, 0}, {1, 1}), {.emission = {2, 3, 4}, .emission_texture = texture});
    EXPECT_TRUE(scene::list_lights(scene).empty());
    for (const char* world : kSurfacesWorlds)
        EXPECT_LE(largest_difference_from_formula(
                      test::render_technique(scene, world, {16, 16}).hdr,
                      [&](dvec2 at) {
                          return dvec3(2, 3, 4) * dvec3(sample_texture_in_double(texture, at));
                      }),
                  4e-4)
            << world;
    scene.materials[0].light = vec3(1);
    EXPECT_EQ(scene::list_lights(scene).size(), 1u);
}

/// A smooth floor in a box of constant radiance must reflect the share R of that radiance by
/// Schlick's formula. The rest, 1 - R, is its diffuse ambient light.
TEST(SharpSurfaces, ReflectanceFollowsSchlick) {
    struct MaterialTestCase {
        vec3 colour;
        float metallic;
        vec3 f0;
        bool away = false; ///< the floor has one side and is seen from behind
    };
    for (const MaterialTestCase& each : {MaterialTestCase{{.8f, .5f, .2f}, 1, vec3(.04f)},
                                         MaterialTestCase{{.8f, .5f, .2f}, 1, vec3(.04f), true},
                                         MaterialTestCase{{.8f, .5f, .2f}, 0, vec3(.25f)},
                                         MaterialTestCase{{.6f, .6f, .6f}, .5f, {.1f, .2f, .3f}}}) {
        scene::Scene scene = test::make_furnace_scene(1);
        scene.objects.pop_back();           // remove the mirror ball
        scene.materials[0].light = vec3(0); // the box is visible but lights nothing
        const std::size_t floor = test::add_material(scene, {.name = "floor",
                                                             .albedo = each.colour,
                                                             .metallic = each.metallic,
                                                             .roughness = .04f,
                                                             .dielectric_f0 = each.f0,
                                                             .dielectric_f90 = vec3(1)});
        const double left = each.away ? 4 : -4;
        test::add_quad(scene, "floor", floor, {left, -2, -5}, {left, -2, 5}, {-left, -2, 5},
                       {-left, -2, -5});
        scene.objects.back().mirror = true;
        scene.cameras.front() = {
            .eye = {0, 0, -4}, .target = {0, -2, 0}, .vertical_fov_degrees = 60};
        const vec3 c = each.colour;
        const vec3 f0 = glm::mix(each.f0, c, each.metallic);
        for (const char* technique : {"raytrace", "reuse:face=64", "hybrid:face=64"}) {
            const session::TechniqueResult part = test::render_technique(scene, technique, {32, 32},
                                                                         3);
            double off = 0;
            int seen = 0;
            for (int y = 0; y < 32; ++y)
                for (int x = 0; x < 32; ++x) {
                    const double tangent = std::tan(std::numbers::pi / 6);
                    const dvec3 forward = glm::normalize(dvec3(0, -2, 4)),
                                right = glm::normalize(glm::cross(forward, dvec3(0, 1, 0))),
                                up = glm::cross(right, forward);
                    const dvec3 ray = glm::normalize(
                        forward + tangent * ((x - 15.5) / 16 * right - (y - 15.5) / 16 * up));
                    const double t = ray.y < 0 ? -2 / ray.y : 1e9;
                    if (std::abs(t * ray.x) > 3.9 || t * ray.z > 8.9) continue;
                    ++seen;
                    const double away = std::pow(1 + ray.y, 5);
                    for (int i = 0; i < 3; ++i) {
                        const double r = f0[i] + (1 - f0[i]) * away;
                        const double wanted = (1 - r) * c[i] * (1 - each.metallic) *
                                                  .05 + // diffuse part, lit by ambient light only
                                              r * test::kFurnaceWallRadiance[i];
                        off = std::max(off, std::abs(part.hdr.at(x, y)[i] - wanted));
                    }
                }
            EXPECT_GT(seen, 200);
            EXPECT_LE(off, 1e-3) << technique << ' ' << each.metallic << ' ' << each.away;
        }
    }
}

/// A mirror that emits light must show its own light, seen directly and in a mirror. The mirror is
/// tilted so that it reflects only darkness.
TEST(GlowingMirror, GlowingMirrorShowsItsOwnLight) {
    const vec3 glow(.25f, .5f, 1);
    for (const bool in_mirror : {false, true}) {
        scene::Scene scene = make_scene_showing_mesh(
            make_unit_square({0, 0}, {1, 1}),
            {.emission = in_mirror ? vec3(0) : glow, .mirror = true, .reflectance = vec3(1)});
        if (in_mirror)
            test::add_quad(scene, "behind the eye",
                           test::add_material(
                               scene, {.emission = glow, .mirror = true, .reflectance = vec3(.5f)}),
                           {-12, -4, 3}, {-12, 12, 19}, {13, 12, 19}, {13, -4, 3});
        for (const char* technique : {"raytrace", "reuse:face=64", "secant:face=64,continue=4",
                                      "hybrid:face=64,continue=4"})
            EXPECT_LE(largest_difference_from_formula(
                          test::render_technique(scene, technique, {16, 16}, 3).hdr,
                          [&](dvec2) { return dvec3(glow); }),
                      in_mirror ? 2e-3 : 1e-6)
                << technique << ' ' << in_mirror;
    }
}

/// Returns a scene of a board above a floor, lit by a small lamp. The left half of the board's
/// texture is transparent, so with `cutoff` above 0 the board has a hole there.
scene::Scene make_scene_with_cut_out_board(float cutoff) {
    scene::Scene scene{.name = "hole"};
    auto halves = std::make_shared<scene::Image>();
    halves->name = "halves", halves->size = {2, 1}, halves->texels = {0x00ffffffu, 0xffffffffu};
    test::add_quad(scene, "floor", test::add_material(scene, {.albedo = vec3(.5f)}), {-2, 0, 2},
                   {2, 0, 2}, {2, 0, -2}, {-2, 0, -2});
    scene::Mesh board = scene::quad("board", {-1, .5, 1}, {1, .5, 1}, {1, .5, -1}, {-1, .5, -1});
    board.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    test::add_mesh(
        scene, board,
        test::add_material(scene, {.albedo = vec3(1),
                                   .alpha_cutoff = cutoff,
                                   .albedo_texture = Texture{.image = halves, .nearest = true}}));
    test::add_quad(scene, "lamp", test::add_material(scene, {.emission = vec3(400)}),
                   {-.05, 2, -.05}, {.05, 2, -.05}, {.05, 2, .05}, {-.05, 2, .05});
    scene.cameras.push_back(
        {.eye = {0, 8, .001}, .target = {0, 0, 0}, .up = {0, 0, -1}, .vertical_fov_degrees = 30});
    return scene;
}

TEST(CutOut, CutOutPartIsInvisibleAndCastsNoShadow) {
    // Through the hole in the cut-out quad, a camera above sees the lit floor.
    for (const char* world : kSurfacesWorlds) {
        const measure::Picture
            cut = test::render_technique(make_scene_with_cut_out_board(.5f), world, {32, 32}).hdr,
            whole = test::render_technique(make_scene_with_cut_out_board(0), world, {32, 32}).hdr;
        scene::Scene without = make_scene_with_cut_out_board(.5f);
        without.objects.erase(without.objects.begin() + 1);
        const measure::Picture open = test::render_technique(without, world, {32, 32}).hdr;
        EXPECT_LE(glm::length(cut.at(12, 16) - open.at(12, 16)), 1e-5) << world;
        EXPECT_LE(glm::length(cut.at(20, 16) - whole.at(20, 16)), 1e-5) << world;
        EXPECT_GT(glm::length(cut.at(12, 16) - whole.at(12, 16)), .01) << world;
        // The shadow of the board is 1.3 times as large as the board. These pixels show the floor
        // to the left and right of the board.
        EXPECT_LE(glm::length(cut.at(7, 16) - open.at(7, 16)), 1e-5) << world;
        EXPECT_LE(glm::length(cut.at(25, 16) - whole.at(25, 16)), 1e-5) << world;
        EXPECT_GT(open.at(25, 16).x, 1.5f * whole.at(25, 16).x) << world;
    }
}

/// Eye and lamp are on the same side of a board. If `away` is true, the front of the board faces
/// away from eye and lamp.
TEST(Sides, SidesAreSeenAndLitAsTheMaterialSays) {
    const auto board = [](bool front_only, bool two_sided, bool away) {
        scene::Mesh mesh = make_unit_square({0, 0}, {1, 1});
        if (away) {
            for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
            for (vec3& normal : mesh.normals) normal = -normal;
        }
        scene::Scene scene = make_scene_showing_mesh(
            mesh, {.albedo = vec3(.5f), .two_sided = two_sided, .front_only = front_only});
        test::add_quad(scene, "lamp", test::add_material(scene, {.emission = vec3(200)}),
                       {.4, 1.4, 1}, {.4, 1.6, 1}, {.6, 1.6, 1}, {.6, 1.4, 1});
        return scene;
    };
    for (const char* world : kSurfacesWorlds) {
        const auto colour = [&](bool front_only, bool two_sided, bool away) {
            return test::render_technique(board(front_only, two_sided, away), world, {8, 8})
                .hdr.at(3, 4)
                .x;
        };
        const float lit = colour(false, false, false);
        EXPECT_GT(lit, .1f) << world;
        // This side of the board is lit by ambient light only.
        EXPECT_FLOAT_EQ(colour(false, false, true), .5f * .05f) << world;
        EXPECT_NEAR(colour(false, true, true), lit, 1e-5) << world;
        EXPECT_NEAR(colour(false, true, false), lit, 1e-5) << world;
        EXPECT_NEAR(colour(true, false, false), lit, 1e-5) << world;
        EXPECT_EQ(colour(true, false, true), 0) << world;
    }
}

/// A board that is invisible from behind must still cast a shadow when lit from behind.
TEST(Sides, OneSidedBoardCastsItsShadowEitherWay) {
    for (const bool away : {false, true}) {
        scene::Scene scene = make_scene_with_cut_out_board(0);
        scene.materials[1].front_only = true;
        scene.materials[1].albedo_texture.reset();
        scene::Mesh& board = scene.meshes[1];
        if (away)
            for (uvec3& triangle : board.triangles) std::swap(triangle.y, triangle.z);
        scene::Scene without = scene;
        without.objects.erase(without.objects.begin() + 1);
        for (const char* world : kSurfacesWorlds)
            EXPECT_LT(test::render_technique(scene, world, {32, 32}).hdr.at(25, 16).x,
                      .6f * test::render_technique(without, world, {32, 32}).hdr.at(25, 16).x)
                << world << away;
    }
}

/// Returns a room with random objects of all kinds of materials.
scene::Scene make_room_of_random_materials(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    scene::Scene scene = test::make_lit_room(0, 2);
    scene.name = "motley";
    for (int k = 0; k < 10; ++k) {
        scene::Mesh mesh = scene::ball("thing " + std::to_string(k), 3);
        for (const vec3& n : mesh.normals) {
            mesh.uv[0].push_back({std::atan2(n.z, n.x) / 2, n.y * 2});
            if (k % 3 == 0) mesh.colours.push_back(vec4(abs(n), 1));
        }
        scene::Material material{.name = mesh.name,
                                 .albedo = vec3(real(.2, 1), real(.2, 1), real(.2, 1)),
                                 .two_sided = k % 2 == 0,
                                 .front_only = k % 5 == 1};
        if (k % 2)
            material.albedo_texture = Texture{.image = make_random_image({4, 4}, seed + k),
                                              .srgb = true};
        if (k % 4 == 1) material.alpha_cutoff = .5f;
        if (k % 4 != 2) material.dielectric_f0 = vec3(.04f), material.dielectric_f90 = vec3(1);
        if (k % 5 == 3)
            material.normal_texture = Texture{.image = make_random_image({2, 2}, seed + 9 * k)};
        if (k % 4 == 2) material.roughness = .04f, material.metallic = float(k % 8 == 2);
        if (k % 4 == 3)
            material.roughness_texture = Texture{.image = make_random_image({2, 2}, seed + k)};
        test::add_mesh(scene, mesh, test::add_material(scene, material));
        scene::Object& object = scene.objects.back();
        const double size = real(.15, .5);
        object.world_from_object = dmat4(
            dvec4(size, 0, 0, 0), dvec4(0, real(.5, 1) * size, 0, 0), dvec4(0, 0, size, 0),
            dvec4(real(-1.3, 1.3), real(-1.6, 1.2), real(-.8, 1.5), 1));
        object.mirror = k % 4 == 2;
    }
    return scene;
}

/// Compares rasterisation with ray tracing. Leaves out mirrors, smooth surfaces, and pixels whose
/// neighbours have another colour, which includes edges of objects and shadows.
TEST(Worlds, RasterisationEqualsRayTracingOnAllMaterials) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const scene::Scene scene = make_room_of_random_materials(seed);
        const uvec2 size{96, 96};
        const session::TechniqueResult raster = test::render_technique(
                                           scene, "hybrid:face=64,shadow_map=1024", size, 3),
                                       rays = test::render_technique(
                                           scene, "raytrace:shadow=map,shadow_map=1024", size);
        int off = 0, judged = 0;
        const auto hit = [&](int x, int y) { return rays.hits[std::size_t(y) * size.x + x]; };
        for (int y = 1; y < 95; ++y)
            for (int x = 1; x < 95; ++x) {
                if (hit(x, y) != 0 && hit(x, y) != shared::kHitRoughNonMirror << 16) continue;
                vec3 low(1e9f), high(0);
                for (int k = 0; k < 9; ++k) {
                    const vec3 colour = rays.hdr.at(x + k % 3 - 1, y + k / 3 - 1);
                    low = min(low, colour), high = max(high, colour);
                }
                if (f32::largest_vector_component(high - low) > .1f)
                    continue; // skip pixels at an edge
                ++judged;
                off += f32::largest_vector_component(abs(raster.hdr.at(x, y) - rays.hdr.at(x, y))) >
                       .02f;
            }
        EXPECT_GT(judged, 4000);
        EXPECT_LE(off, judged / 200) << seed;
        std::cout << "[ MEASURED ] " << off << " of " << judged << '\n';
    }
}

/// Copies of a textured mesh, kept in object spaces, must look like single meshes.
TEST(Copies, TexturedCopiesEqualSingleMeshes) {
    scene::Scene scene = test::make_lit_room(0, 1);
    scene::Mesh mesh = scene::ball("copy", 4);
    for (const vec3& n : mesh.normals) mesh.uv[0].push_back({n.x * 3, n.y * 3});
    const std::size_t material = test::add_material(
        scene, {.albedo = vec3(1),
                .front_only = true,
                .alpha_cutoff = .4f,
                .albedo_texture = Texture{.image = make_random_image({8, 8}, 11), .srgb = true}});
    scene.meshes.push_back(mesh);
    scene::Scene single = scene;
    for (int i = 0; i < 150; ++i) {
        scene::Object object{.name = "copy", .mesh = scene.meshes.size() - 1, .material = material};
        object.world_from_object = dmat4(.1);
        object.world_from_object[3] = dvec4(-1.5 + .3 * (i % 10), -1.6 + .25 * (i / 10), .5, 1);
        scene.objects.push_back(object);
        if (i % 50 == 0) single.meshes.push_back(mesh);
        object.mesh = single.meshes.size() - 1;
        single.objects.push_back(object);
    }
    for (const char* world : kSurfacesWorlds) {
        const measure::Picture a = test::render_technique(scene, world, {64, 64}).hdr,
                               b = test::render_technique(single, world, {64, 64}).hdr;
        int off = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            off += f32::largest_vector_component(abs(a.pixels[i] - b.pixels[i])) > .02f;
        EXPECT_LE(off, 20) << world;
    }
}

} // namespace
