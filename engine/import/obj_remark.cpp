#include "core/text.hpp"
#include "import/obj_text.hpp"
#include "scene/scene_overrides.hpp"
#include "scene/transform.hpp"

#include <cmath>
#include <memory>
#include <utility>

namespace catoptric::scene::obj {

namespace {

using Words = std::vector<std::string_view>;

dvec3 vector_at(const std::vector<double>& list, std::size_t first) {
    return {list[first], list[first + 1], list[first + 2]};
}

Camera parse_camera(const Line& line, const Words& words) {
    const bool is_orthographic = words.size() > 11; // a further word is the picture's height
    const std::vector<double> n = parse_words(line, words, 1, is_orthographic ? 11 : 10);
    const Camera camera{.name = std::string(words[0]),
                        .eye = vector_at(n, 0),
                        .target = vector_at(n, 3),
                        .up = vector_at(n, 6),
                        .vertical_fov_degrees = n[9],
                        .orthographic_height = is_orthographic ? n[10] : 0};
    const dvec3 side = normalized_or_zero(glm::cross(camera.target - camera.eye, camera.up));
    check(side != dvec3(0), Failure::bad_data, line.place(), ": camera ", quote(camera.name),
          " wants an up vector that is not parallel to its view");
    check(n[9] > 0 && n[9] < 180, Failure::bad_data, line.place(), ": camera ", quote(camera.name),
          " wants a field of view between 0 and 180 degrees, found ", n[9]);
    check(!is_orthographic || n[10] > 0, Failure::bad_data, line.place(), ": camera ",
          quote(camera.name), " wants a height above 0, found ", n.back());
    return camera;
}

HarmonicMotion parse_harmonic(const Line& line, const Words& words) {
    const std::vector<double> n = parse_words(line, words, 2, 4);
    check(n[3] > 0, Failure::bad_data, line.place(), ": motion of ", quote(words[0]),
          " wants a period above 0, found ", n[3]);
    return {.amplitude = vector_at(n, 0), .period = n[3]};
}

/// Reads a key count, and then time and position of each key. Words are not stored in a list,
/// because a line may be as long as the file. Throws `bad_data`.
Keyframes parse_keyframes(const Line& line, std::string_view name, std::string_view rest,
                          TranslationTrack::Interpolation interpolation, LoadAccount& account) {
    const bool is_cubic = interpolation == TranslationTrack::Interpolation::cubic;
    const std::size_t stride = is_cubic ? 10 : 4;
    const double count = parse_word(line, take_word(rest));
    const std::size_t found = count_words(rest);
    check(count >= 1 && count * double(stride) == double(found), Failure::bad_data, line.place(),
          ": motion of ", quote(name), " wants ", stride, " numbers for each of ", count,
          " keys, found ", found);
    account.keys.add(found / stride, line.place());
    auto keys = std::make_shared<TranslationTrack>(
        TranslationTrack{.interpolation = interpolation});
    const auto vector = [&] {
        const double x = parse_word(line, take_word(rest)), y = parse_word(line, take_word(rest));
        return dvec3(x, y, parse_word(line, take_word(rest)));
    };
    for (std::size_t i = 0; i < found / stride; ++i) {
        const double time = parse_word(line, take_word(rest));
        check(keys->times.empty() || time > keys->times.back(), Failure::bad_data, line.place(),
              ": motion of ", quote(name), " wants increasing times, found ", time);
        keys->times.push_back(time);
        if (is_cubic) keys->in_tangents.push_back(vector());
        keys->values.push_back(vector());
        if (is_cubic) keys->out_tangents.push_back(vector());
    }
    return {.keys = std::move(keys)};
}

Motion parse_motion(const Line& line, LoadAccount& account) {
    using enum TranslationTrack::Interpolation;
    std::string_view rest = line.rest;
    const std::string_view name = take_word(rest), kind = take_word(rest);
    if (kind == "harmonic") return parse_harmonic(line, split_words(line));
    if (kind == "step") return parse_keyframes(line, name, rest, step, account);
    if (kind == "linear") return parse_keyframes(line, name, rest, linear, account);
    if (kind == "cubic") return parse_keyframes(line, name, rest, cubic, account);
    fail(Failure::bad_data, line.place(), ": motion wants harmonic, step, linear or cubic, found ",
         quote(kind));
}

Sphere parse_sphere(const Line& line, const Words& words) {
    const std::vector<double> n = parse_words(line, words, 1, 4);
    check(n[3] > 0, Failure::bad_data, line.place(), ": sphere ", quote(words[0]),
          " wants a radius above 0, found ", n[3]);
    return {vector_at(n, 0), n[3]};
}

} // namespace

void add_comment(CatoptricComments& comments, const Line& line, LoadAccount& account) {
    const Words list = split_words(line);
    check(!list.empty(), Failure::bad_data, line.place(), ": ", quote(line.keyword),
          " wants a name, found none");
    if (line.keyword == "#exposure") {
        const double stops = parse_words(line, list, 0, 1)[0];
        check(std::abs(stops) <= kMaxExposureStops, Failure::bad_data, line.place(),
              ": exposure wants ", -kMaxExposureStops, " to ", kMaxExposureStops, ", found ",
              stops);
        comments.exposure = stops;
        return;
    }
    const std::string name(list[0]);
    if (line.keyword == "#camera") {
        account.cameras.add(1, line.place());
        comments.cameras.push_back(parse_camera(line, list));
        return;
    }
    if (!comments.named_at.contains(name)) {
        account.remarks.add(1, line.place());
        comments.named_at[name] = line.place();
    }
    if (line.keyword == "#motion")
        comments.motions[name] = parse_motion(line, account);
    else if (line.keyword == "#sphere")
        comments.spheres[name] = parse_sphere(line, list);
    else if (line.keyword == "#hidden")
        comments.hidden[name] = true;
    else
        fail(Failure::bad_data, line.place(),
             ": '# catoptric' wants camera, motion, sphere, hidden or exposure, found ",
             quote(line.keyword.substr(1)));
}

} // namespace catoptric::scene::obj
