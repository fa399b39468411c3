// The kinds of light of KHR_lights_punctual.
#include "import/json.hpp"
#include "scene/light_kind.hpp"
#include "shared.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catoptric::scene {

void read_spot_cone(const gltf::JsonObject& light, PunctualLight& to) {
    const std::optional<gltf::JsonObject> spot = light.object("spot");
    const double inner = spot ? spot->number("innerConeAngle", 0) : 0;
    const double outer = spot ? spot->number("outerConeAngle", std::numbers::pi / 4)
                              : std::numbers::pi / 4;
    light.require(inner >= 0 && inner <= outer && outer <= std::numbers::pi / 2 + 1e-6,
                  "spot: wanted angles with 0 <= inner <= outer <= pi / 2, found ", inner, " and ",
                  outer);
    to.cos_inner = std::cos(inner), to.cos_outer = std::cos(outer);
}

namespace {

/// Returns the width of a spot's edge as a difference of cosines, at least .001.
double spot_edge_width(const PointLight& light) {
    return std::max(.001, light.cos_inner - light.cos_outer);
}

double spot_share(const PointLight& light, double cosine) {
    const double cone = std::clamp((cosine - light.cos_outer) / spot_edge_width(light), 0.0, 1.0);
    return cone * cone;
}

LightShaderNumbers spot_numbers(const PointLight& light) {
    return {static_cast<float>(light.cos_outer), static_cast<float>(1 / spot_edge_width(light))};
}

const RegisteredLightKind kPointLightKind{{.id = PunctualLight::Kind::point,
                                           .name = "point",
                                           .shader_kind = shared::kLightKindPoint,
                                           .is_aimed = false}};
const RegisteredLightKind kSpotLightKind{{.id = PunctualLight::Kind::spot,
                                          .name = "spot",
                                          .shader_kind = shared::kLightKindPoint,
                                          .share = spot_share,
                                          .shader_numbers = spot_numbers,
                                          .read = read_spot_cone}};
const RegisteredLightKind kDirectionalLightKind{{.id = PunctualLight::Kind::directional,
                                                 .name = "directional",
                                                 .shader_kind = shared::kLightKindDirectional,
                                                 .is_parallel = true}};

} // namespace

} // namespace catoptric::scene
