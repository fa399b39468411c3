#pragma once

#include "benchmark/bench_subjects.hpp"
#include "peer_scene.hpp"

#include <string>

/// Code that all comparisons share: checks that pictures agree, and output of costs and ratios.
namespace peers {

/// A picture that our engine and Embree both trace.
struct EnginePeerPicturePair {
    std::string name, technique;
    bool exact = false; ///< exact spheres replace meshes that approximate spheres
};
inline constexpr int kMirrorBounces = 4;
inline constexpr int kEmbreePacketWidths[] = {1, 8, 16}; ///< rays of one call to Embree
inline constexpr int kWarmupFrameCount = 8;              ///< frames before the measured frames
inline constexpr int kFramesPerRound = 4;
inline constexpr float kMaxEqualPixelDifference =
    1e-3F; ///< largest difference of equal pixels in a linear channel
inline constexpr std::size_t kMaxDifferingPixels = 10; ///< most pixels or rays that may differ

std::string engine_benchmark_name(const std::string& pair);
std::string embree_benchmark_name(const std::string& pair, int width);

/// Returns a request to draw a scene at time 0 from its first camera.
catoptric::session::Request make_request_of_scene(catoptric::scene::Scene scene);

/// Returns the number of pixels in which a channel differs by more than kMaxEqualPixelDifference or
/// is NaN.
std::size_t count_differing_pixels(const catoptric::measure::Picture& ours,
                                   const std::vector<PeerVector3>& theirs);

/// The benchmarks of a pair: ours first, then Embree with each width of kEmbreePacketWidths.
struct EngineAndEmbreeBenchmarks {
    std::vector<catoptric::benchmark::Subject> subjects;
    double rays = 0;   ///< rays that Embree traces for one picture
    bool same = false; ///< whether at most kMaxDifferingPixels pixels differ
};
/// Traces a pair and returns its benchmarks. Prints the numbers of rays and of differing pixels.
/// `frames` is the number of our frames that will be measured.
EngineAndEmbreeBenchmarks
trace_pair_and_print_differences(const EmbreeDevice& device,
                                 std::shared_ptr<catoptric::session::Session> session,
                                 catoptric::session::Request request,
                                 const EnginePeerPicturePair& pair, int threads, int frames);

/// Prints a benchmark. `millions` is the number of `what` in an iteration, in millions, for a rate;
/// 0 prints no rate.
void print_benchmark(const catoptric::measure::BenchmarkResult& benchmark, const char* what,
                     double millions);
/// Prints the ratio a / b of two costs: of processor cycles, or of processor time if cycles are not
/// counted; and of wall clock time.
void print_cost_ratio(const catoptric::measure::BenchmarkResult& a,
                      const catoptric::measure::BenchmarkResult& b);
/// Prints the ratios of our cost of a pair to Embree's cost, for each width of kEmbreePacketWidths.
void print_cost_ratios_of_pair(const std::vector<catoptric::measure::BenchmarkResult>& list,
                               const std::string& pair);

const catoptric::measure::BenchmarkResult&
find_benchmark_by_name(const std::vector<catoptric::measure::BenchmarkResult>& list,
                       const std::string& name);

} // namespace peers
