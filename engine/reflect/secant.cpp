// Continues the one step of the seed report as a search, until the reflected ray meets a captured
// surface. With `steps=0` it equals `parallax`.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr Knob kSteps{.name = "steps",
                      .help = "number of secant steps after the first; 0 equals parallax",
                      .low = 0,
                      .high = 8,
                      .value = 2};
constexpr auto kKnobs = search_knobs(std::array{kSteps});

MirrorShading make_secant_shading(graph::Graph&, const render::FrameInputs&,
                                  const KnobSettings& settings, const ShadingInputs& around) {
    const int steps = settings.integer(kSteps);
    if (steps == 0) { // `parallax` has no knobs of a search
        MirrorShading look{make_capture_shader(around, "reflect/parallax.frag", KnobSettings({})),
                           {}};
        look.mirror.constants.emplace_back("refract_model", read_knobs(settings).refract);
        return look;
    }
    MirrorShading look{make_capture_shader(around, "reflect/secant.frag", settings), {}};
    look.mirror.constants.emplace_back("steps", static_cast<std::uint32_t>(steps));
    return look;
}

constexpr std::string_view kDefaultRows[] = {"secant:continue=0", "secant"};

constexpr Technique kTechnique{.name = "secant",
                               .summary = "Searches the captured distance for the point that the "
                                          "reflected ray meets, by secant steps.",
                               .order = 11,
                               .traits = {.captures = TechniqueTraits::Captures::shared},
                               .knobs = kKnobs,
                               .compared = kDefaultRows,
                               .scene_passes = count_capture_passes,
                               .capture = make_capture_options,
                               .in_captures = "reflect/parallax.frag",
                               .look = make_secant_shading};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
