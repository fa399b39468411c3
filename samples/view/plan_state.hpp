#pragma once

#include "app/engine.hpp"
#include "core/plan_entry.hpp"

#include <map>
#include <string>
#include <vector>

/// A plan as controls edit it: a technique with its knobs for all mirrors, and for some their own.
namespace catoptric::view {

struct Drawing {
    std::string technique = "secant";
    std::map<std::string, std::string> knobs; ///< those that are not at their default
    bool operator==(const Drawing&) const = default;
};

struct PlanState {
    Drawing rest;                         ///< of mirrors without their own
    std::map<std::uint32_t, Drawing> own; ///< by mirror, from 1
    /// As it was typed, where it is no list of techniques by number yet ("auto", "plan:FILE",
    /// patterns of names); empty: the members above say all.
    std::string typed;
    bool operator==(const PlanState&) const = default;
};

/// "secant:face=64".
std::string text_of(const Drawing& drawing);
/// As app::FrameSpec::techniques takes it.
std::string text_of(const PlanState& plan);
/// The options of `catoptric render` that draw it, in words.
std::vector<std::string> words_of(const PlanState& plan);
/// Of what the command line says. Throws `usage` as app::parse_technique does.
PlanState plan_of(const std::string& text);
/// The same plan, mirror by mirror, so that it can be edited. `entries`: how it was drawn.
PlanState resolved(const PlanState& plan, const std::vector<PlanEntry>& entries);
/// Sets a knob; its default is not kept.
void set(Drawing& drawing, const app::KnobInfo& knob, const std::string& value);
/// The value of a knob.
std::string value_of(const Drawing& drawing, const app::KnobInfo& knob);
/// The same plan with a knob set wherever the technique has it.
PlanState with(PlanState plan, const std::string& knob, const std::string& value);
/// A file that --plan reads.
std::string json_of(const PlanState& plan);

/// Every technique, asked for once.
const std::vector<app::TechniqueInfo>& table();
/// Null: there is none of that name.
const app::TechniqueInfo* find(const std::string& technique);

} // namespace catoptric::view
