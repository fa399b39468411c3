#pragma once

#include "app/session.hpp"
#include "measure/difference.hpp"

#include <memory>
#include <optional>

namespace catoptric::view {

/// The traced picture, better from pass to pass while nothing changes: first one ray through each
/// pixel's centre, against which errors are figured as compare does, then more of them on average.
class Reference {
public:
    static constexpr int kMostPasses = 64;

    void reset() { *this = {}; }
    /// Renders one pass more beside the session's frames; waits for it. `spec`: of the live frame.
    /// False: it is as good as it gets.
    bool advance(app::Session& session, const app::FrameSpec& spec);
    int passes() const { return passes_; }
    /// As the screen shows it; null before the first pass.
    std::shared_ptr<const measure::Picture> display() const { return display_; }
    /// Of a live picture, over mirror pixels, after the first pass. Costs a FLIP.
    measure::Difference judge(const measure::Picture& hdr, double exposure) const;

private:
    int passes_ = 0;
    measure::Picture centre_, sum_;
    std::vector<std::uint32_t> hits_;
    std::shared_ptr<const measure::Picture> display_;
};

/// What camera rays meet first (app::Part::hits), by a frame beside the session's.
std::vector<std::uint32_t> hits_of(app::Session& session, const app::FrameSpec& spec);

} // namespace catoptric::view
