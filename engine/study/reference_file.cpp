#include "study/reference_file.hpp"

#include "core/error.hpp"
#include "measure/layered_file.hpp"
#include "report/json.hpp"
#include "scene/hash.hpp"

#include <fmt/format.h>

#include <array>

namespace catoptric::study {

namespace {

using report::Json;

constexpr const char* kReferenceSchema = "catoptric/reference/1";
const std::array<std::string, 4> kLayerNames{"A", "B", "variance_A", "variance_B"};

std::string format_point(const dvec3& point) {
    return fmt::format("{},{},{}", point.x, point.y, point.z);
}

/// Returns the file's description. Throws `bad_data` if it is not one of a reference.
Json parse_description(const std::string& text, const std::string& file) {
    Json json = Json::parse(text, nullptr, false);
    const bool is_ours = json.is_object() && json.contains("schema") &&
                         json["schema"] == kReferenceSchema && json.contains("key") &&
                         json["key"].is_object();
    check(is_ours, Failure::bad_data, file,
          ": wanted a reference that 'compare --reference' wrote (", kReferenceSchema,
          "), found another OpenEXR file");
    return json;
}

/// Returns a list of numbers. Throws `bad_data` for another value.
template <typename Number>
std::vector<Number> read_number_list(const Json& json, const char* name, const std::string& file) {
    try {
        return json.at(name).get<std::vector<Number>>();
    } catch (const Json::exception&) {
        fail(Failure::bad_data, file, ": wanted the list of numbers '", name,
             "' in its description");
    }
}

} // namespace

ReferenceKey make_reference_key(const Request& base, const std::string& technique) {
    const scene::Camera& camera = base.camera;
    return {{"scene", scene::hash_scene(base.scene)},
            {"camera", fmt::format("{} at {} up {} fov {} height {}", format_point(camera.eye),
                                   format_point(camera.target), format_point(camera.up),
                                   camera.vertical_fov_degrees, camera.orthographic_height)},
            {"time", fmt::format("{}", base.instant(base.total()))},
            {"size", fmt::format("{}x{}", base.size.x, base.size.y)},
            {"ambient", fmt::format("{}", base.ambient)},
            {"technique", technique},
            {"seed", std::to_string(base.seed)}};
}

void write_reference_file(const StoredReference& reference, const ReferenceKey& key,
                          const std::filesystem::path& path) {
    Json json{{"schema", kReferenceSchema}};
    for (const auto& [name, value] : key) json["key"][name] = value;
    json["seeds"] = reference.seeds;
    json["gpu_ms"] = reference.gpu_ms;
    json["rays"] = reference.rays;
    measure::write_layers({{{kLayerNames[0], reference.a.mean()},
                            {kLayerNames[1], reference.b.mean()},
                            {kLayerNames[2], reference.a.variance()},
                            {kLayerNames[3], reference.b.variance()}},
                           json.dump()},
                          path);
}

StoredReference read_reference_file(const ReferenceKey& key, const std::filesystem::path& path) {
    const std::string file = path.string();
    const measure::LayeredFile stored = measure::read_layers(path, kLayerNames);
    const Json json = parse_description(stored.description, file);
    for (const auto& [name, value] : key) {
        const Json found = json["key"].contains(name) ? json["key"][name] : Json();
        check(found == Json(value), Failure::bad_data, file, ": wanted a reference for the ", name,
              " ", value, ", found one for ", report::describe(found));
    }
    StoredReference reference;
    reference.seeds = read_number_list<int>(json, "seeds", file);
    reference.gpu_ms = read_number_list<double>(json, "gpu_ms", file);
    if (json.contains("rays") && json["rays"].is_number_integer())
        reference.rays = json["rays"].get<int>();
    const int frames = static_cast<int>(reference.seeds.size() / 2);
    check(frames > 0 && !reference.gpu_ms.empty(), Failure::bad_data, file,
          ": wanted seeds and times of at least one frame a half, found ", reference.seeds.size(),
          " and ", reference.gpu_ms.size());
    reference.a = measure::PictureMean(frames, stored.layers[0].picture, stored.layers[2].picture);
    reference.b = measure::PictureMean(frames, stored.layers[1].picture, stored.layers[3].picture);
    return reference;
}

} // namespace catoptric::study
