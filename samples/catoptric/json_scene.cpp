// Writes the JSON of `info SCENE --json`.
#include "json.hpp"
#include "report/comparison.hpp"
#include "report/json.hpp"
#include "scene/material_facts.hpp"
#include "scene/number.hpp"
#include "session/engine.hpp"

namespace catoptric::cli {

namespace {

using report::Json;

Json colour_json(const vec3& colour) {
    return {scene::shortest_double(colour.x), scene::shortest_double(colour.y),
            scene::shortest_double(colour.z)};
}

Json material_json(const session::MaterialInfo& material) {
    Json json{{"name", material.name},
              {"kind", material.kind},
              {"objects", material.objects},
              {"albedo", colour_json(material.albedo)}};
    for (std::size_t i = 0; i < material.factors.size(); ++i)
        json[std::string(scene::kMaterialFactors[i].name)] = scene::shortest_double(
            material.factors[i]);
    json["f0"] = colour_json(material.f0);
    json["light"] = material.light == vec3(0) ? Json() : colour_json(material.light);
    json["glows"] = material.glows, json["masked"] = material.is_masked;
    json["blended"] = material.is_blended;
    json["two_sided"] = material.is_two_sided, json["textures"] = material.textures;
    return json;
}

Json shape_json(const scene::MirrorShape& shape) {
    Json json{{"kind", scene::shape_name(shape.kind)}, {"closed", shape.is_closed}};
    json["sphere"] = nullptr;
    if (shape.fit)
        json["sphere"] = {{"centre", report::point_json(shape.fit->centre)},
                          {"radius", report::number_json(shape.fit->radius)},
                          {"tolerance", report::number_json(shape.tolerance)}};
    return json;
}

Json mirror_json(const session::MirrorInfo& mirror) {
    return {{"mirror", mirror.number},
            {"name", mirror.name},
            {"shape", shape_json(mirror.shape)},
            {"screen_share", report::number_json(mirror.screen_share)},
            {"capture_centre", report::point_json(mirror.capture_centre)},
            {"reflectance", colour_json(mirror.reflectance)},
            {"constant", mirror.is_constant}};
}

template <typename List, typename ToJson>
Json list_json(const List& list, ToJson&& to_json) {
    Json json = Json::array();
    for (const auto& item : list) json.push_back(to_json(item));
    return json;
}

} // namespace

std::string scene_json(const SceneInfoFacts& words) {
    const session::SceneInfo& info = words.info;
    const report::SceneFacts& facts = info.facts;
    const measure::SceneContents& contents = measure::read_scene_contents(facts);
    Json document{{"schema", "catoptric/scene/1"},
                  {"version", session::version()},
                  {"commit", session::commit()}};
    document["scene"] = facts.name;
    document["hash"] = facts.hash;
    document["scene_file"] = words.scene_file.empty() ? Json() : Json(words.scene_file);
    document["triangles"] = facts.triangles;
    document["stored_triangles"] = info.stored_triangles;
    document["objects"] = info.objects;
    document["object_names"] = info.object_names;
    document["meshes"] = info.meshes;
    document["instances"] = info.instances;
    document["bytes"] = {{"geometry", info.geometry_bytes},
                         {"images", info.image_bytes},
                         {"files", info.file_bytes}};
    document["materials"] = list_json(info.materials, material_json);
    document["mirrors"] = list_json(info.mirrors, mirror_json);
    document["mirror_options"] = info.mirror_options;
    document["lights"] = report::lights_json(contents.lights);
    document["environment"] = report::environment_json(contents.environment);
    document["cameras"] = list_json(info.cameras, report::camera_json);
    document["camera"] = report::camera_json(facts.camera);
    document["ambient"] = report::number_json(words.ambient);
    document["exposure"] = words.exposure ? report::number_json(*words.exposure) : Json();
    document["auto_exposure"] = words.auto_exposure;
    document["gaps"] = report::unsupported_json(contents.unsupported);
    document["warnings"] = words.warnings;
    return document.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

} // namespace catoptric::cli
