// Part one of the report: every inter-reflection is rendered again in each frame, from black.
// Bounce k looks into the cubes of bounce k-1, so with i bounces R = N i + 2. The two cube images
// that the report swaps by hand fall out of lifetimes: bounce k+1's cubes lie where bounce k-1's
// were.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr Knob kKnobs[] = {{.name = "bounces",
                            .help = "inter-reflections rendered each frame; 0 leaves mirrors black",
                            .low = 0,
                            .high = 8,
                            .value = 3},
                           kFace,
                           kColour,
                           kShadow,
                           kShadowMapEdge};

Outputs add(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
    const render::Lighting lighting = add_lighting(graph, inputs, settings);
    render::CaptureOptions options = capture_options(inputs, settings, lighting);
    const int bounces = inputs.scene.mirror_count() ? settings.integer("bounces") : 0;
    for (int bounce = 1; bounce <= bounces; ++bounce) {
        options.name = "bounce" + std::to_string(bounce);
        const render::Cubes cubes = render::declare_cubes(graph, inputs, options);
        render::add_captures(graph, inputs, options, cubes);
        options.look = look_into("reflect/naive.frag", cubes, options);
    }
    const std::optional<render::Cubes>& last = options.look.cubes;
    const render::View view = render::add_view(graph, inputs, lighting, options.look);
    return {view.hdr, {}, {}, view.lookup, last};
}

constexpr std::string_view kCompared[] = {"naive:bounces=0", "naive:bounces=1", "naive:bounces=2",
                                          "naive:bounces=3", "naive:bounces=4"};

constexpr Technique kNaive{.name = "naive",
                           .summary = "Renders every bounce again in each frame, from black; looks "
                                      "up the reflected direction as it is.",
                           .order = 1,
                           .knobs = kKnobs,
                           .compared = kCompared,
                           .scene_passes =
                               [](int mirrors, int lights, const Settings& settings) {
                                   return mirrors * settings.integer("bounces") +
                                          shadow_passes(lights, settings) + 1;
                               },
                           .add = add};
const Registered kRow{kNaive};

} // namespace

} // namespace catoptric::reflect
