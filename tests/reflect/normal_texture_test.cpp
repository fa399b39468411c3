// Tests of normal maps, rasterised and ray traced, against formulas.
#include "support/rendering.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <memory>

namespace {

using namespace catoptric;

constexpr uvec2 kTiltedPictureSize{16, 16};
constexpr const char* kTiltedWorlds[] = {"naive:bounces=0", "raytrace", "raytrace:hit=f64"};

std::shared_ptr<scene::Image> make_one_texel_image(std::uint32_t red, std::uint32_t green,
                                                   std::uint32_t blue) {
    auto image = std::make_shared<scene::Image>();
    image->name = "normals", image->size = {1, 1};
    image->texels = {red | green << 8 | blue << 16 | 0xff000000U};
    return image;
}

/// Returns a square at z = 0 that faces the camera, with texture coordinates u to the right and v
/// down, lit along `light`.
scene::Scene make_lit_square(const dvec3& light) {
    scene::Scene scene{.name = "square"};
    const std::size_t material = test::add_material(scene, {.name = "paint", .albedo = vec3(.8f)});
    scene::Mesh square = scene::quad("square", {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    square.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    test::add_mesh(scene, square, material);
    scene::PunctualLight sun{
        .name = "sun", .kind = scene::PunctualLight::Kind::directional, .intensity = vec3(2)};
    const dvec3 back = -glm::normalize(light),
                right = glm::normalize(glm::cross({.1, 1, .2}, back));
    sun.world_from_light = dmat4(dvec4(right, 0), dvec4(glm::cross(back, right), 0), dvec4(back, 0),
                                 dvec4(0, 0, 0, 1));
    scene.punctual.push_back(sun);
    scene.cameras.push_back(
        {.eye = {0, 0, 4}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = 20});
    return scene;
}

measure::Picture render_normal_texture_scene(const scene::Scene& scene,
                                             const std::string& technique) {
    session::Request asked = test::make_test_request(scene, {technique}, kTiltedPictureSize);
    asked.ambient = 0;
    return session::run(test::get_test_engine(), asked).parts.front().hdr;
}

/// Returns the diffuse radiance of a surface with this normal.
double expected_diffuse_radiance(const dvec3& normal, const dvec3& light) {
    return .8 / 3.14159265358979 * 2 *
           std::max(0., -glm::dot(glm::normalize(normal), glm::normalize(light)));
}

TEST(NormalTexture, FlatMapChangesNoPixel) {
    scene::Scene plain = make_lit_square({-.3, -.4, -1});
    // Both compared scenes have a texture, so that the shaders run the same code for both.
    plain.materials[0].albedo_texture = scene::Texture{
        .image = make_one_texel_image(255, 255, 255)};
    scene::Scene mapped = plain;
    mapped.materials[0].normal_texture = scene::Texture{
        .image = make_one_texel_image(128, 128, 255)};
    for (const char* world : kTiltedWorlds)
        EXPECT_EQ(render_normal_texture_scene(mapped, world).pixels,
                  render_normal_texture_scene(plain, world).pixels)
            << world;
}

/// The red channel of a normal map bends the normal along u, and the green channel bends it against
/// v, for any rotation of the texture on the square.
TEST(NormalTexture, RedBendsAlongUAndGreenAgainstV) {
    struct NormalTextureCase {
        std::uint32_t red, green, blue;
        dvec2 u, v; ///< directions on the square in which u and v grow
        float scale = 1;
    };
    const dvec3 light{-.3, -.5, -1};
    for (const NormalTextureCase& each :
         {NormalTextureCase{200, 128, 230, {1, 0}, {0, -1}},
          NormalTextureCase{128, 60, 230, {1, 0}, {0, -1}},
          NormalTextureCase{200, 160, 230, {-1, 0}, {0, -1}}, // mirrored
          NormalTextureCase{200, 160, 230, {0, 1}, {1, 0}},   // turned
          NormalTextureCase{200, 90, 230, {1, 0}, {0, -1}, .5f}}) {
        scene::Scene scene = make_lit_square(light);
        scene::Mesh& mesh = scene.meshes[scene.objects[0].mesh];
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const dvec2 place(mesh.positions[i].x, mesh.positions[i].y);
            mesh.uv[0][i] = vec2(glm::dot(place, each.u), glm::dot(place, each.v));
        }
        scene.materials[0].normal_texture = scene::Texture{
            .image = make_one_texel_image(each.red, each.green, each.blue)};
        scene.materials[0].normal_scale = each.scale;
        const double x = (each.red - 128.) / 127 * each.scale,
                     y = (each.green - 128.) / 127 * each.scale, z = each.blue / 127.5 - 1;
        const dvec3 wanted(x * each.u - y * each.v, z);
        for (const char* world : kTiltedWorlds)
            EXPECT_NEAR(render_normal_texture_scene(scene, world).at(8, 8).x,
                        expected_diffuse_radiance(wanted, light), 2e-4)
                << world << ' ' << each.red << ' ' << each.green;
    }
}

/// Normal maps turn with their object, for a single object and for instances of one mesh.
TEST(NormalTexture, NormalsTurnWithTheObject) {
    const dvec3 light{.4, -.2, -1};
    scene::Scene scene = make_lit_square(light);
    scene.materials[0].two_sided = true;
    scene.materials[0].normal_texture = scene::Texture{
        .image = make_one_texel_image(190, 150, 240)};
    const dmat4 turn = glm::rotate(dmat4(1), .7, dvec3(.1, .2, 1)) *
                       glm::scale(dmat4(1), dvec3(1.5));
    const dvec3 local((190 - 128.) / 127, (150 - 128.) / 127, 240 / 127.5 - 1);
    const dvec3 wanted = glm::normalize(dmat3(turn) * local);
    for (const bool is_instance : {false, true}) {
        scene::Scene turned = scene;
        turned.objects[0].world_from_object = turn;
        if (is_instance) {
            turned.objects.push_back(turned.objects[0]);
            turned.objects.back().name = "further";
            turned.objects.back().world_from_object = glm::translate(dmat4(1), {20, 0, 0});
        }
        for (const char* world : kTiltedWorlds)
            EXPECT_NEAR(render_normal_texture_scene(turned, world).at(8, 8).x,
                        expected_diffuse_radiance(wanted, light), 4e-4)
                << world << ' ' << is_instance;
    }
    // From behind, a two-sided surface shows the same relief from its other side.
    scene.cameras.front().eye = {0, 0, -4};
    scene.punctual.clear();
    const scene::Scene behind = make_lit_square(-light);
    scene.punctual = behind.punctual;
    for (const char* world : kTiltedWorlds)
        EXPECT_NEAR(render_normal_texture_scene(scene, world).at(8, 8).x,
                    expected_diffuse_radiance(-local, -light), 4e-4)
            << world;
}

/// A mirror with a normal map reflects along the bent normal, in captures and by rays. Such a
/// mirror counts neither as flat nor as a sphere.
TEST(NormalTexture, MirrorsReflectAlongTheBentNormal) {
    scene::Scene scene = make_lit_square({0, 0, -1});
    scene.punctual.clear();
    scene.materials[0] = {.name = "mirror", .mirror = true, .reflectance = vec3(1)};
    scene.materials[0].normal_texture = scene::Texture{
        .image = make_one_texel_image(128, 217, 217)};
    // The normal leans up by 45 degrees, so the mirror reflects upwards, where a red wall is.
    const std::size_t wall = test::add_material(
        scene, {.name = "wall", .emission = {3, 0, 0}, .light = vec3(0)});
    test::add_quad(scene, "wall", wall, {-30, 5, 30}, {-30, 5, -30}, {30, 5, -30}, {30, 5, 30});
    for (const char* world : {"raytrace", "reuse:face=32", "secant:face=32", "planar"}) {
        const measure::Picture picture =
            test::render_technique(scene, world, kTiltedPictureSize, 2).hdr;
        EXPECT_NEAR(picture.at(8, 8).x, 3, .01) << world;
    }
}

} // namespace
