#include "study/reference_seeds.hpp"

#include "session/plan_file.hpp"
#include "session/technique_choice.hpp"

#include <algorithm>

namespace catoptric::app {

namespace {

constexpr std::string_view kSeedKnobName = "seed", kRaysKnobName = "rays";

/// Returns the value of a knob that holds whole numbers, or 0 if the technique lacks the knob.
double find_knob_number(const TechniqueChoice& choice, std::string_view knob) {
    const auto setting = std::ranges::find(choice.settings, knob, &Setting::name);
    return setting == choice.settings.end() ? 0 : setting->number.value_or(0);
}

std::string set_knob_number(const std::string& technique, std::string_view knob, int value) {
    const TechniqueChoice choice = parse_technique(technique);
    std::string text = choice.technique;
    char separator = ':';
    for (const Setting& setting : choice.settings) {
        const bool is_set = setting.name == knob;
        if (!is_set && !setting.changed) continue;
        text += separator + setting.name + "=" + (is_set ? std::to_string(value) : setting.text);
        separator = ',';
    }
    return text;
}

} // namespace

std::set<int> list_row_seeds(const std::vector<std::string>& rows) {
    std::set<int> seeds{0};
    for (const std::string& row : rows)
        for (const reflect::TechniquePlanRule& rule : read_technique_plan(row).rules)
            for (const TechniqueKnob& knob : rule.choice.settings.list_knobs())
                if (knob.name == kSeedKnobName)
                    seeds.insert(rule.choice.settings.knob_value_as_integer(knob));
    return seeds;
}

int ReferenceSeeds::next() {
    do {
        ++last_;
    } while (taken_.contains(last_));
    return last_;
}

bool traces_paths(const std::string& technique) {
    const TechniqueChoice choice = parse_technique(technique);
    const auto setting = std::ranges::find(choice.settings, "indirect", &Setting::name);
    return setting != choice.settings.end() && setting->text == "paths";
}

bool draws_rays_from_lobes(const std::string& technique) {
    const TechniqueChoice choice = parse_technique(technique);
    return choice.technique == "raytrace" &&
           (find_knob_number(choice, kRaysKnobName) > 0 || traces_paths(technique));
}

bool draws_rays_to_environment(const std::string& technique, const scene::Scene& scene) {
    if (scene.environment_shadows == 0 || !scene.environment) return false;
    const TechniqueChoice choice = parse_technique(technique);
    const auto shadow = std::ranges::find(choice.settings, "shadow", &Setting::name);
    return choice.technique == "raytrace" &&
           (shadow == choice.settings.end() || shadow->text != "none");
}

std::string set_lobe_seed(const std::string& technique, int seed) {
    return set_knob_number(technique, kSeedKnobName, seed);
}

int find_lobe_rays(const std::string& technique) {
    return static_cast<int>(find_knob_number(parse_technique(technique), kRaysKnobName));
}

std::string set_lobe_rays(const std::string& technique, int rays) {
    return set_knob_number(technique, kRaysKnobName, rays);
}

} // namespace catoptric::app
