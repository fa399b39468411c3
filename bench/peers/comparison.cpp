#include "comparison.hpp"

#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace peers {

using namespace catoptric;
using measure::BenchmarkResult;
using measure::CostKind;

std::string engine_benchmark_name(const std::string& pair) { return "ours/" + pair; }
std::string embree_benchmark_name(const std::string& pair, int width) {
    return "embree/" + pair + "/" + std::to_string(width);
}

session::Request make_request_of_scene(scene::Scene scene) {
    session::Request request;
    request.scene = std::move(scene);
    request.camera = request.scene.cameras.front();
    request.warmup = kWarmupFrameCount;
    return request;
}

std::size_t count_differing_pixels(const measure::Picture& ours,
                                   const std::vector<PeerVector3>& theirs) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        const auto& [x, y, z] = theirs[i];
        const vec3 apart = abs(ours.pixels[i] - vec3(x, y, z));
        count += !(std::max({apart.x, apart.y, apart.z}) <= kMaxEqualPixelDifference);
    }
    return count;
}

EngineAndEmbreeBenchmarks trace_pair_and_print_differences(
    const EmbreeDevice& device, std::shared_ptr<session::Session> session, session::Request request,
    const EnginePeerPicturePair& pair, int threads, int frames) {
    request.techniques = {pair.technique};
    const session::TechniqueResult ours = session->frame(request).read();
    const catoptric::RayCounts rays = ours.rays.value();
    std::printf("%-23s %llu rays\n", engine_benchmark_name(pair.name).c_str(),
                static_cast<unsigned long long>(rays.primary + rays.mirror + rays.shadow));
    EngineAndEmbreeBenchmarks shown{.same = true};
    shown.subjects.push_back(benchmark::make_frame_subject(std::move(session), request, frames));
    shown.subjects.back().name = engine_benchmark_name(pair.name),
    shown.subjects.back().caller.clear();
    const auto peer = std::make_shared<EmbreeWhittedTracer>(device, request, kMirrorBounces,
                                                            pair.exact);
    for (const int width : kEmbreePacketWidths) {
        const PeerTracedPicture theirs = peer->trace_picture(width, threads);
        const std::size_t other = count_differing_pixels(ours.hdr, theirs.pixels);
        const std::string name = embree_benchmark_name(pair.name, width);
        std::printf("%-23s %llu rays, %zu pixels differ by more than %g\n", name.c_str(),
                    static_cast<unsigned long long>(theirs.rays.total_ray_count()), other,
                    static_cast<double>(kMaxEqualPixelDifference));
        shown.same = shown.same && other <= kMaxDifferingPixels;
        shown.rays = static_cast<double>(theirs.rays.total_ray_count());
        shown.subjects.push_back(benchmark::make_subject(
            name, [peer, width, threads] { peer->trace_picture(width, threads); },
            kWarmupFrameCount));
    }
    return shown;
}

void print_benchmark(const BenchmarkResult& benchmark, const char* what, double millions) {
    const double ms = measure::percentile(round_costs(benchmark, CostKind::real_time), .5);
    std::printf("%-23s %9.2f ms %9.2f ms of processors", benchmark.name.c_str(), ms,
                measure::percentile(round_costs(benchmark, CostKind::cpu_time), .5));
    if (benchmark.rounds.front().cycles)
        std::printf(" %9.1f Mcycles",
                    measure::percentile(round_costs(benchmark, CostKind::cycles), .5) / 1e6);
    if (millions > 0) std::printf(" %8.2f M%s/s", 1e3 * millions / ms, what);
    std::printf("\n");
}

void print_cost_ratio(const BenchmarkResult& a, const BenchmarkResult& b) {
    const CostKind cost = a.rounds.front().cycles ? CostKind::cycles : CostKind::cpu_time;
    const measure::CostRatio ratio = measure::cost_ratio(round_costs(a, cost),
                                                         round_costs(b, cost));
    const measure::CostRatio real = measure::cost_ratio(round_costs(a, CostKind::real_time),
                                                        round_costs(b, CostKind::real_time));
    std::printf("%-19s / %-23s %6.3f [%.3f - %.3f] of %s, %6.3f [%.3f - %.3f] on the clock\n",
                a.name.c_str(), b.name.c_str(), ratio.median, ratio.ci95.low, ratio.ci95.high,
                measure::cost_kind_name(cost).c_str(), real.median, real.ci95.low, real.ci95.high);
}

void print_cost_ratios_of_pair(const std::vector<BenchmarkResult>& list, const std::string& pair) {
    for (const int width : kEmbreePacketWidths)
        print_cost_ratio(find_benchmark_by_name(list, engine_benchmark_name(pair)),
                         find_benchmark_by_name(list, embree_benchmark_name(pair, width)));
}

const BenchmarkResult& find_benchmark_by_name(const std::vector<BenchmarkResult>& list,
                                              const std::string& name) {
    return *std::ranges::find(list, name, &BenchmarkResult::name);
}

} // namespace peers
