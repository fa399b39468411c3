#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::cli {

constexpr double kFramesPerSecond = 60; ///< frame rate of motions, as in session::Request::instant

/// The camera at a time: seconds after the start of a camera path, or of the scene's motion.
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

/// The camera of each frame of `render --camera-path`, from a file of keys or of views.
class FrameCameras {
public:
    /// The cameras along a path: frame n shows the camera (n - 1) / 60 s after the first key.
    /// Frames below 1 show the first key.
    explicit FrameCameras(CameraPath path) : path_(std::move(path)) {}
    /// A camera and an instant for each frame: frame n shows the n-th view. Frames below 1 show the
    /// first view, and frames after the last view show the last. `views`: at least one.
    explicit FrameCameras(std::vector<CameraKey> views) : views_(std::move(views)) {}

    /// Returns how many frames show the whole file. May exceed all integers.
    double frame_count() const;
    /// Returns whether the file has an instant of the scene's motion for each frame.
    bool has_instants() const { return !path_; }
    scene::Camera camera_of(int number) const;
    /// Returns the instant of frame `number`, in seconds; only with `has_instants`.
    double instant_of(int number) const { return view_of(number).seconds; }
    /// Checks frames 1 to `last`. Throws `bad_data`, with `file` as the place, if there are fewer
    /// views, and as CameraPath::check_frames does.
    void check_frames(int last, const std::string& file) const;

private:
    const CameraKey& view_of(int number) const;

    std::optional<CameraPath> path_;
    std::vector<CameraKey> views_; ///< instant and camera of each frame, if there is no path
};

/// Reads the cameras from a JSON file of at most 16 MiB: a path of keys, {"keys": [{"time":
/// seconds, "camera": text}]}, or the views.json of `catoptric views`. The text is one that
/// --camera takes, but not `seeded`. Throws `missing_input`, `io` and `bad_data` with the place,
/// the wanted and the found value; also for a camera that a node of the scene carries.
FrameCameras read_frame_cameras(const std::string& file, const scene::Scene& scene);

} // namespace catoptric::cli
