#pragma once

#include "app/engine.hpp"
#include "report/comparison.hpp"

namespace catoptric::app {

/// Splits the error of rows that look into captures by cause, against the default reference.
class CauseFinder {
public:
    /// `truth`: the reference's picture, `hits`: what its camera rays met (see measure/masks.hpp).
    /// `base` and what the references lead to must outlive this.
    CauseFinder(Engine& engine, const Request& base, const measure::Picture& truth,
                const std::vector<std::uint32_t>& hits);

    /// A chain of renderings in a fixed order, each with one more cause mended, and one for each
    /// cause alone. Takes about 15 frames and two times as many rays as that many pictures have
    /// mirror pixels.
    report::Causes find(const std::string& technique) const;

private:
    Engine& engine_;
    const Request& base_;
    const measure::Picture& truth_;
    const std::vector<std::uint32_t>& hits_;
    std::uint32_t mirrors_ = 0;
    std::vector<std::uint32_t>
        drawn_; ///< number of the mirror that the rasteriser draws at each pixel
};

} // namespace catoptric::app
