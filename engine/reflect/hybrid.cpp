// Searches the captures first, and traces only pixels whose search ends with `unknown`. A pass
// lists these pixels, and an indirect dispatch traces them from the camera with the code of the ray
// tracer. Each pixel is either searched or traced, so the weights 1 and 0 always add up to 1.
#include "reflect/pyramid.hpp"

namespace catoptric::reflect {

namespace {

constexpr std::array<std::string_view, 2> kForceChoices{"search", "unknown"};
enum class ForcedResult { search, unknown };
constexpr Knob kForce{.name = "force",
                      .help = "pixels to trace: those for which the search answers unknown, or all",
                      .high = 1,
                      .choices = kForceChoices};
constexpr auto kKnobs = [] {
    auto knobs = search_knobs(std::array{kForce});
    std::ranges::find(knobs, kRefract.name, &Knob::name)->value = shared::kRefractTraced;
    return knobs;
}();

/// Searches that end on glass or a blended surface are left to rays: the captured colour there
/// holds what the capture's centre sees behind the surface.
render::CaptureOptions make_hybrid_options(const render::FrameInputs& inputs,
                                           const KnobSettings& settings) {
    render::CaptureOptions options = make_capture_options(inputs, settings);
    options.blended_alpha = 0;
    options.surfaces = options.surfaces || inputs.scene.has_blended_surfaces() ||
                       inputs.scene.has_glass();
    return options;
}

/// Uses the search of `pyramid`, because it gives the fewest wrong hits. (`march` misses objects
/// that are thinner than its step.)
MirrorShading make_hybrid_shading(graph::Graph& graph, const render::FrameInputs& inputs,
                                  const KnobSettings& settings, const ShadingInputs& around) {
    MirrorShading look = make_pyramid_shading(graph, inputs, settings, around);
    const bool traces_all = settings.get<ForcedResult>(kForce) == ForcedResult::unknown;
    if (traces_all) look.mirror.constants.emplace_back("trusts_none", 1u);
    look.tracer.emplace();
    const bool is_rough = std::ranges::any_of(
        around.mirrors, [&](std::uint32_t mirror) { return inputs.scene.is_rough_mirror(mirror); });
    const SharedKnobs knobs = read_knobs(settings);
    if (is_rough && knobs.rough.lookup != RoughKnobs::Lookup::none)
        look.tracer->rays = knobs.rough.rays;
    // Reading the triangle numbers of the rasteriser costs more than tracing camera rays for the
    // few unknown pixels. Blended surfaces would also be drawn over the triangle numbers.
    if (traces_all && !inputs.scene.has_blended_surfaces() &&
        inputs.scene.device().has_primitive_id()) {
        look.mirror.variant = "#first";
        look.tracer->first_raster = true;
    }
    if (knobs.shadow.method == ShadowKnobs::Method::none)
        look.tracer->shadow = TracerSettings::Shadow::none;
    return look;
}

constexpr std::string_view kDefaultRows[] = {"hybrid"};

constexpr Technique kTechnique{
    .name = "hybrid",
    .summary = "Searches first and traces only the pixels for which the search found no answer.",
    .order = 15,
    .traits = {.captures = TechniqueTraits::Captures::shared,
               .traces_rays = true,
               .noise = TechniqueTraits::Noise::rays},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    .scene_passes = count_capture_passes,
    .capture = make_hybrid_options,
    .in_captures = "reflect/parallax.frag",
    .look = make_hybrid_shading};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
