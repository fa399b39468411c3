#include "scene/scene_file.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "scene/file_options.hpp"
#include "scene/files.hpp"
#include "scene/json.hpp"
#include "scene/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::scene {

namespace {

namespace fs = std::filesystem;

/// Key of the file: its name, its reader and its writer. The table of keys defines the format.
struct OverrideKey {
    const char* name;
    void (*read)(const gltf::Item& file, const gltf::Json& value, SceneOverrides& overrides);
    gltf::Json (*written)(const SceneOverrides& overrides); ///< null: not set
};

using gltf::Item;
using gltf::Json;

std::string text_of(const Item& file, const Json& value, const char* key) {
    file.require(value.is_string(), key, ": wanted a text, found ", gltf::shown(value));
    return value.get<std::string>();
}

std::vector<std::string> texts_of(const Item& file, const Json& value, const char* key) {
    file.require(value.is_array(), key, ": wanted a list of texts, found ", gltf::shown(value));
    std::vector<std::string> texts;
    for (const Json& one : value) texts.push_back(text_of(file, one, key));
    return texts;
}

double number_of(const Item& file, const Json& value, const char* key, double low, double high) {
    const double number = value.is_number() ? value.get<double>() : NAN;
    file.require(number >= low && number <= high, key, ": wanted a number from ", low, " to ", high,
                 ", found ", gltf::shown(value));
    return number;
}

/// Calls `read`, which is shared with the command line, and turns its errors into errors of the
/// file.
template <typename Read>
auto as_data(const Item& file, Read&& read) {
    try {
        return read();
    } catch (const Error& error) {
        fail(Failure::bad_data, file.place(), ": ", error.what());
    }
}

template <typename Value>
Json json_of(const std::optional<Value>& value) {
    return value ? Json(*value) : Json();
}

Json mirror_json(const MirrorOverride& wish) {
    const vec3& r = wish.reflectance;
    const auto text = [](float share) { return Json(as_typed(share)).dump(); };
    return wish.pattern + "=" +
           (r.x == r.y && r.y == r.z ? text(r.x) : text(r.x) + "," + text(r.y) + "," + text(r.z));
}

const std::array<OverrideKey, 12> kKeys{
    {{"mirrors",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          for (const std::string& text : texts_of(file, value, "mirrors"))
              overrides.mirrors.push_back(
                  as_data(file, [&] { return read_mirror_override("mirrors", text); }));
      },
      [](const SceneOverrides& overrides) {
          Json list = Json::array();
          for (const MirrorOverride& wish : overrides.mirrors) list.push_back(mirror_json(wish));
          return list.empty() ? Json() : list;
      }},
     {"lights",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          overrides.lights = texts_of(file, value, "lights");
      },
      [](const SceneOverrides& overrides) {
          return overrides.lights.empty() ? Json() : Json(overrides.lights);
      }},
     {"mirror_max_roughness",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          overrides.mirror_max_roughness = number_of(file, value, "mirror_max_roughness", 0, 1);
      },
      [](const SceneOverrides& overrides) { return json_of(overrides.mirror_max_roughness); }},
     {"dielectric_mirrors",
      [](const Item& file, const Json&, SceneOverrides& overrides) {
          overrides.dielectric_mirrors = file.flag("dielectric_mirrors", false);
      },
      [](const SceneOverrides& overrides) { return json_of(overrides.dielectric_mirrors); }},
     {"environment",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          overrides.environment = text_of(file, value, "environment");
      },
      [](const SceneOverrides& overrides) { return json_of(overrides.environment); }},
     {"environment_scale",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          overrides.environment_scale = number_of(file, value, "environment_scale", 0, kMostScale);
      },
      [](const SceneOverrides& overrides) { return json_of(overrides.environment_scale); }},
     {"environment_rotate",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          overrides.environment_rotation = number_of(file, value, "environment_rotate", -kMostTurn,
                                                     kMostTurn);
      },
      [](const SceneOverrides& overrides) { return json_of(overrides.environment_rotation); }},
     {"ambient",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          overrides.ambient = number_of(file, value, "ambient", 0, kMostScale);
      },
      [](const SceneOverrides& overrides) { return json_of(overrides.ambient); }},
     {"exposure",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          if (value == "auto")
              overrides.exposure = ExposureOverride{};
          else
              overrides.exposure = ExposureOverride{
                  number_of(file, value, "exposure", -kMostStops, kMostStops)};
      },
      [](const SceneOverrides& overrides) {
          if (!overrides.exposure) return Json();
          return overrides.exposure->stops ? Json(*overrides.exposure->stops) : Json("auto");
      }},
     {"camera",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          overrides.camera = text_of(file, value, "camera");
      },
      [](const SceneOverrides& overrides) { return json_of(overrides.camera); }},
     {"up",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          file.require(value == "y" || value == "z", "up: wanted \"y\" or \"z\", found ",
                       gltf::shown(value));
          overrides.up = value == "z" ? Up::z : Up::y;
      },
      [](const SceneOverrides& overrides) {
          return overrides.up ? Json(*overrides.up == Up::z ? "z" : "y") : Json();
      }},
     {"animation",
      [](const Item& file, const Json& value, SceneOverrides& overrides) {
          overrides.animation = text_of(file, value, "animation");
      },
      [](const SceneOverrides& overrides) { return json_of(overrides.animation); }}}};

SceneOverrides read(const std::string& file, const std::string& text, Account& account) {
    const Json document = gltf::parse_json(file, text, account);
    const Item item(document, file);
    item.require(document.is_object(), "wanted an object, found ", gltf::shown(document));
    std::vector<std::string> names;
    for (const OverrideKey& key : kKeys) names.emplace_back(key.name);
    SceneOverrides overrides;
    for (const auto& [name, value] : document.items()) {
        const auto key = std::ranges::find(kKeys, name, &OverrideKey::name);
        if (key == kKeys.end()) {
            std::string list;
            for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
            item.require(false, in_quotes(name), ": wanted one of ", list,
                         did_you_mean(name, names));
        }
        key->read(item, value, overrides);
    }
    return overrides;
}

bool is_file_name(const std::string& environment) {
    return environment != "studio" && environment != "none";
}

} // namespace

fs::path scene_file_of(const fs::path& scene) {
    fs::path path = scene;
    return path += ".catoptric.json";
}

std::optional<SceneFile> read_scene_file(const fs::path& scene, const FileOptions& options) {
    SceneFile found{.path = scene_file_of(scene)};
    const std::string place = found.path.string();
    Account account(options.budget);
    Files files(scene, options.root, account);
    if (found.path.filename().string().size() > Files::kLongestName) return std::nullopt;
    const fs::path real = files.find(found.path.filename().string(), place);
    if (real.empty()) return std::nullopt;
    found.overrides = read(place, files.read(real, place), account);
    if (std::optional<std::string>& picture = found.overrides.environment;
        picture && is_file_name(*picture))
        picture = files.get(*picture, place + ": environment").string();
    found.files = files.found();
    return found;
}

std::string scene_file_text(const SceneOverrides& overrides, const fs::path& scene) {
    SceneOverrides relative = overrides;
    if (std::optional<std::string>& picture = relative.environment;
        picture && is_file_name(*picture)) {
        const fs::path folder = real_path(scene).parent_path();
        const fs::path name = real_path(*picture).lexically_relative(folder);
        check(!name.empty() && *name.begin() != "..", Failure::usage,
              "--environment: ", in_quotes(*picture), ": wanted a picture below ",
              in_quotes(folder.string()), ", where a file beside the scene may name it");
        picture = name.string();
    }
    nlohmann::ordered_json document = nlohmann::ordered_json::object();
    for (const OverrideKey& key : kKeys)
        if (const Json value = key.written(relative); !value.is_null()) document[key.name] = value;
    return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace catoptric::scene
