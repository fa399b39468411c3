#pragma once

#include <optional>
#include <string>
#include <vector>

/// A row's error by cause: what goes when one thing after another is replaced by the reference's
/// own.
namespace catoptric::measure {

/// Squared errors are means over mirror pixels and channels, linear, both pictures clamped to
/// [0,1]; entry n-1 of a vector is mirror n. What goes is negative where mending one thing uncovers
/// another's error.
struct Cause {
    std::string name;
    double in_turn = 0; ///< what goes when this is mended after all causes before it
    double alone = 0;   ///< what goes when this is mended first
    std::vector<double> in_turn_per_mirror, alone_per_mirror;
};

struct Causes {
    double squared_error = 0; ///< of the row itself
    std::vector<double> squared_error_per_mirror;
    std::vector<Cause> list; ///< in the order of mending
    double rest_rmse = 0;    ///< when all is mended: near 0 where no cause is missing
    /// Share of the squared error in pixels that looked within a texel of a light's outline, 0..1.
    double at_light_edges = 0;
};

} // namespace catoptric::measure
