#pragma once

#include "core/frame_facts.hpp"
#include "session/engine.hpp"

#include <map>
#include <string>
#include <vector>

/// A plan as the controls edit it: a technique with knobs for all mirrors, and exceptions for
/// single mirrors.
namespace catoptric::view {

struct TechniqueSettings {
    std::string technique = "secant";
    std::map<std::string, std::string> knobs; ///< knobs that differ from their default
    bool operator==(const TechniqueSettings&) const = default;
};

struct EditedPlan {
    /// Technique of mirrors without an entry in `own`.
    TechniqueSettings rest;
    std::map<std::uint32_t, TechniqueSettings> own; ///< techniques by mirror number, from 1
    /// The plan as the user typed it, unless it lists techniques by mirror number. Examples are
    /// "auto", "plan:FILE" and patterns of names. Empty: the other members define the plan.
    std::string typed;
    bool operator==(const EditedPlan&) const = default;
};

/// Returns the technique with its knobs, such as "secant:face=64".
std::string technique_text(const TechniqueSettings& settings);
/// Returns the plan as session::FrameSpec::techniques takes it.
std::string technique_text(const EditedPlan& plan);
/// Returns the words of the options by which `catoptric render` draws the plan.
std::vector<std::string> plan_words(const EditedPlan& plan);
/// Returns the plan of a command-line text. Throws `usage` as session::parse_technique does.
EditedPlan parse_plan(const std::string& text);
/// Returns the same plan mirror by mirror, for editing. `entries` tells how each mirror was drawn.
EditedPlan resolve_plan(const EditedPlan& plan, const std::vector<PlanEntry>& entries);
/// Removes the knob's entry if the value is the default.
void set(TechniqueSettings& settings, const session::KnobInfo& knob, const std::string& value);
std::string knob_value(const TechniqueSettings& settings, const session::KnobInfo& knob);
/// Returns the plan with the knob set in each technique that has it.
EditedPlan set_knob(EditedPlan plan, const std::string& knob, const std::string& value);
/// Returns the plan as JSON that --plan reads.
std::string plan_to_json(const EditedPlan& plan);

/// The list is built once.
const std::vector<session::TechniqueInfo>& technique_infos();
/// Returns the technique of this name, or null.
const session::TechniqueInfo* technique_info(const std::string& technique);

} // namespace catoptric::view
