#include "core/error.hpp"
#include "scene/gltf_document.hpp"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

namespace catoptric::scene::gltf {

namespace {

using Json = nlohmann::json;

double positive(const Json& value, const std::string& place) {
    check(value.is_number() && value.get<double>() > 0, Failure::bad_data, place,
          ": wanted a number above 0, found ", value.dump());
    return value.get<double>();
}

std::optional<Sphere> sphere(const Json& value, const std::string& place) {
    if (value == false) return std::nullopt;
    if (value == true) return Sphere{.radius = 1};
    check(value.is_array() && value.size() == 4, Failure::bad_data, place,
          ": wanted true, false or [x, y, z, r], found ", value.dump());
    for (const Json& number : value)
        check(number.is_number(), Failure::bad_data, place, ": wanted numbers, found ",
              number.dump());
    const auto number = [&](std::size_t i) { return value[i].get<double>(); };
    return Sphere{.centre = {number(0), number(1), number(2)}, .radius = positive(value[3], place)};
}

} // namespace

Marks marks(const std::string& extras_json, const std::string& place) {
    Marks marks;
    const Json extras = Json::parse(extras_json, nullptr, false); // not JSON: no marks
    if (!extras.is_object() || !extras.contains("catoptric")) return marks;
    const Json& ours = extras["catoptric"];
    check(ours.is_object(), Failure::bad_data, place,
          ": extras.catoptric: wanted an object, found ", ours.dump());
    if (ours.contains("sphere")) marks.sphere = sphere(ours["sphere"], place + ": sphere");
    if (ours.contains("distance"))
        marks.distance = positive(ours["distance"], place + ": distance");
    if (ours.contains("seen_by_camera")) {
        check(ours["seen_by_camera"].is_boolean(), Failure::bad_data, place,
              ": seen_by_camera: wanted true or false, found ", ours["seen_by_camera"].dump());
        marks.seen_by_camera = ours["seen_by_camera"].get<bool>();
    }
    return marks;
}

dmat4 matrix_of(const std::vector<double>& matrix, const std::vector<double>& translation,
                const std::vector<double>& rotation, const std::vector<double>& scale) {
    dmat4 result(1);
    if (matrix.size() == 16) {
        for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = matrix[std::size_t(i)];
        return result;
    }
    if (const auto& r = rotation; r.size() == 4)
        result = dmat4(glm::mat3_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2]))));
    for (int i = 0; i < 3 && scale.size() == 3; ++i) result[i] *= scale[std::size_t(i)];
    if (const auto& t = translation; t.size() == 3) result[3] = dvec4(t[0], t[1], t[2], 1);
    return result;
}

Keyframes keyframes(const std::string& interpolation, std::vector<double> times,
                    const std::vector<dvec3>& output, const std::string& place) {
    using enum Keyframes::Interpolation;
    const bool is_cubic = interpolation == "CUBICSPLINE";
    Keyframes keys{.interpolation = is_cubic ? cubic : interpolation == "STEP" ? step : linear};
    const std::size_t each = is_cubic ? 3 : 1;
    check(output.size() == each * times.size(), Failure::bad_data, place, ": wanted ", each,
          " values for each of ", times.size(), " keys, found ", output.size());
    for (const dvec3& v : output)
        check(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), Failure::bad_data,
              place, ": wanted finite values, found NaN or infinity");
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool increases = times[i] >= 0 && (i == 0 || times[i] > times[i - 1]);
        check(increases && std::isfinite(times[i]), Failure::bad_data, place,
              ": wanted increasing times from 0 on, found ", times[i]);
        keys.values.push_back(output[each * i + each / 2]);
        if (!is_cubic) continue;
        keys.in_tangents.push_back(output[3 * i]);
        keys.out_tangents.push_back(output[3 * i + 2]);
    }
    keys.times = std::move(times);
    return keys;
}

} // namespace catoptric::scene::gltf
