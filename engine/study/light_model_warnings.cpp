#include "study/light_model_warnings.hpp"

#include "reflect/technique.hpp"
#include "scene/light.hpp"
#include "session/plan_file.hpp"

#include <algorithm>

namespace catoptric::study {

namespace {

/// Returns whether the rasteriser lights some pixels of the plan's pictures.
bool is_lit_by_rasteriser(const reflect::TechniquePlan& plan) {
    return std::ranges::any_of(plan.rules, [](const reflect::PlanRule& rule) {
        return !rule.choice.technique->traits.is_ray_traced();
    });
}

} // namespace

std::vector<std::string> light_model_warnings(const CompareRequest& request,
                                              const std::string& technique,
                                              const std::string& label,
                                              const std::vector<Setting>& reference) {
    if (std::ranges::any_of(reference, [](const Setting& setting) {
            return setting.name == "indirect" && setting.text == "paths";
        }))
        return {}; // paths show all light
    const reflect::TechniquePlan plan = read_plan(technique);
    const scene::Scene& scene = request.base.scene;
    const bool hides_environment = scene.environment && scene.environment_shadows > 0;
    std::vector<std::string> warnings;
    const auto warn = [&](const std::string& text) {
        warnings.push_back("'" + label + "': " + text);
    };
    if (plan.uses_soft_shadows() && scene.light_samples == 1 &&
        std::ranges::any_of(scene::list_lights(scene), &scene::PointLight::is_lamp))
        warn("its soft shadows count as an error beside this reference, whose lamps are points; "
             "--truth paths has lamps as areas");
    if (plan.occludes_environment() && !plan.has_probe_light() && !hides_environment &&
        (scene.environment || request.base.ambient > 0))
        warn("its shadow of the environment counts as an error beside this reference; --truth "
             "paths has that shadow");
    if (plan.has_probe_light())
        warn("its light between surfaces counts as an error beside this reference; --truth paths "
             "has that light");
    else if (hides_environment && !plan.occludes_environment() && is_lit_by_rasteriser(plan))
        warn("no surface hides the environment in its rasterised pixels, which counts as an error "
             "beside --environment-shadows; ao=screen hides a part");
    return warnings;
}

} // namespace catoptric::study
