// The technique `raytrace`, which is also the reference: Whitted ray tracing (reflect/tracer.hpp).
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr std::array<std::string_view, 2> kSphereChoices{"mesh", "exact"};
constexpr std::array<std::string_view, 2> kFirstChoices{"ray", "raster"};
constexpr std::array<std::string_view, 2> kHitChoices{"f32", "f64"};
/// Numbered as in shaders/lib/plain.glsl.
constexpr std::array<std::string_view, 6> kRules{"none",        "watertight", "box_slack",
                                                 "spawn_bound", "shadow_end", "stable_sphere"};
enum class Shape { mesh, exact };
enum class First { ray, raster };
enum class Precision { f32, f64 };
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
constexpr Knob kRays{
    .name = "rays",
    .help =
        "rays of each sample, whose directions are drawn from the lobes of rough surfaces (GGX, "
        "roughness above 0.04); 0: all surfaces reflect sharply",
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
constexpr std::int64_t kMostPaths = 65536; // of a pixel: samples times rays
constexpr Knob kSphere{.name = "sphere",
                       .help = "shape of balls: triangles or exact spheres",
                       .high = 1,
                       .choices = kSphereChoices};
constexpr Knob kFirst{
    .name = "first",
    .help = "how the surface that the camera sees is found: by a ray, or by the rasteriser",
    .high = 1,
    .choices = kFirstChoices};
constexpr Knob kHit{.name = "hit",
                    .help = "precision of hit points: single or double",
                    .high = 1,
                    .choices = kHitChoices};
constexpr Knob kWithout{.name = "without",
                        .help = "rule of robustness to leave out, to measure its cost",
                        .high = 5,
                        .choices = kRules};
constexpr Knob kKnobs[] = {kDepth, kSamples, kRays,    kLobeSeed,      kTracedShadow, kSphere,
                           kFirst, kHit,     kWithout, kShadowMapEdge, kCapture};

bool is_first_raster(const KnobSettings& settings) {
    return settings.as<First>(kFirst) == First::raster;
}

TracerSettings make_tracer(const KnobSettings& settings, const render::Lighting& lighting) {
    const SharedKnobs::Shadow shadow = shared_knobs(settings).shadow;
    return {.depth = static_cast<std::uint32_t>(settings.integer(kDepth)),
            .samples = settings.integer(kSamples),
            .rays = static_cast<std::uint32_t>(settings.integer(kRays)),
            .seed = static_cast<std::uint32_t>(settings.integer(kLobeSeed)),
            // A scene without lights has no shadow map, and no light needs a shadow test.
            .shadow = shadow == SharedKnobs::Shadow::none ? TracerSettings::TracedShadow::none
                      : shadow == SharedKnobs::Shadow::map && lighting.shadow_map
                          ? TracerSettings::TracedShadow::map
                          : TracerSettings::TracedShadow::ray,
            .lighting = lighting,
            .exact_spheres = settings.as<Shape>(kSphere) == Shape::exact,
            .first_raster = is_first_raster(settings),
            .doubles = settings.as<Precision>(kHit) == Precision::f64,
            .without = static_cast<std::uint32_t>(settings.integer(kWithout))};
}

std::string conflict(const KnobSettings& settings) {
    if (settings.integer(kRays) * std::int64_t{settings.integer(kSamples)} > kMostPaths)
        return "rays=" + settings.text(kRays) + " for each of samples=" + settings.text(kSamples) +
               ": wanted at most 65536 in all";
    if (!is_first_raster(settings)) return {};
    if (settings.integer(kSamples) > 1)
        return "first=raster finds the surface in the middle of each pixel; wanted samples=1, found "
               "samples=" +
               settings.text(kSamples);
    if (settings.integer(kRays) > 1)
        return "first=raster keeps the surface of each pixel for one ray; wanted rays=0 or rays=1, "
               "found rays=" +
               settings.text(kRays);
    if (settings.as<Shape>(kSphere) == Shape::exact)
        return "first=raster draws the triangles of balls; wanted sphere=mesh, found sphere=exact";
    return {};
}

/// Returns the scene passes: the view, if it is rasterised, and its shadow maps.
int scene_passes(int, int lights, const KnobSettings& settings) {
    if (!is_first_raster(settings)) return count_shadow_passes(lights, settings);
    return 1 + (shared_knobs(settings).shadow == SharedKnobs::Shadow::none ? 0 : lights);
}

TechniqueOutputs add_ray_traced_picture(graph::Graph& graph, const render::FrameInputs& inputs,
                                        const KnobSettings& settings,
                                        const render::Lighting& lighting) {
    const TracedPicture traced = add_picture_tracing(graph, inputs,
                                                     make_tracer(settings, lighting));
    return {traced.hdr, true, {traced.counters}, {}, {}};
}

MirrorShading make_ray_traced_shading(graph::Graph&, const render::FrameInputs&,
                                      const KnobSettings& settings, const MirrorInputs& around) {
    MirrorShading look;
    look.tracer = make_tracer(settings, around.lighting);
    look.mirror.fragment = "reflect/traced.frag";
    if (look.tracer->first_raster) look.mirror.variant = "#first";
    return look;
}

constexpr std::string_view kCompared[] = {"raytrace:depth=0",      "raytrace:depth=1",
                                          "raytrace:depth=2",      "raytrace:depth=3",
                                          "raytrace:depth=4",      "raytrace:depth=8",
                                          "raytrace:sphere=exact", "raytrace:depth=4,first=raster"};

constexpr Technique kRaytrace{
    .name = "raytrace",
    .summary = "Traces Whitted rays in a compute shader; the reference for all other techniques.",
    .order = 100,
    .knobs = kKnobs,
    .compared = kCompared,
    .scene_passes = scene_passes,
    .look = make_ray_traced_shading,
    .conflict = conflict,
    .completes_view = is_first_raster,
    .picture = add_ray_traced_picture};
const RegisteredTechnique kRow{kRaytrace};

} // namespace

} // namespace catoptric::reflect
