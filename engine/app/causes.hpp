#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"
#include "report/comparison.hpp"

#include <functional>

namespace catoptric::app {

/// Told of a picture, and which entry of the list that was asked for it shows.
using VisitPicture = std::function<void(std::size_t entry, const measure::Picture& picture)>;

/// Linear pictures of the first technique in a request's last frame, beside the sequence of those
/// before it: one for each entry of `mended`, a sum of causes of error to take away
/// (shared::kMend...; 0: the frame itself). The session shows the request's scene.
void last_pictures(Session& session, const Request& request,
                   const std::vector<std::uint32_t>& ablated, const VisitPicture& visit,
                   const Watcher& watcher = {});

/// Splits the error of rows that look into captures by cause, against the default reference.
class CauseFinder {
public:
    /// `truth`: the reference's picture, `hits`: what its camera rays met (see measure/masks.hpp).
    /// The session shows the base's scene. It, `base` and what the references lead to must outlive
    /// this.
    CauseFinder(Session& session, const Request& base, const measure::Picture& truth,
                const std::vector<std::uint32_t>& hits, const Watcher& watcher = {});

    /// Five causes share what they make together by Shapley, pixel by pixel, from the pictures of
    /// every set of them mended: 32. Before them goes what distances lose in storage, then what is
    /// a frame late; after them pixels where rasteriser and ray see different mirrors. Takes 48
    /// frames and a dozen rays a mirror pixel in 31 of them; up to 85 where something moves or
    /// distances are no 32-bit floats.
    report::Causes find(const std::string& technique) const;

private:
    Session& session_;
    const Request& base_;
    const measure::Picture& truth_;
    const std::vector<std::uint32_t>& hits_;
    Watcher watcher_;
    std::vector<std::size_t> pixels_; ///< of mirrors
    /// Of `pixels_`: the rasteriser draws another mirror there than the ray meets, or none.
    std::vector<bool> disagree_;
};

} // namespace catoptric::app
