#pragma once

#include "measure/masks.hpp"
#include "measure/picture.hpp"
#include "scene/default_camera.hpp"
#include "support/device.hpp"
#include "support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::session {

/// Prints a technique as a parameter of a test.
inline void PrintTo(const TechniqueInfo& technique, std::ostream* out) { *out << technique.name; }

} // namespace catoptric::session

/// Functions that render a picture in one call, and that compare two pictures.
namespace test {

/// Returns a request for one measured frame without warm-up, seen by the scene's first camera.
inline session::Request make_test_request(const scene::Scene& scene,
                                          const std::vector<std::string>& techniques, uvec2 size) {
    session::Request asked;
    asked.scene = scene;
    asked.techniques = techniques;
    asked.camera = scene.cameras.empty() ? scene::default_camera(scene) : scene.cameras.front();
    asked.size = size;
    asked.frames = 1, asked.warmup = 0;
    return asked;
}

/// Returns the unit direction from the camera through the centre of pixel (x, y) of a square
/// picture of `edge` pixels.
inline dvec3 camera_direction_of_pixel(const scene::Camera& camera, int x, int y, int edge) {
    const dvec3 forward = glm::normalize(camera.target - camera.eye),
                right = glm::normalize(glm::cross(forward, camera.up)),
                down = glm::cross(forward, right);
    const double tangent = std::tan(glm::radians(camera.vertical_fov_degrees / 2));
    return glm::normalize(forward + tangent * (2 * (x + .5) / edge - 1) * right +
                          tangent * (2 * (y + .5) / edge - 1) * down);
}

inline session::TechniqueResult render_technique(const scene::Scene& scene,
                                                 const std::string& technique, uvec2 size,
                                                 int frames = 1) {
    session::Request asked = make_test_request(scene, {technique}, size);
    asked.warmup = frames - 1;
    return std::move(session::run(get_test_engine(), asked).parts.front());
}

/// Renders `frames` frames of a still scene and returns the last. Only the last frame has the
/// requested size and lookup directions. The earlier frames are small, which saves time: the last
/// frame needs only their captures, which do not depend on the picture's size. Not for face=auto,
/// whose captures do.
inline std::vector<session::TechniqueResult> render_last_frame(const session::Request& asked,
                                                               int frames) {
    session::Session session(get_test_engine(), asked.scene);
    session::FrameSpec early = asked;
    early.model = session::RenderedWork::required; // gives the same pictures in less time
    session::FrameSpec last = early;
    early.size = {16, 16}, early.with_lookup = false;
    for (int k = 1; k < frames; ++k) session.frame(early);
    return session.frame(last).read_all();
}

/// Returns "name:knob=value,..." with those of the settings for which the technique has a knob.
inline std::string
technique_with_knobs(const session::TechniqueInfo& technique,
                     const std::vector<std::pair<std::string, std::string>>& settings) {
    std::string text = technique.name;
    char separator = ':';
    for (const auto& [knob, value] : settings) {
        if (std::ranges::find(technique.knobs, knob, &session::KnobInfo::name) ==
            technique.knobs.end())
            continue;
        text += separator + knob + "=" + value;
        separator = ',';
    }
    return text;
}

inline double rmse_of_pictures(const measure::Picture& a, const measure::Picture& b,
                               const measure::Mask& mask = {}) {
    const std::vector<float> no_flip(a.pixels.size(), 0.0f);
    const measure::Difference difference = measure::difference(a, b, mask, no_flip);
    EXPECT_EQ(difference.nonfinite, 0u);
    return difference.rmse;
}

inline bool have_equal_pixel_bytes(const measure::Picture& a, const measure::Picture& b) {
    return a.width == b.width && a.height == b.height &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(vec3)) == 0;
}

/// Returns how many pixels of the picture are not finite numbers.
inline std::size_t count_nonfinite(const measure::Picture& picture) {
    return static_cast<std::size_t>(std::ranges::count_if(picture.pixels, [](const vec3& c) {
        return !(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z));
    }));
}

} // namespace test
