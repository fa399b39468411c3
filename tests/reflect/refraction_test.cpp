// Tests of glass that is looked up in captures (knob `refract`). Expected values are formulas in
// double precision, for glass that shows only an environment, and ray-traced pictures.
#include "core/shader_math.hpp"
#include "import/load.hpp"
#include "measure/picture.hpp"
#include "scene/classify.hpp"
#include "scene/glass_body.hpp"
#include "scene/surroundings.hpp"
#include "support/lit.hpp"
#include "support/numbers.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"
#include "support/special_values.hpp"

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <iostream>

namespace {

using namespace catoptric;

constexpr int kRefractionEdge = 48;

scene::Material make_tinted_glass(bool solid = true) {
    return {.name = "glass",
            .albedo = {.95f, .9f, .8f},
            .roughness = 0,
            .dielectric_f0 = vec3(.04f),
            .dielectric_f90 = vec3(1),
            .transmission = 1,
            .ior = 1.5f,
            .solid = solid,
            .absorption = {.05f, .2f, .4f}};
}

/// Returns a scene of one body below a smooth sky. Rays that leave the body see only the sky.
scene::Scene make_body_below_sky(scene::Mesh mesh, const scene::Material& glass, const dvec3& eye) {
    scene::Scene scene{.name = "body"};
    scene::add_mesh(scene, std::move(mesh), test::add_material(scene, glass));
    scene.environment = test::make_smooth_environment();
    scene.cameras.push_back({.eye = eye, .target = {0, 0, 0}, .vertical_fov_degrees = 30});
    scene::find_mirrors(scene);
    return scene;
}

/// The way of a ray through a body: the points where the ray enters and leaves the body, with their
/// normals. No value: the ray misses the body.
struct BodyCrossing {
    dvec3 near;                    ///< where the ray enters
    dvec3 near_normal, far_normal; ///< unit, outwards
    double way;                    ///< length of the way through the glass
};
/// A function that returns the way of a ray through a body. Its parameter `into` computes the
/// direction of a ray that enters glass at a surface with a given normal.
using FindCrossing = std::function<std::optional<BodyCrossing>(
    const dvec3& eye, const dvec3& direction,
    const std::function<dvec3(const dvec3& normal)>& into)>;

/// Returns the refracted direction by Snell's law in vector form.
dvec3 refract_direction_by_snell(const dvec3& direction, const dvec3& normal, double ratio) {
    const dvec3 across = (direction - glm::dot(direction, normal) * normal) / ratio;
    return across - std::sqrt(1 - glm::dot(across, across)) * normal;
}

/// Returns the radiance of a pixel of make_body_below_sky(): the light that the near surface
/// reflects, and the light that passes both surfaces. Light reflected inside the body is left out.
/// Returns nothing if the far surface reflects all light.
std::optional<dvec3> radiance_of_body(const scene::Scene& scene, const dvec3& direction,
                                      const BodyCrossing& crossing) {
    const scene::Material& glass = scene.materials[0];
    const auto sky = [&](const dvec3& to) {
        return dvec3(scene::environment_radiance(*scene.environment, to));
    };
    const double ior = glass.ior;
    double behind;
    const double cosine = -glm::dot(direction, crossing.near_normal),
                 reflected = f64::fresnel_dielectric(cosine, ior, behind);
    const dvec3 inside = refract_direction_by_snell(direction, crossing.near_normal, ior);
    const double far_cosine = glm::dot(inside, crossing.far_normal),
                 kept = f64::fresnel_dielectric(far_cosine, 1 / ior, behind);
    if (kept == 1) return std::nullopt;
    const dvec3 tint = dvec3(glass.albedo) * dvec3(glass.albedo) *
                       glm::exp(-dvec3(glass.absorption) * crossing.way);
    return reflected * sky(direction + 2 * cosine * crossing.near_normal) +
           (1 - reflected) * (1 - kept) * tint *
               sky(refract_direction_by_snell(inside, -crossing.far_normal, 1 / ior));
}

/// As radiance_of_body, for refract=screen: the light that passes is what the eye sees beyond the
/// point where the ray leaves the body, which is in the picture.
std::optional<dvec3> radiance_of_body_on_screen(const scene::Scene& scene, const dvec3& direction,
                                                const BodyCrossing& crossing) {
    const scene::Material& glass = scene.materials[0];
    const auto sky = [&](const dvec3& to) {
        return dvec3(scene::environment_radiance(*scene.environment, to));
    };
    double behind;
    const double cosine = -glm::dot(direction, crossing.near_normal),
                 reflected = f64::fresnel_dielectric(cosine, double{glass.ior}, behind);
    const dvec3 inside = refract_direction_by_snell(direction, crossing.near_normal, glass.ior);
    const double kept = f64::fresnel_dielectric(glm::dot(inside, crossing.far_normal),
                                                1 / double{glass.ior}, behind);
    if (kept == 1) return std::nullopt;
    const dvec3 tint = dvec3(glass.albedo) * dvec3(glass.albedo) *
                       glm::exp(-dvec3(glass.absorption) * crossing.way);
    const dvec3 seen = crossing.near + crossing.way * inside - scene.cameras.front().eye;
    return reflected * sky(direction + 2 * cosine * crossing.near_normal) +
           (1 - reflected) * (1 - kept) * tint * sky(glm::normalize(seen));
}

std::optional<BodyCrossing>
find_ray_path_through_ball(const dvec3& eye, const dvec3& direction,
                           const std::function<dvec3(const dvec3&)>& into) {
    const double b = glm::dot(eye, direction), c = glm::dot(eye, eye) - 1;
    // Near the outline, a pixel of the mesh may differ from the same pixel of the exact ball, so
    // such pixels are skipped.
    if (b * b - c < .05) return std::nullopt;
    const dvec3 near = eye + (-b - std::sqrt(b * b - c)) * direction, inside = into(near);
    const double way = -2 * glm::dot(near, inside);
    return BodyCrossing{near, near, near + way * inside, way};
}

/// Returns the way of a ray through the box from -half to half.
std::optional<BodyCrossing>
find_ray_path_through_box(const dvec3& half, const dvec3& eye, const dvec3& direction,
                          const std::function<dvec3(const dvec3&)>& into) {
    BodyCrossing crossing{};
    double enters = 0, leaves = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double side = direction[axis] < 0 ? 1 : -1,
                     t = (side * half[axis] - eye[axis]) / direction[axis],
                     out = (-side * half[axis] - eye[axis]) / direction[axis];
        if (t > enters)
            enters = t, crossing.near_normal = dvec3(0), crossing.near_normal[axis] = side;
        leaves = std::min(leaves, out);
    }
    if (enters > leaves - .05) return std::nullopt;
    const dvec3 at = eye + enters * direction, inside = into(crossing.near_normal);
    crossing.near = at;
    crossing.way = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double side = inside[axis] < 0 ? -1 : 1,
                     t = (side * half[axis] - at[axis]) / inside[axis];
        if (t < crossing.way)
            crossing.way = t, crossing.far_normal = dvec3(0), crossing.far_normal[axis] = side;
    }
    return crossing;
}

/// Compares a picture with the expected radiances. `share`: largest allowed share of wrong pixels.
void expect_radiance_by_closed_form(const scene::Scene& scene, const std::string& technique,
                                    double tolerance, const FindCrossing& find_crossing,
                                    double share = .01,
                                    decltype(radiance_of_body)* radiance = radiance_of_body) {
    const measure::Picture found =
        test::render_technique(scene, technique, {kRefractionEdge, kRefractionEdge}).hdr;
    int compared = 0, off = 0;
    double largest = 0;
    const scene::Camera& camera = scene.cameras.front();
    for (int y = 0; y < kRefractionEdge; ++y)
        for (int x = 0; x < kRefractionEdge; ++x) {
            const dvec3 direction = test::camera_direction_of_pixel(camera, x, y, kRefractionEdge);
            const auto crossing = find_crossing(camera.eye, direction, [&](const dvec3& normal) {
                return refract_direction_by_snell(direction, normal, scene.materials[0].ior);
            });
            if (!crossing) continue;
            const std::optional<dvec3> wanted = radiance(scene, direction, *crossing);
            if (!wanted) continue;
            const dvec3 apart = glm::abs(dvec3(found.at(x, y)) - *wanted);
            const double difference = std::max({apart.x, apart.y, apart.z});
            ++compared;
            off += difference > tolerance;
            largest = std::max(largest, difference);
        }
    std::cout << "[ MEASURED ] " << technique << ": " << off << " of " << compared
              << " pixels off, largest difference " << largest << '\n';
    EXPECT_GT(compared, 300) << technique;
    EXPECT_LE(off, share * compared) << technique;
}

TEST(Refraction, BallBendsLightAsTheClosedForm) {
    const scene::Scene scene = make_body_below_sky(scene::ball("ball", 6), make_tinted_glass(),
                                                   {.6, .5, 4.5});
    for (const char* technique : {"secant:refract=sphere", "parallax", "hybrid:refract=auto",
                                  "layered:refract=traced", "reuse:refract=sphere,face=512"})
        expect_radiance_by_closed_form(scene, technique, .02, find_ray_path_through_ball);
}

TEST(Refraction, BoxBendsLightAsTheClosedForm) {
    const dvec3 half(.9, .7, .4);
    const scene::Scene scene = make_body_below_sky(scene::box("box", -half, half),
                                                   make_tinted_glass(), {2.5, 2.1, 3.4});
    for (const char* technique : {"secant:refract=box", "march", "pyramid:refract=box"})
        expect_radiance_by_closed_form(scene, technique, .02,
                                       [&](const dvec3& eye, const dvec3& direction,
                                           const std::function<dvec3(const dvec3&)>& into) {
                                           return find_ray_path_through_box(half, eye, direction,
                                                                            into);
                                       });
}

/// The image of back faces has the resolution of the picture, so the far edges of a box may be
/// wrong by up to one pixel.
TEST(Refraction, BackFacesOfBallAndTurnedBoxBendLightAsTheClosedForm) {
    const scene::Scene ball = make_body_below_sky(scene::ball("ball", 6), make_tinted_glass(),
                                                  {.6, .5, 4.5});
    for (const char* technique :
         {"secant:refract=backface", "hybrid:refract=backface", "reuse:refract=backface,face=512"})
        expect_radiance_by_closed_form(ball, technique, .02, find_ray_path_through_ball);
    const dvec3 half(.9, .7, .4);
    scene::Scene box = make_body_below_sky(scene::box("box", -half, half), make_tinted_glass(),
                                           {2.5, 2.1, 3.4});
    const dmat4 place = glm::rotate(dmat4(1), .6, glm::normalize(dvec3(1, 2, -1)));
    const dmat3 turn(place), back = glm::transpose(turn);
    box.objects.back().world_from_object = place;
    expect_radiance_by_closed_form(
        box, "secant:refract=backface", .02,
        [&](const dvec3& eye, const dvec3& direction,
            const std::function<dvec3(const dvec3&)>& into) {
            std::optional<BodyCrossing> crossing = find_ray_path_through_box(
                half, back * eye, back * direction,
                [&](const dvec3& normal) { return back * into(turn * normal); });
            if (!crossing) return crossing;
            crossing->near = turn * crossing->near;
            crossing->near_normal = turn * crossing->near_normal;
            crossing->far_normal = turn * crossing->far_normal;
            return crossing;
        },
        .05);
}

TEST(Refraction, ScreenShowsThePointWhereTheRayLeavesTheBody) {
    const scene::Scene ball = make_body_below_sky(scene::ball("ball", 6), make_tinted_glass(),
                                                  {.6, .5, 4.5});
    for (const char* technique :
         {"secant:refract=screen", "hybrid:refract=screen", "reuse:refract=screen,face=512"})
        expect_radiance_by_closed_form(ball, technique, .02, find_ray_path_through_ball, .01,
                                       radiance_of_body_on_screen);
    const dvec3 half(.9, .7, .4);
    const scene::Scene box = make_body_below_sky(scene::box("box", -half, half),
                                                 make_tinted_glass(), {2.5, 2.1, 3.4});
    expect_radiance_by_closed_form(
        box, "secant:refract=screen", .02,
        [&](const dvec3& eye, const dvec3& direction,
            const std::function<dvec3(const dvec3&)>& into) {
            return find_ray_path_through_box(half, eye, direction, into);
        },
        .01, radiance_of_body_on_screen);
}

/// A pane whose index of refraction is 1 neither bends nor reflects light. Each pixel is that of
/// the picture in which the pane is out of view.
TEST(Refraction, ScreenShowsEachPixelThroughAPaneThatDoesNotBend) {
    const auto render = [](const scene::Scene& scene, const char* technique) {
        return test::render_technique(scene, technique, {48, 48}, 2);
    };
    const MirrorId ball = MirrorId::from_index(0), pane = MirrorId::from_index(1);
    for (const double orthographic_height : {0., 3.}) {
        const auto make_room = [&](const dvec3& low, const dvec3& high) {
            scene::Scene room = test::make_lit_room(1, 1);
            room.cameras.front().orthographic_height = orthographic_height;
            scene::add_mesh(room, scene::box("pane", low, high),
                            test::add_material(room, {.name = "index 1",
                                                      .albedo = vec3(1),
                                                      .roughness = 0,
                                                      .dielectric_f0 = vec3(0),
                                                      .dielectric_f90 = vec3(1),
                                                      .transmission = 1,
                                                      .ior = 1,
                                                      .solid = true}));
            scene::find_mirrors(room);
            return room;
        };
        const scene::Scene before = make_room({-1.2, -1, -1.6}, {1, .8, -1.3}),
                           aside = make_room({-1.9, -1.9, -2.98}, {-1.8, -1.8, -2.95});
        const measure::Picture through = render(before, "secant:refract=screen,face=64").hdr,
                               wanted = render(aside, "secant:refract=screen,face=64").hdr;
        const std::vector<std::uint32_t> hits = render(before, "raytrace:depth=1").hits,
                                         other_hits = render(aside, "raytrace:depth=1").hits;
        int compared = 0, balls = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (measure::first_mirror(hits[i]) != pane) continue;
            // The ball is in the picture, and itself shows the pane.
            if (measure::first_mirror(other_hits[i]) == ball) {
                ++balls;
                EXPECT_LT(test::max_channel_difference(through.pixels[i], wanted.pixels[i]), .1f)
                    << i;
                continue;
            }
            ++compared;
            for (int channel = 0; channel < 3; ++channel) // weights round to a few ulps below 1
                EXPECT_NEAR(through.pixels[i][channel], wanted.pixels[i][channel],
                            5e-7f * wanted.pixels[i][channel])
                    << i;
        }
        EXPECT_GT(compared, 300);
        EXPECT_GT(balls, 50);
    }
}

/// The pane is larger than the picture and oblique to the view, so at one side rays leave it where
/// the picture does not show them.
TEST(Refraction, ScreenFallsBackToAutoOutsideThePicture) {
    const dvec3 half(30, 30, .5);
    const scene::Scene scene = make_body_below_sky(scene::box("pane", -half, half),
                                                   make_tinted_glass(), {2.5, 0, 2});
    const scene::Camera& camera = scene.cameras.front();
    const double tangent = std::tan(glm::radians(camera.vertical_fov_degrees / 2));
    const dvec3 forward = glm::normalize(camera.target - camera.eye),
                right = glm::normalize(glm::cross(forward, camera.up)),
                down = glm::cross(forward, right);
    const uvec2 size{kRefractionEdge, kRefractionEdge};
    const measure::Picture shown =
                               test::render_technique(scene, "secant:refract=screen", size, 2).hdr,
                           captured = test::render_technique(scene, "secant", size, 2).hdr;
    int inside = 0, outside = 0, off = 0, equal = 0;
    for (int y = 0; y < kRefractionEdge; ++y)
        for (int x = 0; x < kRefractionEdge; ++x) {
            const dvec3 direction = test::camera_direction_of_pixel(camera, x, y, kRefractionEdge);
            const auto crossing = find_ray_path_through_box(
                half, camera.eye, direction, [&](const dvec3& normal) {
                    return refract_direction_by_snell(direction, normal, scene.materials[0].ior);
                });
            ASSERT_TRUE(crossing);
            const dvec3 seen = crossing->near - camera.eye +
                               crossing->way * refract_direction_by_snell(direction,
                                                                          crossing->near_normal,
                                                                          scene.materials[0].ior);
            const double place = std::max(std::abs(glm::dot(seen, right)),
                                          std::abs(glm::dot(seen, down))) /
                                 glm::dot(seen, forward) / tangent;
            const bool is_captured = shown.at(x, y) == captured.at(x, y);
            if (std::abs(place - 1) < 1e-4) continue; // either side by rounding
            if (place > 1) {
                ++outside;
                EXPECT_TRUE(is_captured) << x << ", " << y;
                continue;
            }
            ++inside;
            equal += is_captured;
            const std::optional<dvec3> wanted = radiance_of_body_on_screen(scene, direction,
                                                                           *crossing);
            const dvec3 apart = glm::abs(dvec3(shown.at(x, y)) - *wanted);
            off += std::max({apart.x, apart.y, apart.z}) > .02;
        }
    std::cout << "[ MEASURED ] " << inside << " pixels end in the picture, of which " << off
              << " are off and " << equal << " equal refract=auto; " << outside << " do not\n";
    EXPECT_GT(outside, 100);
    EXPECT_GT(inside, 1000);
    EXPECT_LE(off, inside / 100);
    EXPECT_LE(equal, inside / 100);
}

/// At roughness 1 and an index of at least 1.5, glass shows the mean of the picture; between its
/// levels, the two nearest by turns.
TEST(Refraction, ScreenBlursRoughGlassByTheLevelOfThreeJs) {
    constexpr std::uint32_t kEdge = 16;
    scene::Scene scene{.name = "rough pane", .mirror_max_roughness = 1};
    const std::array<vec3, 2> emissions{{{.8f, .4f, .2f}, {.1f, .6f, .3f}}};
    for (int i = 0; i < 2; ++i) { // a wall whose left and right half differ
        const double left = i == 0 ? -9 : 0, right = i == 0 ? 0 : 9;
        test::add_quad(scene, "wall",
                       test::add_material(scene, {.name = "wall", .emission = emissions[i]}),
                       {left, -9, -3}, {right, -9, -3}, {right, 9, -3}, {left, 9, -3});
    }
    scene::Material glass = make_tinted_glass();
    glass.absorption = vec3(0);
    const std::size_t material = test::add_material(scene, glass);
    scene::add_mesh(scene, scene::box("pane", {-9, -9, -.1}, {9, 9, 0}), material);
    scene.cameras.push_back({.eye = {0, 0, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 1});
    const auto render = [&](float roughness, float ior) {
        scene.materials[material].roughness = roughness;
        scene.materials[material].ior = ior;
        const float root = (ior - 1) / (ior + 1);
        scene.materials[material].dielectric_f0 = vec3(root * root);
        scene::find_mirrors(scene);
        session::Request asked = test::make_test_request(scene, {"secant:refract=screen,face=16"},
                                                         {kEdge, kEdge});
        asked.ambient = 0, asked.warmup = 1;
        return session::run(test::get_test_engine(), asked);
    };
    const auto passing = [&](float ior) {
        const double kept = 1 - std::pow((ior - 1.) / (ior + 1.), 2);
        return kept * kept * dvec3(glass.albedo) * dvec3(glass.albedo);
    };
    // The camera looks along -z, so x grows to the right. Level m has the step between the halves
    // in its middle, and the hardware interpolates over one texel of 2^m pixels.
    const auto of_level = [&](int x, double level) {
        const auto at = [&](int whole) {
            const double texel = std::exp2(whole), steps = (x + .5 - kEdge / 2.) / texel + .5;
            const double share = kEdge / texel < 2 ? .5 : std::clamp(steps, 0., 1.);
            return (1 - share) * dvec3(emissions[0]) + share * dvec3(emissions[1]);
        };
        const int below = static_cast<int>(level);
        return glm::mix(at(below), at(below + 1), level - below);
    };
    for (const auto& [roughness, ior, level] : {std::tuple{1.f, 1.5f, 4.},
                                                {1.f, 1.8f, 4.},
                                                {.5f, 1.5f, 2.},
                                                {.6f, 1.5f, 2.4},
                                                {.5f, 1.25f, 1.},
                                                {.2f, 1.5f, .8}}) {
        const session::RunResult rendered = render(roughness, ior);
        const measure::Picture& found = rendered.parts.front().hdr;
        for (std::uint32_t y = 0; y < kEdge; ++y)
            for (std::uint32_t x = 0; x < kEdge; ++x)
                for (int channel = 0; channel < 3; ++channel)
                    EXPECT_NEAR(found.at(x, y)[channel],
                                (passing(ior) * of_level(static_cast<int>(x), level))[channel],
                                2e-3)
                        << "roughness " << roughness << ", index " << ior << " at " << x << ", "
                        << y;
    }
}

/// Returns the names of the passes of a frame.
std::vector<std::string> pass_names(const session::RunResult& run) {
    std::vector<std::string> names;
    for (const session::PassTime& pass : run.frames.back().passes) names.push_back(pass.name);
    return names;
}

TEST(Refraction, ScreenAddsPassesOnlyWhereGlassReadsThem) {
    const auto render = [](const scene::Scene& scene, const std::string& technique) {
        session::Request asked = test::make_test_request(scene, {technique}, {32, 24});
        asked.warmup = 1;
        return session::run(test::get_test_engine(), asked);
    };
    scene::Scene glass = make_body_below_sky(scene::ball("ball", 3), make_tinted_glass(),
                                             {.6, .5, 4.5});
    const session::RunResult bodies = render(glass, "secant:face=32"),
                             screen = render(glass, "secant:face=32,refract=screen");
    std::vector<std::string> wanted = pass_names(bodies);
    const auto view = std::ranges::find(wanted, "view");
    ASSERT_NE(view, wanted.end());
    wanted.insert(view + 1, {"opaque_picture", "view.glass"});
    EXPECT_EQ(pass_names(screen), wanted);
    EXPECT_EQ(screen.parts.front().scene_passes, bodies.parts.front().scene_passes);

    glass.materials.front().roughness = .2f;
    scene::find_mirrors(glass);
    for (const auto& [technique, levels] : {std::pair{"secant:face=32,refract=screen", 1},
                                            {"secant:face=32,refract=screen,rough=none", 0}})
        EXPECT_EQ(std::ranges::count(pass_names(render(glass, technique)), "opaque_picture/levels"),
                  levels)
            << technique;

    const scene::Scene room = test::make_lit_room(1, 1);
    const session::RunResult with = render(room, "secant:refract=screen,face=32"),
                             without = render(room, "secant:face=32");
    EXPECT_EQ(pass_names(with), pass_names(without));
    EXPECT_TRUE(test::have_equal_pixel_bytes(with.parts.front().hdr, without.parts.front().hdr));
    EXPECT_EQ(with.parts.front().memory_bytes, without.parts.front().memory_bytes);
}

/// Mirrors that are no glass may have another technique than glass.
TEST(Refraction, ScreenWorksInPlans) {
    const scene::Scene scene = scene::load("glass");
    const uvec2 size{64, 48};
    const auto render = [&](const std::string& plan) {
        return test::render_technique(scene, plan, size, 3).hdr;
    };
    const std::string screen = "*=secant:face=64,refract=screen", bodies = "*=secant:face=64";
    // No glass of the ball's technique reads the picture.
    EXPECT_TRUE(test::have_equal_pixel_bytes(render(bodies),
                                             render("5=secant:face=64,refract=screen " + bodies)));
    // Pixels that rays complete have no numbers of triangles in the picture, although force=unknown
    // draws such numbers elsewhere.
    const measure::Picture searched = render(screen),
                           traced = render("5=hybrid:force=unknown,face=64 " + screen);
    EXPECT_EQ(test::count_nonfinite(traced), 0u);
    const std::vector<std::uint32_t> hits =
        test::render_technique(scene, "raytrace:depth=2", size).hits;
    int compared = 0, off = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const MirrorId first = measure::first_mirror(hits[i]);
        if (!first || first == MirrorId::from_index(4)) continue;
        ++compared;
        off += test::max_channel_difference(searched.pixels[i], traced.pixels[i]) > .02f;
    }
    EXPECT_GT(compared, 300);
    EXPECT_LE(off, compared / 50);
}

/// Returns the FLIP between a row and ray tracing, over the pixels of one mirror of the scene.
double flip_on_mirror(const session::TechniqueResult& found, const session::TechniqueResult& traced,
                      std::size_t mirror) {
    measure::Mask shown(traced.hits.size(), 0);
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (measure::first_mirror(traced.hits[i]) == MirrorId::from_index(mirror)) shown[i] = 255;
    return measure::flip_mean(measure::flip(found.display, traced.display), shown);
}

/// A lens and a bottle bend light at curved surfaces that differ from a ball or a box.
TEST(Refraction, BackFacesShowLensAndBottleBetterThanAnyBody) {
    const scene::Scene scene = scene::load("glass");
    const uvec2 size{128, 96};
    const session::TechniqueResult traced = test::render_technique(scene, "raytrace:depth=8", size);
    const auto render = [&](const std::string& model) {
        return test::render_technique(scene, "secant:face=64,refract=" + model, size, 2);
    };
    const session::TechniqueResult backs = render("backface"), bodies = render("auto"),
                                   unbent = render("thin");
    for (std::size_t mirror = 0; mirror < 4; ++mirror) {
        const double found = flip_on_mirror(backs, traced, mirror),
                     least = std::min(flip_on_mirror(bodies, traced, mirror),
                                      flip_on_mirror(unbent, traced, mirror));
        std::cout << "[ MEASURED ] mirror " << mirror + 1 << ": FLIP with back faces " << found
                  << ", with the best body " << least << '\n';
        EXPECT_LT(found, mirror < 2 ? least + .02 : .9 * least) << mirror;
    }
}

/// In a scene without glass, no pass draws back faces.
TEST(Refraction, BackFacesCostNothingWithoutGlass) {
    const scene::Scene room = test::make_lit_room(1, 1);
    const session::TechniqueResult with = test::render_technique(
                                       room, "secant:refract=backface,face=32", {32, 32}, 2),
                                   without = test::render_technique(room, "secant:face=32",
                                                                    {32, 32}, 2);
    EXPECT_TRUE(test::have_equal_pixel_bytes(with.hdr, without.hdr));
    EXPECT_EQ(with.memory_bytes, without.memory_bytes);
}

/// The bounces of `naive` are captures, which have no images of the camera's view. Each of two
/// balls shows the other in its captures.
TEST(Refraction, ModelsOfTheCameraViewAreAutoInBounces) {
    scene::Scene scene = make_body_below_sky(scene::ball("ball", 4), make_tinted_glass(),
                                             {.6, .5, 4.5});
    scene::add_mesh(scene, scene::ball("other", 4), 0);
    scene.objects.back().world_from_object[3] = dvec4(2.2, 0, -1, 1);
    scene::find_mirrors(scene);
    for (const char* model : {"backface", "screen"})
        EXPECT_EQ(test::count_nonfinite(
                      test::render_technique(
                          scene, std::string("naive:bounces=2,face=32,refract=") + model, {24, 24})
                          .hdr),
                  0u)
            << model;
}

/// Through a pane of glass in front of a wall, the wall must appear at its true position.
TEST(Refraction, ThinGlassShowsWhatIsBehindIt) {
    for (const bool solid : {false, true}) {
        scene::Scene scene{.name = "pane"};
        scene::Material glass = make_tinted_glass(solid);
        glass.absorption = vec3(0);
        const std::size_t pane = test::add_material(scene, glass),
                          wall = test::add_material(scene,
                                                    {.name = "wall", .emission = {.8f, .4f, .2f}});
        if (solid)
            scene::add_mesh(scene, scene::box("pane", {-9, -9, -.1}, {9, 9, 0}), pane);
        else
            test::add_quad(scene, "pane", pane, {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
        test::add_quad(scene, "wall", wall, {-9, -9, -3}, {9, -9, -3}, {9, 9, -3}, {-9, 9, -3});
        scene.cameras.push_back({.eye = {0, 0, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 1});
        scene::find_mirrors(scene);
        session::Request asked = test::make_test_request(scene, {"secant:refract=thin"}, {1, 1});
        asked.ambient = 0, asked.warmup = 1;
        const vec3 seen = session::run(test::get_test_engine(), asked).parts.front().hdr.at(0, 0);
        const dvec3 once = .96 * dvec3(glass.albedo),
                    all = solid ? once * once : (1 - 2 * .04 / 1.04) * dvec3(glass.albedo);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(seen[channel], all[channel] * dvec3(.8, .4, .2)[channel], 2e-3)
                << (solid ? "solid" : "sheet");
    }
}

TEST(Refraction, TracerTakesGlassOver) {
    const scene::Scene scene = scene::load("glass");
    const uvec2 size{96, 72};
    const measure::Picture traced = test::render_technique(scene, "raytrace:depth=8", size).hdr,
                           hybrid = test::render_technique(scene, "hybrid:face=64", size, 4).hdr;
    const std::vector<std::uint32_t> hits =
        test::render_technique(scene, "raytrace:depth=1", size).hits;
    int off = 0, glass = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const MirrorId mirror = measure::first_mirror(hits[i]);
        if (!mirror || mirror == MirrorId::from_index(4)) continue; // the mirror ball is no glass
        ++glass;
        off += test::max_channel_difference(traced.pixels[i], hybrid.pixels[i]) > .02f;
    }
    EXPECT_GT(glass, 1000);
    EXPECT_LE(off, glass / 100); // at outlines the rasteriser may cover other pixels
}

TEST(Refraction, GlassIsMoreThanItsDiffusePart) {
    const scene::Scene scene = scene::load("glass");
    const uvec2 size{96, 72};
    const session::TechniqueResult traced = test::render_technique(scene, "raytrace:depth=8", size);
    const auto error = [&](const char* technique) {
        const measure::Picture found = test::render_technique(scene, technique, size, 4).hdr;
        double sum = 0;
        for (std::size_t i = 0; i < traced.hits.size(); ++i)
            if (measure::first_mirror(traced.hits[i]))
                sum += test::max_channel_difference(found.pixels[i], traced.hdr.pixels[i]);
        return sum;
    };
    const double diffuse = error("secant:refract=none,face=64"),
                 refracted = error("secant:face=64"), unbent = error("secant:refract=thin,face=64");
    std::cout << "[ MEASURED ] sum of errors: diffuse " << diffuse << ", unbent " << unbent
              << ", by the body " << refracted << '\n';
    EXPECT_LT(refracted, .4 * diffuse);
    EXPECT_LT(refracted, unbent);
}

/// A camera inside glass must see the surroundings through the glass, and not black.
TEST(Refraction, CameraInsideGlassSeesOut) {
    for (const bool two_sided : {false, true}) {
        scene::Material glass = make_tinted_glass();
        glass.two_sided = two_sided;
        const scene::Scene scene = make_body_below_sky(scene::ball("ball", 4), glass, {0, .1, .2});
        const uvec2 size{24, 24};
        const measure::Picture traced = test::render_technique(scene, "raytrace:depth=8", size).hdr;
        for (const char* technique : {"hybrid", "secant"}) {
            const measure::Picture found = test::render_technique(scene, technique, size, 3).hdr;
            double sum = 0, wanted = 0;
            for (std::size_t i = 0; i < found.pixels.size(); ++i)
                sum += found.pixels[i].x, wanted += traced.pixels[i].x;
            EXPECT_NEAR(sum, wanted, .15 * wanted) << technique << (two_sided ? ", two-sided" : "");
        }
    }
}

/// The capture of glass may be read in any direction. This is also true for a flat sheet that is
/// seen from one side, so no face of its capture may be left out.
TEST(Refraction, RequiredWorkDrawsThePictureOfAllWork) {
    scene::Scene room = test::make_lit_room(0, 1);
    test::add_quad(room, "sheet", test::add_material(room, make_tinted_glass(false)),
                   {-.8, -1.2, -1}, {-.8, .8, -1}, {.8, .8, -1}, {.8, -1.2, -1});
    scene::find_mirrors(room);
    for (const scene::Scene& scene : {room, scene::load("glass")})
        for (const char* technique : {"secant:refract=box,face=64", "hybrid:refract=thin,face=32",
                                      "secant:refract=screen,face=64"}) {
            session::Request asked = test::make_test_request(scene, {technique}, {64, 48});
            asked.warmup = 3;
            asked.model = session::RenderedWork::everything;
            const measure::Picture all =
                session::run(test::get_test_engine(), asked).parts.front().hdr;
            asked.model = session::RenderedWork::required;
            const measure::Picture required =
                session::run(test::get_test_engine(), asked).parts.front().hdr;
            EXPECT_TRUE(test::have_equal_pixel_bytes(all, required))
                << scene.name << ", " << technique;
        }
}

TEST(GlassBody, VolumeOfClosedMeshesIsThatOfTheirBody) {
    EXPECT_NEAR(scene::closed_volume(scene::box("box", {1, 2, 3}, {2, 4, 6})), 6, 1e-12);
    EXPECT_NEAR(scene::closed_volume(scene::ball("ball", 6)), 4 * test::kPi / 3, .01);
    EXPECT_EQ(scene::closed_volume(scene::quad("quad", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})),
              0);
}

/// A flat mirror must show a glass ball in front of it.
TEST(Refraction, FlatMirrorsShowGlassByItsTechnique) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "flat", .mirror = true});
    test::add_quad(scene, "flat", mirror, {-1.6, -1.6, 1.9}, {-1.6, 1.6, 1.9}, {1.6, 1.6, 1.9},
                   {1.6, -1.6, 1.9});
    scene::Material glass = make_tinted_glass();
    glass.absorption = vec3(0);
    scene::Mesh ball = scene::ball("ball", 5);
    scene::add_mesh(scene, ball, test::add_material(scene, glass));
    scene.objects.back().world_from_object = dmat4(dvec4(.6, 0, 0, 0), dvec4(0, .6, 0, 0),
                                                   dvec4(0, 0, .6, 0), dvec4(.7, -.3, .4, 1));
    scene.cameras.front().eye = {-.9, .3, -2.5};
    scene::find_mirrors(scene);
    scene::Scene plaster = scene;
    plaster.materials.back() = {.name = "plaster", .albedo = vec3(.9f)};
    scene::find_mirrors(plaster);
    const uvec2 size{96, 96};
    const session::TechniqueResult traced = test::render_technique(scene, "raytrace:depth=8", size);
    const measure::Mask shown = measure::mask_mirror_in_mirror(traced.hits);
    EXPECT_GT(measure::count_pixels(shown), 200u);
    const auto error = [&](const scene::Scene& of, const std::string& technique) {
        return test::rmse_of_pictures(test::render_technique(of, technique, size, 5).hdr,
                                      traced.hdr, shown);
    };
    const double diffuse = error(plaster, "planar");
    for (const auto& [rest, share] :
         {std::pair{std::string("secant"), .3}, {"raytrace", .15}, {"hybrid", .15}}) {
        const double found = error(scene, "planar:rest=" + rest);
        std::cout << "[ MEASURED ] glass in a flat mirror by " << rest << ": rmse " << found
                  << ", plaster " << diffuse << '\n';
        EXPECT_LT(found, share * diffuse) << rest;
    }
}

TEST(GlassBody, SimpleBodyFollowsFromShapeAndPlace) {
    using enum scene::GlassBody;
    const auto model = [](scene::Mesh mesh, const dmat4& place, const scene::Material& material) {
        scene::Scene scene{.name = "body"};
        scene::add_mesh(scene, std::move(mesh), test::add_material(scene, material));
        scene.objects.back().world_from_object = place;
        return scene::choose_glass_body(scene, scene.objects.back(),
                                        scene::closed_volume(scene.meshes.back()));
    };
    const scene::Material glass = make_tinted_glass();
    const double c = std::sqrt(.5);
    const dmat4 still(1),
        turned(dvec4(c, 0, c, 0), dvec4(0, 1, 0, 0), dvec4(-c, 0, c, 0), dvec4(3, 0, 0, 1));
    const scene::Mesh pane = scene::box("pane", {-1, -1, -.02}, {1, 1, .02});
    EXPECT_EQ(model(scene::ball("ball", 3), turned, glass), sphere);
    EXPECT_EQ(model(pane, still, glass), box);
    EXPECT_EQ(model(pane, turned, glass), thin);
    EXPECT_EQ(model(scene::torus("ring", 1, .1, 24), still, glass), thin);
    EXPECT_EQ(model(pane, still, make_tinted_glass(false)), thin) << "a sheet";
    EXPECT_EQ(model(scene::quad("quad", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), still, glass),
              thin)
        << "open";
    EXPECT_EQ(model(pane, still, {.name = "paint"}), std::nullopt);
}

} // namespace
