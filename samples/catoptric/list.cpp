// catoptric list: lists techniques, scenes, devices or metrics.
#include "core/error.hpp"
#include "json.hpp"
#include "measure/metric.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "scene/built_in.hpp"
#include "scene/load.hpp"
#include "session/engine.hpp"
#include "session/folders.hpp"
#include "table.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <memory>

namespace catoptric::cli {

namespace {

constexpr const char* kListExamples = R"(Examples:
  catoptric list techniques
  catoptric list techniques parallax      its knobs
  catoptric list devices --json)";

const std::vector<std::string> kKinds{"techniques", "scenes", "devices", "metrics"};

std::string knob_text(const app::KnobInfo& knob) {
    const std::string range = knob.choices.empty()
                                  ? fmt::format("{:.0f} to {:.0f}{}", knob.low, knob.high,
                                                knob.special.empty() ? "" : " or " + knob.special)
                                  : fmt::format("{}", fmt::join(knob.choices, "|"));
    return fmt::format("    {:<12} {} ({}; default {})\n", knob.name, knob.help, range, knob.value);
}

constexpr const char* kAutoSummary =
    "Chooses a technique for each mirror from what the picture shows, and gives the reasons.";

std::string technique_line(const std::string& name, const std::string& summary) {
    return fmt::format("{:<12} {}\n", name, summary);
}

/// Returns one line per technique.
std::string techniques_text(const std::vector<app::TechniqueInfo>& techniques) {
    std::string text;
    for (const app::TechniqueInfo& technique : techniques)
        text += technique_line(technique.name, technique.summary);
    return text + technique_line("auto", kAutoSummary) +
           "\nKnobs of a technique: catoptric list techniques NAME\n";
}

/// Returns the text of one technique with its knobs.
std::string technique_text(const app::TechniqueInfo& technique) {
    std::string text = technique_line(technique.name, technique.summary);
    for (const app::KnobInfo& knob : technique.knobs) text += knob_text(knob);
    return text;
}

/// Returns only the technique of this name. Throws `usage` for an unknown name, with the nearest.
std::vector<app::TechniqueInfo> only(std::vector<app::TechniqueInfo> techniques,
                                     const std::string& name) {
    if (name == "auto") return {{.name = "auto", .summary = kAutoSummary}};
    std::vector<std::string> names;
    for (const app::TechniqueInfo& technique : techniques) names.push_back(technique.name);
    return {techniques[parse_choice("list techniques", name, names)]};
}

std::string techniques_listing(const std::string& name, bool json) {
    std::vector<app::TechniqueInfo> techniques = app::techniques();
    if (!name.empty()) techniques = only(std::move(techniques), name);
    if (json) return techniques_json(techniques);
    return name.empty() ? techniques_text(techniques) : technique_text(techniques.front());
}

std::string devices_text(const std::vector<app::DeviceInfo>& devices) {
    std::string text;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const app::DeviceInfo& device = devices[i];
        text += fmt::format("{}  {}  {}, Vulkan {}, {}{}{}\n", i, device.name, device.type,
                            device.api, device.driver,
                            device.profile.empty() ? "" : ", profile " + device.profile,
                            device.missing.empty() ? "" : "; not usable, lacks " + device.missing);
    }
    return text;
}

std::string named_text(const std::vector<Named>& rows) {
    std::string text;
    for (const Named& row : rows) text += fmt::format("{:<24} {}\n", row.name, row.summary);
    return text;
}

std::vector<Named> scenes() {
    std::vector<Named> rows;
    for (const scene::BuiltIn& scene : scene::built_in_scenes())
        rows.push_back({scene.name, scene.summary});
    return rows;
}

/// Returns unit, pixels and better direction of a metric, as far as they exist.
std::string facts_of(const measure::Metric& quantity) {
    std::vector<std::string> facts;
    if (!quantity.unit.empty()) facts.emplace_back(quantity.unit);
    if (quantity.mask == "each")
        facts.emplace_back("over each mask and mirror");
    else if (!quantity.mask.empty())
        facts.push_back("over " + std::string(quantity.mask));
    if (quantity.better != measure::Better::neither)
        facts.emplace_back(quantity.better == measure::Better::less ? "less is better"
                                                                    : "more is better");
    return facts.empty() ? "" : " (" + join(facts) + ")";
}

std::string metrics_text() {
    std::string text;
    for (const measure::Metric& quantity : measure::metrics())
        text += fmt::format("{:<32} {}{}\n", quantity.name, quantity.help, facts_of(quantity));
    return text;
}

std::string listing(const std::string& kind, const std::string& name, bool json) {
    check(name.empty() || kind == "techniques", Failure::usage, "'list ", kind,
          "' wanted no further argument, found '", name, "'");
    if (kind == "techniques") return techniques_listing(name, json);
    if (kind == "devices") {
        const std::vector<app::DeviceInfo> devices = app::devices(app::profile_folder());
        for (const app::DeviceInfo& device : devices)
            if (!device.warning.empty()) warn(device.warning);
        return json ? devices_json(devices) : devices_text(devices);
    }
    if (kind == "metrics") return json ? metrics_json() : metrics_text();
    return json ? named_json(kind, scenes()) : named_text(scenes());
}

} // namespace

void add_list(CommandLine& program) {
    struct ListOptions {
        Manners manners;
        std::string kind, name;
    };
    const auto options = std::make_shared<ListOptions>();
    Verb& verb = program.add("list", "techniques, scenes, devices or metrics");
    verb.examples(kListExamples);
    verb.argument("WHAT", "techniques, scenes, devices or metrics", options->kind,
                  Verb::Need::required);
    verb.argument("NAME", "name of a technique, to list its knobs", options->name,
                  Verb::Need::optional);
    add_manners(verb, options->manners);
    verb.does([options] {
        parse_choice("list", options->kind, kKinds);
        put(listing(options->kind, options->name, options->manners.json));
        return 0;
    });
}

} // namespace catoptric::cli
