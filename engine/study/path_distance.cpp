// The study `path-distance`: how far the reference itself is from path tracing. Where lamps light a
// closed room, light between surfaces is most of the picture, and all rows and the reference lack
// it. A small picture with few paths says whether this matters more than what tells the rows apart.
#include "study/path_distance.hpp"

#include "core/error.hpp"
#include "measure/display.hpp"
#include "measure/masks.hpp"
#include "measure/picture_mean.hpp"
#include "session/access.hpp"
#include "session/processor.hpp"
#include "session/technique_choice.hpp"
#include "study/path_distance_cache.hpp"
#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>

namespace catoptric::study {

namespace {

constexpr int kDefaultSeconds = 10; ///< limit of the time if the user gives none
/// Paths of each pixel in one frame. More would make a frame of a heavy scene, which nothing can
/// interrupt, too long.
constexpr int kPathsOfFrame = 4;
constexpr const char* kPathsOfFrameTechnique = "raytrace:depth=16,rays=4,indirect=paths";

/// Returns the seconds that a limit of time counts: processor time on a processor, whose frames
/// take longer on the clock if other programs run, otherwise time on the clock.
double read_used_seconds(const Engine& engine) {
    if (engine.device().type == "cpu") return read_process_seconds();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Returns whether a picture is not larger than that of the measurement, so that the paths would
/// take longer than the rows.
bool is_small_picture(const uvec2& size) {
    return std::uint64_t{size.x} * size.y <= kPathDistancePixels;
}

/// Returns the size of the small picture: the shape of the comparison's picture, at most 64x64
/// pixels in all.
uvec2 choose_path_size(const uvec2& size) {
    const double pixels = double{1} * size.x * size.y;
    const double factor = std::min(std::sqrt(kPathDistancePixels / pixels), 1.0);
    const auto shrink = [&](unsigned edge) {
        return std::max(1u, static_cast<unsigned>(std::floor(factor * edge + 1e-9)));
    };
    return {shrink(size.x), shrink(size.y)};
}

/// Returns the technique that renders one frame of the reference: one sample a pixel, and few rays
/// in each frame if the reference has noise.
std::string frame_technique(const std::string& reference) {
    const ParsedTechnique choice = parse_technique(reference);
    std::string text = choice.technique;
    char separator = ':';
    for (const Setting& setting : choice.settings) {
        if (!setting.changed || setting.name == choice.traits().samples ||
            setting.name == choice.traits().seed)
            continue;
        const bool is_ray_count = setting.name == choice.traits().rays &&
                                  setting.number.value_or(0) > 0;
        text += separator + setting.name + "=" +
                (is_ray_count ? std::to_string(kPathsOfFrame) : setting.text);
        separator = ',';
    }
    return text;
}

std::string quote_for_shell(const std::string& word) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789._/+-=:,@";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

/// Returns the command that measures the distance in a full comparison.
std::string make_command(const scene::Scene& scene, const std::string& reference) {
    const std::string name = scene.files.empty() ? scene.name : scene.files.front().string();
    return fmt::format("catoptric compare {} -o DIR --truth paths --techniques {}",
                       quote_for_shell(name), quote_for_shell(reference));
}

/// Renders small pictures of the reference and of paths. Each picture with noise is two means of
/// frames, all of which have different seeds.
class PathPictures {
public:
    PathPictures(Session& session, Request request, const std::string& reference,
                 const Watcher& watcher)
        : session_(session), request_(std::move(request)), watcher_(watcher),
          reference_frame_(frame_technique(reference)),
          has_noise_(is_noisy(reference_frame_, request_.scene)), seeds_({reference}) {}

    /// Adds a frame to one half. Both halves of a reference without noise are one picture.
    void add_frame(std::size_t half) {
        add_frame_of(paths_[half], kPathsOfFrameTechnique, true);
        if (has_noise_ || references_[0].count() == 0)
            add_frame_of(references_[half], reference_frame_, has_noise_);
    }
    bool has_both_halves() const { return paths_[1].count() > 0; }
    int path_count() const { return kPathsOfFrame * (paths_[0].count() + paths_[1].count()); }
    int frame_count() const { return paths_[0].count(); }

    void fill_distance(measure::PathDistance& distance) const {
        std::vector<float> flip_map = compute_flip(references_, paths_),
                           noise_map = measure::flip(show(paths_[0].mean()),
                                                     show(paths_[1].mean()));
        if (has_noise_) {
            const std::vector<float> added = measure::flip(show(references_[0].mean()),
                                                           show(references_[1].mean()));
            for (std::size_t i = 0; i < added.size(); ++i) noise_map[i] += added[i];
        }
        const measure::Mask mirrors = measure::mask_mirrors(hits_), all = measure::mask_all(hits_);
        distance.flip = measure::flip_mean(flip_map, mirrors);
        distance.noise = measure::flip_mean(noise_map, mirrors);
        distance.flip_all = measure::flip_mean(flip_map, all);
        distance.noise_all = measure::flip_mean(noise_map, all);
        distance.paths = path_count();
    }

private:
    using Halves = std::array<measure::PictureMean, 2>;

    void add_frame_of(measure::PictureMean& half, const std::string& technique, bool has_noise) {
        request_.techniques = {has_noise ? set_lobe_seed(technique, seeds_.next()) : technique};
        RunResult result = run(session_, request_, watcher_);
        if (hits_.empty()) hits_ = std::move(result.parts.front().hits);
        half.add(result.parts.front().hdr);
    }

    measure::Picture show(const measure::Picture& picture) const {
        return measure::to_unrounded_display(picture, request_.exposure);
    }

    /// Returns the mean of both halves; of the first half alone if the second has no picture.
    static measure::Picture mean_of_halves(const Halves& halves) {
        measure::Picture mean = halves[0].mean();
        if (halves[1].count() == 0) return mean;
        const measure::Picture other = halves[1].mean();
        for (std::size_t i = 0; i < mean.pixels.size(); ++i)
            mean.pixels[i] = (mean.pixels[i] + other.pixels[i]) / 2.0f;
        return mean;
    }

    std::vector<float> compute_flip(const Halves& a, const Halves& b) const {
        return measure::flip(show(mean_of_halves(a)), show(mean_of_halves(b)));
    }

    Session& session_;
    Request request_;
    const Watcher& watcher_;
    std::string reference_frame_;
    bool has_noise_;
    ReferenceSeeds seeds_;
    Halves references_, paths_;
    std::vector<std::uint32_t> hits_; ///< of the first frame: first mirror of each pixel
};

/// Returns the request for one frame of a small picture.
Request make_path_request(const Request& base) {
    Request request = base;
    request.size = choose_path_size(base.size);
    request.time = base.instant(base.total());
    request.animate = false;
    request.warmup = 0, request.frames = 1;
    request.until_settled = false;
    request.model = RenderedWork::everything;
    request.most_captures = 0, request.budget_ms = 0;
    return request;
}

ReferenceKey make_path_key(const Request& request, const std::string& reference) {
    ReferenceKey key = make_reference_key(request, frame_technique(reference));
    key.emplace_back("paths", kPathsOfFrameTechnique);
    key.emplace_back("exposure", fmt::format("{}", request.exposure));
    key.emplace_back("program", version() + " " + commit());
    return key;
}

/// Traces paths until the distance is precise or the time is used up.
void trace_path_distance(const Engine& engine, PathPictures& pictures, const Watcher& watcher,
                         measure::PathDistance& distance) {
    const double start = read_used_seconds(engine);
    const auto used = [&] { return read_used_seconds(engine) - start; };
    double last = 0; // seconds of the last two frames
    do {
        report_row(watcher,
                   fmt::format("distance to path tracing, {} paths a pixel", pictures.path_count()),
                   static_cast<std::size_t>(used()),
                   static_cast<std::size_t>(std::ceil(distance.most_seconds)));
        const double before = used();
        pictures.add_frame(0);
        distance.seconds = used();
        if (distance.seconds > distance.most_seconds && !pictures.has_both_halves()) {
            distance.unknown = fmt::format("a frame of {} paths a pixel took {:.3g} s, and {:g} s "
                                           "are the limit",
                                           kPathsOfFrame, distance.seconds, distance.most_seconds);
            return;
        }
        pictures.add_frame(1);
        pictures.fill_distance(distance);
        distance.seconds = used();
        last = distance.seconds - before;
    } while (!measure::is_precise(distance) && distance.seconds + last <= distance.most_seconds);
}

} // namespace

int choose_path_seconds(const uvec2& size) { return is_small_picture(size) ? 0 : kDefaultSeconds; }

std::optional<measure::PathDistance>
measure_path_distance(Engine& engine, Session& session, const Request& base,
                      const std::string& reference, double seconds, const Watcher& watcher,
                      const std::function<void(const std::string&)>& warn) {
    if (traces_paths(reference)) return std::nullopt;
    const Request request = make_path_request(base);
    measure::PathDistance distance;
    distance.width = static_cast<int>(request.size.x);
    distance.height = static_cast<int>(request.size.y);
    distance.most_seconds = seconds;
    distance.command = make_command(base.scene, reference);
    if (!parse_technique(reference).traits().is_ray_traced()) {
        distance.unknown = "the reference is not ray traced";
        return distance;
    }
    const std::filesystem::path folder = Access::cache_folder(engine);
    const ReferenceKey key = make_path_key(request, reference);
    const std::filesystem::path file = folder.empty() ? folder
                                                      : find_path_distance_file(folder, key);
    if (!file.empty())
        if (auto kept = read_path_distance(file, key, warn);
            kept && (kept->most_seconds >= seconds || measure::is_precise(*kept))) {
            kept->command = distance.command;
            return kept;
        }
    if (seconds <= 0) {
        distance.unknown = is_small_picture(base.size)
                               ? "pictures of at most 64x64 pixels are left out"
                               : "--path-distance 0 leaves it out";
        return distance;
    }
    try {
        PathPictures pictures(session, request, reference, watcher);
        trace_path_distance(engine, pictures, watcher, distance);
    } catch (const Error& error) {
        if (is_signal(error.failure) || !engine.usable()) throw;
        distance.unknown = error.what();
    }
    if (distance.is_known() && !file.empty()) keep_path_distance(file, key, distance, warn);
    return distance;
}

namespace {

/// States, until the distance is measured, that it is not known.
void prepare_path_distance(const CompareRequest& request, int /*count*/,
                           report::Comparison& comparison) {
    if (traces_paths(request.reference)) return;
    measure::PathDistance distance;
    distance.unknown = "it is measured after the rows";
    distance.command = make_command(request.base.scene, request.reference);
    comparison.path_distance = std::make_shared<measure::PathDistance>(std::move(distance));
}

void run_path_distance(const StudyInput& input) {
    std::optional<measure::PathDistance> distance = measure_path_distance(
        input.engine, input.session, input.request.base, input.request.reference, input.count,
        input.request.watcher, input.warn);
    if (!distance) return;
    input.comparison.path_distance = std::make_shared<measure::PathDistance>(std::move(*distance));
    input.tell();
}

const RegisteredStudy kPathDistanceStudy{
    {.name = kPathDistanceStudyName,
     .help = "most seconds of processor time to measure, at 64x64, how far the reference itself is "
             "from path tracing; kept by scene and view; 0: leave it out (10, or 0 for pictures "
             "of at most 64x64 pixels)",
     .order = 5,
     .number = "S",
     .low = 0,
     .high = 86'400,
     .prepare = prepare_path_distance,
     .run = run_path_distance}};

} // namespace

} // namespace catoptric::study
