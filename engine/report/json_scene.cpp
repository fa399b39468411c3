// Writes the field "scene" of report.json.
#include "report/json.hpp"

namespace catoptric::report {

Json make_camera_json(const measure::CameraFacts& camera) {
    const bool is_flat = camera.orthographic_height > 0;
    return {
        {"name", camera.name},
        {"eye", make_point_json(camera.eye)},
        {"target", make_point_json(camera.target)},
        {"up", make_point_json(camera.up)},
        {"vertical_fov_degrees", is_flat ? Json() : make_number_json(camera.vertical_fov_degrees)},
        {"orthographic_height", is_flat ? make_number_json(camera.orthographic_height) : Json()}};
}

Json make_lights_json(const std::vector<LightFacts>& lights) {
    return make_list_json(lights, [](const LightFacts& light) {
        const bool is_mesh = light.kind == "mesh";
        return Json{
            {"kind", light.kind},
            {"name", is_mesh ? Json() : Json(light.name)},
            {"position", light.is_parallel ? Json() : make_point_json(light.position)},
            {"direction", light.direction == dvec3(0) ? Json() : make_point_json(light.direction)},
            {"emission", make_point_json(light.emission)},
            {"area", is_mesh ? make_number_json(light.area) : Json()}};
    });
}

Json make_environment_json(const std::optional<EnvironmentFacts>& environment) {
    if (!environment) return nullptr;
    return {{"name", environment->name},
            {"scale", make_number_json(environment->scale)},
            {"rotation_degrees", make_number_json(environment->rotation_degrees)}};
}

Json make_unsupported_features_json(const std::vector<UnsupportedFeatureFacts>& unsupported) {
    return make_list_json(unsupported, [](const UnsupportedFeatureFacts& gap) {
        return Json{{"id", gap.id},
                    {"count", gap.count},
                    {"first", gap.first},
                    {"pixel_share", make_number_json(gap.pixel_share)}};
    });
}

Json make_scene_json(const SceneFacts& scene) {
    const measure::SceneContents& contents = measure::read_scene_contents(scene);
    return {{"name", scene.name},
            {"triangles", scene.triangles},
            {"mirrors", scene.mirrors},
            {"hash", scene.hash},
            {"camera", make_camera_json(scene.camera)},
            {"lights", make_lights_json(contents.lights)},
            {"environment", make_environment_json(contents.environment)},
            {"gaps", make_unsupported_features_json(contents.unsupported)}};
}

} // namespace catoptric::report
