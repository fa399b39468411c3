// Part one of the seed report. Every inter-reflection is rendered again in each frame, starting
// from black. Bounce k looks into the cubes of bounce k-1, so with i bounces R = N i + 2. The
// report swaps two cube images by hand. Here the render graph finds this from lifetimes: bounce k+1
// reuses the memory of bounce k-1.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr Knob kBounces{.name = "bounces",
                        .help = "mirror bounces rendered in each frame; 0 leaves mirrors black",
                        .low = 0,
                        .high = 8,
                        .value = 3};
constexpr Knob kKnobs[] = {kBounces,          kFace,   kColour,    kRefract,    kIndirect,  kProbes,
                           kAmbientOcclusion, kShadow, kShadowMap, kSoftShadow, kOthersFace};

/// Builds the shading of mirrors bounce by bounce. The last bounce captures only mirrors with the
/// technique `naive`, because only these look into its captures.
MirrorShading make_naive_shading(graph::Graph& graph, const render::FrameInputs& inputs,
                                 const KnobSettings& settings, const ShadingInputs& around) {
    render::CaptureOptions options = make_capture_options(inputs, settings);
    options.lighting = around.lighting;
    render::MirrorShader look; // without a fragment shader, the mirror is black
    const int bounces = settings.integer(kBounces);
    for (int bounce = 1; bounce <= bounces; ++bounce) {
        render::CaptureOptions of_others = options;
        if (bounce == bounces) of_others.face = 0;
        std::vector of_mirrors(inputs.scene.mirror_count(), of_others);
        for (const std::uint32_t mirror : around.mirrors) of_mirrors[mirror] = options;
        const auto captures = std::make_shared<const render::MirrorCaptures>(
            render::declare_capture_images(graph, inputs, "bounce" + std::to_string(bounce),
                                           std::move(of_mirrors)));
        remove_view_images(look);
        render::add_captures(graph, inputs, *captures, render::use_same_shader(inputs.scene, look));
        look = make_capture_shader({captures, around.lighting, around.mirrors},
                                   "reflect/naive.frag", settings);
    }
    return {std::move(look), {}};
}

constexpr std::string_view kDefaultRows[] = {
    "naive:bounces=0", "naive:bounces=1", "naive:bounces=2", "naive:bounces=3", "naive:bounces=4"};

constexpr Technique kTechnique{
    .name = "naive",
    .summary =
        "Renders every bounce again in each frame, from black; looks up the reflected direction "
        "without correction.",
    .order = 1,
    .traits = {.captures = TechniqueTraits::Captures::own,
               .seed_part = TechniqueTraits::SeedPart::bounces},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    .scene_passes =
        [](int mirrors, int lights, const KnobSettings& settings) {
            return mirrors * settings.integer(kBounces) + count_shadow_passes(lights, settings) + 1;
        },
    .look = make_naive_shading};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
