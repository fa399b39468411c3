#pragma once

#include "app/bench_subjects.hpp"
#include "peer_scene.hpp"

#include <string>

/// What all comparisons share: pictures that must be the same, costs and ratios as they are
/// printed.
namespace peers {

/// A picture of ours and Embree's of the same scene. `exact`: balls in place of their triangles.
struct Pair {
    std::string name, technique;
    bool exact = false;
};
inline constexpr int kDepth = 4;
inline constexpr int kWidths[] = {1, 8, 16}; ///< rays in a call of Embree's
inline constexpr int kWarmup = 8;            ///< frames
inline constexpr int kFramesARound = 4;
inline constexpr float kSame = 1e-3F;         ///< of a channel, linear
inline constexpr std::size_t kMostOther = 10; ///< pixels, or rays

std::string our_name(const std::string& pair);
std::string peer_name(const std::string& pair, int width);

/// A scene at its start, seen by its first camera.
catoptric::app::Request request_of(catoptric::scene::Scene scene);

/// Of how many pixels a channel differs by more than kSame, or is no number.
std::size_t other_pixels(const catoptric::measure::Picture& ours,
                         const std::vector<Vector>& theirs);

/// What shows a pair, ours first, then Embree with each width.
struct Shown {
    std::vector<catoptric::app::Subject> subjects;
    double rays = 0;   ///< by Embree
    bool same = false; ///< but for kMostOther pixels
};
/// Prints the rays of both and how many pixels differ. `frames`: of ours that are measured.
Shown show(const EmbreeDevice& device, std::shared_ptr<catoptric::app::Session> session,
           catoptric::app::Request request, const Pair& pair, int threads, int frames);

/// `millions`: of `what` that an iteration does; 0: not said.
void print(const catoptric::measure::Benchmark& benchmark, const char* what, double millions);
/// Of cycles where they are counted, else of processor time; and on the clock.
void print_ratio(const catoptric::measure::Benchmark& a, const catoptric::measure::Benchmark& b);
/// Ours of a pair beside Embree's of all widths.
void print_ratios(const std::vector<catoptric::measure::Benchmark>& list, const std::string& pair);

const catoptric::measure::Benchmark& named(const std::vector<catoptric::measure::Benchmark>& list,
                                           const std::string& name);

} // namespace peers
