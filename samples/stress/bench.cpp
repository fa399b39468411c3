#include "stress/bench.hpp"

#include "measure/flip.hpp"
#include "measure/picture_file.hpp"
#include "scene/default_camera.hpp"
#include "session/access.hpp"
#include "session/frames.hpp"
#include "session/watcher.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>

namespace catoptric::stress {

namespace {

/// Returns the text as a file name of letters, digits and single hyphens.
std::string picture_name(const std::string& text) {
    std::string name;
    for (const char c : text)
        if (std::isalnum(static_cast<unsigned char>(c)))
            name += c;
        else if (!name.empty() && name.back() != '-')
            name += '-';
    return name;
}

} // namespace

bool is_refusal(const Error& error) {
    static const std::regex kLimitWord(R"(allows ([a-z_]+[a-z_0-9]* = )?[0-9])");
    return error.failure == Failure::exhausted &&
           std::regex_search(std::string(error.what()), kLimitWord);
}

bool Bench::ends_run(const Error& error) const {
    const bool is_fault = error.failure == Failure::device_lost ||
                          error.failure == Failure::no_device ||
                          (error.failure == Failure::exhausted && !is_refusal(error));
    return is_fault || is_signal(error.failure) || !bench_engine_.usable();
}

session::Request Bench::make_request(const scene::Scene& scene, const std::string& technique,
                                     int frames) const {
    session::Request request;
    request.scene = scene;
    request.techniques = {technique};
    request.camera = scene.cameras.empty() ? scene::default_camera(scene) : scene.cameras.front();
    request.size = size_;
    request.frames = 1;
    request.warmup = frames - 1;
    return request;
}

session::TechniqueResult Bench::render_technique(const session::Request& request) {
    session::Session session(bench_engine_, request.scene);
    session::FrameLoop frames(session, request);
    while (frames.render_next()) throw_if_stopped(watcher_);
    return frames.frame().read();
}

std::string Bench::fit_captures(const std::string& technique) const {
    if (!has_small_pictures()) return technique;
    const std::vector<session::TechniqueInfo> infos = session::techniques();
    const auto info = std::ranges::find(infos, technique.substr(0, technique.find(':')),
                                        &session::TechniqueInfo::name);
    if (info == infos.end()) return technique;
    std::string fitted = technique;
    for (const auto& [knob, texels] : {std::pair("face", "64"), std::pair("shadow_map", "256")}) {
        const bool is_knob = std::ranges::find(info->knobs, knob, &session::KnobInfo::name) !=
                             info->knobs.end();
        if (!is_knob || technique.find(std::string(knob) + "=") != technique.npos) continue;
        fitted += (fitted.find(':') == fitted.npos ? ":" : ",") + std::string(knob) + "=" + texels;
    }
    return fitted;
}

void Bench::plan_technique(const session::Request& request) {
    session::Session session(bench_engine_, request.scene);
    session::Access::format_plan(session, request, session::PlanFormat::text);
}

void Bench::add_flip(const std::string& what, const session::TechniqueResult& found,
                     const session::TechniqueResult& wanted, double limit,
                     const std::string& seen) {
    const double flip = measure::flip_mean(measure::flip(found.display, wanted.display));
    row_.cases.push_back(
        {what, count_nonfinite(found.hdr) > 0 ? std::nan("") : flip, limit, !seen.empty(), seen});
    if (row_.cases.back().is_within_limit()) return;
    const std::string name = row_.id + "-" + picture_name(what);
    for (const auto& [part, which] : {std::pair(&found, "-found"), std::pair(&wanted, "-wanted")})
        row_.pictures.push_back({name + which, part->display.width, part->display.height,
                                 measure::encode_png(part->display)});
}

void Bench::add_nonfinite(const std::string& what, const session::TechniqueResult& part) {
    add_case(what + ": pixels that are no numbers", static_cast<double>(count_nonfinite(part.hdr)),
             0);
}

bool Bench::add_attempt(const std::string& what, const std::function<void()>& work) {
    try {
        work();
        add_case(what + ": done", 0, 0);
        return true;
    } catch (const Error& error) {
        if (ends_run(error)) throw;
        if (is_refusal(error))
            add_skipped(what, error);
        else
            add_case(what + ": fails: " + error.what(), 1, 0);
        return false;
    }
}

void Bench::add_expected_error(const std::string& what, Failure failure, const std::string& limit,
                               const std::function<void()>& work) {
    std::string text = "not refused";
    try {
        work();
    } catch (const Error& error) {
        if (ends_run(error)) throw;
        text = error.what();
        if (error.failure == failure && text.find(limit) != text.npos)
            return add_case(what + ": refused: " + text, 0, 0);
    }
    add_case(what + ": wanted a refusal that names " + limit + ", found: " + text, 1, 0);
}

std::size_t count_nonfinite(const measure::Picture& picture) {
    return static_cast<std::size_t>(std::ranges::count_if(picture.pixels, [](const vec3& pixel) {
        return !(std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z));
    }));
}

double brightest_channel(const measure::Picture& picture) {
    double most = 0;
    for (const vec3& pixel : picture.pixels)
        most = std::max({most, double{pixel.x}, double{pixel.y}, double{pixel.z}});
    return count_nonfinite(picture) > 0 ? std::nan("") : most;
}

std::size_t count_different(const measure::Picture& a, const measure::Picture& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] != b.pixels[i];
    return count;
}

} // namespace catoptric::stress
