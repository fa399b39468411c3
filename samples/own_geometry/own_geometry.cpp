// A scene made in memory, with a mesh of our own: a wavy mirror over a tiled floor, under a lamp.
#include <catoptric/picture.hpp>
#include <catoptric/scene.hpp>
#include <catoptric/session.hpp>

#include <cmath>
#include <cstdio>
#include <memory>

using namespace catoptric;

namespace {

/// A square of 4 by 4 in the plane y = 0, with waves around its middle.
scene::Mesh make_wave_mesh(unsigned cells) {
    scene::Mesh mesh{.name = "waves"};
    for (unsigned row = 0; row <= cells; ++row)
        for (unsigned column = 0; column <= cells; ++column) {
            const double x = 4.0 * column / cells - 2, z = 4.0 * row / cells - 2;
            const double r = std::hypot(x, z) + 1e-9, slope = -.3 * std::sin(3 * r);
            mesh.positions.emplace_back(x, .1 * std::cos(3 * r), z);
            mesh.normals.push_back(vec3(glm::normalize(dvec3(-slope * x / r, 1, -slope * z / r))));
            if (row == 0 || column == 0) continue;
            const unsigned here = row * (cells + 1) + column, before = here - cells - 1;
            mesh.triangles.emplace_back(before - 1, here - 1, here); // seen from above
            mesh.triangles.emplace_back(before - 1, here, before);
        }
    return mesh;
}

scene::Scene make_wave_scene() {
    scene::Scene made{.name = "waves"};
    const auto paint = [&](const char* name, vec3 colour) {
        return scene::add_material(made, {.name = name, .albedo = colour});
    };
    const std::size_t light = paint("light", vec3(.7f)), dark = paint("dark", {.1f, .15f, .3f});
    const std::size_t lamp = scene::add_material(made, {.name = "lamp", .emission = vec3(18)});
    const std::size_t glass = scene::add_material(
        made, {.name = "mirror", .mirror = true, .reflectance = vec3(.9f)});
    for (int i = 0; i < 64; ++i) {
        const double x = i % 8 - 4, z = i / 8 - 4;
        scene::add_quad(made, "tile", (i + i / 8) % 2 ? light : dark, {x, -1, z}, {x, -1, z + 1},
                        {x + 1, -1, z + 1}, {x + 1, -1, z});
    }
    scene::add_quad(made, "lamp", lamp, {-1, 4, -1}, {1, 4, -1}, {1, 4, 1}, {-1, 4, 1});
    scene::add_ball(made, "ball", light, {0, 1.2, -1}, .6);
    scene::add_mesh(made, make_wave_mesh(40), glass);
    made.environment = std::make_shared<scene::Environment>(
        scene::Environment{.name = "studio", .studio = true});
    made.cameras.push_back({.eye = {0, 3, 6}, .target = {0, 0, 0}});
    return made;
}

} // namespace

int main() try {
    session::Engine engine({});
    session::Session session(engine, make_wave_scene());
    const auto picture = [&](const char* technique) {
        return session
            .frame({.techniques = {technique},
                    .camera = session.scene().cameras.front(),
                    .size = {192, 144}})
            .hdr();
    };
    const measure::Picture truth = picture("raytrace"), fast = picture("secant");
    const std::vector<float> flip = measure::flip(measure::to_unrounded_display(fast),
                                                  measure::to_unrounded_display(truth));
    std::printf("secant against rays: FLIP %.4f\n", measure::flip_mean(flip));
    measure::write_png(measure::to_display(fast), "waves.png");
    scene::save_glb(session.scene(), "waves.glb");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "own_geometry: %s\n", error.what());
    return 1;
}
