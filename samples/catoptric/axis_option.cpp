#include "axis_option.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "parse.hpp"
#include "session/engine.hpp"
#include "session/technique_choice.hpp"

#include <algorithm>
#include <map>

namespace catoptric::cli {

namespace {

bool has_knob(const std::string& technique, const std::string& knob) {
    for (const session::TechniqueInfo& info : session::techniques())
        if (info.name == technique)
            return std::ranges::find(info.knobs, knob, &session::KnobInfo::name) !=
                   info.knobs.end();
    return false;
}

/// Returns whether the text "name:knob=value,..." gives the knob a value.
bool sets_knob(const std::string& text, const std::string& knob) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return false;
    return std::ranges::any_of(split(text.substr(colon + 1), ","), [&](const std::string& setting) {
        return setting.starts_with(knob + "=");
    });
}

std::string format_setting(const Setting& setting) {
    return setting.name + "=" + (setting.number ? std::to_string(*setting.number) : setting.text);
}

/// Returns the technique as text with the values of all its knobs. Two texts that mean the same
/// technique give the same result.
std::string format_all_knobs(const std::string& text) {
    const session::ParsedTechnique choice = session::parse_technique(text);
    std::string all = choice.technique;
    for (const Setting& setting : choice.settings) all += " " + format_setting(setting);
    return all;
}

std::vector<std::string> expand_axis(const std::vector<std::string>& techniques,
                                     const KnobAxis& axis) {
    std::vector<std::string> rows;
    bool is_known = false;
    const auto varies = [&](const std::string& text) {
        return has_knob(session::parse_technique(text).technique, axis.knob) &&
               !sets_knob(text, axis.knob);
    };
    // A new row may equal an existing row, if the value is the knob's default. Such a row is left
    // out.
    std::vector<std::string> known;
    for (const std::string& text : techniques)
        if (!varies(text)) known.push_back(format_all_knobs(text));
    for (const std::string& text : techniques) {
        is_known |= has_knob(session::parse_technique(text).technique, axis.knob);
        if (!varies(text)) {
            rows.push_back(text);
            continue;
        }
        const char* separator = text.find(':') == std::string::npos ? ":" : ",";
        for (const std::string& value : axis.values) {
            std::string row = text + separator;
            row += axis.knob + "=" + value;
            const std::string whole = parse_option("--axis", [&] { return format_all_knobs(row); });
            if (std::ranges::find(known, whole) != known.end()) continue;
            known.push_back(whole);
            rows.push_back(std::move(row));
        }
    }
    if (!is_known) {
        std::vector<std::string> names;
        for (const std::string& text : techniques)
            for (const Setting& setting : session::parse_technique(text).settings)
                if (std::ranges::find(names, setting.name) == names.end())
                    names.push_back(setting.name);
        fail(Failure::usage, "--axis ", axis.knob,
             ": wanted a knob of one of the techniques, see 'list techniques'; found none that has "
             "it",
             suggest_name_or_list(axis.knob, names));
    }
    return rows;
}

} // namespace

KnobAxis parse_axis(const std::string& text) {
    const std::size_t end = text.find('=');
    KnobAxis axis;
    if (end != std::string::npos) axis = {text.substr(0, end), split(text.substr(end + 1), ",")};
    std::vector<std::string> values = axis.values;
    std::ranges::sort(values);
    const bool is_complete = values.size() >= 2 && !values.front().empty() &&
                             std::ranges::adjacent_find(values) == values.end();
    check(!axis.knob.empty() && is_complete, Failure::usage,
          "--axis: wanted KNOB=VALUE,VALUE,... with different values, found ", quote(text));
    return axis;
}

std::vector<std::string> expand_axes(std::vector<std::string> techniques,
                                     const std::vector<KnobAxis>& axes) {
    for (const KnobAxis& axis : axes) techniques = expand_axis(techniques, axis);
    return techniques;
}

std::vector<std::string> axes_without_effect(const measure::Comparison& comparison,
                                             const std::vector<KnobAxis>& axes) {
    std::vector<std::string> sentences;
    for (const KnobAxis& axis : axes) {
        // Rows that differ in this knob alone, by technique, model and the other knobs.
        std::map<std::string, std::vector<const measure::Row*>> groups;
        for (const measure::Row& row : comparison.rows) {
            std::string key = row.technique + " " + row.model;
            for (const Setting& setting : row.settings)
                if (setting.name != axis.knob) key += " " + format_setting(setting);
            if (has_knob(row.technique, axis.knob)) groups[key].push_back(&row);
        }
        for (const auto& [key, rows] : groups)
            if (rows.size() > 1 && std::ranges::all_of(rows, [&](const measure::Row* row) {
                    return row->hdr.pixels == rows.front()->hdr.pixels;
                }))
                sentences.push_back("--axis " + axis.knob + ": the picture of " +
                                    rows.front()->label +
                                    " is the same with each value; the knob may have no effect "
                                    "with these settings");
    }
    return sentences;
}

} // namespace catoptric::cli
