#pragma once

#include "benchmark/bench_subjects.hpp"
#include "peer_scene.hpp"

#include <string>

/// Code that all comparisons share: checks that pictures agree, and output of costs and ratios.
namespace peers {

/// A picture that our engine and Embree both trace.
struct Pair {
    std::string name, technique;
    bool exact = false; ///< exact spheres replace meshes that approximate spheres
};
inline constexpr int kDepth = 4;
inline constexpr int kWidths[] = {1, 8, 16}; ///< rays of one call to Embree
inline constexpr int kWarmup = 8;            ///< frames before the measured frames
inline constexpr int kFramesARound = 4;
inline constexpr float kSame = 1e-3F; ///< largest difference of equal pixels in a linear channel
inline constexpr std::size_t kMostOther = 10; ///< most pixels or rays that may differ

std::string our_name(const std::string& pair);
std::string peer_name(const std::string& pair, int width);

/// Returns a request to draw a scene at time 0 from its first camera.
catoptric::app::Request request_of(catoptric::scene::Scene scene);

/// Returns the number of pixels in which a channel differs by more than kSame or is NaN.
std::size_t other_pixels(const catoptric::measure::Picture& ours,
                         const std::vector<Vector>& theirs);

/// The benchmarks of a pair: ours first, then Embree with each width of kWidths.
struct Shown {
    std::vector<catoptric::app::BenchmarkSubject> subjects;
    double rays = 0;   ///< rays that Embree traces for one picture
    bool same = false; ///< whether at most kMostOther pixels differ
};
/// Traces a pair and returns its benchmarks. Prints the numbers of rays and of differing pixels.
/// `frames` is the number of our frames that will be measured.
Shown show(const EmbreeDevice& device, std::shared_ptr<catoptric::app::Session> session,
           catoptric::app::Request request, const Pair& pair, int threads, int frames);

/// Prints a benchmark. `millions` is the number of `what` in an iteration, in millions, for a rate;
/// 0 prints no rate.
void print(const catoptric::measure::Benchmark& benchmark, const char* what, double millions);
/// Prints the ratio a / b of two costs: of processor cycles, or of processor time if cycles are not
/// counted; and of wall clock time.
void print_ratio(const catoptric::measure::Benchmark& a, const catoptric::measure::Benchmark& b);
/// Prints the ratios of our cost of a pair to Embree's cost, for each width of kWidths.
void print_ratios(const std::vector<catoptric::measure::Benchmark>& list, const std::string& pair);

const catoptric::measure::Benchmark& named(const std::vector<catoptric::measure::Benchmark>& list,
                                           const std::string& name);

} // namespace peers
