// Stress properties of light that arrives bounce by bounce: each bounce changes the picture less
// than the last one, and no bounce removes light.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include "import/load.hpp"
#include "measure/masks.hpp"
#include "measure/picture.hpp"
#include "scene/built_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::stress {

namespace {

constexpr int kMaxBounces = 6;
constexpr double kMaxBounceStepRatio = 0.4; // a step is at most this share of the step before
/// Least edge of pictures of late bounces, which cover few pixels.
constexpr std::uint32_t kMinBouncePictureEdge = 256;

struct BouncePictures {
    std::vector<measure::Picture> pictures; ///< entry k: picture with k bounces
    measure::Mask mirrors;
};

BouncePictures render_bounces(Bench& bench, session::Request request, int face = 128) {
    const auto render = [&](const std::string& technique) {
        request.techniques = {technique};
        return bench.render_technique(request);
    };
    BouncePictures bounces{{}, measure::mask_mirrors(render("raytrace:depth=1").hits)};
    for (int k = 0; k <= kMaxBounces; ++k)
        bounces.pictures.push_back(render(fmt::format("naive:face={},bounces={}", face, k)).hdr);
    return bounces;
}

/// Returns the rmse between the pictures with k and k + 1 bounces over mirror pixels, k = 0..5.
/// Adds the case that no pixel gets darker with a further bounce. No pixel can get darker because
/// captures start black, and each capture is a weighted mean of captures of the bounce before.
std::vector<double> bounce_differences(Bench& bench, const std::string& where,
                                       const BouncePictures& bounces) {
    const std::vector<float> no_flip(bounces.pictures.front().pixels.size());
    std::vector<double> steps;
    for (std::size_t k = 0; k + 1 < bounces.pictures.size(); ++k) {
        const measure::Picture &before = bounces.pictures[k], &after = bounces.pictures[k + 1];
        std::size_t darker = 0;
        for (std::size_t i = 0; i < before.pixels.size(); ++i)
            darker += !all(greaterThanEqual(after.pixels[i], before.pixels[i]));
        bench.add_case(fmt::format("{}, bounce {}: pixels that got darker", where, k + 1),
                       double(darker), 0);
        steps.push_back(measure::difference(before, after, bounces.mirrors, no_flip).rmse);
    }
    return steps;
}

void add_falling(Bench& bench, const std::string& where, const std::vector<double>& steps) {
    for (std::size_t k = 1; k < steps.size(); ++k) {
        bench.add_case(fmt::format("{}, bounce {}: share of the step before", where, k + 1),
                       steps[k] / steps[k - 1], kMaxBounceStepRatio);
        bench.add_case(fmt::format("{}, bounce {}: no change", where, k + 1), steps[k] > 0 ? 0 : 1,
                       0);
    }
}

void judge_cornell_bounces(Bench& bench) {
    session::Request request = bench.make_request(scene::make_cornell(), "naive", 1);
    request.size = uvec2(bench.has_small_pictures() ? kMinBouncePictureEdge : 512);
    add_falling(bench, "the report's room",
                bounce_differences(bench, "the report's room", render_bounces(bench, request)));
}

/// Returns the light that bounce `k` adds to a mirror pixel, in the mean of all channels clamped to
/// [0,1].
double added_light(const BouncePictures& bounces, std::size_t k) {
    double sum = 0;
    for (std::size_t i = 0; i < bounces.mirrors.size(); ++i)
        if (bounces.mirrors[i] != 0)
            for (int channel = 0; channel < 3; ++channel)
                sum += std::min(bounces.pictures[k].pixels[i][channel], 1.f) -
                       std::min(bounces.pictures[k - 1].pixels[i][channel], 1.f);
    return sum / (3 * double(measure::count_pixels(bounces.mirrors)));
}

/// Judges a room with small balls. A third image covers one or two of about 4,000 pixels, and
/// chance decides whether their texels see the lamp. The fall from step to step is therefore
/// random, and so is an rmse, which a few bright pixels decide. Only the light that bounce 4 adds
/// is judged.
void judge_ball_bounces(Bench& bench) {
    session::Request request = bench.make_request(make_room(bench, 4), "naive", 1);
    request.size = bench.size_at_least(kMinBouncePictureEdge);
    const BouncePictures bounces = render_bounces(bench, request);
    bounce_differences(bench, "a room", bounces);
    bench.add_case("a room, bounce 4: light added, as a share of that of bounce 1",
                   added_light(bounces, 4) / added_light(bounces, 1), .01);
}

/// Two flat mirrors that face each other in a box that emits 1, with an `angle` between them and
/// one `reflectance`. After k mirrors a ray has turned by 2 k times the angle, until it leaves the
/// mirrors. A captured path of k mirrors shows reflectance^k. A further bounce turns a black band,
/// as wide as the last one, into the next power.
struct MirrorWedge {
    double reflectance, angle;

    scene::Scene make_wedge_scene(dvec3 eye) const {
        scene::Scene scene = make_white_furnace({});
        const std::size_t mirror = add_material(
            scene, {.name = "mirror",
                    .mirror = true,
                    .reflectance = vec3(static_cast<float>(reflectance))});
        const auto add = [&](double x, double by) {
            const dvec3 along = 2.0 * dvec3(std::sin(by), 0, std::cos(by)), up(0, 2, 0),
                        at(x, 0, 1);
            add_quad(scene, mirror, at - along - up, at + along - up, at + along + up,
                     at - along + up);
        };
        add(-1, -angle / 2), add(1, angle / 2);
        scene.cameras.front() = {
            .eye = eye, .target = {-1, eye.y, eye.z + 1.2}, .vertical_fov_degrees = 70};
        return scene;
    }
    /// Returns whether the radiance is 0 or what up to `most` mirrors leave of 1.
    bool is_explained(float radiance, int most) const {
        if (radiance == 0) return true;
        for (int k = 1; k <= most; ++k)
            if (std::abs(radiance / std::pow(reflectance, k) - 1) <= .005) return true;
        return false;
    }
};

/// Judges the wedge of two mirrors. From the third bounce on, a change must be the reflectance
/// times the change before. Each pixel that does not mix two bands must show a power of the
/// reflectance.
void judge_mirror_wedge(Bench& bench) {
    const MirrorWedge wedge{bench.random(.2, .3), bench.random(.05, .08)};
    session::Request request = bench.make_request(
        wedge.make_wedge_scene(
            {bench.random(-.1, .1), bench.random(-.2, .2), bench.random(-.9, -.7)}),
        "naive", 1);
    request.ambient = 0;
    request.size = bench.size_at_least(kMinBouncePictureEdge);
    const BouncePictures bounces = render_bounces(bench, request, 256);
    const std::string where = fmt::format("mirrors of {:.3f} at {:.3f}", wedge.reflectance,
                                          wedge.angle);
    const std::vector<double> steps = bounce_differences(bench, where, bounces);
    add_falling(bench, where, steps);
    for (std::size_t k = 2; k + 1 < steps.size(); ++k)
        bench.add_case(
            fmt::format("{}, bounce {}: share of the step before, off the reflectance by a "
                        "share of",
                        where, k + 1),
            std::abs(steps[k] / steps[k - 1] / wedge.reflectance - 1), .1);
    std::size_t strange = 0;
    for (std::size_t i = 0; i < bounces.mirrors.size(); ++i)
        strange += bounces.mirrors[i] != 0 &&
                   !wedge.is_explained(bounces.pictures.back().pixels[i].x, kMaxBounces);
    bench.add_case(where + ": share of pixels that no number of mirrors explains",
                   double(strange) / double(measure::count_pixels(bounces.mirrors)), .2);
}

void judge_bounces(Bench& bench) {
    judge_cornell_bounces(bench);
    judge_ball_bounces(bench);
    judge_mirror_wedge(bench);
}

const RegisteredProperty kBouncesProperty{{"N8", "naive, bounces 0..6",
                                           "no mirror darkens, steps fall by 2.5 and more",
                                           judge_bounces, "bounces_capped"}};

} // namespace

} // namespace catoptric::stress
