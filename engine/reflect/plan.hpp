#pragma once

#include "reflect/technique.hpp"
#include "require/model.hpp"

#include <string>
#include <string_view>
#include <vector>

/// Plans, which choose the technique of each mirror.
namespace catoptric::reflect {

/// One entry of a plan. The pattern is a list of mirror numbers from 1, names with shell wildcards,
/// or `*`, separated by commas.
struct PlanRule {
    std::string pattern;
    TechniqueChoice choice;
};

/// The techniques of a frame as the user asked for them.
struct TechniquePlan {
    std::string label; ///< "secant:face=64", "1=planar *=reuse", "plan:mixed.json"
    std::vector<PlanRule> rules;
    bool is_technique = false; ///< one technique for all mirrors; the scene may have none
    bool is_auto = false;      ///< no rules until a scene has suggested them (kAutoPlanName)
    /// Reason for the technique of each mirror, in suggested plans.
    std::vector<std::string> reasons;

    /// Returns the label as a file name of at most 80 bytes.
    std::string file_name() const;
    /// Returns whether both plans have the same patterns with the same techniques and settings. The
    /// spelling of the labels does not matter.
    bool is_same(const TechniquePlan& other) const;
    /// Returns whether some technique of the plan takes light between surfaces from light probes.
    bool has_probe_light() const;
    /// Returns whether some rule draws soft shadows of lamps (soft=pcss).
    bool uses_soft_shadows() const;
    /// Returns whether some technique of the plan hides the environment from diffuse surfaces.
    bool occludes_environment() const;
};

/// Name of the technique `auto`, which chooses a plan for each scene
/// (require::suggest_plan).
inline constexpr std::string_view kAutoPlanName = "auto";

/// Reads "name[:knob=value,...]", or rules "PATTERN=name[:knob=value,...] ..." separated by blanks,
/// or kAutoPlanName. Throws `Failure::usage` with the faulty part and the nearest name.
TechniquePlan parse_plan(std::string_view text);

/// A plan applied to the mirrors of a scene. All lists but `choices` have one entry per mirror;
/// entry n-1 belongs to mirror n.
struct Assignment {
    std::vector<TechniqueChoice> choices; ///< all different; at least one
    std::vector<std::uint32_t> of_mirror; ///< index into `choices` for each mirror
    /// For each mirror: the pattern of the rule that chose its technique. Empty: one technique
    /// draws all mirrors.
    std::vector<std::string> patterns;
    /// For each mirror: the reason for its technique, if `auto` chose the plan or another technique
    /// replaces the requested one; else empty.
    std::vector<std::string> reasons;
    /// For each mirror: a clause that names the parts of the mirror that its technique cannot draw;
    /// else empty.
    std::vector<std::string> lacks;
};

/// Returns the plan applied to mirrors with these names. If several rules match a mirror, a number
/// wins over a name and a name over `*`. Between equals the first rule wins. Throws
/// `Failure::usage` for a pattern without a match and for a mirror without a rule. O(rules *
/// mirrors).
Assignment assign_techniques(const TechniquePlan& plan, const std::vector<std::string>& names);

/// Adds to the model's input the needs of the plan's techniques that do not depend on visibility:
/// whole cubes, captures of all mirrors, and the edge of the coarsest shadow map.
void add_capture_needs(require::WorkModelInput& input, const std::vector<TechniquePlan>& plans);

/// Replaces the technique of each mirror that the technique cannot draw (Technique::unfit). The
/// knob `rest` names the replacement, which keeps the shadow settings.
///
/// Assignment::lacks reports the replacement, and the share of a mirror that lies in
/// none of its flat faces. `flats` has one entry per mirror. `tolerance` is in radians.
Assignment replace_unfit(Assignment assignment, const std::vector<scene::FlatFaces>& flats,
                         double tolerance);

} // namespace catoptric::reflect
