#include "core/error.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catoptric::scene {

namespace {

dvec3 offset_at(const std::monostate&, double) { return dvec3(0); }

dvec3 offset_at(const Harmonic& motion, double seconds) {
    // 1 - cos(a) = 2 sin^2(a/2), which keeps its digits near zero; the remainder is exact
    const double phase = std::remainder(seconds, motion.period) / motion.period;
    const double sine = std::sin(std::numbers::pi * phase);
    return motion.amplitude * (2 * sine * sine);
}

/// Time within [0, last key]: after the last key everything starts again at 0.
double wrapped(const Keys& keys, double seconds) {
    const double end = keys.times.back();
    if (!(end > 0) || (seconds >= 0 && seconds <= end)) return seconds;
    const double rest = std::fmod(seconds, end);
    return rest < 0 ? rest + end : rest;
}

/// glTF 2.0 appendix C, with s from 0 to 1 in an interval of td seconds: p = (2s^3 - 3s^2 + 1) v_k
/// + td (s^3 - 2s^2 + s) b_k + (-2s^3 + 3s^2) v_k+1 + td (s^3 - s^2) a_k+1
dvec3 hermite(const dvec3& value, const dvec3& out_tangent, const dvec3& next,
              const dvec3& in_tangent, double s, double interval) {
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * value + interval * (s3 - 2 * s2 + s) * out_tangent +
           (3 * s2 - 2 * s3) * next + interval * (s3 - s2) * in_tangent;
}

dvec3 offset_at(const Keyframes& motion, double seconds) {
    if (motion.keys == nullptr || motion.keys->times.empty()) return dvec3(0);
    const Keys& keys = *motion.keys;
    const auto value = [&](std::size_t k) {
        return motion.world_from_keys * (keys.values[k] - motion.rest);
    };
    const double time = wrapped(keys, seconds);
    const auto after = std::ranges::upper_bound(keys.times, time);
    if (after == keys.times.begin()) return value(0);
    if (after == keys.times.end()) return value(keys.values.size() - 1);
    const std::size_t k = static_cast<std::size_t>(after - keys.times.begin()) - 1;
    const double interval = keys.times[k + 1] - keys.times[k];
    const double s = (time - keys.times[k]) / interval;
    switch (keys.interpolation) {
    case Keys::Interpolation::step: return value(k);
    case Keys::Interpolation::linear: return glm::mix(value(k), value(k + 1), s);
    case Keys::Interpolation::cubic:
        return hermite(value(k), motion.world_from_keys * keys.out_tangents[k], value(k + 1),
                       motion.world_from_keys * keys.in_tangents[k + 1], s, interval);
    }
    return dvec3(0);
}

double period_of(const std::monostate&) { return 0; }
double period_of(const Harmonic& motion) { return motion.period; }
double period_of(const Keyframes& motion) {
    const bool is_still = motion.keys == nullptr || motion.keys->times.empty();
    return is_still ? 0 : std::max(motion.keys->times.back(), 0.0);
}

} // namespace

Keys in_the_world(const Keyframes& motion) {
    Keys keys = motion.keys ? *motion.keys : Keys();
    for (dvec3& value : keys.values) value = motion.world_from_keys * (value - motion.rest);
    for (dvec3& tangent : keys.in_tangents) tangent = motion.world_from_keys * tangent;
    for (dvec3& tangent : keys.out_tangents) tangent = motion.world_from_keys * tangent;
    return keys;
}

double period(const Scene& scene) {
    double longest = 0;
    for (const Object& object : scene.objects)
        longest = std::max(longest, std::visit([](const auto& motion) { return period_of(motion); },
                                               object.motion));
    return longest;
}

Scene at(const Scene& scene, double seconds) {
    check(std::isfinite(seconds), Failure::usage, "time: wanted a finite number of seconds, found ",
          seconds);
    Scene still = scene;
    for (Object& object : still.objects) {
        const auto offset_of = [&](const auto& motion) { return offset_at(motion, seconds); };
        const dvec3 offset = std::visit(offset_of, object.motion);
        object.world_from_object[3] += dvec4(offset, 0);
        if (object.sphere) object.sphere->centre += offset;
        object.motion = std::monostate();
    }
    return still;
}

} // namespace catoptric::scene
