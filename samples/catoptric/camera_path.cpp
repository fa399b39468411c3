#include "camera_path.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "report/json.hpp"
#include "scene/camera_named.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>

namespace catoptric::cli {

namespace {

using PathJson = report::Json;

constexpr std::uintmax_t kMaxPathFileBytes = 16U << 20U;
constexpr const char* kViewsSchema = "catoptric/views/1";

/// Throws `bad_data` if the camera stands at its target or looks along its up vector.
void check_direction(const scene::Camera& camera, const std::string& place) {
    const dvec3 along = camera.target - camera.eye;
    const double sine = glm::length(glm::cross(along, camera.up)) /
                        (glm::length(along) * glm::length(camera.up));
    check(sine > 1e-6, Failure::bad_data, place,
          ": wanted a camera that looks to a target beside its up axis, found ",
          scene::format_camera(camera),
          fmt::format(" with the up axis {},{},{}", camera.up.x, camera.up.y, camera.up.z));
}

dvec3 read_point(const PathJson& point, const std::string& place) {
    const bool is_point = point.is_array() && point.size() == 3 &&
                          std::ranges::all_of(point, &PathJson::is_number);
    check(is_point, Failure::bad_data, place, ": wanted a list of three numbers, found ",
          report::describe(point));
    return {point[0].get<double>(), point[1].get<double>(), point[2].get<double>()};
}

/// Returns a number from above 0 to `high`.
double read_positive(const PathJson& number, double high, const std::string& place) {
    check(number.is_number() && number > 0 && number <= high, Failure::bad_data, place,
          ": wanted a number above 0 and at most ", high, ", found ", report::describe(number));
    return number.get<double>();
}

/// Returns a camera as report::camera_json writes it.
scene::Camera read_view_camera(const PathJson& json, const std::string& place) {
    check(json.is_object(), Failure::bad_data, place, ": wanted an object, found ",
          report::describe(json));
    const auto member = [&](const char* name) { return json.value(name, PathJson()); };
    scene::Camera camera;
    camera.eye = read_point(member("eye"), place + ".eye");
    camera.target = read_point(member("target"), place + ".target");
    camera.up = read_point(member("up"), place + ".up");
    if (const PathJson height = member("orthographic_height"); !height.is_null())
        camera.orthographic_height = read_positive(height, 1e30, place + ".orthographic_height");
    else
        camera.vertical_fov_degrees = read_positive(member("vertical_fov_degrees"), 179,
                                                    place + ".vertical_fov_degrees");
    check_direction(camera, place);
    return camera;
}

/// Reads the views of a document that `catoptric views` wrote.
std::vector<CameraKey> read_views(const PathJson& document, const std::string& file) {
    const PathJson schema = document.value("schema", PathJson());
    check(schema == kViewsSchema, Failure::bad_data, file, ": wanted the schema ", kViewsSchema,
          " of a file with 'views', found ", report::describe(schema));
    const PathJson& list = document["views"];
    check(list.is_array() && !list.empty(), Failure::bad_data, file,
          ": wanted at least one view in 'views', found ",
          list.is_array() ? "none" : report::describe(list));
    std::vector<CameraKey> views;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string place = file + ": views[" + std::to_string(i) + "]";
        check(list[i].is_object(), Failure::bad_data, place, ": wanted an object, found ",
              report::describe(list[i]));
        const PathJson time = list[i].value("time", PathJson());
        check(time.is_number() && time >= -1e6 && time <= 1e6, Failure::bad_data, place,
              ".time: wanted seconds from -1e6 to 1e6, found ", report::describe(time));
        views.push_back({time.get<double>(),
                         read_view_camera(list[i].value("camera", PathJson()), place + ".camera")});
        if (const PathJson name = list[i].value("name", PathJson()); name.is_string())
            views.back().camera.name = name.get<std::string>();
    }
    return views;
}

CameraKey read_camera_key(const PathJson& key, const std::string& place,
                          const scene::Scene& scene) {
    check(key.is_object(), Failure::bad_data, place, ": wanted an object, found ",
          report::describe(key));
    for (const auto& [name, value] : key.items())
        check(name == "time" || name == "camera", Failure::bad_data, place,
              ": wanted time and camera, found '", name, "'");
    const PathJson time = key.value("time", PathJson()), camera = key.value("camera", PathJson());
    check(time.is_number() && time >= 0 && time <= 1e6, Failure::bad_data, place,
          ".time: wanted seconds from 0 to 1e6, found ", report::describe(time));
    check(camera.is_string(), Failure::bad_data, place,
          ".camera: wanted the text of a camera as in --camera, found ", report::describe(camera));
    check(camera != "seeded", Failure::bad_data, place,
          ".camera: wanted a camera of the scene or numbers, found 'seeded'");
    CameraKey result{time.get<double>(),
                     scene::find_camera(camera.get<std::string>(), scene,
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
        const double seconds = frame / kFramesPerSecond;
        std::ostringstream place;
        place << file << ": after " << seconds << " s";
        check_direction(camera_after(seconds), place.str());
    }
}

double FrameCameras::frame_count() const {
    if (!path_) return static_cast<double>(views_.size());
    // The last frame shows the last key. A tiny amount is subtracted, because the decimal number of
    // seconds may be rounded up.
    return std::ceil(path_->duration() * kFramesPerSecond - 1e-6) + 1;
}

const CameraKey& FrameCameras::view_of(int number) const {
    const auto index = static_cast<std::size_t>(std::max(number, 1) - 1);
    return views_[std::min(index, views_.size() - 1)];
}

scene::Camera FrameCameras::camera_of(int number) const {
    return path_ ? path_->camera_after((number - 1) / kFramesPerSecond) : view_of(number).camera;
}

void FrameCameras::check_frames(int last, const std::string& file) const {
    if (path_) {
        const double whole = std::min(frame_count(), double(std::numeric_limits<int>::max()));
        return path_->check_frames(std::min(last, static_cast<int>(whole)), file);
    }
    check(static_cast<std::size_t>(last) <= views_.size(), Failure::bad_data, file, ": wanted ",
          last, " views, one for each frame of --frames, found ", views_.size());
}

namespace {

CameraPath read_key_path(const PathJson& document, const std::string& file,
                         const scene::Scene& scene) {
    const PathJson list = document.is_object() ? document.value("keys", PathJson()) : PathJson();
    check(list.is_array() && list.size() >= 2, Failure::bad_data, file,
          ": wanted an object with at least two 'keys', found ",
          list.is_array() ? std::to_string(list.size())
                          : report::describe(document.is_object() ? list : document));
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

} // namespace

FrameCameras read_frame_cameras(const std::string& file, const scene::Scene& scene) {
    const auto document = parse_json<PathJson>(
        file, read_json_text(file, "a camera path", kMaxPathFileBytes));
    if (document.is_object() && document.contains("views"))
        return FrameCameras(read_views(document, file));
    return FrameCameras(read_key_path(document, file, scene));
}

} // namespace catoptric::cli
