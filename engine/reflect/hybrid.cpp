// Search first, trace only what the search cannot know. Pixels whose search ends UNKNOWN go into a
// list as long as need be; an indirect dispatch traces just those from the camera with the ray
// tracer's own function. A pixel is either found or traced: weights 1 and 0, so they always add up
// to 1.
#include "reflect/pyramid.hpp"

namespace catoptric::reflect {

namespace {

/// What the view searches with: of the searches, the one with the fewest wrong answers that call
/// themselves right (`march` misses what is thinner than its step).
constexpr const char* kSearch = "reflect/pyramid.frag";

constexpr std::array<std::string_view, 2> kForceChoices{"search", "unknown"};
constexpr auto kKnobs = [] {
    auto knobs = search_knobs(std::array{
        Knob{.name = "force",
             .help = "trace what the search does not know, or take every answer as unknown",
             .high = 1,
             .choices = kForceChoices}});
    std::ranges::find(knobs, "captures", &Knob::name)->value = 1; // before anything is traced
    return knobs;
}();

/// Pixels to trace, and how many work groups they are.
struct List {
    graph::Buffer pixels, arguments, counters;
};

List add_list(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings,
              graph::Image lookup) {
    using graph::Use;
    const uvec2 size = inputs.size;
    List list;
    list.pixels = graph.buffer({inputs.prefix + "list", sizeof(std::uint32_t) * size.x * size.y});
    list.arguments = graph.buffer({inputs.prefix + "list/arguments", 3 * sizeof(std::uint32_t)});
    list.counters = graph.buffer({inputs.prefix + "counters", sizeof(shared::Counters)});
    graph.pass(inputs.prefix + "list/reset")
        .writes(list.counters, Use::copy_to)
        .writes(list.arguments, Use::copy_to)
        .record([=](graph::Commands& commands) {
            commands.fill(list.counters, 0);
            commands.fill(list.arguments, 0);
        });
    graph.pass(inputs.prefix + "list")
        .reads(lookup, Use::storage_read)
        .writes(list.counters, Use::storage)
        .writes(list.arguments, Use::storage)
        .writes(list.pixels, Use::storage_write)
        .record([=, every = settings.choice("force") == "unknown" ? 1u
                                                                  : 0u](graph::Commands& commands) {
            commands.bind("lookup", lookup);
            commands.bind("counters", list.counters);
            commands.bind("arguments", list.arguments);
            commands.bind("List", list.pixels);
            commands.use(gpu::ComputeState{"reflect/hybrid_list.comp", {{"every_mirror", every}}});
            commands.push(size);
            commands.dispatch((size.x + 7) / 8, (size.y + 7) / 8);
        });
    return list;
}

void add_trace(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings,
               const List& list, graph::Image hdr) {
    using graph::Use;
    const std::uint32_t shadow_rays = settings.choice("shadow") == "none" ? 0 : 2;
    inputs.scene.want_tracing();
    graph.pass(inputs.prefix + "trace")
        .reads(list.arguments, Use::indirect)
        .reads(list.pixels, Use::storage_read)
        .writes(list.counters, Use::storage)
        .writes(hdr, Use::storage)
        .record([=, &scene = inputs.scene, size = inputs.size](graph::Commands& commands) {
            scene.bind(commands);
            scene.bind_tracing(commands);
            commands.bind("picture", hdr);
            commands.bind("counters", list.counters);
            commands.bind("List", list.pixels);
            commands.use(gpu::ComputeState{"reflect/hybrid_trace.comp",
                                           {{"max_depth", render::kReferenceDepth},
                                            {"shadow", shadow_rays},
                                            {"own_spaces", scene.has_own_spaces() ? 1u : 0u}}});
            commands.push(size);
            commands.dispatch_indirect(list.arguments);
        });
}

Outputs add(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
    const Feedback captured = add_feedback(graph, inputs, settings, "reflect/parallax.frag");
    render::MirrorLook look = view_look(captured, settings, kSearch);
    if (!captured.cubes) return add_view_of(graph, inputs, captured, look);
    look.images.emplace_back("bounds", add_pyramid(graph, inputs, captured));
    const render::View view = render::add_view(graph, inputs, captured.lighting, look, true);
    const List list = add_list(graph, inputs, settings, *view.lookup);
    add_trace(graph, inputs, settings, list, view.hdr);
    return {view.hdr,
            {},
            list.counters,
            inputs.with_lookup ? view.lookup : std::nullopt,
            captured.cubes};
}

constexpr std::string_view kCompared[] = {"hybrid"};

constexpr Technique kHybrid{
    .name = "hybrid",
    .summary = "Searches first and traces only the pixels for which the search found no answer.",
    .order = 15,
    .knobs = kKnobs,
    .compared = kCompared,
    .scene_passes = feedback_passes,
    .add = add};
const Registered kRow{kHybrid};

} // namespace

} // namespace catoptric::reflect
