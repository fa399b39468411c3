#pragma once
// The library is built with GLM's packed types. A program may set all other options of GLM.
#ifdef GLM_FORCE_DEFAULT_ALIGNED_GENTYPES
#error "catoptric: wanted GLM's packed types, found GLM_FORCE_DEFAULT_ALIGNED_GENTYPES"
#endif
#include <glm/glm.hpp>

#include <limits>

namespace catoptric {

using glm::dmat3, glm::dmat4, glm::dvec2, glm::dvec3, glm::dvec4, glm::ivec2, glm::mat4;
using glm::uvec2, glm::uvec3, glm::vec2, glm::vec3, glm::vec4;

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
};

} // namespace catoptric
