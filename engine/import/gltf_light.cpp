#include "import/gltf_texture.hpp"

#include "scene/light_kind.hpp"
#include "scene/material_facts.hpp"
#include "scene/repair.hpp"

#include <algorithm>

namespace catoptric::scene::gltf {

namespace {

constexpr std::string_view kPunctualLightsExtension = "KHR_lights_punctual";

/// Returns the kind of a light, as its `type` or our own mark in `extras` names it.
const LightKind& read_light_kind(const JsonObject& light) {
    const std::optional<JsonObject> ours = find_extras(light);
    const std::string type = light.text("type");
    const std::string name = ours && ours->has("light") ? ours->text("light") : type;
    const auto kind = std::ranges::find_if(light_kinds(), [&](const LightKind& row) {
        return row.name == name && gltf_type_of(row) == type;
    });
    light.require(kind != light_kinds().end(), "type: wanted point, spot or directional, found ",
                  describe(Json(type)));
    return *kind;
}

PunctualLight read_punctual_light(const JsonObject& light) {
    const LightKind& kind = read_light_kind(light);
    PunctualLight to{.name = light.name(), .kind = kind.id};
    const std::vector<double> colour = light.numbers("color", 3);
    const double intensity = light.number("intensity", 1);
    to.intensity = vec3(colour.empty() ? dvec3(intensity)
                                       : intensity * dvec3(colour[0], colour[1], colour[2]));
    light.require(is_valid_radiance(to.intensity),
                  "wanted an intensity of at least 0 that fits a float, found another");
    if (light.has("range")) to.range = light.number("range", 0);
    light.require(to.range > 0, "range: wanted a number above 0, found ", to.range);
    if (kind.read != nullptr) kind.read(light, to);
    return to;
}

} // namespace

PunctualLights read_lights(const MaterialContext& source) {
    PunctualLights result;
    if (const auto all = source.root.extension(kPunctualLightsExtension))
        all->each("lights", [&](const JsonObject& item) {
            result.lights.push_back(read_punctual_light(item));
        });
    source.root.each("nodes", [&](const JsonObject& node) {
        const std::optional<JsonObject> use = node.extension(kPunctualLightsExtension);
        result.of_node.push_back(
            use ? std::optional(use->needed_index("light", result.lights.size())) : std::nullopt);
    });
    return result;
}

} // namespace catoptric::scene::gltf
