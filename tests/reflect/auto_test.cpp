// Tests of pictures drawn with `auto`, which chooses a plan for the scene.
#include "import/load.hpp"
#include "require/suggest.hpp"
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/pose.hpp"
#include "session/access.hpp"
#include "session/resolve_auto.hpp"
#include "session/seeded_camera.hpp"
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

constexpr uvec2 kAutoPictureSize{64, 64};

/// Returns the plan that suits the picture on the device of the tests.
std::string suggest_plan(const scene::Scene& rest) {
    const scene::Scene now = scene::scene_at(rest, 0);
    return require::suggest_plan(
               {.now = now, .camera = now.cameras.front(), .size = kAutoPictureSize},
               session::Access::unit_costs(test::get_test_engine()).costs)
        .plan;
}

/// If one technique suits all mirrors, the picture must equal that of a request for this technique.
TEST(Auto, PictureIsThatOfTheSuggestedPlanAndEachMirrorHasAReason) {
    for (const scene::Scene& scene : {test::make_mirror_hall(), scene::make_cornell()}) {
        const session::TechniqueResult part = test::render_technique(scene, "auto",
                                                                     kAutoPictureSize, 3),
                                       plan = test::render_technique(scene, suggest_plan(scene),
                                                                     kAutoPictureSize, 3);
        EXPECT_TRUE(test::have_equal_pixel_bytes(part.hdr, plan.hdr));
        ASSERT_EQ(part.plan.size(), scene::mirrors(scene).size());
        for (std::size_t i = 0; i < part.plan.size(); ++i) {
            EXPECT_EQ(part.plan[i].technique, plan.plan[i].technique);
            EXPECT_TRUE(part.plan[i].why.starts_with(part.plan[i].technique)) << part.plan[i].why;
            EXPECT_NE(part.plan[i].why.find(": "), std::string::npos) << part.plan[i].why;
        }
        EXPECT_EQ(part.label, "auto");
    }
}

/// Returns the milliseconds that the costs predict for the work that the frame does.
double predict_ms_of_counted_work(session::Session& session, const session::FrameSpec& spec) {
    const session::Frame frame = session::Access::render_frame(session, spec,
                                                               {.counts_work = true});
    const WorkCounts counts = sum_work(session::Access::pass_work(frame));
    require::WorkValues values;
    for (std::size_t i = 0; i < kWorkKindCount; ++i)
        values.values[i] = static_cast<double>(counts.values[i].value_or(0));
    return require::predict_ms(values, require::default_unit_costs());
}

/// What `auto` expects of a traced plan before it is drawn, and the work that the plan then does,
/// in drawn views of five scenes.
TEST(Auto, ExpectedTimesOfTracedPlansAreThoseOfTheirWork) {
    for (const char* name : {"cornell-mirrors", "courtyard", "flat", "gallery", "room"}) {
        const scene::Scene rest = scene::load(name), now = scene::scene_at(rest, 0);
        session::Session session(test::get_test_engine(), rest);
        for (const std::uint64_t seed : {1, 2, 3}) {
            session::FrameSpec spec{.camera = session::make_seeded_camera(rest, 0, seed),
                                    .size = uvec2(256)};
            const require::PlanSuggestion suggestion = require::suggest_plan(
                {.now = now, .camera = spec.camera, .size = spec.size});
            int traced = 0;
            for (const require::PlanCandidate& candidate : suggestion.candidates) {
                if (!candidate.name.starts_with("raytrace")) continue;
                spec.techniques = {candidate.name};
                const double counted = predict_ms_of_counted_work(session, spec);
                EXPECT_NEAR(candidate.ms, counted, .35 * counted)
                    << name << ", camera " << seed << ", " << candidate.name;
                ++traced;
            }
            EXPECT_EQ(traced, 2);
        }
    }
}

/// A plan belongs to a scene and a sequence. After an edit or a cut, `auto` must choose again.
TEST(Auto, PlanIsChosenAgainAfterAnEditOrACut) {
    scene::Scene hall = test::make_mirror_hall();
    session::Session session(test::get_test_engine(), hall);
    session::FrameSpec frame_spec{
        .techniques = {"auto"}, .camera = hall.cameras.front(), .size = kAutoPictureSize};
    EXPECT_EQ(session.frame(frame_spec).read().plan.size(), 3u);
    const std::size_t block = scene::mirrors(hall).at(1);
    // This edit makes the block a surface that is no mirror. The panel therefore gets another
    // mirror number.
    session.change(scene::paint(block, 0));
    const std::vector<PlanEntry> plan = session.frame(frame_spec).read().plan;
    ASSERT_EQ(plan.size(), 2u);
    session::FrameSpec away = frame_spec; // this view shows a corner of the panel and no ball
    away.camera.eye = {.9, .9, 1.2}, away.camera.target = {.9, 1, 1.9};
    away.camera.vertical_fov_degrees = 10;
    EXPECT_EQ(session.frame(away).read().plan[0].why, plan[0].why)
        << "the sequence goes on as it began";
    session.forget();
    const std::string chosen_again = session.frame(away).read().plan[0].why;
    EXPECT_NE(chosen_again.find("no pixel shows it"), std::string::npos) << chosen_again;
}

/// A frame beside the sequence has a plan of its own, and takes none from the sequence.
TEST(Auto, PlanStaysAfterAFrameBesideTheSequence) {
    const scene::Scene hall = test::make_mirror_hall();
    session::Session session(test::get_test_engine(), hall);
    session::FrameSpec frame_spec{
        .techniques = {"auto"}, .camera = hall.cameras.front(), .size = kAutoPictureSize};
    const std::string why = session.frame(frame_spec).read().plan[0].why;
    session::FrameSpec aside = frame_spec;
    aside.techniques = {"reuse:face=16"}, aside.keeps_history = true;
    EXPECT_EQ(session.frame(aside).read().plan[0].technique, "reuse");
    // This view does not show the ball.
    frame_spec.camera.eye = {.9, .9, 1.2}, frame_spec.camera.target = {.9, 1, 1.9};
    frame_spec.camera.vertical_fov_degrees = 10;
    EXPECT_EQ(session.frame(frame_spec).read().plan[0].why, why);
}

/// A comparison suspends the sequence of a row and resumes it later. The plan of the first frame
/// must stay, so that `auto` does not choose again in each round.
TEST(Auto, PlanStaysWhenItsSequenceIsResumed) {
    const scene::Scene hall = test::make_mirror_hall();
    session::Session session(test::get_test_engine(), hall);
    session::FrameSpec frame_spec{
        .techniques = {"auto"}, .camera = hall.cameras.front(), .size = kAutoPictureSize};
    const std::string why = session.frame(frame_spec).read().plan[0].why;
    session::FrameSequence sequence = session::Access::suspend(session);
    session::FrameSpec other = frame_spec;
    other.techniques = {"reuse:face=16"};
    session.frame(other);
    session::Access::suspend(session);
    session::Access::resume(session, std::move(sequence));
    // This view does not show the ball.
    frame_spec.camera.eye = {.9, .9, 1.2}, frame_spec.camera.target = {.9, 1, 1.9};
    frame_spec.camera.vertical_fov_degrees = 10;
    EXPECT_EQ(session.frame(frame_spec).read().plan[0].why, why);
}

} // namespace
