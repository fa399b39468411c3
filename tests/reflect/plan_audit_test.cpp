// Tests of the audit of running frames. Its sampled pixels must be those of the running picture,
// its errors must equal those of a comparison, and it must notice a wrong technique and outdated
// reflections.
#include "study/plan_audit.hpp"

#include "compare.hpp"
#include "core/file.hpp"
#include "measure/audit_schedule.hpp"
#include "scene/hash.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

namespace {

using namespace catoptric;

constexpr uvec2 kAuditedSize{64, 64};
constexpr const char* kRunningPlan = "parallax:face=64,shadow_map=64";
constexpr double kAuditedLimit = .08; ///< limit of FLIP; the audited plan has a FLIP of .04 to .06

scene::Scene make_audited_room() {
    return test::replace_balls_by_coarse_balls(test::make_lit_room(2, 1));
}

session::FrameSpec make_audited_spec(const scene::Scene& scene) {
    session::FrameSpec spec = test::make_test_request(scene, {kRunningPlan}, kAuditedSize);
    spec.model = session::RenderedWork::required;
    return spec;
}

/// Returns the camera of frame k. The cameras of successive frames move on a small circle.
scene::Camera camera_of(const scene::Camera& first, int k) {
    scene::Camera camera = first;
    camera.eye += dvec3(.3 * std::sin(.11 * k), .2 * std::sin(.07 * k),
                        .1 + .1 * std::cos(.09 * k));
    return camera;
}

study::PlanAuditRequest make_audit_request(std::vector<std::string> plans = {kRunningPlan}) {
    study::PlanAuditRequest request;
    request.plans = std::move(plans);
    request.max_error = kAuditedLimit;
    request.pace = {.every = 4, .most_time = std::numeric_limits<double>::infinity()};
    return request;
}

/// Returns a request that audits every frame that is counted.
study::PlanAuditRequest make_request_of_every_frame() {
    study::PlanAuditRequest request = make_audit_request();
    request.pace.every = 1;
    return request;
}

TEST(PlanAudit, SampledViewKeepsPixelCentresForAnySize) {
    const scene::Camera camera{.vertical_fov_degrees = 50};
    const scene::Camera flat{.orthographic_height = 3};
    for (const uvec2 size : {uvec2(64, 64), uvec2(1920, 1080), uvec2(512, 512), uvec2(1367, 771),
                             uvec2(4000, 10), uvec2(1, 1), uvec2(3840, 2160)}) {
        const study::SampledView view = study::choose_sampled_view(camera, size, 40'000);
        SCOPED_TRACE(testing::Message() << size.x << "x" << size.y << " step " << view.step);
        EXPECT_EQ(view.step % 2, 1u);
        ASSERT_GE(std::min(view.size.x, view.size.y), 1u);
        EXPECT_LE(view.size.x * view.size.y, 40'000u);
        const uvec2 last = view.first + view.step * (view.size - uvec2(1));
        // The sampled pixels leave margins of equal width at both ends of a row, narrower than two
        // sampling steps.
        EXPECT_EQ(view.first, size - uvec2(1) - last);
        EXPECT_LT(view.first.x, 2 * view.step);
        EXPECT_LT(view.first.y, 2 * view.step);
        // The direction through the first sample must be the same in the sampled view and in the
        // whole picture.
        const auto slope = [](double degrees, double y, double height) {
            return std::tan(glm::radians(degrees) / 2) * (1 - 2 * (y + .5) / height);
        };
        EXPECT_NEAR(slope(view.camera.vertical_fov_degrees, 0, view.size.y),
                    slope(camera.vertical_fov_degrees, view.first.y, size.y), 1e-12);
        EXPECT_NEAR(study::choose_sampled_view(flat, size, 40'000).camera.orthographic_height *
                        (1 - 1. / view.size.y),
                    flat.orthographic_height * (1 - (2. * view.first.y + 1) / size.y), 1e-12);
    }
    EXPECT_EQ(study::choose_sampled_view(camera, {200, 200}, 40'000).step, 1u);
    EXPECT_EQ(study::choose_sampled_view(camera, {201, 200}, 40'000).step, 3u);
    EXPECT_EQ(study::choose_sampled_view(camera, {200, 200}, 40'000).camera, camera);
}

/// The ray-traced picture of the sampled view must equal the same pixels of the whole ray-traced
/// picture, except in pixels where the last bit of a ray's direction decides which surface is hit.
TEST(PlanAudit, TracedSamplesEqualThePixelsOfTheWholePicture) {
    for (const char* name : {"room", "courtyard"}) {
        SCOPED_TRACE(name);
        const scene::Scene scene = scene::load(name);
        session::Session session(test::get_test_engine(), scene);
        session::FrameSpec spec = test::make_test_request(scene, {"raytrace:depth=16"}, {97, 66});
        const measure::Picture whole = session.frame(spec).hdr();
        const study::SampledView view = study::choose_sampled_view(spec.camera, spec.size, 800);
        ASSERT_EQ(view.step, 3u);
        spec.camera = view.camera, spec.size = view.size;
        const measure::Picture samples = study::sample_picture(whole, view),
                               traced = session.frame(spec).hdr();
        std::size_t other = 0;
        for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
            const vec3 difference = glm::abs(samples.pixels[i] - traced.pixels[i]);
            other += std::max({difference.x, difference.y, difference.z}) > .01f;
        }
        EXPECT_LE(other, samples.pixels.size() / 100);
    }
}

TEST(PlanAudit, ErrorIsThatOfAComparison) {
    const scene::Scene scene = make_audited_room();
    study::CompareRequest compared;
    static_cast<session::FrameSpec&>(compared.base) = make_audited_spec(scene);
    compared.base.scene = scene;
    compared.base.warmup = 8, compared.base.frames = 6;
    const measure::Row row = study::compare(test::get_test_engine(), compared).rows.front();

    session::Session session(test::get_test_engine(), scene);
    for (const study::ErrorQuantity quantity :
         {study::ErrorQuantity::flip, study::ErrorQuantity::rmse}) {
        study::PlanAuditRequest request = make_request_of_every_frame();
        request.quantity = quantity;
        study::RunningPlanAudit audit(request);
        session::FrameSpec spec = make_audited_spec(scene);
        std::optional<double> error;
        for (int k = 0; k < 18; ++k) {
            // The scene stands still and only the frame's time changes, so that each frame counts
            // as new.
            spec.time = k;
            const session::Frame frame = session.frame(spec);
            if (const auto found = audit.watch_frame(session, frame, spec, k).error) error = found;
        }
        ASSERT_TRUE(error);
        EXPECT_NEAR(*error,
                    quantity == study::ErrorQuantity::flip ? row.error.flip : row.error.rmse, 1e-6);
    }
}

/// A reference without rays from lobes shows rough surfaces sharply. An edit that makes a surface
/// rough therefore pauses the audit.
TEST(PlanAudit, RoughSurfaceAndUnsettledCapturesAreNotAudited) {
    const scene::Scene scene = make_audited_room();
    const std::size_t shiny = scene.objects[scene::mirrors(scene).front()].material;
    scene::Material rough = scene.materials[shiny];
    rough.mirror = false, rough.metallic = 1, rough.roughness = .3f;
    rough.albedo = vec3(.9f);
    session::Session session(test::get_test_engine(), scene);
    study::RunningPlanAudit audit(make_request_of_every_frame());
    session::FrameSpec spec = make_audited_spec(scene);
    int k = 0;
    const auto count_audited_frames = [&](int frames) {
        const std::size_t before = audit.audit().frame_count();
        for (int i = 0; i < frames; ++i, ++k) {
            spec.camera = camera_of(scene.cameras.front(), k);
            const session::Frame frame = session.frame(spec);
            audit.watch_frame(session, frame, spec, k / 60.);
        }
        return audit.audit().frame_count() - before;
    };
    EXPECT_EQ(count_audited_frames(8), 0u);
    EXPECT_GT(count_audited_frames(30), 0u);
    session.change(scene::set_material(shiny, rough));
    EXPECT_EQ(count_audited_frames(30), 0u);
    EXPECT_THAT(audit.describe(), testing::HasSubstr("; paused, because a surface is rough"));
    session.change(scene::set_material(shiny, scene.materials[shiny]));
    EXPECT_GT(count_audited_frames(30), 0u);
    audit.wait_until_settled();
    EXPECT_EQ(count_audited_frames(8), 0u);
}

/// The frames of the audit are outside the sequence of running frames, so all running pictures must
/// keep their bytes. The picture of this test is large enough to be sampled. Choices that were made
/// in the first frame of the sequence, such as `face=auto`, must stay.
TEST(PlanAudit, RunningPicturesKeepTheirBytes) {
    const scene::Scene scene = make_audited_room();
    session::FrameSpec spec = make_audited_spec(scene);
    spec.size = {210, 200};
    for (const char* plan : {"secant:face=auto,shadow_map=64", "auto"}) {
        study::PlanAuditRequest request = make_audit_request({plan});
        request.pace.every = 2;
        spec.techniques = request.plans;
        study::RunningPlanAudit audit(request);
        session::Session audited(test::get_test_engine(), scene),
            plain(test::get_test_engine(), scene);
        for (int k = 0; k < 22; ++k) {
            spec.camera = camera_of(scene.cameras.front(), 2 * k);
            const session::Frame frame = audited.frame(spec);
            const measure::Picture picture = frame.hdr();
            audit.watch_frame(audited, frame, spec, k);
            EXPECT_TRUE(test::have_equal_pixel_bytes(picture, plain.frame(spec).hdr()))
                << plan << " " << k;
        }
        EXPECT_GE(audit.audit().frame_count(), 2u);
    }
}

TEST(PlanAudit, UnchangedPicturesAndOtherPlansAreNotAudited) {
    const scene::Scene scene = make_audited_room();
    session::Session session(test::get_test_engine(), scene);
    study::RunningPlanAudit audit(make_request_of_every_frame());
    session::FrameSpec spec = make_audited_spec(scene);
    const auto run = [&](int frames) {
        for (int k = 0; k < frames; ++k) audit.watch_frame(session, session.frame(spec), spec, k);
        return audit.audit().frame_count();
    };
    EXPECT_EQ(run(30), 0u); // the picture does not change, so it counts once
    for (int k = 1; k <= 20; ++k) spec.camera = camera_of(scene.cameras.front(), k), run(1);
    const std::size_t moving = audit.audit().frame_count();
    EXPECT_GE(moving, 4u);
    EXPECT_EQ(run(10), moving);
    session.change(scene::set_material(1, {.name = "red", .albedo = {.6f, .2f, .1f}}));
    EXPECT_EQ(run(10), moving + 1); // a changed scene counts as a new frame
    spec.techniques = {"reuse:face=16"};
    spec.camera.eye.x += .1;
    EXPECT_EQ(run(1), moving + 1); // another plan than the audited plan
    spec.techniques = {kRunningPlan};
    // The camera turns to a view without mirrors.
    spec.camera.target = spec.camera.eye + dvec3(0, 0, -1);
    EXPECT_EQ(run(1), moving + 1);
}

struct CaughtFault {
    bool is_early = false;  ///< whether an alarm was raised before the fault began
    int frames = 0;         ///< frames from the fault until the alarm
    std::size_t audits = 0; ///< number of audited frames among them
};

/// Runs frames in which a fault begins at some frame, until the audit raises an alarm. `fault`
/// returns the faulty picture that is shown instead of the frame.
template <typename ShowFault>
CaughtFault run_until_alarm(session::Session& session, int faulty, std::uint64_t seed,
                            const ShowFault& fault) {
    constexpr int kMostFrames = 200;
    study::PlanAuditRequest request = make_audit_request();
    request.pace.seed = seed;
    study::RunningPlanAudit audit(request);
    session::FrameSpec spec = make_audited_spec(session.scene());
    std::size_t before = 0;
    session.forget();
    for (int k = 0; k < kMostFrames; ++k) {
        spec.camera = camera_of(session.scene().cameras.front(), k);
        const session::Frame frame = k < faulty ? session.frame(spec) : fault(spec);
        const study::AuditState outcome = audit.watch_frame(session, frame, spec, k / 60.);
        if (k < faulty) before = audit.audit().frame_count();
        if (outcome.is_alarm)
            return {k < faulty, k - faulty + 1, audit.audit().frame_count() - before};
    }
    return {false, kMostFrames, audit.audit().frame_count() - before};
}

template <typename ShowFault>
void expect_fault_is_caught_for_20_seeds(session::Session& session, const ShowFault& fault) {
    int most_frames = 0;
    std::size_t most_audits = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const int faulty = 30 + static_cast<int>(seed * 7 % 20);
        const CaughtFault caught = run_until_alarm(session, faulty, seed, fault);
        EXPECT_FALSE(caught.is_early) << seed;
        // About 8 audited frames pass before the fault. After that, at most 4 failures raise an
        // alarm.
        EXPECT_LE(caught.audits, 4u) << seed;
        most_frames = std::max(most_frames, caught.frames);
        most_audits = std::max(most_audits, caught.audits);
    }
    std::printf("20 of 20 alarms, after at most %d frames, %zu audited\n", most_frames,
                most_audits);
    EXPECT_LE(most_frames, 20);
}

TEST(PlanAudit, WrongLawIsCaughtForEverySeed) {
    const scene::Scene scene = make_audited_room();
    session::Session session(test::get_test_engine(), scene), wrong(test::get_test_engine(), scene);
    expect_fault_is_caught_for_20_seeds(session, [&](session::FrameSpec spec) {
        spec.techniques = {"reuse:face=64,shadow_map=64"}; // a technique without parallax
                                                           // correction
        return wrong.frame(spec);
    });
}

/// A wall changes its colour, but the mirrors continue to show the old captures.
TEST(PlanAudit, StaleReflectionsAreCaughtForEverySeed) {
    const scene::Scene scene = make_audited_room();
    session::Session session(test::get_test_engine(), scene), stale(test::get_test_engine(), scene);
    session.change(scene::set_material(0, {.name = "white", .albedo = {.25f, .3f, .7f}}));
    expect_fault_is_caught_for_20_seeds(
        session, [&](const session::FrameSpec& spec) { return stale.frame(spec); });
}

TEST(PlanAudit, AlarmStepsToTheSurerPlanAndStopsThere) {
    const scene::Scene scene = make_audited_room();
    session::Session session(test::get_test_engine(), scene);
    study::PlanAuditRequest request = make_audit_request(
        {kRunningPlan, "reuse:face=64", "reuse:face=16"});
    request.pace.every = 1;
    study::RunningPlanAudit audit(request);
    EXPECT_EQ(audit.plan(), "reuse:face=16");
    session::FrameSpec spec = make_audited_spec(scene);
    std::vector<int> steps;
    std::vector<std::string> messages;
    int alarms = 0;
    for (int k = 0; k < 120; ++k) {
        spec.camera = camera_of(scene.cameras.front(), k);
        spec.techniques = {audit.plan()};
        const study::AuditState outcome = audit.watch_frame(session, session.frame(spec), spec,
                                                            k / 60.);
        alarms += outcome.is_alarm;
        if (!outcome.message.empty()) messages.push_back(outcome.message);
        if (!outcome.has_new_plan) continue;
        steps.push_back(k);
        EXPECT_EQ(audit.audit().frame_count(), 0u); // the audit of the new plan begins without
                                                    // evidence
    }
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_EQ(alarms, 2);
    ASSERT_EQ(messages.size(), 3u);
    EXPECT_EQ(messages[0],
              "audit: 2 of 2 frames break flip <= 0.08; the plan is now reuse:face=64");
    EXPECT_EQ(messages[1], "audit: 2 of 2 frames break flip <= 0.08");
    EXPECT_EQ(messages[2], std::string("audit: the plan is now ") + kRunningPlan);
    EXPECT_GE(steps[1] - steps[0], 30); // half a second
    EXPECT_EQ(audit.plan(), kRunningPlan);
    EXPECT_THAT(audit.describe(),
                testing::MatchesRegex("audit: [0-9]+ of [0-9]+ frames keep flip <= 0.08; assured "
                                      "share 0.[0-9]+; [0-9.]+ % of the frames' time"));
}

class LibraryAudit : public test::InFolder {
protected:
    /// Writes a file of two plans as `choose` writes it. The second plan is the chosen one, whose
    /// time was predicted.
    std::filesystem::path write_file_of_two_plans(double limit,
                                                  const std::string& scene_hash = "") const {
        const auto proof = [](const std::string& plan, const std::string& keeps_time) {
            return R"({"technique": ")" + plan + R"(", "keeps_error": true, "keeps_time": )" +
                   keeps_time + "}";
        };
        const std::filesystem::path file = folder / "plan.json";
        write_file(file, R"({"certificate": {"quantity": "flip", "share": 0.95,)"
                         R"( "confidence": 0.95, "max_error": )" +
                             std::to_string(limit) + R"(, "scene_hash": ")" + scene_hash +
                             R"("}, "proofs": [)" + proof(kRunningPlan, "true") + ", " +
                             proof("reuse:face=16", R"("may")") + "]}");
        return file;
    }
};

/// The class of the library counts frames of a plan in any spelling, and says in its state which
/// plan to change to.
TEST_F(LibraryAudit, ReadsAFileAndReturnsItsState) {
    const scene::Scene scene = make_audited_room();
    int calls = 0;
    study::PlanAudit audit(write_file_of_two_plans(.001, scene::hash_scene(scene)),
                           {.every = 1,
                            .most_time = std::numeric_limits<double>::infinity(),
                            .before_audit = [&] { ++calls; }});
    EXPECT_TRUE(audit.is_for(scene));
    EXPECT_FALSE(audit.is_for(scene::load("flat")));
    EXPECT_EQ(audit.plan(), "reuse:face=16");
    session::Session session(test::get_test_engine(), scene);
    session::FrameSpec spec = make_audited_spec(scene);
    spec.techniques = {"*=reuse:face=16"}; // another spelling of a plan for all mirrors
    audit.prepare(session, spec);
    study::AuditState state;
    int audited = 0;
    for (int k = 0; k < 60 && !state.has_new_plan; ++k) {
        spec.camera = camera_of(scene.cameras.front(), k);
        state = audit.watch_frame(session, session.frame(spec), spec, k / 60.);
        audited += state.error.has_value();
        if (!state.error || state.has_new_plan) continue;
        EXPECT_EQ(state.frames, 1u); // two failures raise the alarm
        EXPECT_EQ(state.failures, 1u);
        EXPECT_GT(*state.error, .001);
        EXPECT_GT(state.time_share, 0);
        EXPECT_EQ(state.plan, 1u);
    }
    EXPECT_TRUE(state.is_alarm);
    EXPECT_EQ(state.plan, 0u);
    EXPECT_EQ(state.frames, 0u); // the audit of the new plan begins without evidence
    EXPECT_EQ(audited, 2);
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(audit.plan(), kRunningPlan);
    EXPECT_EQ(state.message, std::string("audit: 2 of 2 frames break flip <= 0.001; the plan is "
                                         "now ") +
                                 kRunningPlan);
    EXPECT_THAT(audit.describe(), testing::StartsWith("audit: 0 of 0 frames keep flip <= 0.001"));
}

TEST_F(LibraryAudit, AssuresTheShareOfItsState) {
    const scene::Scene scene = make_audited_room();
    study::PlanAudit audit(write_file_of_two_plans(1),
                           {.every = 1, .most_time = std::numeric_limits<double>::infinity()});
    EXPECT_TRUE(audit.is_for(scene)); // the file does not name its scene
    session::Session session(test::get_test_engine(), scene);
    session::FrameSpec spec = make_audited_spec(scene);
    spec.size = {16, 16};
    spec.techniques = {audit.plan()};
    study::AuditState state;
    double before = 0;
    for (int k = 0; k < 90; ++k) {
        spec.camera = camera_of(scene.cameras.front(), k);
        state = audit.watch_frame(session, session.frame(spec), spec, k / 60.);
        EXPECT_GE(state.assured_share, before);
        before = state.assured_share;
    }
    EXPECT_GE(state.frames, 60u);
    EXPECT_EQ(state.failures, 0u);
    measure::Audit known;
    for (std::size_t i = 0; i < state.frames; ++i) known.count_frame(true);
    EXPECT_EQ(state.assured_share, known.assured_share());
    EXPECT_FALSE(state.is_alarm || state.has_new_plan);
}

TEST_F(LibraryAudit, RefusesOptionsOutOfRange) {
    const std::filesystem::path file = write_file_of_two_plans(1);
    EXPECT_EQ(test::catch_error_text(Failure::usage, [&] { study::PlanAudit(file, {.every = 0}); }),
              "audit: every: wanted at least 1 frame, found 0");
    EXPECT_EQ(
        test::catch_error_text(Failure::usage, [&] { study::PlanAudit(file, {.most_time = 0}); }),
        "audit: share of time: wanted a number above 0, found 0");
}

TEST(PlanAudit, ImpossibleAuditsAreRefused) {
    EXPECT_EQ(test::catch_error_text(Failure::usage,
                                     [] { study::RunningPlanAudit(make_audit_request({})); }),
              "audit: plans: wanted at least 1, found none");
    study::PlanAuditRequest request = make_audit_request();
    request.max_error = 2;
    EXPECT_EQ(test::catch_error_text(Failure::usage, [&] { study::RunningPlanAudit{request}; }),
              "audit: limit of error: wanted a number from 0 to 1, found 2");
    scene::Scene rough = make_audited_room();
    test::make_mirrors_rough(rough, .2f);
    session::Session session(test::get_test_engine(), rough);
    study::RunningPlanAudit audit(make_audit_request());
    test::expect_error([&] { audit.prepare(session, make_audited_spec(rough)); }, Failure::usage,
                       {"audit: reference: wanted one with rays=N, because surfaces of 'room' are "
                        "rough, found raytrace:depth=16"});
}

/// An audit compares mirror pixels, which only a ray-traced reference knows. After the refusal the
/// session goes on as if there were no audit.
TEST(PlanAudit, ReferenceWithoutFirstHitsIsRefusedAndTheSessionGoesOn) {
    const scene::Scene room = make_audited_room();
    study::PlanAuditRequest request = make_audit_request();
    request.reference = "naive:bounces=1";
    session::FrameSpec spec = make_audited_spec(room);
    spec.techniques = {"reuse"};
    session::Session audited(test::get_test_engine(), room), other(test::get_test_engine(), room);
    audited.frame(spec).read(), other.frame(spec).read();
    study::RunningPlanAudit audit(request);
    test::expect_error([&] { audit.prepare(audited, spec); }, Failure::usage,
                       {"audit: reference: wanted a ray-traced one, found naive:bounces=1"});
    EXPECT_EQ(audited.frame(spec).read().hdr.pixels, other.frame(spec).read().hdr.pixels);
}

/// Runs frames of a rough scene, and returns the audit after them. The reference has two halves.
std::unique_ptr<study::RunningPlanAudit> audit_rough_room(study::ErrorQuantity quantity,
                                                          double limit, int frames) {
    scene::Scene rough = make_audited_room();
    test::make_mirrors_rough(rough, .2f);
    study::PlanAuditRequest request = make_request_of_every_frame();
    request.quantity = quantity;
    request.max_error = limit;
    request.reference = "raytrace:depth=4,rays=4";
    auto audit = std::make_unique<study::RunningPlanAudit>(request);
    session::Session session(test::get_test_engine(), rough);
    session::FrameSpec spec = make_audited_spec(rough);
    spec.size = {32, 32};
    for (int k = 0; k < frames; ++k) {
        spec.camera = camera_of(rough.cameras.front(), k);
        audit->watch_frame(session, session.frame(spec), spec, k / 60.);
    }
    return audit;
}

/// Against a reference with noise, a frame keeps the limit only if the noise cannot hide a failure,
/// and only frames that fail whatever the noise is raise an alarm.
TEST(PlanAudit, RoughSceneIsAuditedByTwoHalves) {
    for (const study::ErrorQuantity quantity :
         {study::ErrorQuantity::flip, study::ErrorQuantity::rmse}) {
        const auto kept = audit_rough_room(quantity, .9, 24),
                   broken = audit_rough_room(quantity, 0, 24);
        EXPECT_GT(kept->audit().frame_count(), 5u);
        EXPECT_EQ(kept->audit().failures(), 0u);
        EXPECT_FALSE(kept->is_alarmed());
        EXPECT_EQ(broken->audit().failures(), broken->audit().frame_count());
        EXPECT_TRUE(broken->is_alarmed());
    }
}

/// With few rays, the noise of the halves is of the size of the limit. Neither passes nor failures
/// are then certain.
TEST(PlanAudit, NoiseOfTheSizeOfTheLimitNeitherAssuresNorAlarms) {
    const auto audit = audit_rough_room(study::ErrorQuantity::flip, .1, 24);
    EXPECT_EQ(audit->audit().failures(), audit->audit().frame_count());
    EXPECT_EQ(audit->audit().assured_share(), 0);
    EXPECT_FALSE(audit->is_alarmed());
}

} // namespace
