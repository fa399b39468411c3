// Captures with two layers (Umenhoffer, Patow, Szirmay-Kalos, GPU Gems 3, chapter 17). The second
// layer holds surfaces that the nearest surface hides from the capture's centre.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr Knob kSteps{.name = "steps",
                      .help = "number of steps of equal angle along the reflected ray",
                      .low = 1,
                      .high = 256,
                      .value = 16};
constexpr auto kKnobs = search_knobs(std::array{kSteps});

render::CaptureOptions make_layered_options(const render::FrameInputs& inputs,
                                            const KnobSettings& settings) {
    render::CaptureOptions options = make_capture_options(inputs, settings);
    options.second_layer = true;
    return options;
}

MirrorShading make_layered_shading(graph::Graph&, const render::FrameInputs&,
                                   const KnobSettings& settings, const ShadingInputs& around) {
    MirrorShading look{make_capture_shader(around, "reflect/layered.frag", settings), {}};
    look.mirror.constants.emplace_back("steps",
                                       static_cast<std::uint32_t>(settings.integer(kSteps)));
    // Mirrors with this shader never look into captures without a second layer. For such captures,
    // the colour image is bound as a placeholder.
    const auto bind_layer_images = [&](const char* name, auto&& image) {
        std::vector<graph::ImageHandle> list;
        for (const render::CubeCaptureArray& cubes : around.captures->arrays)
            list.push_back(image(cubes));
        look.mirror.images.emplace_back(name, std::move(list));
    };
    bind_layer_images("distance1",
                      [](const auto& cubes) { return cubes.distance.value_or(cubes.colour); });
    bind_layer_images("distance2",
                      [](const auto& cubes) { return cubes.distance2.value_or(cubes.colour); });
    bind_layer_images("colour1", [](const auto& cubes) { return cubes.colour; });
    bind_layer_images("colour2",
                      [](const auto& cubes) { return cubes.colour2.value_or(cubes.colour); });
    return look;
}

constexpr std::string_view kDefaultRows[] = {"layered"};

constexpr Technique kTechnique{
    .name = "layered",
    .summary =
        "Marches through captures that also hold a second surface behind the first, and so finds "
        "hidden surfaces.",
    .order = 14,
    .traits = {.captures = TechniqueTraits::Captures::shared},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    // The number of scene passes R is 2 N + 2 for N mirrors.
    .scene_passes =
        [](int mirrors, int lights, const KnobSettings& settings) {
            return count_capture_passes(2 * mirrors, lights, settings);
        },
    .capture = make_layered_options,
    .in_captures = "reflect/parallax.frag",
    .look = make_layered_shading};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
