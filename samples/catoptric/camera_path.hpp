#pragma once

#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

constexpr double kFramesPerSecond = 60; ///< frame rate of motions, as in app::Request::instant

/// The camera at a time, in seconds after the start of a camera path.
struct CameraKey {
    double seconds = 0;
    scene::Camera camera;
};

/// Smooth motion of a camera through keys, for `render --camera-path`.
class CameraPath {
public:
    /// `keys`: at least two keys, with ascending times. All cameras are perspective, or all are
    /// orthographic.
    explicit CameraPath(std::vector<CameraKey> keys) : keys_(std::move(keys)) {}

    /// Returns the time from the first key to the last, in seconds.
    double duration() const { return keys_.back().seconds - keys_.front().seconds; }
    /// Returns the camera `seconds` after the first key; after the last key, that of the last key.
    /// Eye, target, up and angle of view are cubic Hermite splines through the keys, with the
    /// tangents of Catmull and Rom for keys at unequal distances in time. Two keys give a straight
    /// line. Angle of view and orthographic height stay between those of the two keys around.
    scene::Camera camera_after(double seconds) const;
    /// Checks the frames of the path, which are 1/60 s apart. Throws `bad_data`, with `file` as the
    /// place, if in one of the frames the camera stands at its target or looks along its up vector.
    void check_frames(int frames, const std::string& file) const;

private:
    std::vector<CameraKey> keys_;
};

/// Reads a path from a JSON file of at most 16 MiB: {"keys": [{"time": seconds, "camera": text}]}.
/// The text is one that --camera takes, but not `seeded`. Throws `missing_input`, `io` and
/// `bad_data` with the place, the wanted and the found value; also for a camera that a node of the
/// scene carries.
CameraPath read_camera_path(const std::string& file, const scene::Scene& scene);

} // namespace catoptric::cli
