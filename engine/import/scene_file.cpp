#include "import/scene_file.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "import/file_options.hpp"
#include "import/files.hpp"
#include "import/json.hpp"
#include "scene/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::scene {

namespace {

namespace fs = std::filesystem;

/// How a value may be written without JSON's quotes: not at all, as a text, or as a list of one.
enum class ValueForm : std::uint8_t { json, text, list };

/// Key of the file: its name, its reader and its writer. The table of keys defines the format.
struct FileKey {
    const char* name;
    ValueForm form;
    void (*read)(const gltf::JsonObject& file, const gltf::Json& value, SceneOverrides& overrides);
    gltf::Json (*written)(const SceneOverrides& overrides); ///< null: the member is not written
};

using gltf::Json;
using gltf::JsonObject;

std::string read_text(const JsonObject& file, const Json& value, const char* key) {
    file.require(value.is_string(), key, ": wanted a text, found ", gltf::describe(value));
    return value.get<std::string>();
}

/// Reads a member that is "none" or `word`. Returns whether it is `word`.
bool read_none_or_word(const JsonObject& file, const Json& value, const char* key,
                       const char* word) {
    const std::string text = read_text(file, value, key);
    file.require(text == "none" || text == word, key, ": wanted \"none\" or \"", word, "\", found ",
                 quote(text));
    return text == word;
}

std::vector<std::string> read_text_list(const JsonObject& file, const Json& value,
                                        const char* key) {
    file.require(value.is_array(), key, ": wanted a list of texts, found ", gltf::describe(value));
    std::vector<std::string> texts;
    for (const Json& one : value) texts.push_back(read_text(file, one, key));
    return texts;
}

double read_bounded_number(const JsonObject& file, const Json& value, const char* key, double low,
                           double high) {
    const double number = value.is_number() ? value.get<double>() : NAN;
    file.require(number >= low && number <= high, key, ": wanted a number from ", low, " to ", high,
                 ", found ", gltf::describe(value));
    return number;
}

int read_bounded_whole(const JsonObject& file, const Json& value, const char* key, int low,
                       int high) {
    const double number = read_bounded_number(file, value, key, low, high);
    file.require(number == std::floor(number), key, ": wanted a whole number, found ",
                 gltf::describe(value));
    return static_cast<int>(number);
}

/// Calls `read`, which is shared with the command line, and turns its errors into errors of the
/// file.
template <typename Read>
auto rethrow_as_bad_data(const JsonObject& file, Read&& read) {
    try {
        return read();
    } catch (const Error& error) {
        fail(Failure::bad_data, file.place(), ": ", error.what());
    }
}

template <typename Value>
Json optional_to_json(const std::optional<Value>& value) {
    return value ? Json(*value) : Json();
}

Json word_to_json(const std::optional<bool>& is_word, const char* word) {
    return is_word ? Json(*is_word ? word : "none") : Json();
}

Json mirror_to_json(const MirrorOverride& wish) {
    const vec3& r = wish.reflectance;
    const auto text = [](float share) { return Json(shortest_double(share)).dump(); };
    return wish.pattern + "=" +
           (r.x == r.y && r.y == r.z ? text(r.x) : text(r.x) + "," + text(r.y) + "," + text(r.z)) +
           (wish.roughness > 0 ? ",roughness=" + text(wish.roughness) : "");
}

const std::array<FileKey, 16> kFileKeys{
    {{"mirrors", ValueForm::list,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          for (const std::string& text : read_text_list(file, value, "mirrors"))
              overrides.mirrors.push_back(rethrow_as_bad_data(
                  file, [&] { return parse_mirror_override("mirrors", text); }));
      },
      [](const SceneOverrides& overrides) {
          Json list = Json::array();
          for (const MirrorOverride& wish : overrides.mirrors) list.push_back(mirror_to_json(wish));
          return list.empty() ? Json() : list;
      }},
     {"lights", ValueForm::list,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.lights = read_text_list(file, value, "lights");
      },
      [](const SceneOverrides& overrides) {
          return overrides.lights.empty() ? Json() : Json(overrides.lights);
      }},
     {"mirror_max_roughness", ValueForm::json,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.mirror_max_roughness = read_bounded_number(file, value, "mirror_max_roughness",
                                                               0, 1);
      },
      [](const SceneOverrides& overrides) {
          return optional_to_json(overrides.mirror_max_roughness);
      }},
     {"dielectric_mirrors", ValueForm::json,
      [](const JsonObject& file, const Json&, SceneOverrides& overrides) {
          overrides.dielectric_mirrors = file.flag("dielectric_mirrors", false);
      },
      [](const SceneOverrides& overrides) {
          return optional_to_json(overrides.dielectric_mirrors);
      }},
     {"multiple_scattering", ValueForm::text,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.multiple_scattering = read_none_or_word(file, value, "multiple_scattering",
                                                            "turquin");
      },
      [](const SceneOverrides& overrides) {
          return word_to_json(overrides.multiple_scattering, "turquin");
      }},
     {"glass_shadow", ValueForm::text,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.tints_glass_shadows = read_none_or_word(file, value, "glass_shadow", "tint");
      },
      [](const SceneOverrides& overrides) {
          return word_to_json(overrides.tints_glass_shadows, "tint");
      }},
     {"light_samples", ValueForm::json,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.light_samples = read_bounded_whole(file, value, "light_samples", 1,
                                                       kMaxLightSamples);
      },
      [](const SceneOverrides& overrides) { return optional_to_json(overrides.light_samples); }},
     {"environment_shadows", ValueForm::json,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.environment_shadows = read_bounded_whole(file, value, "environment_shadows", 0,
                                                             kMaxEnvironmentShadows);
      },
      [](const SceneOverrides& overrides) {
          return optional_to_json(overrides.environment_shadows);
      }},
     {"environment", ValueForm::text,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.environment = read_text(file, value, "environment");
      },
      [](const SceneOverrides& overrides) { return optional_to_json(overrides.environment); }},
     {"environment_scale", ValueForm::json,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.environment_scale = read_bounded_number(file, value, "environment_scale", 0,
                                                            kMaxLightScale);
      },
      [](const SceneOverrides& overrides) {
          return optional_to_json(overrides.environment_scale);
      }},
     {"environment_rotate", ValueForm::json,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.environment_rotation = read_bounded_number(
              file, value, "environment_rotate", -kMaxRotationDegrees, kMaxRotationDegrees);
      },
      [](const SceneOverrides& overrides) {
          return optional_to_json(overrides.environment_rotation);
      }},
     {"ambient", ValueForm::json,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.ambient = read_bounded_number(file, value, "ambient", 0, kMaxLightScale);
      },
      [](const SceneOverrides& overrides) { return optional_to_json(overrides.ambient); }},
     {"exposure", ValueForm::json,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          if (value == "auto")
              overrides.exposure = ExposureOverride{};
          else
              overrides.exposure = ExposureOverride{read_bounded_number(
                  file, value, "exposure", -kMaxExposureStops, kMaxExposureStops)};
      },
      [](const SceneOverrides& overrides) {
          if (!overrides.exposure) return Json();
          return overrides.exposure->stops ? Json(*overrides.exposure->stops) : Json("auto");
      }},
     {"camera", ValueForm::text,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.camera = read_text(file, value, "camera");
      },
      [](const SceneOverrides& overrides) { return optional_to_json(overrides.camera); }},
     {"up", ValueForm::text,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          file.require(value == "y" || value == "z", "up: wanted \"y\" or \"z\", found ",
                       gltf::describe(value));
          overrides.up = value == "z" ? UpAxis::z : UpAxis::y;
      },
      [](const SceneOverrides& overrides) {
          return overrides.up ? Json(*overrides.up == UpAxis::z ? "z" : "y") : Json();
      }},
     {"animation", ValueForm::text,
      [](const JsonObject& file, const Json& value, SceneOverrides& overrides) {
          overrides.animation = read_text(file, value, "animation");
      },
      [](const SceneOverrides& overrides) { return optional_to_json(overrides.animation); }}}};

SceneOverrides read_overrides(const std::string& file, const Json& document) {
    const JsonObject item(document, file);
    item.require(document.is_object(), "wanted an object, found ", gltf::describe(document));
    std::vector<std::string> names;
    for (const FileKey& key : kFileKeys) names.emplace_back(key.name);
    SceneOverrides overrides;
    for (const auto& [name, value] : document.items()) {
        const auto key = std::ranges::find(kFileKeys, name, &FileKey::name);
        if (key == kFileKeys.end()) {
            std::string list;
            for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
            item.require(false, quote(name), ": wanted one of ", list, suggest_name(name, names));
        }
        key->read(item, value, overrides);
    }
    return overrides;
}

bool is_environment_file(const std::string& environment) {
    return environment != "studio" && environment != "none";
}

} // namespace

fs::path scene_file_path(const fs::path& scene) {
    fs::path path = scene;
    return path += ".catoptric.json";
}

std::optional<SceneFile> read_scene_file(const fs::path& scene, const FileOptions& options) {
    SceneFile found{.path = scene_file_path(scene)};
    const std::string place = found.path.string();
    LoadAccount account(options.budget);
    FileOpener files(scene, options.root, account);
    if (found.path.filename().string().size() > FileOpener::kMaxNameLength) return std::nullopt;
    const fs::path real = files.find(found.path.filename().string(), place);
    if (real.empty()) return std::nullopt;
    found.overrides = read_overrides(place,
                                     gltf::parse_json(place, files.read(real, place), account));
    if (std::optional<std::string>& picture = found.overrides.environment;
        picture && is_environment_file(*picture))
        picture = files.find_required(*picture, place + ": environment").string();
    found.files = files.found();
    return found;
}

SceneOverrides read_override(const std::string& text) {
    const std::size_t end = text.find('=');
    check(end != std::string::npos && end > 0, Failure::usage,
          "--set: wanted KEY=VALUE, such as ambient=0, found ", quote(text));
    const std::string name = text.substr(0, end), value = text.substr(end + 1);
    const auto key = std::ranges::find(kFileKeys, name, &FileKey::name);
    const ValueForm form = key == kFileKeys.end() ? ValueForm::text : key->form;
    Json parsed = Json::parse(value, nullptr, false);
    const std::optional<double> number = parse_number(value); // such as .5, which JSON lacks
    if (form == ValueForm::json && parsed.is_discarded() && number) parsed = *number;
    if (form == ValueForm::text || parsed.is_discarded()) parsed = value;
    if (form == ValueForm::list && !parsed.is_array()) parsed = Json::array({value});
    try {
        return read_overrides("--set", Json{{name, std::move(parsed)}});
    } catch (const Error& error) {
        fail(Failure::usage, error.what());
    }
}

std::string scene_file_text(const SceneOverrides& overrides, const fs::path& scene) {
    SceneOverrides relative = overrides;
    if (std::optional<std::string>& picture = relative.environment;
        picture && is_environment_file(*picture)) {
        const fs::path folder = real_path(scene).parent_path();
        const fs::path name = real_path(*picture).lexically_relative(folder);
        check(!name.empty() && *name.begin() != "..", Failure::usage,
              "--environment: ", quote(*picture), ": wanted a picture below ",
              quote(folder.string()), ", where a file beside the scene may name it");
        picture = name.string();
    }
    nlohmann::ordered_json document = nlohmann::ordered_json::object();
    for (const FileKey& key : kFileKeys)
        if (const Json value = key.written(relative); !value.is_null()) document[key.name] = value;
    return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace catoptric::scene
