#pragma once

#include "reflect/technique.hpp"
#include "require/model.hpp"

#include <string>
#include <string_view>
#include <vector>

/// Which technique draws which mirror.
namespace catoptric::reflect {

/// One entry of a plan. The pattern is a list with commas of mirror numbers from 1, names with the
/// wildcards of a shell, or `*`.
struct Rule {
    std::string pattern;
    Choice choice;
};

/// A frame's techniques as they were asked for.
struct Plan {
    std::string label; ///< "secant:face=64", "1=planar *=reuse", "plan:mixed.json"
    std::vector<Rule> rules;
    bool is_technique = false; ///< one for all mirrors, which may be none
    bool is_auto = false;      ///< what the scene suggests: no rules until somebody has asked it
    /// Of each mirror, of a plan that was suggested: why it is drawn so.
    std::vector<std::string> reasons;

    /// The label fit for a file name, of no more than 80 bytes.
    std::string file_name() const;
    /// Same patterns with the same techniques and settings, whatever was spelled out.
    bool same_as(const Plan& other) const;
};

/// The plan that is suggested anew for each scene (require::suggest).
inline constexpr std::string_view kAuto = "auto";

/// Reads "name[:knob=value,...]", or "PATTERN=name[:knob=value,...] ..." with blanks between its
/// rules, or kAuto. Throws `Failure::usage` naming what is wrong and the nearest name.
Plan parse_plan(std::string_view text);

/// A plan for the mirrors of a scene.
struct Assignment {
    std::vector<Choice> choices;          ///< no two the same; at least one
    std::vector<std::uint32_t> of_mirror; ///< index into `choices`, entry n-1 of mirror n
    std::vector<std::string> patterns; ///< of the rule that decided, likewise; empty: a technique
    /// Why it is drawn so, likewise, where that is more than the rule: another technique draws it,
    /// or the plan was suggested.
    std::vector<std::string> reasons;
    /// What its technique does not draw as asked, likewise, a clause each; empty: nothing.
    std::vector<std::string> lacks;
};

/// A rule that names the mirror by number goes before one that does by name, that before `*`; of
/// equals the first. `names`: of the mirrors. Throws `Failure::usage` for a pattern without a match
/// and for a mirror without a rule. O(rules * mirrors).
Assignment assign(const Plan& plan, const std::vector<std::string>& names);

/// What the plans' techniques need of a model, whoever is seen.
void demand(require::Question& question, const std::vector<Plan>& plans);

/// Mirrors that their technique cannot draw (Technique::unfit) get the one that its knob `rest`
/// names, with the same shadows. Assignment::lacks says so, and which part of a mirror with flat
/// faces lies in none of them. `flats`: of each mirror.
Assignment fitted(Assignment assignment, const std::vector<scene::FlatFaces>& flats,
                  double tolerance);

} // namespace catoptric::reflect
