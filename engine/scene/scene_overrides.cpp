#include "scene/scene_overrides.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "scene/classify.hpp"
#include "scene/material_facts.hpp"
#include "scene/number.hpp"
#include "scene/texel.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <utility>

namespace catoptric::scene {

namespace {

constexpr std::string_view kRoughnessPrefix = ",roughness=";

template <typename Value>
void replace_if_set(std::optional<Value>& value, const std::optional<Value>& stronger) {
    if (stronger) value = stronger;
}

/// Returns the names by which patterns find an object: its own and its material's. If a node has
/// several materials, its objects are named "NODE/MATERIAL", and the node's name counts, too.
std::vector<std::string> matched_names(const Scene& scene, const Object& object) {
    const std::string& material = scene.materials[object.material].name;
    std::vector<std::string> names{object.name, material};
    if (const std::string end = "/" + material; object.name.ends_with(end))
        names.push_back(object.name.substr(0, object.name.size() - end.size()));
    return names;
}

/// Returns the indices of the objects that a pattern matches. Throws if there are none.
std::vector<std::size_t> find_objects(const Scene& scene, const SettingOrigin& by,
                                      const std::string& pattern) {
    std::vector<std::size_t> found;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const std::vector<std::string> names = matched_names(scene, scene.objects[i]);
        if (std::ranges::any_of(names, [&](const auto& name) { return matches(pattern, name); }))
            found.push_back(i);
        known.insert(known.end(), names.begin(), names.end());
    }
    if (!found.empty()) return found;
    std::erase(known, "");
    std::ranges::sort(known);
    known.erase(std::ranges::unique(known).begin(), known.end());
    const std::string nearest = nearest_name(pattern, known);
    std::string list;
    constexpr std::size_t kMaxListedNames = 10;
    for (std::size_t i = 0; i < std::min(known.size(), kMaxListedNames); ++i)
        list += (i ? ", " : "") + quote(known[i]);
    if (known.size() > kMaxListedNames)
        list += " and " + std::to_string(known.size() - kMaxListedNames) + " more";
    fail(by.failure, by.where, " ", quote(pattern), ": matches no object or material of scene ",
         quote(scene.name), "; it has: ", list,
         nearest.empty() ? "" : " (did you mean " + quote(nearest) + "?)");
}

/// Gives these objects a changed copy of their material. Objects that share a material share its
/// copy. Materials keep their indices.
template <typename Change>
void change_materials(Scene& scene, const std::vector<std::size_t>& objects, Change&& change) {
    std::map<std::size_t, std::size_t> copies; // new material by old material
    for (const std::size_t i : objects) {
        std::size_t& material = scene.objects[i].material;
        const auto [entry, is_new] = copies.try_emplace(material, scene.materials.size());
        if (is_new) {
            Material copy = scene.materials[material];
            change(copy);
            scene.materials.push_back(std::move(copy));
        }
        material = entry->second;
    }
}

void apply_mirror(Scene& scene, const MirrorOverride& wish) {
    change_materials(
        scene, find_objects(scene, {"--mirror"}, wish.pattern),
        [&](Material& material) { material = make_mirror_material(material.name, wish); });
}

/// Returns the objects that the pattern matches and that emit light. Throws if there are none.
std::vector<std::size_t> find_emitters(const Scene& scene, const SettingOrigin& by,
                                       const std::string& pattern) {
    std::vector<std::size_t> objects = find_objects(scene, by, pattern);
    std::erase_if(objects, [&](std::size_t i) {
        return !is_visibly_emissive(scene.materials[scene.objects[i].material]);
    });
    check(!objects.empty(), by.failure, by.where, " ", quote(pattern),
          ": wanted something that emits light, found objects that do not");
    return objects;
}

void make_lights(Scene& scene, const std::string& pattern) {
    change_materials(scene, find_emitters(scene, {"--light"}, pattern), [](Material& material) {
        material.light = material.emission;
        if (material.emission_texture) *material.light *= mean_texel(*material.emission_texture);
    });
}

} // namespace

Material make_mirror_material(std::string name, const MirrorOverride& wish) {
    if (wish.roughness == 0)
        return {.name = std::move(name), .mirror = true, .reflectance = wish.reflectance};
    return {.name = std::move(name),
            .albedo = wish.reflectance,
            .metallic = 1,
            .roughness = wish.roughness};
}

SceneOverrides combine(const SceneOverrides& stronger, const SceneOverrides& weaker) {
    SceneOverrides both = weaker;
    for (const MirrorOverride& wish : stronger.mirrors)
        std::erase_if(both.mirrors,
                      [&](const MirrorOverride& other) { return other.pattern == wish.pattern; });
    for (const std::string& pattern : stronger.lights) std::erase(both.lights, pattern);
    both.mirrors.insert(both.mirrors.end(), stronger.mirrors.begin(), stronger.mirrors.end());
    both.lights.insert(both.lights.end(), stronger.lights.begin(), stronger.lights.end());
    replace_if_set(both.mirror_max_roughness, stronger.mirror_max_roughness);
    replace_if_set(both.dielectric_mirrors, stronger.dielectric_mirrors);
    replace_if_set(both.multiple_scattering, stronger.multiple_scattering);
    replace_if_set(both.tints_glass_shadows, stronger.tints_glass_shadows);
    replace_if_set(both.light_samples, stronger.light_samples);
    replace_if_set(both.environment_shadows, stronger.environment_shadows);
    replace_if_set(both.environment, stronger.environment);
    replace_if_set(both.environment_scale, stronger.environment_scale);
    replace_if_set(both.environment_rotation, stronger.environment_rotation);
    replace_if_set(both.exposure, stronger.exposure);
    replace_if_set(both.camera, stronger.camera);
    replace_if_set(both.up, stronger.up);
    replace_if_set(both.animation, stronger.animation);
    replace_if_set(both.ambient, stronger.ambient);
    return both;
}

bool matches(const std::string& pattern, const std::string& name) {
    return pattern == name || fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

MirrorOverride parse_mirror_override(const std::string& option, const std::string& whole) {
    MirrorOverride wish;
    std::string text = whole;
    if (const std::size_t at = text.rfind(kRoughnessPrefix); at != text.npos) {
        const std::optional<double> number = parse_number(
            std::string_view(text).substr(at + kRoughnessPrefix.size()));
        check(number && *number >= 0 && *number <= 1, Failure::usage, option,
              ": wanted a number from 0 to 1 after ',roughness=', found ", quote(whole));
        wish.roughness = static_cast<float>(*number);
        text.resize(at);
    }
    wish.pattern = text;
    const std::size_t at = text.rfind('=');
    if (at != text.npos) {
        std::vector<double> numbers;
        std::string_view rest = std::string_view(text).substr(at + 1);
        bool all = true;
        while (all) {
            const std::size_t comma = rest.find(',');
            const std::optional<double> number = parse_number(rest.substr(0, comma));
            all = number.has_value();
            if (number) numbers.push_back(*number);
            if (comma == rest.npos) break;
            rest.remove_prefix(comma + 1);
        }
        if (all) {
            const bool is_colour = numbers.size() == 1 || numbers.size() == 3;
            check(
                is_colour &&
                    std::ranges::all_of(numbers, [](double n) { return n >= 0 && n <= 1; }),
                Failure::usage, option,
                ": wanted PATTERN or PATTERN=REFLECTANCE[,roughness=NUMBER], REFLECTANCE a number or "
                "r,g,b, all from 0 to 1, found ",
                quote(text));
            wish.pattern = text.substr(0, at);
            for (int i = 0; i < 3; ++i)
                wish.reflectance[i] = static_cast<float>(
                    numbers[numbers.size() == 3 ? static_cast<std::size_t>(i) : 0]);
        }
    }
    check(!wish.pattern.empty(), Failure::usage, option, ": wanted a name or a pattern, found ",
          quote(text));
    return wish;
}

std::string mirror_pattern(const std::string& name) {
    constexpr std::size_t kMaxNameBytes = 60; // a longer name is reduced to its beginning
    std::size_t size = std::min(name.size(), kMaxNameBytes);
    while (size > 0 && size < name.size() && (name[size] & 0xc0) == 0x80)
        --size; // keeps UTF-8 characters whole
    const bool is_plain = escape(name) == name;
    std::string pattern;
    for (const char c : name.substr(0, size)) {
        const auto byte = static_cast<unsigned char>(c);
        if (!is_plain && (byte < 0x20 || byte >= 0x7f)) {
            pattern += '?';
            continue;
        }
        if (std::string_view("*?[\\").find(c) != std::string_view::npos) pattern += '\\';
        pattern += c;
    }
    if (size < name.size()) pattern += '*';
    if (pattern.find('=') != pattern.npos)
        pattern += "=1"; // else the pattern's end might read as a reflectance
    // A name may hold what looks like the option of a roughness. A set of one comma equals a comma.
    for (std::size_t at = 0; (at = pattern.find(kRoughnessPrefix, at)) != pattern.npos;)
        pattern.replace(at, 1, "[,]");
    return pattern;
}

void check_patterns(const Scene& scene, const SceneOverrides& overrides, const std::string& file) {
    for (const MirrorOverride& wish : overrides.mirrors)
        find_objects(scene, {file + ": mirrors", Failure::bad_data}, wish.pattern);
    for (const std::string& pattern : overrides.lights)
        find_emitters(scene, {file + ": lights", Failure::bad_data}, pattern);
}

void apply_overrides(Scene& scene, const SceneOverrides& overrides) {
    if (overrides.up == UpAxis::z) turn_to_y_up(scene);
    for (const MirrorOverride& wish : overrides.mirrors) apply_mirror(scene, wish);
    for (const std::string& pattern : overrides.lights) make_lights(scene, pattern);
    if (overrides.mirror_max_roughness)
        scene.mirror_max_roughness = static_cast<float>(*overrides.mirror_max_roughness);
    scene.has_multiple_scattering = overrides.multiple_scattering.value_or(
        scene.has_multiple_scattering);
    scene.tints_glass_shadows = overrides.tints_glass_shadows.value_or(scene.tints_glass_shadows);
    for (UnsupportedFeature& feature : scene.unsupported)
        if (scene.tints_glass_shadows && feature.id == "glass-shadow")
            feature.id = "glass-shadow-straight";
    for (const MirrorOverride& wish : overrides.mirrors)
        check(wish.roughness <= scene.mirror_max_roughness, Failure::usage, "--mirror ",
              quote(wish.pattern), ": wanted a roughness of at most ",
              format_number(scene.mirror_max_roughness),
              ", above which no surface is a mirror, found ", format_number(wish.roughness),
              "; raise --mirror-max-roughness");
    find_mirrors(scene, overrides.dielectric_mirrors.value_or(false));
}

} // namespace catoptric::scene
