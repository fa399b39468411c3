// The secant search: its first step is the report's, the next ones are worth far larger captures.
#include "support/searches.hpp"

namespace {

using namespace catoptric;

TEST(Secant, WithoutStepsIsParallax) {
    const scene::Scene scene = scene::cornell_mirrors();
    for (const std::string settings :
         {"face=64", "face=37,distance=r16f", "face=64,distance=unorm8,shadow=none"}) {
        const app::Part parallax = test::render(scene, "parallax:" + settings, {160, 120}, 3);
        for (const std::string further : {"", "continue=0,", "captures=all,lookup=object,"}) {
            const app::Part secant = test::render(scene, "secant:steps=0," + further + settings,
                                                  {160, 120}, 3);
            EXPECT_TRUE(test::same_bytes(secant.hdr, parallax.hdr)) << further << settings;
        }
    }
}

TEST(Secant, IsWorthItsSteps) {
    test::expect_worth(
        "secant",
        {.first_order = .57, .all = .42, .coarse = .49, .mirror_in_mirror = .25, .angle = .04});
}

TEST(Secant, NeedsSmallerCapturesThanParallax) {
    for (const test::Look& look : test::looks()) {
        SCOPED_TRACE(look.camera.name);
        const auto judged = test::judge(
            scene::cornell_mirrors(), look,
            {"parallax:face=512", "secant:face=256,continue=0", "secant:face=64,continue=0"});
        EXPECT_LE(judged[1].first_order, judged[0].first_order);
        EXPECT_LE(judged[2].lookup.mean_degrees, .05 * judged[0].lookup.mean_degrees);
    }
}

} // namespace
