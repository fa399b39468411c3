// Writes the field "scene" of report.json.
#include "report/json.hpp"

namespace catoptric::report {

Json camera_json(const measure::CameraFacts& camera) {
    const bool is_flat = camera.orthographic_height > 0;
    return {{"name", camera.name},
            {"eye", point_json(camera.eye)},
            {"target", point_json(camera.target)},
            {"up", point_json(camera.up)},
            {"vertical_fov_degrees", is_flat ? Json() : number_json(camera.vertical_fov_degrees)},
            {"orthographic_height", is_flat ? number_json(camera.orthographic_height) : Json()}};
}

Json lights_json(const std::vector<LightFacts>& lights) {
    return list_json(lights, [](const LightFacts& light) {
        const bool is_mesh = light.kind == "mesh";
        return Json{
            {"kind", light.kind},
            {"name", is_mesh ? Json() : Json(light.name)},
            {"position", light.is_parallel ? Json() : point_json(light.position)},
            {"direction", light.direction == dvec3(0) ? Json() : point_json(light.direction)},
            {"emission", point_json(light.emission)},
            {"area", is_mesh ? number_json(light.area) : Json()}};
    });
}

Json environment_json(const std::optional<EnvironmentFacts>& environment) {
    if (!environment) return nullptr;
    return {{"name", environment->name},
            {"scale", number_json(environment->scale)},
            {"rotation_degrees", number_json(environment->rotation_degrees)}};
}

Json unsupported_json(const std::vector<UnsupportedFeatureFacts>& unsupported) {
    return list_json(unsupported, [](const UnsupportedFeatureFacts& gap) {
        return Json{{"id", gap.id},
                    {"count", gap.count},
                    {"first", gap.first},
                    {"pixel_share", number_json(gap.pixel_share)}};
    });
}

Json scene_json(const SceneFacts& scene) {
    const measure::SceneContents& contents = measure::read_scene_contents(scene);
    return {{"name", scene.name},
            {"triangles", scene.triangles},
            {"mirrors", scene.mirrors},
            {"hash", scene.hash},
            {"camera", camera_json(scene.camera)},
            {"lights", lights_json(contents.lights)},
            {"environment", environment_json(contents.environment)},
            {"gaps", unsupported_json(contents.unsupported)}};
}

} // namespace catoptric::report
