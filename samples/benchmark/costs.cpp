#include "benchmark/costs.hpp"

#include "measure/statistics.hpp"
#include "session/access.hpp"
#include "session/technique_choice.hpp"
#include "session/work.hpp"
#include "study/row_run.hpp"

#include <memory>

namespace catoptric::benchmark {

namespace {

std::string sample_name(const Request& request) {
    return request.scene.name + "/" + std::to_string(request.size.x) + "x" +
           std::to_string(request.size.y) + "/" + work_name(request.model) + "/" +
           parse_technique(request.techniques.front()).label;
}

/// Returns one request for each technique.
std::vector<Request> split_request(const Request& request) {
    std::vector<Request> rows;
    for (const std::string& technique : request.techniques) {
        rows.push_back(request);
        rows.back().techniques = {technique};
    }
    return rows;
}

/// Returns the median time of the frames on the device. `threads`: those of a device that is a
/// processor; 0 for other devices.
double median_time(const std::vector<std::vector<FrameTimes>>& rounds, int threads) {
    std::vector<std::vector<double>> samples;
    for (const std::vector<FrameTimes>& round : rounds) {
        samples.emplace_back();
        for (const FrameTimes& frame : round)
            samples.back().push_back(threads > 0 ? frame.cpu_ms / threads : frame.gpu_ms);
    }
    return measure::summarise(samples).median;
}

} // namespace

void measure_cost_rows(Session& session, const std::vector<Request>& rows, const DeviceInfo& device,
                       const BenchOptions& options, std::vector<measure::TimedWork>& samples) {
    const int rounds = study::round_count(options.iterations, options.rounds);
    const int repeated_frames = study::must_repeat_first_round(device.type)
                                    ? study::frames_of_round(options.iterations, rounds, 0)
                                    : 0;
    std::vector<std::unique_ptr<study::RowMeasurement>> runs;
    for (int round = 0; round < rounds; ++round)
        for (std::size_t place = 0; place < rows.size(); ++place) {
            // Every second round measures the rows in reverse order, so that no row always follows
            // the same row.
            const std::size_t i = round % 2 == 0 ? place : rows.size() - 1 - place;
            if (round == 0)
                runs.push_back(std::make_unique<study::RowMeasurement>(
                    session, rows[i], options.watcher, repeated_frames));
            report_row(options.watcher, sample_name(rows[i]),
                       static_cast<std::size_t>(round) * rows.size() + place,
                       static_cast<std::size_t>(rounds) * rows.size());
            runs[i]->measure_round(study::frames_of_round(options.iterations, rounds, round));
            runs[i]->suspend_frames();
        }
    if (repeated_frames > 0)
        for (const std::unique_ptr<study::RowMeasurement>& run : runs) {
            run->repeat_first_round();
            run->replace_first_round();
            run->suspend_frames();
        }
    for (std::size_t i = 0; i < rows.size(); ++i)
        samples.push_back({sample_name(rows[i]),
                           sum_work(count_frame_work(session, rows[i], options.watcher)),
                           median_time(runs[i]->rounds(), device.threads)});
}

std::vector<measure::TimedWork> measure_cost_samples(Engine& engine, const Request& request,
                                                     const BenchOptions& options) {
    Session session(engine, request.scene);
    std::vector<measure::TimedWork> samples;
    for (const RenderedWork model : {RenderedWork::everything, RenderedWork::required})
        for (const std::uint32_t divisor : {1u, 2u}) {
            Request part = request;
            part.model = model;
            part.size = glm::max(request.size / divisor, uvec2(1));
            part.frames = options.iterations;
            measure_cost_rows(session, split_request(part), engine.device(), options, samples);
        }
    return samples;
}

std::vector<measure::TimedWork> count_work_samples(Engine& engine, const Request& request,
                                                   const Watcher& watcher) {
    Session session(engine, request.scene);
    std::vector<measure::TimedWork> samples;
    for (const Request& row : split_request(request))
        samples.push_back({sample_name(row), sum_work(count_frame_work(session, row, watcher)), 0});
    return samples;
}

std::vector<WorkKind> fitted_kinds() {
    std::vector<WorkKind> kinds;
    for (std::size_t i = 0; i < kWorkKindCount; ++i) kinds.push_back(static_cast<WorkKind>(i));
    return kinds;
}

} // namespace catoptric::benchmark
