#pragma once

#include "core/byte_source.hpp"
#include "core/math.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace catoptric {

/// What the header of a Radiance picture (.hdr) says of its pixels (Ward, "Real Pixels", and the
/// file formats of Radiance).
struct RadianceHeader {
    uvec2 stored{0};            ///< pixels in a stored line, and stored lines
    bool is_transposed = false; ///< stored lines are columns of the picture
    bool starts_right = false, starts_below = false;
    /// What a stored value of red, green and blue must be multiplied by: one over the product of
    /// all EXPOSURE and COLORCORR.
    std::array<double, 3> factor{1, 1, 1};

    uvec2 size() const { return is_transposed ? uvec2(stored.y, stored.x) : stored; }
    /// Returns whether rows are stored as the picture shows them, from the top.
    bool has_usual_order() const { return !is_transposed && !starts_right && !starts_below; }
    /// Returns all pixels of three values, by rows from the top, of the stored ones.
    std::vector<float> turn(std::span<const float> stored_values) const;
    void scale(std::span<float> values) const;
};

/// Throws `bad_data` for a header that cannot be read, for colours in XYZ, and if fewer bytes
/// follow than its lines take.
RadianceHeader read_radiance_header(const ByteSource& bytes, const std::string& name);

} // namespace catoptric
