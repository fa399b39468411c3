#include "scene/camera_named.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "scene/number.hpp"

#include <algorithm>

namespace catoptric::scene {

namespace {

double parse_camera_number(const std::string& text, const SettingOrigin& by) {
    const std::optional<double> value = parse_number(text);
    check(value.has_value(), by.failure, by.where, ": wanted a finite number, found ", quote(text));
    return *value;
}

double parse_number_within(const std::string& text, double low, double high,
                           const SettingOrigin& by) {
    const std::optional<double> value = parse_number(text);
    check(value && *value >= low && *value <= high, by.failure, by.where,
          ": wanted a finite number from ", low, " to ", high, ", found ", quote(text));
    return *value;
}

dvec3 parse_point(const std::string& text, const SettingOrigin& by) {
    const std::vector<std::string> parts = split(text, ",");
    check(parts.size() == 3, by.failure, by.where, ": wanted a point X,Y,Z, found ", quote(text));
    return {parse_camera_number(parts[0], by), parse_camera_number(parts[1], by),
            parse_camera_number(parts[2], by)};
}

Camera parse_placed_camera(const std::string& text, const SettingOrigin& by) {
    const std::vector<std::string> parts = split(text, ":");
    check(parts.size() == 3, by.failure, by.where,
          ": wanted EX,EY,EZ:TX,TY,TZ:FOV (eye, target, degrees) or "
          "EX,EY,EZ:TX,TY,TZ:h=HEIGHT (orthographic), found ",
          quote(text));
    Camera camera{
        .name = text, .eye = parse_point(parts[0], by), .target = parse_point(parts[1], by)};
    if (parts[2].starts_with("h="))
        camera.orthographic_height = parse_number_within(parts[2].substr(2), 1e-9, 1e18, by);
    else
        camera.vertical_fov_degrees = parse_number_within(parts[2], 0.001, 179, by);
    check(camera.eye != camera.target, by.failure, by.where,
          ": wanted a target away from the eye, found both at ", parts[0]);
    const dvec3 along = camera.target - camera.eye;
    if (along.x == 0 && along.z == 0) camera.up = dvec3(0, 0, 1); // +y is parallel to the view
    return camera;
}

std::string camera_names(const std::vector<Camera>& cameras) {
    constexpr std::size_t kMaxListedCameras = 20;
    std::string list;
    for (std::size_t i = 0; i < std::min(cameras.size(), kMaxListedCameras); ++i)
        list += (i ? ", " : "") + std::to_string(i) + " " + quote(cameras[i].name);
    if (cameras.size() > kMaxListedCameras)
        list += " and " + std::to_string(cameras.size() - kMaxListedCameras) + " more";
    return list.empty() ? "none" : list;
}

std::string format_point(const dvec3& v) {
    return format_number(v.x) + "," + format_number(v.y) + "," + format_number(v.z);
}

} // namespace

Camera find_camera(const std::string& text, const Scene& scene, const SettingOrigin& by) {
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) {
        if (camera.name == text) return camera;
        names.push_back(camera.name);
    }
    if (text.find(':') != std::string::npos) return parse_placed_camera(text, by);
    const bool is_index = text.find_first_not_of("0123456789") == std::string::npos &&
                          text.size() < 10;
    if (is_index && !text.empty() && std::stoul(text) < scene.cameras.size())
        return scene.cameras[std::stoul(text)];
    names.emplace_back("seeded");
    fail(by.failure, by.where, ": scene ", quote(scene.name), " has no camera ", quote(text),
         "; it has: ", camera_names(scene.cameras),
         "; or seeded, EX,EY,EZ:TX,TY,TZ:FOV, or EX,EY,EZ:TX,TY,TZ:h=HEIGHT",
         suggest_name(text, names));
}

std::string format_camera(const Camera& camera) {
    return format_point(camera.eye) + ":" + format_point(camera.target) + ":" +
           (camera.orthographic_height > 0 ? "h=" + format_number(camera.orthographic_height)
                                           : format_number(camera.vertical_fov_degrees));
}

} // namespace catoptric::scene
