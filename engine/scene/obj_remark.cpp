#include "core/error.hpp"
#include "scene/obj_text.hpp"

namespace catoptric::scene::obj {

namespace {

using Words = std::vector<std::string_view>;

dvec3 vector_at(const std::vector<double>& list, std::size_t first) {
    return {list[first], list[first + 1], list[first + 2]};
}

Camera camera(const Line& line, const Words& words) {
    const std::vector<double> n = numbers(line, words, 1, 10);
    const Camera camera{.name = std::string(words[0]),
                        .eye = vector_at(n, 0),
                        .target = vector_at(n, 3),
                        .up = vector_at(n, 6),
                        .vertical_fov_degrees = n[9]};
    const dvec3 side = glm::cross(camera.target - camera.eye, camera.up);
    check(side != dvec3(0), Failure::bad_data, line.where, ": camera '", camera.name,
          "' wants an up that is not along its view, found none");
    check(n[9] > 0 && n[9] < 180, Failure::bad_data, line.where, ": camera '", camera.name,
          "' wants a field of view between 0 and 180 degrees, found ", n[9]);
    return camera;
}

Harmonic harmonic(const Line& line, const Words& words) {
    const std::vector<double> n = numbers(line, words, 2, 4);
    check(n[3] > 0, Failure::bad_data, line.where, ": motion of '", words[0],
          "' wants a period above 0, found ", n[3]);
    return {.amplitude = vector_at(n, 0), .period = n[3]};
}

Keyframes keyframes(const Line& line, const Words& words, Keyframes::Interpolation interpolation) {
    const bool is_cubic = interpolation == Keyframes::Interpolation::cubic;
    const std::size_t stride = is_cubic ? 10 : 4;
    const double count = numbers(line, words, 2, 1)[0];
    check(count >= 1 && count * double(stride) == double(words.size() - 3), Failure::bad_data,
          line.where, ": motion of '", words[0], "' wants ", stride, " numbers for each of ",
          words[2], " keys, found ", words.size() - 3);
    const std::vector<double> n = numbers(line, words, 3, words.size() - 3);
    Keyframes keys{.interpolation = interpolation};
    for (std::size_t i = 0; i < n.size(); i += stride) {
        check(keys.times.empty() || n[i] > keys.times.back(), Failure::bad_data, line.where,
              ": motion of '", words[0], "' wants increasing times, found ", n[i]);
        keys.times.push_back(n[i]);
        keys.values.push_back(vector_at(n, is_cubic ? i + 4 : i + 1));
        if (!is_cubic) continue;
        keys.in_tangents.push_back(vector_at(n, i + 1));
        keys.out_tangents.push_back(vector_at(n, i + 7));
    }
    return keys;
}

Motion motion(const Line& line, const Words& words) {
    using enum Keyframes::Interpolation;
    const std::string_view kind = words.size() > 1 ? words[1] : std::string_view();
    if (kind == "harmonic") return harmonic(line, words);
    if (kind == "step") return keyframes(line, words, step);
    if (kind == "linear") return keyframes(line, words, linear);
    if (kind == "cubic") return keyframes(line, words, cubic);
    fail(Failure::bad_data, line.where, ": motion wants harmonic, step, linear or cubic, found '",
         kind, "'");
}

Sphere sphere(const Line& line, const Words& words) {
    const std::vector<double> n = numbers(line, words, 1, 4);
    check(n[3] > 0, Failure::bad_data, line.where, ": sphere '", words[0],
          "' wants a radius above 0, found ", n[3]);
    return {vector_at(n, 0), n[3]};
}

} // namespace

void add_remark(Remarks& remarks, const Line& line) {
    const Words list = words(line);
    check(!list.empty(), Failure::bad_data, line.where, ": '", line.keyword,
          "' wants a name, found none");
    const std::string name(list[0]);
    if (line.keyword == "#camera") {
        remarks.cameras.push_back(camera(line, list));
        return;
    }
    remarks.named_at.try_emplace(name, line.where);
    if (line.keyword == "#motion")
        remarks.motions[name] = motion(line, list);
    else if (line.keyword == "#sphere")
        remarks.spheres[name] = sphere(line, list);
    else if (line.keyword == "#hidden")
        remarks.hidden[name] = true;
    else
        fail(Failure::bad_data, line.where,
             ": '# catoptric' wants camera, motion, sphere or hidden, found '",
             line.keyword.substr(1), "'");
}

} // namespace catoptric::scene::obj
