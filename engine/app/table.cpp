// The table of techniques as the outside sees it.
#include "app/engine.hpp"
#include "reflect/technique.hpp"

namespace catoptric::app {

std::vector<TechniqueInfo> techniques() {
    std::vector<TechniqueInfo> infos;
    for (const reflect::Technique* row : reflect::techniques()) {
        TechniqueInfo info{std::string(row->name), std::string(row->summary), {}};
        const Settings defaults(row->knobs);
        for (const catoptric::Knob& knob : row->knobs)
            info.knobs.push_back({std::string(knob.name),
                                  std::string(knob.help),
                                  knob.low,
                                  knob.high,
                                  defaults.text(knob.name),
                                  {knob.choices.begin(), knob.choices.end()},
                                  std::string(knob.special)});
        infos.push_back(std::move(info));
    }
    return infos;
}

TechniqueChoice parse_technique(const std::string& text) {
    const reflect::Choice choice = reflect::parse_choice(text);
    TechniqueChoice result{
        std::string(choice.technique->name), choice.label, choice.file_name(), {}};
    const Settings defaults(choice.technique->knobs);
    for (const catoptric::Knob& knob : choice.technique->knobs) {
        const bool is_number = knob.choices.empty() && !choice.settings.is_special(knob.name);
        const std::string value = choice.settings.text(knob.name);
        result.settings.push_back(
            {std::string(knob.name), value,
             is_number ? std::optional(choice.settings.number(knob.name)) : std::nullopt,
             value != defaults.text(knob.name)});
    }
    return result;
}

} // namespace catoptric::app
