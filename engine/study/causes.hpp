#pragma once

#include "measure/causes.hpp"
#include "report/comparison.hpp"
#include "session/run.hpp"
#include "session/watcher.hpp"

#include <functional>

namespace catoptric::app {

/// Receives a picture, and the index of the list entry that the picture shows.
using PictureVisitor = std::function<void(std::size_t entry, const measure::Picture& picture)>;

/// Renders the last frame of the request's first technique, once for each entry of `ablated`, as
/// linear pictures. Each picture is a frame that keeps the history unchanged, after the request's
/// earlier frames. An entry is a sum of causes of error to remove (shared::kAblate...); 0 is the
/// frame itself. The session shows the request's scene.
void render_ablated_pictures(Session& session, const Request& request,
                             const std::vector<std::uint32_t>& ablated, const PictureVisitor& visit,
                             const Watcher& watcher = {});

/// Splits the error of rows that look into captures by cause, against the default reference.
class ErrorCauseFinder {
public:
    /// `truth`: the reference's picture. `hits`: what its camera rays met (see measure/masks.hpp).
    /// The session must show the scene of `base`. All objects passed by reference must outlive the
    /// finder.
    ErrorCauseFinder(Session& session, const Request& base, const measure::Picture& truth,
                     const std::vector<std::uint32_t>& hits, const Watcher& watcher = {});

    /// Finds how much each cause contributes to the error of `technique`. Five causes share their
    /// joint error by Shapley values, per pixel, from pictures of all 32 sets of ablated causes.
    /// Two causes are taken out before these five: the storage format of distances, then content
    /// that is a frame late. Pixels where rasteriser and ray see different mirrors are taken out
    /// after them. Renders 48 frames, with a dozen rays per mirror pixel in 31 of them. Renders up
    /// to 85 frames if objects move or distances are not stored as 32-bit floats.
    report::Causes find(const std::string& technique) const;

private:
    Session& study_session_;
    const Request& base_;
    const measure::Picture& truth_;
    const std::vector<std::uint32_t>& hits_;
    Watcher watcher_;
    std::vector<std::size_t> pixels_; ///< indices of the pixels that show mirrors
    /// For each of `pixels_`: whether the rasteriser draws no mirror, or another mirror than the
    /// one that the camera ray meets.
    std::vector<bool> disagree_;
};

} // namespace catoptric::app
