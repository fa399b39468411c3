#include "scene/camera_named.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "scene/number.hpp"

#include <algorithm>

namespace catoptric::scene {

namespace {

double number(const std::string& text, const SaidBy& by) {
    const std::optional<double> value = parse_number(text);
    check(value.has_value(), by.failure, by.where, ": wanted a finite number, found ",
          in_quotes(text));
    return *value;
}

double number_within(const std::string& text, double low, double high, const SaidBy& by) {
    const std::optional<double> value = parse_number(text);
    check(value && *value >= low && *value <= high, by.failure, by.where,
          ": wanted a finite number from ", low, " to ", high, ", found ", in_quotes(text));
    return *value;
}

dvec3 point(const std::string& text, const SaidBy& by) {
    const std::vector<std::string> parts = split(text, ",");
    check(parts.size() == 3, by.failure, by.where, ": wanted a point X,Y,Z, found ",
          in_quotes(text));
    return {number(parts[0], by), number(parts[1], by), number(parts[2], by)};
}

Camera placed(const std::string& text, const SaidBy& by) {
    const std::vector<std::string> parts = split(text, ":");
    check(parts.size() == 3, by.failure, by.where,
          ": wanted EX,EY,EZ:TX,TY,TZ:FOV (eye, target, degrees) or "
          "EX,EY,EZ:TX,TY,TZ:h=HEIGHT (orthographic), found ",
          in_quotes(text));
    Camera camera{.name = text, .eye = point(parts[0], by), .target = point(parts[1], by)};
    if (parts[2].starts_with("h="))
        camera.orthographic_height = number_within(parts[2].substr(2), 1e-9, 1e18, by);
    else
        camera.vertical_fov_degrees = number_within(parts[2], 0.001, 179, by);
    check(camera.eye != camera.target, by.failure, by.where,
          ": wanted a target away from the eye, found both at ", parts[0]);
    const dvec3 along = camera.target - camera.eye;
    if (along.x == 0 && along.z == 0) camera.up = dvec3(0, 0, 1); // +y is parallel to the view
    return camera;
}

std::string list_of(const std::vector<Camera>& cameras) {
    constexpr std::size_t kMostListed = 20;
    std::string list;
    for (std::size_t i = 0; i < std::min(cameras.size(), kMostListed); ++i)
        list += (i ? ", " : "") + std::to_string(i) + " " + in_quotes(cameras[i].name);
    if (cameras.size() > kMostListed)
        list += " and " + std::to_string(cameras.size() - kMostListed) + " more";
    return list.empty() ? "none" : list;
}

std::string text_of(const dvec3& v) {
    return number_text(v.x) + "," + number_text(v.y) + "," + number_text(v.z);
}

} // namespace

Camera camera_named(const std::string& text, const Scene& scene, const SaidBy& by) {
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) {
        if (camera.name == text) return camera;
        names.push_back(camera.name);
    }
    if (text.find(':') != std::string::npos) return placed(text, by);
    const bool is_index = text.find_first_not_of("0123456789") == std::string::npos &&
                          text.size() < 10;
    if (is_index && !text.empty() && std::stoul(text) < scene.cameras.size())
        return scene.cameras[std::stoul(text)];
    names.emplace_back("seeded");
    fail(by.failure, by.where, ": scene ", in_quotes(scene.name), " has no camera ",
         in_quotes(text), "; it has: ", list_of(scene.cameras),
         "; or seeded, EX,EY,EZ:TX,TY,TZ:FOV, or EX,EY,EZ:TX,TY,TZ:h=HEIGHT",
         did_you_mean(text, names));
}

std::string camera_text(const Camera& camera) {
    return text_of(camera.eye) + ":" + text_of(camera.target) + ":" +
           (camera.orthographic_height > 0 ? "h=" + number_text(camera.orthographic_height)
                                           : number_text(camera.vertical_fov_degrees));
}

} // namespace catoptric::scene
