// Tests of the secant search: without steps it must equal `parallax`, for glass as well.
#include "scene/built_in.hpp"
#include "support/searches.hpp"

namespace {

using namespace catoptric;

TEST(Secant, WithoutStepsEqualsParallax) {
    scene::Scene scene = scene::make_cornell();
    scene.materials.push_back({.name = "glass",
                               .albedo = vec3(1),
                               .roughness = 0,
                               .dielectric_f0 = vec3(.04f),
                               .dielectric_f90 = vec3(1),
                               .transmission = 1,
                               .solid = true});
    const std::size_t first = scene::mirrors(scene)[0];
    scene.objects[first].material = scene.materials.size() - 1;
    scene.objects[first].mirror = true;
    for (const std::string settings :
         {"face=64", "face=37,distance=r16f", "face=64,distance=unorm8,shadow=none"}) {
        const session::TechniqueResult parallax = test::render_technique(
            scene, "parallax:" + settings, {160, 120}, 3);
        for (const std::string further : {"", "continue=0,", "captures=all,lookup=object,"}) {
            const session::TechniqueResult secant = test::render_technique(
                scene, "secant:steps=0," + further + settings, {160, 120}, 3);
            EXPECT_TRUE(test::have_equal_pixel_bytes(secant.hdr, parallax.hdr))
                << further << settings;
        }
    }
}

} // namespace
