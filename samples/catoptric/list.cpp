// catoptric list: lists techniques, scenes, devices, metrics or costs of devices.
#include "core/error.hpp"
#include "json.hpp"
#include "measure/metric.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "report/costs.hpp"
#include "scene/built_in.hpp"
#include "session/engine.hpp"
#include "session/folders.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <memory>

namespace catoptric::cli {

namespace {

constexpr const char* kListExamples = R"(Examples:
  catoptric list techniques
  catoptric list techniques parallax      its knobs
  catoptric list devices --json)";

const std::vector<std::string> kListableKinds{"techniques", "scenes", "devices", "metrics",
                                              "costs"};

std::string describe_knob(const session::KnobInfo& knob) {
    const std::string range = knob.choices.empty()
                                  ? fmt::format("{:.0f} to {:.0f}{}", knob.low, knob.high,
                                                knob.special.empty() ? "" : " or " + knob.special)
                                  : fmt::format("{}", fmt::join(knob.choices, "|"));
    return fmt::format("    {:<12} {} ({}; default {})\n", knob.name, knob.help, range, knob.value);
}

constexpr const char* kAutoSummary =
    "Chooses a technique for each mirror from what the picture shows, and gives the reasons.";

std::string format_technique_line(const std::string& name, const std::string& summary) {
    return fmt::format("{:<12} {}\n", name, summary);
}

/// Returns one line per technique.
std::string format_technique_list(const std::vector<session::TechniqueInfo>& techniques) {
    std::string text;
    for (const session::TechniqueInfo& technique : techniques)
        text += format_technique_line(technique.name, technique.summary);
    return text + format_technique_line("auto", kAutoSummary) +
           "\nKnobs of a technique: catoptric list techniques NAME\n";
}

/// Returns the text of one technique with its knobs.
std::string describe_technique(const session::TechniqueInfo& technique) {
    std::string text = format_technique_line(technique.name, technique.summary);
    for (const session::KnobInfo& knob : technique.knobs) text += describe_knob(knob);
    return text;
}

/// Throws `usage` for an unknown name, with the nearest.
std::vector<session::TechniqueInfo>
keep_named_technique(std::vector<session::TechniqueInfo> techniques, const std::string& name) {
    if (name == "auto") return {{.name = "auto", .summary = kAutoSummary}};
    std::vector<std::string> names;
    for (const session::TechniqueInfo& technique : techniques) names.push_back(technique.name);
    return {techniques[parse_choice("list techniques", name, names)]};
}

std::string technique_text(const std::string& name, bool json) {
    std::vector<session::TechniqueInfo> techniques = session::techniques();
    if (!name.empty()) techniques = keep_named_technique(std::move(techniques), name);
    if (json) return techniques_json(techniques);
    return name.empty() ? format_technique_list(techniques)
                        : describe_technique(techniques.front());
}

std::string format_device_list(const std::vector<session::DeviceInfo>& devices) {
    std::string text;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const session::DeviceInfo& device = devices[i];
        text += fmt::format("{}  {}  {}, Vulkan {}, {}{}{}{}\n", i, device.name, device.type,
                            device.api, device.driver,
                            device.profile.empty() ? "" : ", profile " + device.profile,
                            device.calibration.empty() ? "" : ", calibrated",
                            device.missing.empty() ? "" : "; not usable, lacks " + device.missing);
    }
    return text;
}

std::string format_named_list(const std::vector<NamedListEntry>& rows) {
    std::string text;
    for (const NamedListEntry& row : rows)
        text += fmt::format("{:<24} {}\n", row.name, row.summary);
    return text;
}

/// Returns the known costs of devices, with the device and the origin of its costs.
std::vector<NamedListEntry> list_device_costs() {
    std::vector<NamedListEntry> rows;
    for (const report::KnownCosts& known : report::list_known_costs()) {
        const measure::DeviceCosts costs = report::read_device_costs(std::string(known.text),
                                                                     known.name);
        rows.push_back({known.name, fmt::format("{} ({})", costs.device,
                                                measure::cost_origin_name(costs.origin))});
    }
    return rows;
}

std::vector<NamedListEntry> built_in_scenes() {
    std::vector<NamedListEntry> rows;
    for (const scene::BuiltInScene& scene : scene::built_in_scenes())
        rows.push_back({scene.name, scene.summary});
    return rows;
}

/// Returns unit, pixels and better direction of a metric, as far as they exist.
std::string describe_metric(const measure::Metric& metric) {
    std::vector<std::string> facts;
    if (!metric.unit.empty()) facts.emplace_back(metric.unit);
    if (metric.mask == "each")
        facts.emplace_back("over each mask and mirror");
    else if (!metric.mask.empty())
        facts.push_back("over " + std::string(metric.mask));
    if (metric.better != measure::BetterDirection::neither)
        facts.emplace_back(metric.better == measure::BetterDirection::less ? "less is better"
                                                                           : "more is better");
    return facts.empty() ? "" : " (" + join_with_commas(facts) + ")";
}

std::string format_metric_list() {
    std::string text;
    for (const measure::Metric& metric : measure::metrics())
        text += fmt::format("{:<32} {}{}\n", metric.name, metric.help, describe_metric(metric));
    return text;
}

std::string list_output(const std::string& kind, const std::string& name, bool json) {
    check(name.empty() || kind == "techniques", Failure::usage, "'list ", kind,
          "' wanted no further argument, found '", name, "'");
    if (kind == "techniques") return technique_text(name, json);
    if (kind == "devices") {
        const std::vector<session::DeviceInfo> devices = session::devices(
            session::find_profile_folder(), session::find_calibration_folder());
        for (const session::DeviceInfo& device : devices)
            if (!device.warning.empty()) print_warning(device.warning);
        return json ? devices_json(devices) : format_device_list(devices);
    }
    if (kind == "metrics") return json ? metrics_json() : format_metric_list();
    const std::vector<NamedListEntry> rows = kind == "costs" ? list_device_costs()
                                                             : built_in_scenes();
    return json ? named_json(kind, rows) : format_named_list(rows);
}

} // namespace

void add_list_verb(CommandLine& program) {
    struct ListOptions {
        OutputOptions output_options;
        std::string kind, name;
    };
    const auto options = std::make_shared<ListOptions>();
    Verb& verb = program.add_verb("list",
                                  "techniques, scenes, devices, metrics or costs of devices");
    verb.examples(kListExamples);
    verb.argument("WHAT", "techniques, scenes, devices, metrics or costs", options->kind,
                  Verb::Need::required);
    verb.argument("NAME", "name of a technique, to list its knobs", options->name,
                  Verb::Need::optional);
    add_output_options(verb, options->output_options);
    verb.action([options] {
        parse_choice("list", options->kind, kListableKinds);
        print_result(list_output(options->kind, options->name, options->output_options.json));
        return 0;
    });
}

} // namespace catoptric::cli
