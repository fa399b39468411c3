#pragma once

#include "app/oracle.hpp"
#include "support/rendering.hpp"

#include <iostream>

/// How techniques that look into captures do in the built-in scene, seen by its camera at t = 0, 512x512.
namespace test {

inline constexpr uvec2 kContractSize{512, 512};
inline constexpr int kConvergedFrames = 8; ///< deeper bounces have arrived

/// Linear rmse against ray tracing, by what the reflected ray meets.
struct ColourError {
    double all = 0, first_order = 0, mirror_in_mirror = 0;
};

inline ColourError colour_error(const std::string& technique) {
    static const app::Part truth = render(scene::cornell_mirrors(), "raytrace:depth=16", kContractSize);
    const measure::Picture picture = render(scene::cornell_mirrors(), technique, kContractSize, kConvergedFrames).hdr;
    const ColourError error{rmse(picture, truth.hdr, measure::mirrors(truth.hits)), rmse(picture, truth.hdr, measure::first_order(truth.hits)),
                            rmse(picture, truth.hdr, measure::mirror_in_mirror(truth.hits))};
    std::cout << "[ MEASURED ] " << technique << ": rmse " << error.all << ", first order " << error.first_order
              << ", mirror in mirror " << error.mirror_in_mirror << "\n";
    return error;
}

/// Where each first-order pixel looked and should have.
inline std::vector<measure::LookedUp> looked_up(const scene::Scene& scene, const std::string& technique, uvec2 size) {
    app::Request asked = request(scene, {technique}, size);
    asked.with_lookup = true;
    return app::Oracle(asked).judge(engine().run(asked).parts.front().lookup);
}

inline measure::LookupError lookup_error(const std::string& technique) {
    const measure::LookupError error = measure::lookup_error(looked_up(scene::cornell_mirrors(), technique, kContractSize));
    std::cout << "[ MEASURED ] " << technique << ": mean angle " << error.mean_degrees << " degrees, p95 " << error.p95_degrees << ", wrong object "
              << error.wrong_object << ", unknown " << error.unknown << "\n";
    return error;
}

/// What a search must be worth, as shares of the error of `parallax` with the same face.
struct Worth {
    double first_order; ///< face=512, reflected rays that meet no second mirror
    double all;         ///< face=512, followed through other mirrors
    double angle;       ///< face=512, mean of the looked-up direction on first-order pixels
};

inline void expect_worth(const std::string& search, const Worth& worth) {
    const ColourError parallax = colour_error("parallax:face=512"), coarse = colour_error("parallax:face=256");
    const ColourError alone = colour_error(search + ":face=512,continue=0"), followed = colour_error(search + ":face=512,continue=4");
    EXPECT_LE(alone.first_order, worth.first_order * parallax.first_order);
    EXPECT_LE(followed.all, worth.all * parallax.all);
    EXPECT_LE(colour_error(search + ":face=256,continue=4").all, .80 * coarse.all);
    EXPECT_LE(followed.mirror_in_mirror, .55 * alone.mirror_in_mirror);
    EXPECT_LE(lookup_error(search + ":face=512,continue=0").mean_degrees, worth.angle * lookup_error("parallax:face=512").mean_degrees);
}

} // namespace test
