#include "reflect/plan.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "reflect/captures.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <functional>
#include <optional>

#include <fnmatch.h>

namespace catoptric::reflect {

namespace {

constexpr std::string_view kPlanRuleSeparators = " \t\n";
constexpr std::size_t kMaxFileName = 80;

constexpr double kMinReportedNonFlatShare =
    .001; // smallest share of area outside all flat faces that is reported

std::string format_percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
    return text;
}

/// How precisely an item of a pattern names a mirror; the smallest rank wins.
enum PatternPrecision { kNumber, kName, kRest, kNone };

/// Returns the item as a number, or none if it is not a number.
std::optional<std::size_t> parse_mirror(const std::string& item) {
    std::size_t number = 0;
    const char* end = item.data() + item.size();
    const auto [stop, error] = std::from_chars(item.data(), end, number);
    return error == std::errc{} && stop == end ? std::optional(number) : std::nullopt;
}

/// Returns how precisely an item of a pattern names the mirror with this index, from 0.
PatternPrecision find_precision(const std::string& item, std::size_t index,
                                const std::string& name) {
    if (item == "*") return kRest;
    if (const auto number = parse_mirror(item)) return *number == index + 1 ? kNumber : kNone;
    return fnmatch(item.c_str(), name.c_str(), 0) == 0 ? kName : kNone;
}

std::string quote_names(const std::vector<std::string>& names) {
    constexpr std::size_t kMaxListedMirrors = 20;
    std::string list = std::to_string(names.size()) + (names.size() == 1 ? " mirror" : " mirrors");
    for (std::size_t i = 0; i < std::min(names.size(), kMaxListedMirrors); ++i)
        list += (i ? ", " : ": ") + std::to_string(i + 1) + " " + quote(names[i]);
    return list + (names.size() > kMaxListedMirrors ? ", ..." : "");
}

PlanRule parse_rule(const std::string& text, std::string_view plan) {
    const auto equals = text.find('=');
    check(equals != std::string::npos && equals > 0 && text.find(':') > equals, Failure::usage,
          "plan '", plan, "': wanted PATTERN=TECHNIQUE, found '", text, "'");
    PlanRule rule{text.substr(0, equals), parse_choice(std::string_view(text).substr(equals + 1))};
    for (const std::string& item : split(rule.pattern, ","))
        check(!item.empty(), Failure::usage, "plan '", plan, "': pattern '", rule.pattern,
              "' has an empty entry");
    return rule;
}

/// Returns the index of the choice in `choices`. Adds the choice unless an equal one is present.
std::uint32_t find_or_add(const TechniqueChoice& choice, std::vector<TechniqueChoice>& choices) {
    const auto found = std::ranges::find_if(
        choices, [&](const TechniqueChoice& known) { return known.is_same(choice); });
    if (found != choices.end()) return static_cast<std::uint32_t>(found - choices.begin());
    choices.push_back(choice);
    return static_cast<std::uint32_t>(choices.size() - 1);
}

/// Returns the technique for mirrors that their own technique cannot draw. It takes the settings
/// for shadows and light from `choice`.
TechniqueChoice choose_fallback(const TechniqueChoice& choice) {
    TechniqueChoice rest = *choice.rest;
    const KnobSettings defaults(choice.technique->knobs);
    for (const Knob* const knob :
         {&kShadow, &kShadowMap, &kSoftShadow, &kIndirect, &kProbes, &kAmbientOcclusion}) {
        if (!rest.settings.has(*knob) || (knob == &kIndirect && !rest.settings.has(kProbes)))
            continue; // raytrace has other settings for light
        const std::string value = choice.settings.format(*knob);
        if (value == defaults.format(*knob)) continue;
        rest.settings.set(rest.technique->name, knob->name, value);
        rest.label += (rest.label.find(':') == std::string::npos ? ":" : ",") +
                      std::string(knob->name) + "=" + value;
    }
    rest.update_shared();
    return rest;
}

} // namespace

std::string TechniquePlan::file_name() const {
    if (is_technique) return rules.front().choice.file_name();
    if (is_auto) return std::string(kAutoPlanName);
    std::string name = label.starts_with("plan:") ? label : "plan-" + label;
    std::erase(name, '=');
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c) && c != '.' && c != '_' && c != '-'; },
        '-');
    if (name.size() <= kMaxFileName) return name;
    const std::size_t mark = std::hash<std::string>{}(label); // shortened names differ by this hash
    return name.substr(0, kMaxFileName - 7) + "-" + std::to_string(mark % 1000000);
}

bool TechniquePlan::is_same(const TechniquePlan& other) const {
    return std::ranges::equal(rules, other.rules, [](const PlanRule& a, const PlanRule& b) {
        return a.pattern == b.pattern && a.choice.is_same(b.choice);
    });
}

bool TechniquePlan::has_probe_light() const {
    return std::ranges::any_of(
        rules, [](const PlanRule& rule) { return rule.choice.shared.light.has_probe_light(); });
}

bool TechniquePlan::uses_soft_shadows() const {
    return std::ranges::any_of(
        rules, [](const PlanRule& rule) { return rule.choice.shared.shadow.is_soft; });
}

bool TechniquePlan::occludes_environment() const {
    return std::ranges::any_of(rules, [](const PlanRule& rule) {
        return rule.choice.shared.light.occlusion != LightKnobs::Occlusion::none;
    });
}

TechniquePlan parse_plan(std::string_view text) {
    if (text == kAutoPlanName)
        return {.label = std::string(text), .rules = {}, .is_auto = true, .reasons = {}};
    const std::string_view head = text.substr(0, text.find(':'));
    if (head == kAutoPlanName)
        fail(Failure::usage, "'", text,
             "': wanted auto alone, which finds settings itself, found '",
             text.substr(kAutoPlanName.size()), "' after it");
    if (head.find('=') == std::string_view::npos)
        return {.label = std::string(text),
                .rules = {{"*", parse_choice(text)}},
                .is_technique = true,
                .reasons = {}};
    TechniquePlan plan{.label = std::string(text), .rules = {}, .reasons = {}};
    for (const std::string& rule : split(text, kPlanRuleSeparators))
        if (!rule.empty()) plan.rules.push_back(parse_rule(rule, text));
    return plan;
}

Assignment assign_techniques(const TechniquePlan& plan, const std::vector<std::string>& names) {
    Assignment assignment;
    if (plan.is_technique) {
        assignment.choices = {plan.rules.front().choice};
        assignment.of_mirror.assign(names.size(), 0);
        assignment.patterns.assign(names.size(), "");
        assignment.reasons = plan.reasons;
        assignment.reasons.resize(names.size());
        return assignment;
    }
    struct BestRule {
        PatternPrecision rank = kNone;
        const PlanRule* rule = nullptr;
    };
    std::vector<BestRule> best(names.size());
    for (const PlanRule& rule : plan.rules) {
        for (const std::string& item : split(rule.pattern, ",")) {
            bool matches = false;
            for (std::size_t i = 0; i < names.size(); ++i) {
                const PatternPrecision rank = find_precision(item, i, names[i]);
                matches = matches || rank != kNone;
                if (rank < best[i].rank) best[i] = {rank, &rule};
            }
            check(matches, Failure::usage, "plan '", plan.label, "': pattern '", item,
                  "' matches no mirror; the scene has ", quote_names(names),
                  suggest_name(item, names));
        }
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        check(best[i].rule != nullptr, Failure::usage, "plan '", plan.label,
              "': no rule for mirror ", i + 1, " ", quote(names[i]),
              "; '*=TECHNIQUE' takes the rest");
        assignment.of_mirror.push_back(find_or_add(best[i].rule->choice, assignment.choices));
        assignment.patterns.push_back(best[i].rule->pattern);
    }
    assignment.reasons = plan.reasons;
    assignment.reasons.resize(names.size());
    return assignment;
}

void add_capture_needs(require::WorkModelInput& input, const std::vector<TechniquePlan>& plans) {
    std::optional<std::uint32_t> coarsest;
    for (const TechniquePlan& plan : plans)
        for (const auto& [pattern, choice] : plan.rules) {
            const TechniqueChoice& searching = choice.rest ? *choice.rest : choice;
            input.whole_cubes = input.whole_cubes || searching.technique->reads_whole_cubes;
            input.asks_all = input.asks_all || searching.shared.search.asks_all;
            if (choice.shared.shadow.method == ShadowKnobs::Method::none) continue;
            const std::uint32_t edge = choice.shared.shadow.edge;
            coarsest = std::min(coarsest.value_or(edge), edge);
            input.has_soft_shadows = input.has_soft_shadows || choice.shared.shadow.is_soft;
        }
    input.shadow_edge = coarsest.value_or(input.shadow_edge);
}

Assignment replace_unfit(Assignment assignment, const std::vector<scene::FlatFaces>& flats,
                         double tolerance) {
    std::vector<TechniqueChoice> choices; // only choices that some mirror still uses
    assignment.lacks.assign(assignment.of_mirror.size(), "");
    if (assignment.of_mirror.empty()) return assignment;
    for (std::size_t i = 0; i < assignment.of_mirror.size(); ++i) {
        TechniqueChoice choice = assignment.choices[assignment.of_mirror[i]];
        const std::string lack = choice.technique->unfit(flats[i], tolerance, choice.settings);
        if (!lack.empty()) {
            const std::string asked(choice.technique->name);
            choice = choose_fallback(choice);
            assignment.reasons[i] = asked + " draws flat mirrors, and this is " + lack +
                                    ": rest=" + choice.label;
            assignment.lacks[i] = lack + ", drawn by " + choice.label;
        } else if (choice.technique->traits.draws_mirrored_views) {
            const double bent = 1 - flats[i].flat_share(tolerance);
            if (bent >= kMinReportedNonFlatShare)
                assignment.lacks[i] = format_percent(bent) +
                                      " of its surface is not flat, black there";
        }
        assignment.of_mirror[i] = find_or_add(choice, choices);
    }
    assignment.choices = std::move(choices);
    return assignment;
}

} // namespace catoptric::reflect
