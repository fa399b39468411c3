#pragma once

#include "core/math.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace test {

using catoptric::vec3;

/// A random number generator (SplitMix64) that is fast and gives the same numbers on every machine.
class RandomNumbers {
public:
    explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}
    std::uint32_t random_word() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
    }
    /// Returns a number in [0, 1) that is a multiple of 2^-24.
    float random_unit_fraction() { return static_cast<float>(random_word() >> 8) * 0x1p-24f; }
    float random_number_between(float lo, float hi) {
        return lo + (hi - lo) * random_unit_fraction();
    }
    std::size_t random_integer_below(std::size_t count) {
        return static_cast<std::size_t>((std::uint64_t{random_word()} * count) >> 32);
    }
    vec3 random_point_in_cube() {
        const float x = random_number_between(-1, 1), y = random_number_between(-1, 1);
        return {x, y, random_number_between(-1, 1)};
    }
    vec3 random_unit_direction() {
        for (;;) {
            const vec3 v = random_point_in_cube();
            const float size = glm::length(v);
            if (size > 0.1f && size <= 1) return v / size;
        }
    }
    /// Returns a number of random sign with a magnitude of 10^low to 10^high, uniform in the
    /// exponent.
    float random_log_uniform_number(float low, float high) {
        const float size = std::pow(10.0f, random_number_between(low, high));
        return random_word() % 2 == 0 ? size : -size;
    }
    /// Returns the barycentric weights of a random point, uniform over the triangle.
    vec3 random_barycentric_weights() {
        const float s = std::sqrt(random_unit_fraction()), r = random_unit_fraction();
        return {1 - s, s * (1 - r), s * r};
    }

private:
    std::uint64_t state_;
};

} // namespace test
