#include "stress/rough_floor.hpp"

#include "stress/scenes.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace catoptric::stress {

namespace {

constexpr std::uint32_t kStripWidthPixels = 32;
constexpr uvec2 kFloorPictureSize{kStripWidthPixels * kFloorStripRoughness.size(), 32};

/// Returns an environment of radiance 1. All scenes share it, because the engine filters each
/// environment once and keeps the result.
std::shared_ptr<const scene::Environment> make_white_environment() {
    static const auto kEnvironment = [] {
        auto map = std::make_shared<scene::Environment>();
        map->size = {128, 64};
        map->texels.assign(std::size_t{map->size.x} * map->size.y, vec3(1));
        return std::shared_ptr<const scene::Environment>(std::move(map));
    }();
    return kEnvironment;
}

} // namespace

scene::Material make_white_metal() {
    return {.name = "white metal", .albedo = vec3(1), .metallic = 1};
}

scene::Material make_white_plastic() {
    return {.name = "white plastic",
            .albedo = vec3(1),
            .dielectric_f0 = vec3(.04f),
            .dielectric_f90 = vec3(1)};
}

scene::Scene make_rough_floor(const scene::Material& material, double degrees, bool is_mirror) {
    constexpr double kFloorWidth = 1, kPictureHeight = kFloorWidth;
    const double angle = degrees * std::numbers::pi / 180, cosine = std::cos(angle),
                 sine = std::sin(angle);
    scene::Scene scene{.name = "rough floor", .mirror_max_roughness = 1};
    scene.environment = make_white_environment();
    const double depth = kPictureHeight / cosine; // twice what the camera sees
    double left = -kFloorWidth * kFloorStripRoughness.size() / 2;
    for (const double roughness : kFloorStripRoughness) {
        scene::Material strip = material;
        strip.roughness = static_cast<float>(roughness);
        const double right = left + kFloorWidth;
        add_quad(scene, add_material(scene, strip), {left, 0, depth}, {right, 0, depth},
                 {right, 0, -depth}, {left, 0, -depth});
        scene.objects.back().mirror = is_mirror;
        left = right;
    }
    // The lower edge of the picture plane lies above the floor.
    const double distance = kPictureHeight * (1 + sine / cosine);
    scene.cameras.push_back({.eye = distance * dvec3(0, cosine, sine),
                             .target = {0, 0, 0},
                             .up = {0, sine, -cosine},
                             .orthographic_height = kPictureHeight});
    return scene;
}

std::array<double, kFloorStripRoughness.size()>
measure_strips(Bench& bench, const scene::Scene& floor, const std::string& technique) {
    session::Request request = bench.make_request(floor, technique, 2);
    request.size = kFloorPictureSize;
    request.ambient = 0;
    const measure::Picture picture = bench.render_technique(request).hdr;
    std::array<double, kFloorStripRoughness.size()> means{};
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        means[i % kFloorPictureSize.x / kStripWidthPixels] += picture.pixels[i].x /
                                                              double(kStripWidthPixels *
                                                                     kFloorPictureSize.y);
    return means;
}

} // namespace catoptric::stress
