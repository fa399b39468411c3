#include "session/plan_file.hpp"

#include "core/error.hpp"
#include "core/json.hpp"

#include <nlohmann/json.hpp>

namespace catoptric::session {

namespace {

using PlanJson = nlohmann::json;

constexpr std::string_view kPlanFilePrefix = "plan:";
constexpr std::uintmax_t kMaxPlanBytes = 16U << 20U;

std::string format_json_value(const PlanJson& value) {
    constexpr std::size_t kMaxQuotedBytes = 60;
    if (value.is_structured()) return value.is_array() ? "a list" : "an object";
    const std::string text = value.dump(-1, ' ', true, PlanJson::error_handler_t::replace);
    return text.size() <= kMaxQuotedBytes ? text : text.substr(0, kMaxQuotedBytes) + "...";
}

const PlanJson& find_rules(const PlanJson& document, const std::string& file) {
    if (document.is_object() && document.contains("schema"))
        check(document["schema"].is_string() &&
                  document["schema"].get_ref<const std::string&>().starts_with("catoptric/"),
              Failure::bad_data, file,
              ".schema: wanted one that begins with \"catoptric/\", found ",
              format_json_value(document["schema"]));
    const PlanJson& list = document.is_object() && document.contains("plan") ? document["plan"]
                                                                             : document;
    check(list.is_array() && !list.empty(), Failure::bad_data, file,
          ": wanted a list of rules, or an object with one as 'plan', found ",
          format_json_value(list));
    return list;
}

/// Returns a member that must be text or, if `numbers` is true, a whole number.
std::string read_text(const PlanJson& rule, const char* member, const std::string& place,
                      bool numbers) {
    const PlanJson value = rule.value(member, PlanJson());
    if (numbers && value.is_number_unsigned()) return std::to_string(value.get<std::uint64_t>());
    check(value.is_string() && !value.get_ref<const std::string&>().empty(), Failure::bad_data,
          place, ".", member, ": wanted ", numbers ? "a mirror's number or a pattern" : "text",
          ", found ", value.is_null() ? "nothing" : format_json_value(value));
    return value.get<std::string>();
}

/// Returns whether the plan consists of one rule that gives `auto` to all mirrors. `auto` cannot be
/// the technique of a single mirror.
bool is_auto_plan(const PlanJson& rules) {
    return rules.size() == 1 && rules[0].is_object() && rules[0].size() == 2 &&
           rules[0].value("mirror", PlanJson()) == "*" &&
           rules[0].value("technique", PlanJson()) == reflect::kAutoPlanName;
}

reflect::PlanRule read_rule(const PlanJson& rule, const std::string& place) {
    check(rule.is_object(), Failure::bad_data, place, ": wanted an object, found ",
          format_json_value(rule));
    for (const auto& [key, value] : rule.items())
        check(key == "mirror" || key == "technique" || key == "settings" || key == "name" ||
                  key == "why",
              Failure::bad_data, place, ": wanted mirror, technique and settings, found '", key,
              "'");
    std::string pattern = read_text(rule, "mirror", place, true);
    reflect::TechniqueChoice choice = reflect::parse_choice(
        read_text(rule, "technique", place, false));
    const PlanJson settings = rule.value("settings", PlanJson::object());
    check(settings.is_object(), Failure::bad_data, place, ".settings: wanted an object, found ",
          format_json_value(settings));
    for (const auto& [knob, value] : settings.items()) {
        check(value.is_string() || value.is_number(), Failure::bad_data, place, ".settings.", knob,
              ": wanted a number or text, found ", format_json_value(value));
        choice.settings.set(choice.technique->name, knob,
                            value.is_string() ? value.get<std::string>() : value.dump());
    }
    choice.update_shared();
    return {std::move(pattern), std::move(choice)};
}

} // namespace

reflect::TechniquePlan read_plan(const std::string& text) {
    if (!text.starts_with(kPlanFilePrefix)) return reflect::parse_plan(text);
    const std::string file = text.substr(kPlanFilePrefix.size());
    const PlanJson document = parse_json<PlanJson>(file,
                                                   read_json_text(file, "a plan", kMaxPlanBytes));
    reflect::TechniquePlan plan{text, {}};
    const PlanJson& rules = find_rules(document, file);
    if (is_auto_plan(rules)) {
        plan = reflect::parse_plan(reflect::kAutoPlanName);
        plan.label = text;
        return plan;
    }
    for (std::size_t i = 0; i < rules.size(); ++i)
        plan.rules.push_back(read_rule(rules[i], file + ": plan[" + std::to_string(i) + "]"));
    return plan;
}

std::vector<std::string> mirror_names(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const std::size_t object : scene::mirrors(scene))
        names.push_back(scene.objects[object].name);
    return names;
}

} // namespace catoptric::session
