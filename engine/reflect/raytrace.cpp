// The technique `raytrace`, which is also the reference: Whitted ray tracing (reflect/tracer.hpp).
#include "reflect/captures.hpp"

#include <algorithm>

namespace catoptric::reflect {

namespace {

constexpr std::array<std::string_view, 2> kLampSamplingChoices{"sampled", "met"};
constexpr std::array<std::string_view, 2> kIndirectChoices{"none", "paths"};
constexpr std::array<std::string_view, 2> kExactSphereChoices{"mesh", "exact"};
constexpr std::array<std::string_view, 2> kFirstHitChoices{"ray", "raster"};
constexpr std::array<std::string_view, 2> kHitPrecisionChoices{"f32", "f64"};
/// Names of the rules that can be left out, numbered as in shaders/lib/plain.glsl.
constexpr std::array<std::string_view, 6> kTracerWithoutChoices{
    "none", "watertight", "box_slack", "spawn_bound", "shadow_end", "stable_sphere"};
enum class LampSampling { sampled, met };
enum class IndirectLight { none, paths };
enum class SphereShape { mesh, exact };
enum class FirstHit { ray, raster };
enum class HitPrecision { f32, f64 };
constexpr Knob kDepth{.name = "depth",
                      .help = "largest number of mirror bounces; longer paths end black",
                      .low = 0,
                      .high = 64,
                      .value = 8};
constexpr Knob kSamples{
    .name = "samples",
    .help = "rays per pixel: 1 = the centre, n*n = a regular grid, other numbers = stratified",
    .low = 1,
    .high = 65536,
    .value = 1};
constexpr Knob kLobeRays{
    .name = "rays",
    .help =
        "rays of each sample, whose directions are drawn from the lobes of rough surfaces (GGX, "
        "roughness above 0.04); 0: rough mirrors reflect sharply",
    .low = 0,
    .high = 65536,
    .value = 0};
constexpr Knob kLobeSeed{
    .name = "seed",
    .help = "seed of the directions drawn for rays=N, in addition to --seed; pictures of two seeds "
            "are independent draws",
    .low = 0,
    .high = 999'999'999,
    .value = 0};
constexpr Knob kLamps{
    .name = "lamps",
    .help =
        "how rays of rough surfaces find lamps: sampled = beside each ray, one to a point drawn "
        "on a lamp (next-event estimation; not with sphere=exact or hit=f64); met = by chance",
    .high = 1,
    .choices = kLampSamplingChoices};
constexpr Knob kTracedIndirect{
    .name = "indirect",
    .help = "light between surfaces: none = lamps are points, and ambient light stands in; paths = "
            "path tracing, for which rays also leave diffuse surfaces (rays=0 counts as 1; depth "
            "counts all bounces)",
    .high = 1,
    .choices = kIndirectChoices};
constexpr std::int64_t kMaxPathsPerPixel = 65536; // largest number for a pixel: samples times rays
constexpr Knob kSphere{.name = "sphere",
                       .help = "shape of balls: triangles or exact spheres",
                       .high = 1,
                       .choices = kExactSphereChoices};
constexpr Knob kFirstHit{
    .name = "first",
    .help = "how the surface that the camera sees is found: by a ray, or by the rasteriser",
    .high = 1,
    .choices = kFirstHitChoices};
constexpr Knob kHitPrecision{.name = "hit",
                             .help = "precision of hit points: single or double",
                             .high = 1,
                             .choices = kHitPrecisionChoices};
constexpr Knob kTracerWithout{.name = "without",
                              .help = "rule of robustness to leave out, to measure its cost",
                              .high = 5,
                              .choices = kTracerWithoutChoices};
constexpr Knob kKnobs[] = {kDepth,          kSamples,      kLobeRays,  kLobeSeed, kLamps,
                           kTracedIndirect, kTracedShadow, kSphere,    kFirstHit, kHitPrecision,
                           kTracerWithout,  kShadowMap,    kOthersFace};

bool rasters_first(const KnobSettings& settings) {
    return settings.get<FirstHit>(kFirstHit) == FirstHit::raster;
}

bool is_path_traced(const KnobSettings& settings) {
    return settings.get<IndirectLight>(kTracedIndirect) == IndirectLight::paths;
}

TracerSettings make_tracer_settings(const KnobSettings& settings,
                                    const render::ShadingLights& lighting) {
    const ShadowKnobs::Method shadow = read_knobs(settings).shadow.method;
    return {.depth = static_cast<std::uint32_t>(settings.integer(kDepth)),
            .samples = settings.integer(kSamples),
            .rays = static_cast<std::uint32_t>(
                std::max(settings.integer(kLobeRays), is_path_traced(settings) ? 1 : 0)),
            .samples_lamps = settings.get<LampSampling>(kLamps) == LampSampling::sampled,
            .paths = is_path_traced(settings),
            .seed = static_cast<std::uint32_t>(settings.integer(kLobeSeed)),
            // A scene without lights needs neither a shadow map nor shadow rays.
            .shadow = shadow == ShadowKnobs::Method::none ? TracerSettings::Shadow::none
                      : shadow == ShadowKnobs::Method::map && lighting.shadow_map
                          ? TracerSettings::Shadow::map
                          : TracerSettings::Shadow::ray,
            .lighting = lighting,
            .exact_spheres = settings.get<SphereShape>(kSphere) == SphereShape::exact,
            .first_raster = rasters_first(settings),
            .doubles = settings.get<HitPrecision>(kHitPrecision) == HitPrecision::f64,
            .without = static_cast<std::uint32_t>(settings.integer(kTracerWithout))};
}

std::string describe_conflict(const KnobSettings& settings) {
    if (settings.integer(kLobeRays) * std::int64_t{settings.integer(kSamples)} > kMaxPathsPerPixel)
        return "rays=" + settings.format(kLobeRays) +
               " for each of samples=" + settings.format(kSamples) +
               ": wanted at most 65536 in all";
    if (is_path_traced(settings)) {
        if (rasters_first(settings))
            return "indirect=paths lights the first surface by rays; wanted first=ray, found "
                   "first=raster";
        if (settings.get<HitPrecision>(kHitPrecision) == HitPrecision::f64)
            return "indirect=paths computes points in single precision; wanted hit=f32, found "
                   "hit=f64";
    }
    if (!rasters_first(settings)) return {};
    if (settings.integer(kSamples) > 1)
        return "first=raster finds the surface in the middle of each pixel; wanted samples=1, found "
               "samples=" +
               settings.format(kSamples);
    if (settings.get<SphereShape>(kSphere) == SphereShape::exact)
        return "first=raster draws the triangles of balls; wanted sphere=mesh, found sphere=exact";
    return {};
}

/// Returns the scene passes: the view, if it is rasterised, and its shadow maps.
int count_scene_passes(int, int lights, const KnobSettings& settings) {
    if (!rasters_first(settings)) return count_shadow_passes(lights, settings);
    return 1 + (read_knobs(settings).shadow.method == ShadowKnobs::Method::none ? 0 : lights);
}

TechniqueOutputs add_traced_picture(graph::Graph& graph, const render::FrameInputs& inputs,
                                    const KnobSettings& settings,
                                    const render::ShadingLights& lighting) {
    const TracedPicture traced = add_picture_tracing(graph, inputs,
                                                     make_tracer_settings(settings, lighting));
    return {.hdr = traced.hdr, .has_hits = true, .counters = {traced.counters}};
}

MirrorShading make_traced_shading(graph::Graph&, const render::FrameInputs& inputs,
                                  const KnobSettings& settings, const ShadingInputs& around) {
    MirrorShading look;
    look.tracer = make_tracer_settings(settings, around.lighting);
    look.mirror.fragment = "reflect/traced.frag";
    // If the view is drawn for another technique, blended surfaces would be drawn over the
    // rasteriser's triangle numbers.
    if (!around.completes_view && inputs.scene.has_blended_surfaces())
        look.tracer->first_raster = false;
    if (look.tracer->first_raster) look.mirror.variant = "#first";
    return look;
}

constexpr std::string_view kDefaultRows[] = {
    "raytrace:depth=0",      "raytrace:depth=1",
    "raytrace:depth=2",      "raytrace:depth=3",
    "raytrace:depth=4",      "raytrace:depth=8",
    "raytrace:sphere=exact", "raytrace:depth=4,first=raster"};

constexpr Technique kTechnique{
    .name = "raytrace",
    .summary = "Traces Whitted rays in a compute shader; the reference for all other techniques.",
    .order = 100,
    .traits = {.traces_rays = true,
               .draws_whole_picture = true,
               .noise = TechniqueTraits::Noise::rays,
               .seed = kLobeSeed.name,
               .rays = kLobeRays.name,
               .samples = kSamples.name,
               .paths = {kTracedIndirect.name, kIndirectChoices[1]},
               .unshadowed = {kTracedShadow.name, kTracedShadowChoices[2]},
               .seed_part = TechniqueTraits::SeedPart::rays},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    .scene_passes = count_scene_passes,
    .look = make_traced_shading,
    .conflict = describe_conflict,
    .completes_view = rasters_first,
    .picture = add_traced_picture};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
