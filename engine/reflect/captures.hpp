#pragma once

#include "reflect/technique.hpp"
#include "render/light_probes.hpp"
#include "render/passes.hpp"
#include "shared.h"

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
    .help = "edge of a capture's face in texels; auto: as fine as the picture's pixels",
    .low = 1,
    .high = 16384,
    .value = 256,
    .special = "auto"};
inline constexpr Knob kEvery{
    .name = "every",
    .help =
        "captures are drawn again at most in each N-th frame, in turns; a reflection is then up "
        "to N - 1 frames old",
    .low = 1,
    .high = 64,
    .value = 1};
inline constexpr Knob kOthersFace{
    .name = "capture",
    .help = "in a plan with other techniques: face edge, in texels, of the capture by which other "
            "mirrors show this mirror; none: black in other mirrors",
    .low = 1,
    .high = 16384,
    .value = 256,
    .special = "none"};
inline constexpr Knob kColour{.name = "colour",
                              .help = "format of captured colour: half (up to 65504) or float",
                              .high = 1,
                              .choices = kColourChoices};
inline constexpr Knob kShadow{.name = "shadow",
                              .help = "shadows: from shadow maps or none",
                              .high = 1,
                              .choices = kShadowChoices};
inline constexpr std::array<std::string_view, 3> kTracedShadowChoices{"ray", "map", "none"};
inline constexpr Knob kTracedShadow{.name = "shadow",
                                    .help = "shadows: from rays, from shadow maps, or none",
                                    .high = 2,
                                    .choices = kTracedShadowChoices};
inline constexpr Knob kShadowMap{.name = "shadow_map",
                                 .help = "edge of a shadow map's face in texels",
                                 .low = 1,
                                 .high = 16384,
                                 .value = 1024};
inline constexpr std::array<std::string_view, 2> kSoftShadowChoices{"none", "pcss"};
inline constexpr Knob kSoftShadow{
    .name = "soft",
    .help = "shadows of lamps in shadow maps: none (hard, as from a point), or pcss (soft by the "
            "lamp's size; shadows of rays stay hard; judge it by --truth paths)",
    .high = 1,
    .choices = kSoftShadowChoices};
inline constexpr Knob kDistance{.name = "distance",
                                .help = "format of captured distances",
                                .high = 2,
                                .choices = kDistanceChoices};
inline constexpr Knob kRange{
    .name = "range",
    .help = "largest distance that distance=unorm8 can store, in world units",
    .low = 1,
    .high = 1000000,
    .value = 200};

inline constexpr Knob kContinue{
    .name = "continue",
    .help =
        "number of further mirrors through which a reflected ray is followed before the look-up",
    .low = 0,
    .high = 8,
    .value = 4};

inline constexpr std::array<std::string_view, 2> kLookupChoices{"bilinear", "object"};
inline constexpr std::array<std::string_view, 2> kSearchedCapturesChoices{"own", "all"};
inline constexpr std::array<std::string_view, 2> kCapturedMirrorChoices{"captured", "left_out"};
inline constexpr std::array<std::string_view, 3> kShowChoices{"colour", "state", "residual"};

inline constexpr Knob kLookup{
    .name = "lookup",
    .help = "interpolation of colour: bilinear mixes four texels; object mixes only texels that "
            "show the same object",
    .high = 1,
    .value = 1,
    .choices = kLookupChoices};
inline constexpr Knob kSearchedCaptures{
    .name = "captures",
    .help = "captures that a search reads: own, or all (other mirrors' captures if the own one "
            "answers unknown)",
    .high = 1,
    .choices = kSearchedCapturesChoices};
inline constexpr Knob kCapturedMirrors{
    .name = "mirrors",
    .help = "mirrors in captures: captured, or left_out (without exact spheres, through which rays "
            "are followed)",
    .high = 1,
    .choices = kCapturedMirrorChoices};
inline constexpr Knob kShow{
    .name = "show",
    .help = "picture on mirrors: colour; state of the search, hit (green), unknown (red) or miss "
            "(blue); residual of the search",
    .high = 2,
    .choices = kShowChoices};

/// Names of the methods for rough mirrors and of the distance laws, in the order of
/// RoughKnobs::Lookup and RoughKnobs::Law.
inline constexpr std::array<std::string_view, 5> kRoughChoices{"none", "mips", "prefilter", "rays",
                                                               "fast"};
inline constexpr std::array<std::string_view, 5> kLawChoices{"none", "frostbite", "square", "cone",
                                                             "exact"};
inline constexpr Knob kRough{
    .name = "rough",
    .help =
        "look-up for rough surfaces: none (sharp), mips (box-filtered level of the capture), "
        "prefilter (level filtered by the GGX lobe), fast (the same with few fitted samples in fine "
        "levels), rays (searches in directions of the lobe)",
    .high = 4,
    .value = 2,
    .choices = kRoughChoices};
inline constexpr Knob kTaps{
    .name = "taps",
    .help = "samples of each texel for rough=prefilter, and for wide lobes of fast",
    .low = 1,
    .high = 2048,
    .value = 32};
inline constexpr Knob kRays{
    .name = "rays",
    .help =
        "directions of each rough pixel: searches for rough=rays, rays where a tracer completes "
        "the search",
    .low = 1,
    .high = 1024,
    .value = 16};
inline constexpr Knob kLaw{
    .name = "law",
    .help =
        "how the blur of rough=mips, prefilter and fast depends on the distance of the reflected "
        "surface: none, frostbite, square, cone, or exact (the lobe's solid angle)",
    .high = 4,
    .value = 4,
    .choices = kLawChoices};

/// Names of the models of glass, in the order of shared::kRefract....
inline constexpr std::array<std::string_view, 8> kRefractChoices{
    "none", "auto", "thin", "sphere", "box", "traced", "backface", "screen"};
inline constexpr Knob kRefract{
    .name = "refract",
    .help =
        "light that passes glass: none (glass shows its diffuse part), auto (what fits the "
        "body: thin, sphere or box), thin (rays are not bent), sphere (a ball at each point), "
        "box (the body's bounds), traced (rays where a tracer completes the search, else auto), "
        "backface (the back faces that the camera's view shows, else auto), screen (the picture "
        "without glass where the refracted ray leaves the body, else auto)",
    .high = render::kRefractScreen,
    .value = shared::kRefractAuto,
    .choices = kRefractChoices};

/// Names of images of the camera's view in shaders/lib/refraction.glsl and opaque_picture.glsl.
inline constexpr const char* kGlassBackImage = "glass_backs";
inline constexpr const char* kOpaquePictureImage = "opaque_picture";
inline constexpr const char* kOpaqueLevelImage = "opaque_levels";

/// Returns the model of glass for views other than the camera's, which have no images of the
/// camera's view.
inline std::uint32_t other_view_refraction(std::uint32_t refract) {
    return refract >= render::kRefractBackface ? shared::kRefractAuto : refract;
}
/// Makes a mirror's shader fit for other views than the camera's: it reads no images of that view.
void remove_view_images(render::MirrorShader& look);

inline constexpr std::array<std::string_view, 2> kIndirectLightChoices{"ambient", "captures"};
inline constexpr Knob kIndirect{
    .name = "indirect",
    .help = "light between surfaces: ambient (--ambient and the whole environment, the same "
            "everywhere), or captures (light probes: small captures on a grid; judge it by --truth "
            "paths)",
    .high = 1,
    .choices = kIndirectLightChoices};
inline constexpr std::array<std::string_view, 3> kAmbientOcclusionChoices{"none", "screen",
                                                                          "captures"};
inline constexpr Knob kAmbientOcclusion{
    .name = "ao",
    .help = "what hides the environment, --ambient and light of indirect=captures from diffuse "
            "surfaces: none, screen (near surfaces, only in the camera's view), or captures (light "
            "probes, in all views; not with indirect=captures)",
    .high = 2,
    .choices = kAmbientOcclusionChoices};
inline constexpr Knob kProbes{
    .name = "probes",
    .help = "most light probes of the grid, for indirect=captures and ao=captures",
    .low = 27,
    .high = 4096,
    .value = 64};

/// Knobs that every search has, in lists after the search's own knobs.
inline constexpr std::array kSearchKnobs{kFace,
                                         kEvery,
                                         kColour,
                                         kDistance,
                                         kRange,
                                         kContinue,
                                         kLookup,
                                         kSearchedCaptures,
                                         kCapturedMirrors,
                                         kShow,
                                         kRough,
                                         kLaw,
                                         kTaps,
                                         kRays,
                                         kRefract,
                                         kIndirect,
                                         kProbes,
                                         kAmbientOcclusion,
                                         kShadow,
                                         kShadowMap,
                                         kSoftShadow};

template <std::size_t N>
constexpr std::array<Knob, N + kSearchKnobs.size()> search_knobs(const std::array<Knob, N>& own) {
    std::array<Knob, N + kSearchKnobs.size()> knobs{};
    std::ranges::copy(kSearchKnobs, std::ranges::copy(own, knobs.begin()).out);
    return knobs;
}

/// Returns the number of shadow passes: one for each light, or 0 with `shadow=none`.
int count_shadow_passes(int lights, const KnobSettings& settings);

/// Returns the options of a capture from the knobs: face edge, colour format and, for techniques
/// with these knobs, distance format and surface numbers. Throws `Failure::no_device` for
/// `colour=float` on a device that cannot filter 32-bit floats.
render::CaptureOptions make_capture_options(const render::FrameInputs& inputs,
                                            const KnobSettings& settings);

/// Returns a mirror shading that looks into the captures with the fragment shader `fragment`. The
/// knobs `continue`, `lookup`, `captures`, `show` and `refract`, where they exist, become shader
/// constants.
render::MirrorShader make_capture_shader(const ShadingInputs& around, std::string fragment,
                                         const KnobSettings& settings);

/// Returns the shader with which mirrors are drawn by a technique that searches captures, and its
/// constants. The technique's own knobs become shader constants of the same names.
render::MirrorShader make_search_shader(const Technique& technique, const ShadingInputs& around,
                                        const KnobSettings& settings);

/// Consecutive layers of an array of cube maps.
struct CubeRange {
    std::uint32_t first = 0, count = 0;
};
/// Returns the cubes of captures in array `array` for which `derived`, an image that passes compute
/// from captures, is out of date, as runs of layers. Sets their content hash to `hash` of the
/// mirror. If captures are not kept from frame to frame, all cubes are out of date.
template <typename Hash>
std::vector<CubeRange>
find_outdated_cubes(graph::Graph& graph, const render::MirrorCaptures& captures,
                    std::uint32_t array, graph::ImageHandle derived, Hash&& hash) {
    std::vector<CubeRange> runs;
    for (std::uint32_t mirror = 0; mirror < captures.places.size(); ++mirror) {
        const render::CubeSlot& place = captures.places[mirror];
        if (place.array != array) continue;
        const std::uint32_t first = 6 * place.cube;
        if (!captures.drawings.empty()) {
            const std::uint64_t content_hash = hash(mirror);
            if (graph.has_content_hash(derived.layers(first, 6), content_hash)) continue;
            graph.set_content_hash(derived.layers(first, 6), content_hash);
        }
        if (runs.empty() || runs.back().first + runs.back().count != first)
            runs.push_back({first, 0});
        runs.back().count += 6;
    }
    return runs;
}

/// Returns the scene passes R of techniques with one capture per mirror: N + 2 with one light.
inline int count_capture_passes(int mirrors, int lights, const KnobSettings& settings) {
    return mirrors + count_shadow_passes(lights, settings) + 1;
}

} // namespace catoptric::reflect
