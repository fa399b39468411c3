#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"
#include "report/comparison.hpp"

namespace catoptric::app {

/// Linear pictures of the first technique in a request's last frame: its own, then beside it one
/// for each entry of `mended`, a sum of causes of error to take away (shared::kMend...). The
/// session shows the request's scene.
std::vector<measure::Picture> last_pictures(Session& session, const Request& request,
                                            const std::vector<std::uint32_t>& mended,
                                            const Watcher& watcher = {});

/// Splits the error of rows that look into captures by cause, against the default reference.
class CauseFinder {
public:
    /// `truth`: the reference's picture, `hits`: what its camera rays met (see measure/masks.hpp).
    /// The session shows the base's scene. It, `base` and what the references lead to must outlive
    /// this.
    CauseFinder(Session& session, const Request& base, const measure::Picture& truth,
                const std::vector<std::uint32_t>& hits, const Watcher& watcher = {});

    /// A chain of renderings in a fixed order, each with one more cause mended, and one for each
    /// cause alone. Takes about 15 frames and two times as many rays as that many pictures have
    /// mirror pixels.
    report::Causes find(const std::string& technique) const;

private:
    Session& session_;
    const Request& base_;
    const measure::Picture& truth_;
    const std::vector<std::uint32_t>& hits_;
    Watcher watcher_;
    std::uint32_t mirrors_ = 0;
    std::vector<std::uint32_t>
        drawn_; ///< number of the mirror that the rasteriser draws at each pixel
};

} // namespace catoptric::app
