// Captures of two layers (Umenhoffer, Patow, Szirmay-Kalos, GPU Gems 3, chapter 17): what a ray
// meets behind something that hides it from the capture's centre is in the second.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr auto kKnobs = search_knobs(
    std::array{Knob{.name = "steps",
                    .help = "steps of equal angle along the reflected ray",
                    .low = 1,
                    .high = 256,
                    .value = 16}});

Outputs add(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
    const Feedback captured = add_feedback(graph, inputs, settings, "reflect/parallax.frag", true);
    render::MirrorLook look = view_look(captured, settings, "reflect/layered.frag");
    look.constants.emplace_back("steps", static_cast<std::uint32_t>(settings.integer("steps")));
    if (const auto& cubes = captured.cubes)
        look.images = {{"distance1", *cubes->distance},
                       {"distance2", *cubes->distance2},
                       {"colour1", cubes->colour},
                       {"colour2", *cubes->colour2}};
    return add_view_of(graph, inputs, captured, look);
}

constexpr std::string_view kCompared[] = {"layered"};

constexpr Technique kLayered{.name = "layered",
                             .summary = "Marches through captures that also hold the next surface "
                                        "behind the nearest, and tells silhouettes from surfaces.",
                             .order = 14,
                             .knobs = kKnobs,
                             .compared = kCompared,
                             // R = 2 N + 2
                             .scene_passes =
                                 [](int mirrors, int lights, const Settings& settings) {
                                     return feedback_passes(2 * mirrors, lights, settings);
                                 },
                             .add = add};
const Registered kRow{kLayered};

} // namespace

} // namespace catoptric::reflect
