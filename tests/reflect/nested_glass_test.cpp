// Tests of solid bodies of glass that share space, against a ray tracer in double precision.
#include "core/shader_math.hpp"
#include "scene/surroundings.hpp"
#include "support/rendering.hpp"
#include "support/scenes.hpp"
#include "support/smooth_environment.hpp"
#include "support/special_values.hpp"

#include <cmath>
#include <iostream>
#include <optional>

namespace {

using namespace catoptric;

constexpr int kBallsEdge = 48;

/// A ball of glass. Where balls share space, the last of the list is there.
struct GlassBallPlace {
    dvec3 centre;
    double radius;
    scene::Material glass;
};

scene::Material make_ranked_glass(float ior, const vec3& absorption = vec3(0)) {
    return {.name = "glass",
            .albedo = vec3(1),
            .roughness = 0,
            .dielectric_f0 = vec3(std::pow((ior - 1) / (ior + 1), 2.f)),
            .dielectric_f90 = vec3(1),
            .transmission = 1,
            .ior = ior,
            .solid = true,
            .absorption = absorption};
}

scene::Scene make_scene_of_balls(const std::vector<GlassBallPlace>& balls) {
    scene::Scene scene{.name = "balls"};
    for (const GlassBallPlace& ball : balls)
        test::add_ball(scene, "ball", test::add_material(scene, ball.glass), ball.centre,
                       ball.radius, 5);
    scene.environment = test::make_smooth_environment();
    scene.cameras.push_back({.eye = {.5, .4, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 36});
    return scene;
}

class NestedWitness {
public:
    NestedWitness(const scene::Scene& scene, const std::vector<GlassBallPlace>& balls)
        : scene_(scene), balls_(balls) {}

    /// Returns the light along a ray that starts in the balls of the set of bits `inside`.
    dvec3 trace(const dvec3& origin, const dvec3& direction, unsigned inside, double weight,
                int depth) const {
        if (depth == 0 || weight < 1e-5) return dvec3(0);
        double nearest = 0;
        std::optional<std::size_t> met;
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const dvec3 from = origin - balls_[i].centre;
            const double b = glm::dot(from, direction),
                         c = glm::dot(from, from) - balls_[i].radius * balls_[i].radius;
            if (b * b < c) continue;
            const double root = std::sqrt(b * b - c), t = inside >> i & 1 ? root - b : -root - b;
            if (t > 1e-9 && (!met || t < nearest)) nearest = t, met = i;
        }
        const scene::Material* const before = find_glass(inside);
        if (!met) return scene::environment_radiance(*scene_.environment, direction);
        const unsigned behind_bits = inside ^ 1u << *met;
        const scene::Material* const after = find_glass(behind_bits);
        const dvec3 at = origin + nearest * direction;
        const dvec3 absorbed = before ? glm::exp(-dvec3(before->absorption) * nearest) : dvec3(1);
        if (before == after) return absorbed * trace(at, direction, behind_bits, weight, depth);
        dvec3 normal = glm::normalize(at - balls_[*met].centre);
        if (glm::dot(normal, direction) > 0) normal = -normal;
        const double ratio = double(after ? after->ior : 1) / double(before ? before->ior : 1),
                     cosine = -glm::dot(direction, normal);
        double behind;
        const double reflected = f64::fresnel_dielectric(cosine, ratio, behind);
        dvec3 light = reflected * trace(at, direction + 2 * cosine * normal, inside,
                                        weight * reflected, depth - 1);
        if (reflected < 1)
            light += (1 - reflected) *
                     trace(at, f64::refract_direction(direction, normal, cosine, ratio, behind),
                           behind_bits, weight * (1 - reflected), depth - 1);
        return absorbed * light;
    }

private:
    const scene::Material* find_glass(unsigned inside) const {
        for (std::size_t i = balls_.size(); i-- > 0;)
            if (inside >> i & 1) return &balls_[i].glass;
        return nullptr;
    }
    const scene::Scene& scene_;
    const std::vector<GlassBallPlace>& balls_;
};

void expect_balls_equal_witness(const char* what, const std::vector<GlassBallPlace>& balls) {
    const scene::Scene scene = make_scene_of_balls(balls);
    const NestedWitness witness(scene, balls);
    const measure::Picture found = test::render_technique(scene, "raytrace:depth=16,sphere=exact",
                                                          {kBallsEdge, kBallsEdge})
                                       .hdr;
    int off = 0;
    for (int y = 0; y < kBallsEdge; ++y)
        for (int x = 0; x < kBallsEdge; ++x) {
            const dvec3 direction = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                                    kBallsEdge);
            const dvec3 wanted = witness.trace(scene.cameras.front().eye, direction, 0, 1, 16);
            const dvec3 difference = glm::abs(dvec3(found.at(x, y)) - wanted);
            off += std::max({difference.x, difference.y, difference.z}) > .02;
        }
    std::cout << "[ MEASURED ] " << what << ": " << off << " of " << kBallsEdge * kBallsEdge
              << " pixels off by .02\n";
    EXPECT_LE(off, kBallsEdge * kBallsEdge / 250) << what;
}

TEST(NestedGlassRays, EqualsATracerInDoublePrecision) {
    const scene::Material water = make_ranked_glass(1.33f, {.1f, .4f, .9f}),
                          glass = make_ranked_glass(1.5f, {.6f, .2f, .1f}),
                          air = make_ranked_glass(1);
    expect_balls_equal_witness("water in a ball of glass",
                               {{{0, 0, 0}, 1, glass}, {{.1, .05, .1}, .6, water}});
    expect_balls_equal_witness("a bubble of air in a ball of glass",
                               {{{0, 0, 0}, 1, glass}, {{-.2, .1, .1}, .5, air}});
    expect_balls_equal_witness("glass that cuts into water",
                               {{{.5, 0, 0}, .7, water}, {{-.3, .1, 0}, .7, glass}});
    expect_balls_equal_witness("three bodies", {{{0, 0, 0}, 1.1, water},
                                                {{.2, 0, .1}, .7, glass},
                                                {{.3, .1, .1}, .4, make_ranked_glass(1.8f)}});
}

} // namespace
