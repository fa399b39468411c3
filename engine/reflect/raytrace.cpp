// The reference: Whitted ray tracing in a compute shader over a hierarchy that needs no ray-tracing
// extension. One dispatch a sample, added up in the picture: a software driver ends all loops of an
// invocation after 65,535 iterations, and one sample of a deep path must stay below that.
#include "reflect/captures.hpp"

#include <cmath>
#include <random>

namespace catoptric::reflect {

namespace {

constexpr std::array<std::string_view, 3> kTracedShadowChoices{"ray", "map", "none"};
constexpr std::array<std::string_view, 2> kSphereChoices{"mesh", "exact"};
constexpr std::array<std::string_view, 2> kHitChoices{"f32", "f64"};
/// As shaders/lib/plain.glsl numbers them.
constexpr std::array<std::string_view, 6> kRules{"none",        "watertight", "box_slack",
                                                 "spawn_bound", "shadow_end", "stable_sphere"};
/// World units: what the report moves a ray's origin by.
constexpr double kReportOffset = 1e-3;
constexpr Knob kKnobs[] = {
    {.name = "depth",
     .help = "mirror bounces; a path that meets more ends black",
     .low = 0,
     .high = 64,
     .value = 8},
    {.name = "samples",
     .help = "rays a pixel: 1 = its centre, n*n = a regular grid, else stratified",
     .low = 1,
     .high = 65536,
     .value = 1},
    {.name = "shadow",
     .help = "shadow ray, shadow map or none",
     .high = 2,
     .choices = kTracedShadowChoices},
    {.name = "sphere",
     .help = "balls as triangles or as exact spheres",
     .high = 1,
     .choices = kSphereChoices},
    {.name = "hit",
     .help = "hit points in single or double precision",
     .high = 1,
     .choices = kHitChoices},
    {.name = "without",
     .help = "rule of robustness to leave out, only for measuring what it costs",
     .high = 5,
     .choices = kRules},
    kShadowMapEdge};

/// Work groups in one row of a dispatch: every device allows 65535.
constexpr std::uint32_t kMostAcross = 32768;

/// Where sample i of n lies in the pixel: its centre, the regular grid, or one point in each of n
/// cells of the smallest grid that holds them, jittered.
std::vector<vec2> sample_offsets(int count, std::uint64_t seed) {
    const int edge = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    const bool regular = edge * edge == count;
    std::mt19937_64 random(seed);
    std::vector<vec2> offsets;
    for (int i = 0; i < count; ++i) {
        const auto jitter = [&] {
            return regular ? 0.5f : static_cast<float>(random() >> 40) * 0x1p-24f;
        };
        const float y = static_cast<float>(i / edge) + jitter(),
                    x = static_cast<float>(i % edge) + jitter();
        offsets.push_back(vec2(x, y) / static_cast<float>(edge));
    }
    return offsets;
}

Outputs add(graph::Graph& graph, const render::FrameInputs& inputs, const Settings& settings) {
    using graph::Use;
    render::Lighting lighting = add_lighting(graph, inputs, settings);
    const uvec2 size = inputs.size;
    const graph::Image hdr = graph.image({inputs.prefix + "hdr", Format::rgba32f, size.x, size.y});
    const graph::Image hits = graph.image({inputs.prefix + "hits", Format::r32ui, size.x, size.y});
    const graph::Buffer counters = graph.buffer(
        {inputs.prefix + "counters", sizeof(shared::Counters)});
    graph.pass(inputs.prefix + "raytrace/reset")
        .writes(counters, Use::copy_to)
        .record([=](graph::Commands& commands) { commands.fill(counters, 0); });
    inputs.scene.want_tracing();
    graph::PassBuilder pass = graph.pass(inputs.prefix + "raytrace");
    if (lighting.shadow_map) pass.reads(*lighting.shadow_map, Use::sampled);
    const bool doubles = settings.choice("hit") == "f64";
    const gpu::ComputeState state{
        lighting.shadow_map
            ? (doubles ? "raytrace.comp#shadow_map_doubles" : "raytrace.comp#shadow_map")
            : (doubles ? "raytrace.comp#doubles" : "raytrace.comp"),
        {{"max_depth", static_cast<std::uint32_t>(settings.integer("depth"))},
         {"shadow", settings.choice("shadow") == "none" ? 0u
                    : lighting.shadow_map               ? 1u
                                                        : 2u},
         {"exact_spheres", static_cast<std::uint32_t>(settings.integer("sphere"))},
         {"own_spaces", inputs.scene.has_own_spaces() ? 1u : 0u},
         {"without", static_cast<std::uint32_t>(settings.integer("without"))},
         {"fixed_offset", inputs.scene.space().length(kReportOffset)}}};
    pass.writes(hdr, Use::storage_write)
        .writes(hits, Use::storage_write)
        .writes(counters, Use::storage)
        .record([=, &scene = inputs.scene, seed = inputs.seed,
                 samples = settings.integer("samples")](graph::Commands& commands) {
            scene.bind(commands);
            scene.bind_tracing(commands);
            if (lighting.shadow_map)
                commands.bind("shadow_map", *lighting.shadow_map, graph::Filter::compare);
            commands.bind("picture", hdr);
            commands.bind("hits", hits);
            commands.bind("counters", counters);
            commands.use(state);
            const std::uint32_t groups = (size.x + 7) / 8 * ((size.y + 7) / 8),
                                rows = (groups + kMostAcross - 1) / kMostAcross;
            const std::vector<vec2> offsets = sample_offsets(samples, seed);
            for (std::uint32_t i = 0; i < offsets.size(); ++i) {
                if (i > 0) commands.barrier();
                commands.push(
                    shared::Trace{offsets[i], i, static_cast<std::uint32_t>(samples), size});
                commands.dispatch((groups + rows - 1) / rows, rows);
            }
        });
    return {hdr, hits, counters, {}, {}};
}

constexpr std::string_view kCompared[] = {
    "raytrace:depth=0", "raytrace:depth=1", "raytrace:depth=2",     "raytrace:depth=3",
    "raytrace:depth=4", "raytrace:depth=8", "raytrace:sphere=exact"};

constexpr Technique kRaytrace{
    .name = "raytrace",
    .summary = "Whitted ray tracing in compute: what the others are measured against.",
    .order = 100,
    .knobs = kKnobs,
    .compared = kCompared,
    .scene_passes = [](int, int lights,
                       const Settings& settings) { return shadow_passes(lights, settings); },
    .add = add};
const Registered kRow{kRaytrace};

} // namespace

} // namespace catoptric::reflect
