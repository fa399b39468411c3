#include "camera_path.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "report/json.hpp"
#include "scene/camera_named.hpp"

#include <algorithm>
#include <cstdint>

namespace catoptric::cli {

namespace {

using PathJson = report::Json;

constexpr std::uintmax_t kMaxPathFileBytes = 16U << 20U;

CameraKey read_camera_key(const PathJson& key, const std::string& place,
                          const scene::Scene& scene) {
    check(key.is_object(), Failure::bad_data, place, ": wanted an object, found ",
          report::describe_json_value(key));
    for (const auto& [name, value] : key.items())
        check(name == "time" || name == "camera", Failure::bad_data, place,
              ": wanted time and camera, found '", name, "'");
    const PathJson time = key.value("time", PathJson()), camera = key.value("camera", PathJson());
    check(time.is_number() && time >= 0 && time <= 1e6, Failure::bad_data, place,
          ".time: wanted seconds from 0 to 1e6, found ", report::describe_json_value(time));
    check(camera.is_string(), Failure::bad_data, place,
          ".camera: wanted the text of a camera as in --camera, found ",
          report::describe_json_value(camera));
    check(camera != "seeded", Failure::bad_data, place,
          ".camera: wanted a camera of the scene or numbers, found 'seeded'");
    CameraKey result{time.get<double>(),
                     scene::find_camera_by_name(camera.get<std::string>(), scene,
                                                {place + ".camera", Failure::bad_data})};
    check(result.camera.follows == scene::RigAttachment(), Failure::bad_data, place,
          ".camera: wanted a camera that stands still, found '", result.camera.name,
          "', which a node of the scene carries");
    return result;
}

/// Returns how fast a value changes at key `i`, per second.
template <typename Value>
Value find_tangent(const std::vector<CameraKey>& keys, std::size_t i,
                   Value scene::Camera::*member) {
    const CameraKey& before = keys[i == 0 ? 0 : i - 1];
    const CameraKey& after = keys[std::min(i + 1, keys.size() - 1)];
    return (after.camera.*member - before.camera.*member) / (after.seconds - before.seconds);
}

} // namespace

scene::Camera CameraPath::camera_after(double seconds) const {
    // After the last key, its camera is returned without rounding.
    if (seconds >= duration()) return keys_.back().camera;
    const double time = keys_.front().seconds + std::clamp(seconds, 0.0, duration());
    const auto next = std::ranges::upper_bound(keys_, time, {}, &CameraKey::seconds);
    const std::size_t to = std::min<std::size_t>(static_cast<std::size_t>(next - keys_.begin()),
                                                 keys_.size() - 1),
                      from = to - 1;
    const double span = keys_[to].seconds - keys_[from].seconds,
                 t = (time - keys_[from].seconds) / span;
    scene::Camera camera = keys_[from].camera;
    const auto interpolate = [&](auto member) {
        const auto a = keys_[from].camera.*member, b = keys_[to].camera.*member;
        const auto slope_a = find_tangent(keys_, from, member) * span,
                   slope_b = find_tangent(keys_, to, member) * span;
        const auto change = b - a;
        // The spline is written as a + (...) and not by the four Hermite polynomials, because this
        // form is exact at both keys.
        camera.*member = t == 1 ? b
                                : a + t * (slope_a + t * (3.0 * change - 2.0 * slope_a - slope_b +
                                                          t * (slope_a + slope_b - 2.0 * change)));
    };
    interpolate(&scene::Camera::eye);
    interpolate(&scene::Camera::target);
    interpolate(&scene::Camera::up);
    interpolate(&scene::Camera::vertical_fov_degrees);
    interpolate(&scene::Camera::orthographic_height);
    // Between two keys, a spline may leave the range of the two values, so the value is clamped to
    // the range.
    const auto [low, high] = std::minmax(keys_[from].camera.vertical_fov_degrees,
                                         keys_[to].camera.vertical_fov_degrees);
    camera.vertical_fov_degrees = std::clamp(camera.vertical_fov_degrees, low, high);
    const auto [least, most] = std::minmax(keys_[from].camera.orthographic_height,
                                           keys_[to].camera.orthographic_height);
    camera.orthographic_height = std::clamp(camera.orthographic_height, least, most);
    return camera;
}

void CameraPath::check_frames(int frames, const std::string& file) const {
    for (int frame = 0; frame < frames; ++frame) {
        const scene::Camera camera = camera_after(frame / kFramesPerSecond);
        const dvec3 along = camera.target - camera.eye;
        const double sine = glm::length(glm::cross(along, camera.up)) /
                            (glm::length(along) * glm::length(camera.up));
        check(sine > 1e-6, Failure::bad_data, file, ": after ", frame / kFramesPerSecond,
              " s, wanted a camera that looks to a target beside its up axis, found ",
              scene::format_camera(camera));
    }
}

CameraPath read_camera_path(const std::string& file, const scene::Scene& scene) {
    const auto document = parse_json<PathJson>(
        file, read_json_text(file, "a camera path", kMaxPathFileBytes));
    const PathJson list = document.is_object() ? document.value("keys", PathJson()) : PathJson();
    check(list.is_array() && list.size() >= 2, Failure::bad_data, file,
          ": wanted an object with at least two 'keys', found ",
          list.is_array() ? std::to_string(list.size())
                          : report::describe_json_value(document.is_object() ? list : document));
    for (const auto& [name, value] : document.items())
        check(name == "keys", Failure::bad_data, file, ": wanted only 'keys', found '", name, "'");
    std::vector<CameraKey> keys;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string place = file + ": keys[" + std::to_string(i) + "]";
        CameraKey key = read_camera_key(list[i], place, scene);
        if (i > 0) {
            check(key.seconds > keys.back().seconds, Failure::bad_data, place,
                  ".time: wanted more than ", keys.back().seconds, ", found ", key.seconds);
            check((key.camera.orthographic_height > 0) ==
                      (keys.back().camera.orthographic_height > 0),
                  Failure::bad_data, place,
                  ".camera: wanted all cameras perspective or all orthographic, found both");
        }
        keys.push_back(std::move(key));
    }
    return CameraPath(std::move(keys));
}

} // namespace catoptric::cli
