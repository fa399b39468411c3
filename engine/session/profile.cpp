#include "session/profile.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "report/json.hpp"

#include <algorithm>
#include <cctype>

namespace catoptric::session {

namespace fs = std::filesystem;
using report::Json;

namespace {

constexpr const char* kProfileSchema = "catoptric/device-profile/1";
constexpr std::uintmax_t kMaxProfileBytes = 1U << 20U;

/// Leaves out JSON's quotes.
std::string format_for_message(const Json& value) {
    return value.is_string() ? quote(value.get<std::string>()) : report::describe(value);
}

/// Throws `failure` with `place` in front.
std::size_t find_variant_index(std::string_view name, Failure failure, const std::string& place) {
    std::string known;
    for (std::size_t i = 0; i < gpu::kVariantCount; ++i) {
        const gpu::ShaderVariant& variant = gpu::shader_variants()[i];
        if (variant.name == name) return i;
        known += (known.empty() ? "" : ", ") + std::string(variant.name);
    }
    fail(failure, place, ": wanted one of ", known, ", found ", quote(name));
}

/// Returns the index of the choice, or throws `failure` with `place` in front.
std::uint8_t find_choice(const gpu::ShaderVariant& variant, const Json& choice, Failure failure,
                         const std::string& place) {
    for (std::size_t k = 0; k < variant.choices.size(); ++k)
        if (choice == variant.choices[k]) return static_cast<std::uint8_t>(k);
    fail(failure, place, ".", variant.name, ": wanted ", quote(variant.choices[0]), " or ",
         quote(variant.choices[1]), ", found ", format_for_message(choice));
}

Json device_json(const DeviceInfo& device) {
    return {{"name", device.name}, {"driver", device.driver}, {"id", device.id}};
}

gpu::VariantChoices read_profile(const fs::path& file, const DeviceInfo& device) {
    return parse_profile(read_json_text(file, "a device profile", kMaxProfileBytes), file.string(),
                         device);
}

/// Returns the choices of the folder's profile, or the defaults if there is no usable profile.
gpu::VariantChoices find_profile_choices(const fs::path& folder, DeviceInfo& device) {
    const fs::path file = folder / profile_file_name(device);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(file, error))) return default_variants(device);
    try {
        const gpu::VariantChoices choices = read_profile(file, device);
        device.profile = file.filename().string();
        return choices;
    } catch (const Error& refused) {
        device.warning = std::string(refused.what()) +
                         "; shaders are as by default ('bench --tune' writes a new profile)";
        return default_variants(device);
    }
}

} // namespace

gpu::VariantChoices default_variants(const DeviceInfo& device) {
    gpu::VariantChoices choices{};
    // Only a software driver gives each of its threads a contiguous run of work groups.
    const std::size_t groups = find_variant_index("groups", Failure::internal, "variants");
    choices[groups] = device.type == "cpu" ? 0 : 1;
    return choices;
}

std::string profile_file_name(const DeviceInfo& device) {
    std::string name = device.id + "-" + device.driver;
    const auto is_safe = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-';
    };
    for (char& c : name)
        if (!is_safe(c)) c = '_';
    return name + ".json";
}

std::string profile_text(const DeviceInfo& device,
                         const std::vector<measure::VariantTrial>& tried) {
    Json document{{"schema", kProfileSchema}, {"version", version()}, {"commit", commit()}};
    document["device"] = device_json(device);
    document["variants"] = Json::object();
    document["measured"] = Json::array();
    for (const measure::VariantTrial& one : tried) {
        document["variants"][one.variant] = one.is_faster() ? one.choice : one.standard;
        const measure::CostRatio ratio = one.time_ratio();
        document["measured"].push_back({{"variant", one.variant},
                                        {"choice", one.choice},
                                        {"against", one.standard},
                                        {"benchmark", one.benchmark},
                                        {"ratio", report::number_json(ratio.median)},
                                        {"ci95", report::interval_json(ratio.ci95)},
                                        {"taken", one.is_faster()}});
    }
    return report::serialise(document);
}

gpu::VariantChoices parse_profile(const std::string& text, const std::string& file,
                                  const DeviceInfo& device) {
    const Json document = parse_json<Json>(file, text);
    const auto member = [](const Json& object, const char* name) {
        return object.is_object() ? object.value(name, Json()) : Json();
    };
    check(member(document, "schema") == kProfileSchema, Failure::bad_data, file,
          ": wanted a device profile, schema '", kProfileSchema, "', found ",
          format_for_message(member(document, "schema")));
    const Json found = member(document, "device"), wanted = device_json(device);
    for (const auto& [name, value] : wanted.items())
        check(member(found, name.c_str()) == value, Failure::bad_data, file,
              ": is another device's or driver's profile: device.", name, ": wanted ",
              format_for_message(value), ", found ",
              format_for_message(member(found, name.c_str())));
    const Json list = member(document, "variants");
    check(list.is_object(), Failure::bad_data, file, ": variants: wanted an object, found ",
          format_for_message(list));
    gpu::VariantChoices choices = default_variants(device);
    const std::string place = file + ": variants";
    for (const auto& [name, choice] : list.items()) {
        const std::size_t i = find_variant_index(name, Failure::bad_data, place);
        choices[i] = find_choice(gpu::shader_variants()[i], choice, Failure::bad_data, place);
    }
    return choices;
}

NamedVariants named_variants(const gpu::VariantChoices& choices) {
    NamedVariants variants;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const gpu::ShaderVariant& variant = gpu::shader_variants()[i];
        variants.emplace_back(variant.name, variant.choices[choices[i]]);
    }
    return variants;
}

gpu::VariantChoices parse_variants(const NamedVariants& variants, const DeviceInfo& device) {
    gpu::VariantChoices choices = default_variants(device);
    for (const auto& [name, choice] : variants) {
        const std::size_t i = find_variant_index(name, Failure::usage, "variants");
        choices[i] = find_choice(gpu::shader_variants()[i], choice, Failure::usage, "variants");
    }
    return choices;
}

gpu::VariantChoices choose_variants(const EngineOptions& options, DeviceInfo& device) {
    gpu::VariantChoices choices = default_variants(device);
    if (!options.variants.empty()) {
        choices = parse_variants(options.variants, device);
    } else if (!options.profile.empty()) {
        choices = read_profile(options.profile, device);
        device.profile = options.profile.filename().string();
    } else if (!options.profiles.empty()) {
        choices = find_profile_choices(options.profiles, device);
    }
    device.variants = named_variants(choices);
    return choices;
}

} // namespace catoptric::session
