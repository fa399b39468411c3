// Tests of the secant search: without steps it must equal `parallax`.
#include "scene/built_in.hpp"
#include "support/searches.hpp"

namespace {

using namespace catoptric;

TEST(Secant, WithoutStepsEqualsParallax) {
    const scene::Scene scene = scene::make_cornell_mirrors();
    for (const std::string settings :
         {"face=64", "face=37,distance=r16f", "face=64,distance=unorm8,shadow=none"}) {
        const app::TechniqueResult parallax = test::render_technique(scene, "parallax:" + settings,
                                                                     {160, 120}, 3);
        for (const std::string further : {"", "continue=0,", "captures=all,lookup=object,"}) {
            const app::TechniqueResult secant = test::render_technique(
                scene, "secant:steps=0," + further + settings, {160, 120}, 3);
            EXPECT_TRUE(test::have_equal_pixel_bytes(secant.hdr, parallax.hdr))
                << further << settings;
        }
    }
}

} // namespace
