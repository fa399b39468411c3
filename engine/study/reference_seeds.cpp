#include "study/reference_seeds.hpp"

#include "session/plan_file.hpp"
#include "session/technique_choice.hpp"

#include <algorithm>

namespace catoptric::study {

namespace {

/// Returns the value of a knob that holds whole numbers, or 0 if the technique lacks the knob.
double find_number(const ParsedTechnique& choice, std::string_view knob) {
    const auto setting = std::ranges::find(choice.settings, knob, &Setting::name);
    return setting == choice.settings.end() ? 0 : setting->number.value_or(0);
}

bool has_choice(const ParsedTechnique& technique, const TechniqueTraits::Choice& wanted) {
    const auto setting = std::ranges::find(technique.settings, wanted.knob, &Setting::name);
    return setting != technique.settings.end() && setting->text == wanted.choice;
}

std::string set_knob_number(const ParsedTechnique& choice, std::string_view knob, int value) {
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

std::set<int> row_seeds(const std::vector<std::string>& rows) {
    std::set<int> seeds{0};
    for (const std::string& row : rows)
        for (const reflect::PlanRule& rule : read_plan(row).rules)
            for (const Knob& knob : rule.choice.settings.knobs())
                if (knob.name == rule.choice.technique->traits.seed)
                    seeds.insert(rule.choice.settings.integer(knob));
    return seeds;
}

int ReferenceSeeds::next() {
    do {
        ++last_;
    } while (taken_.contains(last_));
    return last_;
}

bool traces_paths(const std::string& technique) {
    const ParsedTechnique choice = parse_technique(technique);
    return has_choice(choice, choice.traits().paths);
}

bool draws_lobe_rays(const std::string& technique) {
    const ParsedTechnique choice = parse_technique(technique);
    return choice.traits().has_drawable_noise() &&
           (find_number(choice, choice.traits().rays) > 0 || traces_paths(technique));
}

bool draws_environment_rays(const std::string& technique, const scene::Scene& scene) {
    if (scene.environment_shadows == 0 || !scene.environment) return false;
    const ParsedTechnique choice = parse_technique(technique);
    return choice.traits().has_drawable_noise() && !has_choice(choice, choice.traits().unshadowed);
}

std::string set_lobe_seed(const std::string& technique, int seed) {
    const ParsedTechnique choice = parse_technique(technique);
    return set_knob_number(choice, choice.traits().seed, seed);
}

int find_lobe_rays(const std::string& technique) {
    const ParsedTechnique choice = parse_technique(technique);
    return static_cast<int>(find_number(choice, choice.traits().rays));
}

std::string set_lobe_rays(const std::string& technique, int rays) {
    const ParsedTechnique choice = parse_technique(technique);
    return set_knob_number(choice, choice.traits().rays, rays);
}

} // namespace catoptric::study
