// The search that the report's one step begins: it goes on until the reflected ray meets what was
// captured. steps=0 is `parallax`.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr auto kKnobs = search_knobs(
    std::array{Knob{.name = "steps",
                    .help = "secant steps after the first; 0 equals parallax",
                    .low = 0,
                    .high = 8,
                    .value = 2}});

Outputs add(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
    const Feedback captured = add_feedback(graph, inputs, settings, "reflect/parallax.frag");
    if (settings.integer("steps") == 0 && captured.cubes) // parallax has no other knobs
        return add_view_of(graph, inputs, captured,
                           look_into("reflect/parallax.frag", *captured.cubes, captured.options));
    render::MirrorLook look = view_look(captured, settings, "reflect/secant.frag");
    look.constants.emplace_back("steps", static_cast<std::uint32_t>(settings.integer("steps")));
    return add_view_of(graph, inputs, captured, look);
}

constexpr std::string_view kCompared[] = {"secant:continue=0", "secant"};

constexpr Technique kSecant{.name = "secant",
                            .summary = "Searches the captured distance for the point that the "
                                       "reflected ray meets, by secant steps.",
                            .order = 11,
                            .knobs = kKnobs,
                            .compared = kCompared,
                            .scene_passes = feedback_passes,
                            .add = add};
const Registered kRow{kSecant};

} // namespace

} // namespace catoptric::reflect
