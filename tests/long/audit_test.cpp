// Runs a long loop of frames with an audit. If the plan keeps its limit, no alarm may be raised.
// The test prints the times of frames with and without the audit.
#include "study/plan_audit.hpp"
#include "support/rendering.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace {

using namespace catoptric;

constexpr int kFramesOfLoop = 2000, kFramesOfTurn = 25;

session::FrameSpec make_spec_of_loop_frame(const scene::Scene& scene, int k, uvec2 size) {
    session::FrameSpec spec = test::make_test_request(scene, {"parallax:face=64,shadow_map=64"},
                                                      size);
    spec.model = session::RenderedWork::required;
    spec.camera.eye += dvec3(.3 * std::sin(.11 * k), .2 * std::sin(.07 * k),
                             .1 + .1 * std::cos(.09 * k));
    return spec;
}

/// A loop with audit and a loop without audit take turns, so that other load of the machine affects
/// both.
void run_audited_loop(uvec2 size) {
    const scene::Scene scene = test::replace_balls_by_coarse_balls(test::make_lit_room(2, 1));
    session::Session audited(test::get_test_engine(), scene), plain(test::get_test_engine(), scene);
    for (session::Session* session : {&audited, &plain}) // the first frames compile shaders
        for (int k = 0; k < 16; ++k)
            static_cast<void>(session->frame(make_spec_of_loop_frame(scene, k, size)).times());
    study::PlanAuditRequest request;
    request.plans = {"parallax:face=64,shadow_map=64"};
    request.max_error = .08;
    study::RunningPlanAudit audit(request);
    audit.prepare(audited, make_spec_of_loop_frame(scene, 0, size));
    double with = 0, without = 0, cpu_with = 0, cpu_without = 0; // seconds
    for (int begin = 0; begin < kFramesOfLoop; begin += kFramesOfTurn)
        for (const bool is_audited : {true, false}) {
            const auto start = std::chrono::steady_clock::now();
            // Processor time of all threads, including the driver's.
            const std::clock_t cpu_start = std::clock();
            for (int k = begin; k < begin + kFramesOfTurn; ++k) {
                const session::FrameSpec spec = make_spec_of_loop_frame(scene, k, size);
                session::Session& session = is_audited ? audited : plain;
                const session::Frame frame = session.frame(spec);
                static_cast<void>(frame.times());
                if (is_audited) {
                    EXPECT_FALSE(audit.watch_frame(audited, frame, spec, k / 60.).is_alarm) << k;
                }
            }
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
            (is_audited ? with : without) += seconds.count();
            (is_audited ? cpu_with : cpu_without) += static_cast<double>(std::clock() - cpu_start) /
                                                     CLOCKS_PER_SEC;
        }
    EXPECT_FALSE(audit.audit().is_alarmed());
    EXPECT_EQ(audit.audit().failures(), 0u);
    EXPECT_GT(audit.audit().frame_count(), 1u);
    std::printf(
        "%ux%u, %d frames: %.3f ms a frame with audit, %.3f ms without, ratio %.3f (of processor time %.3f); blocks "
        "of %zu frames; %s\n",
        size.x, size.y, kFramesOfLoop, 1e3 * with / kFramesOfLoop, 1e3 * without / kFramesOfLoop,
        with / without, cpu_with / cpu_without, audit.schedule().block_length(),
        audit.describe().c_str());
}

TEST(LongAudit, PlanWithinItsLimitRaisesNoAlarm) { run_audited_loop({64, 64}); }
TEST(LongAudit, LargerPictureIsSampledAndRaisesNoAlarm) { run_audited_loop({256, 256}); }

} // namespace
