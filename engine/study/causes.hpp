#pragma once

#include "measure/causes.hpp"
#include "measure/halves.hpp"
#include "report/comparison.hpp"
#include "session/run.hpp"
#include "session/watcher.hpp"

#include <functional>

namespace catoptric::study {

using namespace session;

/// Receives a picture, and the index of the list entry that the picture shows.
using PictureVisitor = std::function<void(std::size_t entry, const measure::Picture& picture)>;

/// Renders the last frame of the request's first technique, once for each entry of `ablated`, as
/// linear pictures. Each picture is a frame that keeps the history unchanged, after the request's
/// earlier frames. An entry is a sum of causes of error to remove (shared::kAblate...); 0 is the
/// frame itself. From bit shared::kAblateDrawBits on it has the number of the picture's random
/// directions; 0: those of the row. The session shows the request's scene.
void render_ablated(Session& session, const Request& request,
                    const std::vector<std::uint32_t>& ablated, const PictureVisitor& visit,
                    const Watcher& watcher = {});

/// Splits the error of rows that look into captures by cause, against the default reference.
class CauseFinder {
public:
    /// Finds causes of errors in the scene of `base`, which `session` must show. `truth` is the
    /// reference's picture, and `hits` holds what each of its camera rays met (measure/masks.hpp).
    /// `halves` are the two halves of a reference with noise; null for a reference without noise.
    /// All objects passed by reference must outlive the finder.
    CauseFinder(Session& session, const Request& base, const measure::Picture& truth,
                const std::vector<std::uint32_t>& hits, const Watcher& watcher = {},
                const measure::NoisyHalves* halves = nullptr);

    /// Finds how much each cause contributes to the error of `technique`. Five causes share their
    /// joint error by Shapley values, per pixel, from pictures of all 32 sets of ablated causes.
    /// Two causes are taken out before these five: the storage format of distances, then content
    /// that is a frame late. Pixels where rasteriser and ray see different mirrors are taken out
    /// after them. Renders 48 frames, with a dozen rays per mirror pixel in 31 of them. Renders up
    /// to 85 frames if objects move or distances are not stored as 32-bit floats.
    ///
    /// If the reference has noise, a picture with removed causes also has two halves with different
    /// random directions, so that squared errors are unbiased (measure/halves.hpp). Before the five
    /// causes, noise is removed, then the filter of captures. Distance law and lobe shape follow
    /// together and share their error by Shapley values. Renders about 36 times 2
    /// kFramesPerHalf frames, with a dozen rays for each direction of a lobe.
    report::Causes find(const std::string& technique) const;
    /// Frames of each half of a picture of a removed cause, with shared::kAblatedLobeRays
    /// directions for each pixel of a rough mirror.
    static constexpr std::uint32_t kFramesPerHalf = 4;

private:
    double pixel_error(const measure::Picture& a, const measure::Picture& b,
                       std::size_t place) const;

    Session& session_;
    const Request& base_;
    const measure::Picture& truth_;
    const std::vector<std::uint32_t>& hits_;
    Watcher watcher_;
    const measure::NoisyHalves* halves_; ///< null: the reference has no noise
    std::vector<std::size_t> pixels_;    ///< indices of the pixels that show mirrors
    /// For each of `pixels_`: whether the rasteriser draws no mirror, or another mirror than the
    /// one that the camera ray meets.
    std::vector<bool> disagree_;
};

} // namespace catoptric::study
