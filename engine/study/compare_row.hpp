#pragma once

#include "measure/halves.hpp"
#include "report/comparison.hpp"
#include "session/session.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Functions that fill one row of a comparison.
namespace catoptric::study {

using namespace session;

/// Returns a row that describes the technique or plan, without its cost, picture and errors.
report::Row describe_row(const std::string& text, const TechniqueResult& part);
struct MeasuredFrames {
    std::vector<std::vector<FrameTimes>> rounds;
    /// Frames within which each capture is drawn again in its turn (CaptureBudget::every). A sample
    /// is then the mean of a whole cycle, because no single frame is typical.
    std::size_t cycle = 1;
};

/// Fills the row's cost from the frames measured so far. The row's passes are those whose name
/// begins with `prefix`. `on_processor`: the device is a processor.
void fill_row_times(report::Row& row, const MeasuredFrames& frames, const std::string& prefix,
                    bool on_processor);
struct ComparedReference {
    const measure::Picture& hdr; ///< linear; of a reference with noise, the mean of its halves
    /// Halves of a reference with noise, at the comparison's exposure; null: no noise.
    const measure::NoisyHalves* halves = nullptr;
};

/// Returns the FLIP of both pictures for each pixel. The pictures are as displayed at `exposure`
/// stops, and are not rounded to 8 bits. For a noisy reference, returns the mean of the FLIP
/// against each half.
std::vector<float> compute_flip_map(const measure::Picture& picture, const ComparedReference& truth,
                                    double exposure);
/// Returns how far a picture is from the truth, over the pixels of a mask. `flip_map`: FLIP of both
/// pictures for each pixel.
measure::Difference masked_error(const measure::Picture& picture, const ComparedReference& truth,
                                 const measure::Mask& mask, std::span<const float> flip_map,
                                 double exposure);
/// Returns how far a picture is from the truth, over all masks. `flip_map`: FLIP of both pictures
/// for each pixel. `hits`: first hits of the picture, see TechniqueResult::hits. `exposure`: stops.
measure::Errors masked_errors(const measure::Picture& picture, const ComparedReference& truth,
                              std::span<const float> flip_map,
                              const std::vector<std::uint32_t>& hits, std::size_t mirrors,
                              double exposure);
/// Fills the errors of a row, its picture and the means of its picture. `hits`: first hits at the
/// same instant. `exposure`: stops.
void fill_row_errors(report::Row& row, const TechniqueResult& part, const ComparedReference& truth,
                     const std::vector<std::uint32_t>& hits, std::size_t mirrors, double exposure);

} // namespace catoptric::study
