// Presents the table of techniques to users of the library.
#include "session/table.hpp"

#include "session/engine.hpp"
#include "session/plan_file.hpp"
#include "session/technique_choice.hpp"

namespace catoptric::session {

std::vector<TechniqueInfo> techniques() {
    std::vector<TechniqueInfo> infos;
    for (const reflect::Technique* row : reflect::techniques()) {
        TechniqueInfo info{std::string(row->name), std::string(row->summary), {}};
        const KnobSettings defaults(row->knobs);
        for (const catoptric::Knob& knob : row->knobs) {
            const std::span<const std::string_view> choices = knob.names();
            info.knobs.push_back(
                {std::string(knob.name),
                 std::string(knob.help),
                 knob.low,
                 choices.empty() ? knob.high : static_cast<double>(choices.size() - 1),
                 defaults.format(knob),
                 {choices.begin(), choices.end()},
                 std::string(knob.special)});
        }
        infos.push_back(std::move(info));
    }
    return infos;
}

std::vector<Setting> knob_settings(const reflect::TechniqueChoice& choice) {
    std::vector<Setting> settings;
    const KnobSettings defaults(choice.technique->knobs);
    for (const catoptric::Knob& knob : choice.technique->knobs) {
        const bool is_number = knob.names().empty() && !choice.settings.is_special(knob);
        const std::string value = choice.settings.format(knob);
        settings.push_back({std::string(knob.name), value,
                            is_number ? std::optional(choice.settings.number(knob)) : std::nullopt,
                            value != defaults.format(knob)});
    }
    return settings;
}

const TechniqueTraits& ParsedTechnique::traits() const {
    static constexpr TechniqueTraits kPlanTraits;
    return of_technique ? *of_technique : kPlanTraits;
}

ParsedTechnique parse_technique(const std::string& text) {
    const reflect::TechniquePlan plan = read_plan(text);
    if (plan.is_auto) return {plan.label, plan.label, plan.file_name(), {}};
    if (!plan.is_technique) return {"plan", plan.label, plan.file_name(), {}};
    const reflect::TechniqueChoice& choice = plan.rules.front().choice;
    return {std::string(choice.technique->name), choice.label, choice.file_name(),
            knob_settings(choice), &choice.technique->traits};
}

} // namespace catoptric::session
