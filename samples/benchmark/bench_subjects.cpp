#include "benchmark/bench_subjects.hpp"

#include "core/error.hpp"
#include "session/access.hpp"
#include "session/rays.hpp"
#include "session/technique_choice.hpp"
#include "session/work.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace catoptric::benchmark {

namespace {

/// Benchmark of frames of one technique. The history of the frames continues from round to round,
/// as if no other benchmark ran in between.
class FrameBenchmark {
public:
    FrameBenchmark(std::shared_ptr<Session> session, Request request)
        : session_(std::move(session)), request_(std::move(request)) {}

    IterationMeasurements render_frames() {
        // Created here and not earlier, because a FrameLoop begins with a cut.
        if (!frames_) frames_.emplace(*session_, request_);
        check(frames_->render_next(), Failure::internal,
              "a benchmark went on after its last frame");
        const FrameTimes& times = frames_->frame().times();
        IterationMeasurements iteration{times.host.sum(),
                                        {{"gpu_ms", times.gpu_ms}, {"record_ms", times.record_ms}}};
        if (rays_) iteration.counters["rays"] = *rays_;
        iteration.counters.insert(work_.begin(), work_.end());
        return iteration;
    }

    void suspend_frames() {
        if (!frames_) return;
        if (!is_read_)
            if (const auto rays = frames_->frame().read().rays)
                rays_ = static_cast<double>(rays->primary + rays->mirror + rays->shadow);
        frames_->suspend();
        if (!is_read_) count_work();
        is_read_ = true;
    }

private:
    void count_work() {
        const WorkCounts work = sum_work(count_frame_work(*session_, request_));
        for (std::size_t i = 0; i < kWorkKindCount; ++i)
            if (work.values[i])
                work_[measure::kWorkPrefix + std::string(kWorkKinds[i].name)] = static_cast<double>(
                    *work.values[i]);
    }

    std::shared_ptr<Session> session_;
    Request request_;
    std::optional<FrameLoop> frames_;
    bool is_read_ = false;
    std::optional<double> rays_;
    std::map<std::string, double> work_; ///< counted work of one frame
};

} // namespace

Subject make_session_subject(Engine& engine, const scene::Scene& scene) {
    return make_subject("session/" + scene.name,
                        [&engine, scene] { const Session session(engine, scene); });
}

Subject make_bvh_subject(const scene::Scene& scene) {
    const auto geometry = std::make_shared<render::FrameGeometry>(
        render::make_geometry(scene::scene_at(scene, 0), render::make_scene_units(scene)));
    const auto triangles = static_cast<double>(geometry->indices.size() / 3);
    return {.name = "hierarchy/" + scene.name,
            .work =
                [geometry, triangles] {
                    build_bvh_without(*geometry, geometry->ranges.size());
                    return IterationMeasurements{0, {{"triangles", triangles}}};
                },
            .warmup = 1,
            .leave = {},
            .caller = {}};
}

Subject make_frame_subject(std::shared_ptr<Session> session, Request request, int iterations) {
    const std::string place = request.scene.name + "/" + std::to_string(request.size.x) + "x" +
                              std::to_string(request.size.y) + "/" +
                              parse_technique(request.techniques.front()).label;
    const int warmup = request.warmup;
    request.frames = iterations;
    request.scene = scene::Scene(); // the session has its own copy of the scene
    const auto work = std::make_shared<FrameBenchmark>(std::move(session), std::move(request));
    return {.name = "frame/" + place,
            .work = [work] { return work->render_frames(); },
            .warmup = warmup,
            .leave = [work] { work->suspend_frames(); },
            .caller = "host/" + place};
}

} // namespace catoptric::benchmark
