#include "reflect/technique.hpp"

#include "core/error.hpp"
#include "core/table.hpp"

#include <algorithm>

namespace catoptric::reflect {

RegisteredTechnique::RegisteredTechnique(const Technique& technique) {
    const TechniqueTraits& traits = technique.traits;
    const auto check_trait = [&](bool fits, const char* wanted) {
        check(fits, Failure::internal, "technique '", technique.name, "': wanted ", wanted);
    };
    check_trait((traits.captures == TechniqueTraits::Captures::shared) ==
                    (technique.capture != nullptr),
                "`capture` exactly if captures are shared");
    check_trait(traits.draws_mirrored_views == (technique.mirrored_views != nullptr),
                "`mirrored_views` exactly if it draws mirrored views");
    check_trait(traits.draws_whole_picture == (technique.picture != nullptr),
                "`picture` exactly if it draws the whole picture");
    check_trait((technique.search != nullptr) != (technique.look != nullptr),
                "either `search` or `look`");
    table_rows<const Technique*>().push_back(&technique);
}

std::vector<const Technique*> techniques() {
    return sorted_rows<const Technique*>(
        [](const Technique* row) { return std::pair(row->order, row->name); });
}

const Technique& find_technique(std::string_view name) {
    std::vector<std::string> names;
    for (const Technique* row : techniques()) {
        if (row->name == name) return *row;
        names.emplace_back(row->name);
    }
    std::string all;
    for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
    fail(Failure::usage, "no technique '", name, "'", suggest_name(name, names), "; there are ",
         all);
}

std::string TechniqueChoice::file_name() const {
    std::string name = label;
    std::erase(name, '=');
    std::ranges::replace_if(
        name, [](char c) { return c == ':' || c == ','; }, '-');
    return name;
}

void TechniqueChoice::update_shared() {
    shared = read_knobs(settings);
    rest = technique->rest ? std::make_shared<const TechniqueChoice>(
                                 parse_choice(settings.choice_name(*technique->rest)))
                           : nullptr;
}

TechniqueChoice parse_choice(std::string_view text) {
    const auto colon = text.find(':');
    const Technique& technique = find_technique(text.substr(0, colon));
    TechniqueChoice choice{&technique, KnobSettings(technique.knobs), std::string(text)};
    std::string_view rest = colon == std::string_view::npos ? "" : text.substr(colon + 1);
    while (colon != std::string_view::npos) {
        const auto comma = rest.find(',');
        const std::string_view item = rest.substr(0, comma);
        const auto equals = item.find('=');
        check(equals != std::string_view::npos, Failure::usage, "technique '", text, "': '", item,
              "' should read knob=value");
        choice.settings.set(technique.name, item.substr(0, equals), item.substr(equals + 1));
        if (comma == std::string_view::npos) break;
        rest = rest.substr(comma + 1);
    }
    const std::string conflict = technique.conflict(choice.settings);
    check(conflict.empty(), Failure::usage, "technique '", text, "': ", conflict);
    choice.update_shared();
    check(!choice.shared.light.has_probe_light() ||
              choice.shared.light.occlusion != LightKnobs::Occlusion::captures,
          Failure::usage, "technique '", text,
          "': wanted ao=none or ao=screen beside indirect=captures, because the light probes of "
          "indirect=captures know what hides the environment; found ao=captures");
    return choice;
}

} // namespace catoptric::reflect
