#pragma once
// The library is built with GLM's packed types. A program may set all other options of GLM.
#ifdef GLM_FORCE_DEFAULT_ALIGNED_GENTYPES
#error "catoptric: wanted GLM's packed types, found GLM_FORCE_DEFAULT_ALIGNED_GENTYPES"
#endif
#include <glm/glm.hpp>

#include <limits>

namespace catoptric {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// An axis-aligned box. A new box is empty (`lo > hi`), and `add` enlarges the box.
template <typename Real>
struct Bounds {
    using Vec = glm::vec<3, Real>;
    Vec lo{std::numeric_limits<Real>::infinity()};
    Vec hi{-std::numeric_limits<Real>::infinity()};

    bool operator==(const Bounds&) const = default;
    void add(const Vec& point) { lo = glm::min(lo, point), hi = glm::max(hi, point); }
    void add(const Bounds& other) { lo = glm::min(lo, other.lo), hi = glm::max(hi, other.hi); }
    bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
    Vec centre() const { return (lo + hi) * Real(0.5); }
    Vec extent() const { return hi - lo; }
    /// Returns the surface area; 0 for an empty box.
    Real area() const {
        if (empty()) return 0;
        const Vec e = extent();
        return 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
    }
};

} // namespace catoptric
