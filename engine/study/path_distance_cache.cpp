#include "study/path_distance_cache.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "report/json.hpp"

#include <fmt/format.h>

#include <functional>

namespace catoptric::study {

namespace {

constexpr const char* kPathDistanceSchema = "catoptric/path-distance/1";

report::Json key_json(const ReferenceKey& key) {
    report::Json json = report::Json::object();
    for (const auto& [name, value] : key) json[name] = value;
    return json;
}

/// Returns a number, or NaN for null. Throws Json::exception for anything else.
double read_number_or_nan(const report::Json& json, const char* name) {
    const report::Json& value = json.at(name);
    return value.is_null() ? measure::Difference::kNone : value.get<double>();
}

} // namespace

std::filesystem::path find_path_distance_file(const std::filesystem::path& folder,
                                              const ReferenceKey& key) {
    return folder / "paths" /
           fmt::format("{:016x}.json", std::hash<std::string>()(key_json(key).dump()));
}

std::optional<measure::PathDistance>
read_path_distance(const std::filesystem::path& file, const ReferenceKey& key,
                   const std::function<void(const std::string&)>& warn) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return std::nullopt;
    try {
        const report::Json json = report::Json::parse(read_file(file));
        if (json.at("schema") != kPathDistanceSchema || json.at("key") != key_json(key))
            return std::nullopt;
        measure::PathDistance distance{.flip = read_number_or_nan(json, "flip"),
                                       .noise = read_number_or_nan(json, "noise"),
                                       .flip_all = json.at("flip_all").get<double>(),
                                       .noise_all = json.at("noise_all").get<double>(),
                                       .width = json.at("size").at(0).get<int>(),
                                       .height = json.at("size").at(1).get<int>(),
                                       .paths = json.at("paths").get<int>(),
                                       .seconds = json.at("seconds").get<double>(),
                                       .most_seconds = json.at("most_seconds").get<double>(),
                                       .is_kept = true,
                                       .unknown = {},
                                       .command = {}};
        return distance;
    } catch (const report::Json::exception&) {
        warn(file.string() +
             ": wanted a distance to path tracing that a comparison kept, found something else; it "
             "is measured again");
    } catch (const Error& error) {
        warn(std::string(error.what()) + "; the distance to path tracing is measured again");
    }
    return std::nullopt;
}

void keep_path_distance(const std::filesystem::path& file, const ReferenceKey& key,
                        const measure::PathDistance& distance,
                        const std::function<void(const std::string&)>& warn) {
    const report::Json json{{"schema", kPathDistanceSchema},
                            {"key", key_json(key)},
                            {"flip", report::number_json(distance.flip)},
                            {"noise", report::number_json(distance.noise)},
                            {"flip_all", report::number_json(distance.flip_all)},
                            {"noise_all", report::number_json(distance.noise_all)},
                            {"size", report::Json::array({distance.width, distance.height})},
                            {"paths", distance.paths},
                            {"seconds", distance.seconds},
                            {"most_seconds", distance.most_seconds}};
    try {
        std::error_code ignored; // write_file says what is wrong
        std::filesystem::create_directories(file.parent_path(), ignored);
        write_file(file, report::serialise(json));
    } catch (const Error& error) {
        warn(std::string(error.what()) +
             "; each comparison of this scene measures the distance to path tracing again");
    }
}

} // namespace catoptric::study
