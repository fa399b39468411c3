#pragma once

#include "measure/picture.hpp"
#include "session/session.hpp"

#include <memory>
#include <optional>

namespace catoptric::view {

/// The ray-traced reference picture, which improves with each pass while nothing changes. If all
/// mirrors are sharp, the first pass traces one ray through each pixel's centre, and errors are
/// measured against this pass, as in `compare`. Further passes are averaged, for display. In a
/// scene with rough surfaces each further pass draws rays from their lobes, and errors are measured
/// against the mean of these passes, whose noise they include.
class ProgressiveReference {
public:
    static constexpr int kMaxPasses = 64;

    void restart() { *this = {}; }
    /// Renders one more pass outside the session's frame sequence and waits for it. `spec` is that
    /// of the live frame. Returns false if no further pass is needed.
    bool render_pass(session::Session& session, const session::FrameSpec& spec);
    int pass_count() const { return passes_; }
    /// Returns whether errors can be measured: after a pass, or after 16 if passes have noise.
    bool can_measure_errors() const { return has_noise_ ? passes_ > 16 : passes_ > 0; }
    /// Returns the picture as the screen shows it; null before the first pass.
    std::shared_ptr<const measure::Picture> displayed_picture() const { return display_; }
    /// Returns the errors of a live picture over mirror pixels. Needs can_measure_errors().
    /// Costs one FLIP.
    measure::Difference compare(const measure::Picture& hdr, double exposure) const;

private:
    void add_pass(const measure::Picture& picture, double exposure);

    int passes_ = 0;
    bool has_noise_ = false;  ///< whether passes draw random rays
    measure::Picture judged_; ///< the picture against which errors are measured
    measure::Picture sum_;    ///< sum of the passes after the first
    int summed_ = 0;          ///< number of pictures in `sum_`
    std::vector<std::uint32_t> hits_;
    std::shared_ptr<const measure::Picture> display_;
};

/// Returns what camera rays meet first (session::TechniqueResult::hits), by a frame outside the
/// session's sequence.
std::vector<std::uint32_t> render_mirror_hits(session::Session& session,
                                              const session::FrameSpec& spec);

} // namespace catoptric::view
