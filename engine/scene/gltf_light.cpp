#include "scene/gltf_texture.hpp"

#include "scene/repair.hpp"

#include <cmath>
#include <numbers>

namespace catoptric::scene::gltf {

namespace {

constexpr std::string_view kLights = "KHR_lights_punctual";

void read_cone(const Item& light, Punctual& to) {
    const std::optional<Item> spot = light.object("spot");
    const double inner = spot ? spot->number("innerConeAngle", 0) : 0;
    const double outer = spot ? spot->number("outerConeAngle", std::numbers::pi / 4)
                              : std::numbers::pi / 4;
    light.require(inner >= 0 && inner <= outer && outer <= std::numbers::pi / 2 + 1e-6,
                  "spot: wanted angles with 0 <= inner <= outer <= pi / 2, found ", inner, " and ",
                  outer);
    to.cos_inner = std::cos(inner), to.cos_outer = std::cos(outer);
}

Punctual light_of(const Item& light) {
    using enum Punctual::Kind;
    const std::string kind = light.text("type");
    light.require(kind == "point" || kind == "spot" || kind == "directional",
                  "type: wanted point, spot or directional, found ", shown(Json(kind)));
    Punctual to{.name = light.name(),
                .kind = kind == "spot"    ? spot
                        : kind == "point" ? point
                                          : directional};
    const std::vector<double> colour = light.numbers("color", 3);
    const double intensity = light.number("intensity", 1);
    to.intensity = vec3(colour.empty() ? dvec3(intensity)
                                       : intensity * dvec3(colour[0], colour[1], colour[2]));
    light.require(is_radiance(to.intensity),
                  "wanted an intensity of at least 0 that fits a float, found another");
    if (light.has("range")) to.range = light.number("range", 0);
    light.require(to.range > 0, "range: wanted a number above 0, found ", to.range);
    if (to.kind == spot) read_cone(light, to);
    return to;
}

} // namespace

Lights read_lights(const Source& source) {
    Lights result;
    const std::optional<Item> extensions = source.root.object("extensions");
    const std::optional<Item> all = extensions ? extensions->object(kLights) : std::nullopt;
    if (all)
        all->each("lights", [&](const Item& item) { result.lights.push_back(light_of(item)); });
    source.root.each("nodes", [&](const Item& node) {
        const std::optional<Item> its = node.object("extensions");
        const std::optional<Item> use = its ? its->object(kLights) : std::nullopt;
        result.of_node.push_back(
            use ? std::optional(use->needed_index("light", result.lights.size())) : std::nullopt);
    });
    return result;
}

} // namespace catoptric::scene::gltf
