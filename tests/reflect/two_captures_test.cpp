// Tests of a technique with two captures a mirror, which this file and its shader alone add: one
// that other techniques may read, too, and one of its own in which mirrors are black.
#include "reflect/captures.hpp"
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

constexpr Knob kSecondShareKnob{
    .name = "share", .help = "share of the second capture", .value = .5, .is_real = true};
constexpr Knob kTwoCapturesKnobs[] = {kSecondShareKnob, reflect::kFace, reflect::kShadow,
                                      reflect::kShadowMap};

reflect::MirrorShading make_two_captures_shading(graph::Graph& graph,
                                                 const render::FrameInputs& inputs,
                                                 const KnobSettings& settings,
                                                 const reflect::ShadingInputs& around) {
    std::vector<render::CaptureOptions> options = around.captures->options;
    for (render::CaptureOptions& of_mirror : options) of_mirror.lighting = around.lighting;
    const render::MirrorCaptures second = render::declare_capture_images(graph, inputs, "second",
                                                                         std::move(options));
    render::add_captures(graph, inputs, second, render::use_same_shader(inputs.scene, {}));
    reflect::MirrorShading look{
        reflect::make_capture_shader(around, "tests/two_captures.frag", settings), {}};
    std::vector<graph::ImageHandle> colours;
    for (const render::CubeCaptureArray& cubes : second.arrays) colours.push_back(cubes.colour);
    look.mirror.images.emplace_back("second", std::move(colours));
    look.mirror.constants.emplace_back("share",
                                       static_cast<float>(settings.number(kSecondShareKnob)));
    return look;
}

constexpr reflect::Technique kTwoCapturesTechnique{
    .name = "two_captures",
    .summary = "For tests: the mean of two captures of each mirror.",
    .order = 1002,
    .traits = {.captures = TechniqueTraits::Captures::shared},
    .knobs = kTwoCapturesKnobs,
    .scene_passes =
        [](int mirrors, int lights, const KnobSettings& settings) {
            return reflect::count_capture_passes(2 * mirrors, lights, settings);
        },
    .capture = reflect::make_capture_options,
    .in_captures = "reflect/naive.frag",
    .reads_whole_cubes = true,
    .look = make_two_captures_shading};
const reflect::RegisteredTechnique kTwoCapturesTechniqueEntry{kTwoCapturesTechnique};

measure::Picture render_third_frame(const std::string& technique) {
    return test::render_technique(test::make_lit_room(2, 1), technique, {24, 24}, 3).hdr;
}

/// The first capture alone is that of `reuse`, the second alone that of `naive:bounces=1`, except
/// for the bilinear look-up of the second.
TEST(TwoCaptures, ShareMixesTheTwo) {
    const measure::Picture first = render_third_frame("two_captures:share=0,face=32"),
                           second = render_third_frame("two_captures:share=1,face=32"),
                           both = render_third_frame("two_captures:share=0.25,face=32");
    EXPECT_EQ(first.pixels, render_third_frame("reuse:face=32,rough=none").pixels);
    std::size_t different = 0;
    for (std::size_t i = 0; i < both.pixels.size(); ++i) {
        different += first.pixels[i] != second.pixels[i];
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(both.pixels[i][c], .75f * first.pixels[i][c] + .25f * second.pixels[i][c],
                        1e-5f);
    }
    EXPECT_GT(different, both.pixels.size() / 20) << "mirrors are black in the second";
}

} // namespace
