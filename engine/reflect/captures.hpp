#pragma once

#include "reflect/technique.hpp"

#include <algorithm>
#include <array>

/// Knobs that the techniques with captures share, and functions that pass their values to the
/// shared passes.
namespace catoptric::reflect {

inline constexpr std::array<std::string_view, 3> kDistanceChoices{"r32f", "r16f", "unorm8"};
inline constexpr std::array<std::string_view, 2> kColourChoices{"half", "float"};
inline constexpr std::array<std::string_view, 2> kShadowChoices{"map", "none"};

inline constexpr Knob kFace{
    .name = "face",
    .help = "cube face edge in texels; auto: as many as the picture can show",
    .low = 1,
    .high = 16384,
    .value = 256,
    .special = "auto"};
inline constexpr Knob kCapture{
    .name = "capture",
    .help = "beside other techniques: cube face edge of the capture by which other mirrors' "
            "captures show this one, in texels; none: black there",
    .low = 1,
    .high = 16384,
    .value = 256,
    .special = "none"};
inline constexpr Knob kColour{
    .name = "colour",
    .help = "how captures store colour: half, which ends at 65504, or float",
    .high = 1,
    .choices = kColourChoices};
inline constexpr Knob kShadow{
    .name = "shadow", .help = "shadow map or none", .high = 1, .choices = kShadowChoices};
inline constexpr Knob kShadowMapEdge{.name = "shadow_map",
                                     .help = "shadow map edge in texels",
                                     .low = 1,
                                     .high = 16384,
                                     .value = 1024};
inline constexpr Knob kDistance{.name = "distance",
                                .help = "how captures store distance",
                                .high = 2,
                                .choices = kDistanceChoices};
inline constexpr Knob kRange{.name = "range",
                             .help = "world units of a stored 1 with distance=unorm8",
                             .low = 1,
                             .high = 1000000,
                             .value = 200};

inline constexpr Knob kContinue{
    .name = "continue",
    .help = "mirrors the reflected ray is followed through before it is looked up",
    .low = 0,
    .high = 8,
    .value = 4};

inline constexpr std::array<std::string_view, 2> kLookupChoices{"bilinear", "object"};
inline constexpr std::array<std::string_view, 2> kCapturesChoices{"own", "all"};
inline constexpr std::array<std::string_view, 2> kMirrorsChoices{"captured", "left_out"};
inline constexpr std::array<std::string_view, 3> kShowChoices{"colour", "state", "residual"};

/// Knobs that every search has, in lists after the search's own knobs.
inline constexpr std::array kSearchKnobs{
    kFace,
    kColour,
    kDistance,
    kRange,
    kContinue,
    Knob{.name = "lookup",
         .help = "mix the colours of four texels, or only of those that show one object",
         .high = 1,
         .value = 1,
         .choices = kLookupChoices},
    Knob{.name = "captures",
         .help = "captures asked where the search knows no answer: the mirror's own, or then the "
                 "others",
         .high = 1,
         .choices = kCapturesChoices},
    Knob{.name = "mirrors",
         .help = "left_out: captures without mirrors that are exact spheres, which rays are "
                 "followed through anyway",
         .high = 1,
         .choices = kMirrorsChoices},
    Knob{.name = "show",
         .help = "what mirrors show: their colour, whether the search ended in a hit (green), "
                 "unknown (red) or a miss (blue), or its residual",
         .high = 2,
         .choices = kShowChoices},
    kShadow,
    kShadowMapEdge};

template <std::size_t N>
constexpr std::array<Knob, N + kSearchKnobs.size()> search_knobs(const std::array<Knob, N>& own) {
    std::array<Knob, N + kSearchKnobs.size()> knobs{};
    std::ranges::copy(kSearchKnobs, std::ranges::copy(own, knobs.begin()).out);
    return knobs;
}

/// Returns the number of shadow passes: one for each light, or 0 with `shadow=none`.
int shadow_passes(int lights, const Settings& settings);

/// Returns the options of a capture from the knobs: face edge, colour format and, for techniques
/// with these knobs, distance format and surface numbers. Throws `Failure::no_device` for
/// `colour=float` on a device that cannot filter 32-bit floats.
render::CaptureOptions capture_options(const render::FrameInputs& inputs, const Settings& settings);

/// Returns whether the search may read captures of other mirrors (`continue` above 0 or
/// `captures=all`).
bool visits_others(const Settings& settings);

/// Returns a mirror shading that looks into the captures with the fragment shader `fragment`. The
/// knobs `continue`, `lookup`, `captures` and `show`, where they exist, become shader constants.
render::MirrorShader shading_with_captures(const MirrorInputs& around, std::string fragment,
                                           const Settings& settings);

/// Returns the mirror shading of a technique with Technique::search. The technique's own knobs
/// become shader constants of the same names.
render::MirrorShader shading_of_search(const Technique& technique, const MirrorInputs& around,
                                       const Settings& settings);

/// Returns the scene passes R of techniques with one capture per mirror: N + 2 with one light.
inline int feedback_passes(int mirrors, int lights, const Settings& settings) {
    return mirrors + shadow_passes(lights, settings) + 1;
}

} // namespace catoptric::reflect
