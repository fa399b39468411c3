// Tests of frames that know their past, by a technique in time: one ray of each pixel's lobe a
// frame, and the mean of the frames that showed the same surface. It is added by this file and its
// shader alone, and has two tracers in a frame.
#include "reflect/captures.hpp"
#include "render/views.hpp"
#include "scene/pose.hpp"
#include "session/access.hpp"
#include "support/rendering.hpp"

#include <algorithm>
#include <random>

namespace {

using namespace catoptric;

/// An eye as shaders/tests/temporal.comp reads it.
struct TemporalEye {
    vec3 place, right, down, forward;
};

TemporalEye make_temporal_eye(const render::FrameInputs& inputs, const scene::Camera& camera) {
    const shared::View view = render::make_camera_view(camera, inputs.scene.scene_units(),
                                                       inputs.size, 1);
    return {view.eye, view.right, view.down, view.forward};
}

/// What the frame declared last knew.
render::FrameFacts known_facts; // NOLINT: the table of techniques takes plain functions

reflect::TechniqueOutputs add_temporal_picture(graph::Graph& graph,
                                               const render::FrameInputs& inputs,
                                               const KnobSettings&,
                                               const render::ShadingLights& lighting) {
    using graph::ResourceUse;
    known_facts = inputs.facts;
    const reflect::TracedPicture traced = reflect::add_picture_tracing(
        graph, inputs,
        {.depth = 4,
         .rays = 1,
         .seed = static_cast<std::uint32_t>(inputs.facts.number),
         .lighting = lighting});
    const reflect::FirstSurfaceImages first = reflect::add_first_surface(graph, inputs);
    const graph::ImageHandle mean = graph.add_image(
        {inputs.prefix + "mean", TexelFormat::rgba32f, inputs.size.x, inputs.size.y});
    const graph::ImageHandle history = graph.previous(mean);
    const struct {
        TemporalEye now, before;
    } eyes{make_temporal_eye(inputs, inputs.facts.now.camera),
           make_temporal_eye(inputs, inputs.facts.before ? inputs.facts.before->camera
                                                         : inputs.facts.now.camera)};
    graph.add_pass(inputs.prefix + "mean")
        .reads(traced.hdr, ResourceUse::sampled)
        .reads(first.normals_and_distances, ResourceUse::sampled)
        .reads(history, ResourceUse::sampled)
        .writes(mean, ResourceUse::storage_write)
        .record([=, size = inputs.size](graph::PassCommands& commands) {
            commands.bind("traced", traced.hdr);
            commands.bind("normals_and_distances", first.normals_and_distances);
            commands.bind("history", history);
            commands.bind("mean", mean);
            commands.bind_pipeline(gpu::ComputeState{"tests/temporal.comp", {}});
            commands.push_constants(eyes);
            commands.dispatch((size.x + 7) / 8, (size.y + 7) / 8);
        });
    return {.hdr = mean, .counters = {traced.counters, first.counters}};
}

constexpr reflect::Technique kTemporalTechnique{
    .name = "temporal",
    .summary = "For tests: one ray a frame, and the mean of the frames that showed a surface.",
    .order = 1001,
    .traits = {.traces_rays = true,
               .draws_whole_picture = true,
               .noise = TechniqueTraits::Noise::history},
    .scene_passes = [](int, int, const KnobSettings&) { return 0; },
    .look = [](graph::Graph&, const render::FrameInputs&, const KnobSettings&,
               const reflect::ShadingInputs&) { return reflect::MirrorShading{}; },
    .picture = add_temporal_picture};
const reflect::RegisteredTechnique kTemporalTechniqueEntry{kTemporalTechnique};

scene::Scene make_rough_room() {
    scene::Scene scene = test::replace_balls_by_coarse_balls(test::make_lit_room(2, 1));
    test::make_mirrors_rough(scene, .4f);
    return scene;
}

session::FrameSpec make_temporal_spec(const scene::Scene& scene) {
    return test::make_test_request(scene, {"temporal"}, {24, 20});
}

double rmse_of_pictures(const measure::Picture& a, const measure::Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const dvec3 difference = dvec3(a.pixels[i]) - dvec3(b.pixels[i]);
        sum += dot(difference, difference) / 3;
    }
    return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

measure::Picture render_lobe_reference(const scene::Scene& scene, const session::FrameSpec& spec) {
    session::FrameSpec traced = spec;
    traced.techniques = {"raytrace:depth=4,rays=256"};
    session::Session session(test::get_test_engine(), scene);
    return session.frame(traced).hdr();
}

/// With a still camera, frame n is the mean of n pictures of `raytrace` with the seeds 1 to n.
TEST(Temporal, FrameOfAStillCameraIsTheMeanOfIndependentPictures) {
    const scene::Scene scene = make_rough_room();
    const session::FrameSpec spec = make_temporal_spec(scene);
    session::Session session(test::get_test_engine(), scene), other(test::get_test_engine(), scene);
    measure::Picture mean, first;
    for (int seed = 1; seed <= 8; ++seed) {
        session::FrameSpec traced = spec;
        traced.techniques = {"raytrace:depth=4,rays=1,seed=" + std::to_string(seed)};
        const measure::Picture one = other.frame(traced).hdr(), shown = session.frame(spec).hdr();
        if (seed == 1) mean = first = one;
        for (std::size_t i = 0; i < mean.pixels.size(); ++i)
            mean.pixels[i] += (one.pixels[i] - mean.pixels[i]) / static_cast<float>(seed);
        EXPECT_LT(rmse_of_pictures(shown, mean), 1e-6) << "frame " << seed;
    }
    EXPECT_GT(rmse_of_pictures(first, mean), 1e-3) << "pictures with noise";
    session.forget();
    EXPECT_EQ(session.frame(spec).hdr().pixels, first.pixels) << "the first frame after a cut";
}

/// With a moving camera, history is read where its surface was. A room without noise then changes
/// only by the rounding of places to pixels.
TEST(Temporal, HistoryFollowsSurfacesOfAMovingCamera) {
    const scene::Scene scene = test::make_lit_room(0, 1);
    session::FrameSpec spec = make_temporal_spec(scene);
    spec.size = {48, 40};
    session::Session session(test::get_test_engine(), scene);
    session.frame(spec);
    const measure::Picture before = render_lobe_reference(scene, spec);
    measure::Picture shown;
    for (int frame = 0; frame < 4; ++frame) {
        spec.camera.eye.x += .25, spec.camera.target.x += .25;
        shown = session.frame(spec).hdr();
    }
    const measure::Picture reference = render_lobe_reference(scene, spec);
    EXPECT_LT(rmse_of_pictures(shown, reference), .3 * rmse_of_pictures(before, reference));
}

/// Draws sequences inside one another, and the same sequences apart.
TEST(Temporal, SequencesInsideOneAnotherEqualSequencesApart) {
    const scene::Scene scene = make_rough_room();
    const session::FrameSpec spec = make_temporal_spec(scene);
    std::mt19937 random(70);
    session::Session together(test::get_test_engine(), scene);
    std::vector<std::unique_ptr<session::Session>> apart;
    std::vector<std::optional<session::FrameSequence>> sequences(3);
    for (std::size_t i = 0; i < sequences.size(); ++i)
        apart.push_back(std::make_unique<session::Session>(test::get_test_engine(), scene));
    for (int step = 0; step < 12; ++step) {
        const std::size_t i = random() % sequences.size();
        if (sequences[i])
            session::Access::resume(together, std::move(*sequences[i]));
        else
            together.forget();
        for (unsigned frame = 0; frame <= random() % 2; ++frame) {
            session::FrameSpec moved = spec;
            moved.camera.eye.y += .1 * static_cast<double>(random() % 3);
            EXPECT_EQ(together.frame(moved).hdr().pixels, apart[i]->frame(moved).hdr().pixels)
                << "sequence " << i << ", step " << step;
        }
        sequences[i] = session::Access::suspend(together);
    }
}

/// Two sequences of a scene with a motion and an edit, drawn inside one another.
TEST(Temporal, FramesKnowWhereObjectsWereInTheLastFrameOfTheirSequence) {
    scene::Scene scene = make_rough_room();
    scene.objects[0].motion = scene::HarmonicMotion{.amplitude = {.05, 0, 0}, .period = 3};
    session::FrameSpec spec = make_temporal_spec(scene);
    session::Session session(test::get_test_engine(), scene);
    const auto object_transforms = [&](double time) {
        std::vector<dmat4> transforms;
        for (const scene::Object& object : scene::scene_at(session.scene(), time).objects)
            transforms.push_back(object.world_from_object);
        return transforms;
    };
    std::optional<double> drawn;
    std::vector<dmat4> before;
    const auto expect_facts = [&](double time) {
        spec.time = time;
        session.frame(spec);
        EXPECT_EQ(*known_facts.transforms, object_transforms(time));
        EXPECT_EQ(known_facts.before.has_value(), drawn.has_value());
        EXPECT_EQ(known_facts.transforms_before != nullptr, drawn.has_value());
        if (drawn) {
            EXPECT_EQ(*known_facts.transforms_before, before);
        }
        drawn = time, before = object_transforms(time);
    };
    expect_facts(0), expect_facts(.3);
    EXPECT_NE(*known_facts.transforms, *known_facts.transforms_before);
    session::FrameSequence other = session::Access::suspend(session);
    const auto [time_aside, before_aside] = std::pair(drawn, before);
    drawn.reset();
    expect_facts(1), expect_facts(1.1);
    session::Access::suspend(session);
    session::Access::resume(session, std::move(other));
    drawn = time_aside, before = before_aside;
    expect_facts(.4);
    dmat4 moved = scene.objects[1].world_from_object;
    moved[3].x += .01;
    session.change(scene::move(1, moved));
    expect_facts(.4);
    EXPECT_NE((*known_facts.transforms)[1], (*known_facts.transforms_before)[1]) << "an edit";
    expect_facts(.4);
    EXPECT_EQ(*known_facts.transforms, *known_facts.transforms_before) << "nothing moved";
    session.forget();
    drawn.reset();
    expect_facts(.4);
}

/// A technique beside it in the frame has tracers of its own.
TEST(Temporal, PicturesTogetherEqualPicturesApart) {
    const scene::Scene scene = make_rough_room();
    session::FrameSpec spec = make_temporal_spec(scene);
    session::Session alone(test::get_test_engine(), scene);
    session::Session together(test::get_test_engine(), scene);
    session::FrameSpec both = spec;
    both.techniques = {"raytrace:rays=2", "temporal", "hybrid:face=32"};
    for (int frame = 0; frame < 3; ++frame) {
        const session::Frame drawn = together.frame(both);
        EXPECT_EQ(alone.frame(spec).hdr().pixels, drawn.hdr(1).pixels) << "frame " << frame;
        EXPECT_TRUE(drawn.read(1).remembers);
        EXPECT_FALSE(drawn.read(0).remembers);
    }
}

} // namespace
