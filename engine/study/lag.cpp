#include "study/lag.hpp"

#include "core/error.hpp"
#include "core/stopwatch.hpp"
#include "measure/display.hpp"
#include "measure/flip.hpp"
#include "measure/lag.hpp"
#include "measure/masks.hpp"
#include "measure/picture.hpp"
#include "measure/settling.hpp"
#include "report/comparison.hpp"
#include "scene/pose.hpp"
#include "session/technique_choice.hpp"
#include "session/watcher.hpp"
#include "study/reference_cache.hpp"
#include "study/reference_seeds.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace catoptric::study {

namespace {

constexpr int kMaxLagFrames = 30; // frames of a still, and of each side of a cut
constexpr int kPathWarmup = 16;   // frames along the path before the first that counts
// Seconds; a long animation is cut, because a run would take hours.
constexpr double kMaxPathSeconds = 10;
constexpr double kFramesPerSecond = 60;

/// The instants along the scene's motion at which lag is measured. At every speed, a frame
/// coincides with each instant.
struct LagInstants {
    double start = 0;   ///< seconds
    double step = 0;    ///< seconds from one instant to the next
    double fastest = 1; ///< fastest speed, as in LagRequest::speeds
    int stride = 1;     ///< frames of the fastest speed in a step
    int count = 1;      ///< number of instants

    double path_seconds() const { return step * count; }
    double seconds_of_instant(int i) const { return start + step * i; }
    /// Returns the number of frames of a speed in a step.
    int frames_per_instant(double speed) const {
        return stride * static_cast<int>(fastest / speed);
    }
    /// Returns the instant of frame f (0 at the start) of a speed, in seconds. Every
    /// frames_per_instant()-th frame lies exactly on an instant of the path.
    double seconds_of_frame(double speed, int f) const {
        return start + step * (static_cast<double>(f) / frames_per_instant(speed));
    }
};

void check_speeds(const std::vector<double>& speeds) {
    check(!speeds.empty(), Failure::usage, "lag: wanted at least one speed, found none");
    const double fastest = std::ranges::max(speeds);
    for (const double speed : speeds) {
        const double ratio = fastest / speed;
        check(speed > 0 && std::isfinite(ratio) && ratio == std::trunc(ratio), Failure::usage,
              "lag: wanted positive speeds that go a whole number of times into the fastest, ",
              fastest, ", found ", speed);
    }
}

/// Returns a path with as many instants as the fastest speed has frames, or as are allowed. Returns
/// one instant if nothing moves.
LagInstants choose_instants(const LagRequest& request) {
    check_speeds(request.speeds);
    check(request.most_instants > 0, Failure::usage, "lag: wanted at least one instant, found ",
          request.most_instants);
    LagInstants path{.start = request.base.time, .fastest = std::ranges::max(request.speeds)};
    const double frame = path.fastest / kFramesPerSecond;
    const double frames = std::min(scene::scene_period(request.base.scene), kMaxPathSeconds) /
                          frame;
    path.stride = std::max(1, static_cast<int>(std::ceil(frames / request.most_instants)));
    path.count = std::max(1, static_cast<int>(std::lround(frames / path.stride)));
    path.step = frames > 0 ? path.stride * frame : 0;
    return path;
}

/// Returns all figures of the difference. `exposure`: stops.
measure::Difference picture_difference(const measure::Picture& a, const measure::Picture& b,
                                       const measure::Mask& mask, double exposure) {
    return measure::difference(measure::apply_exposure(a, exposure),
                               measure::apply_exposure(b, exposure), mask,
                               measure::flip(measure::to_unrounded_display(a, exposure),
                                             measure::to_unrounded_display(b, exposure)));
}

/// Returns the difference without FLIP, which takes longer than all other figures.
measure::Difference difference_without_flip(const measure::Picture& a, const measure::Picture& b,
                                            const measure::Mask& mask, double exposure) {
    return measure::difference(measure::apply_exposure(a, exposure),
                               measure::apply_exposure(b, exposure), mask,
                               std::vector<float>(a.pixels.size(), 0.0f));
}

bool have_equal_bytes(const measure::Picture& a, const measure::Picture& b) {
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(vec3)) == 0;
}

/// A technique's picture of the scene at rest at one instant, after the picture has stopped
/// changing.
struct SettledPicture {
    TechniqueResult part;
    int frames = 0;     ///< frames until the picture stopped changing
    bool rests = false; ///< false: the picture still changed at the cap
};

class LagMeasurement {
public:
    LagMeasurement(Session& session, const LagRequest& request, report::LagResults& lag)
        : session_(session), request_(request), lag_(lag), path_(choose_instants(request)),
          mirrors_(static_cast<int>(scene::mirrors(request.base.scene).size())) {
        check(!request_.base.techniques.empty(), Failure::usage, "lag: no technique was asked for");
        for (const std::string& text : request_.base.techniques)
            parse_technique(text); // throws before any work
    }

    void measure_rows() {
        for (int i = 0; i < path_.count; ++i) lag_.seconds.push_back(path_.seconds_of_instant(i));
        lag_.path = path_.path_seconds();
        lag_.jump_from = path_.start + path_.path_seconds() / 2;
        lag_.frame_cap = kMaxLagFrames;
        const bool has_noise = is_noisy(request_.reference, request_.base.scene);
        begin_progress("reference " + request_.reference, 0,
                       (path_.count + (has_noise ? 1 : 0)) * kMaxLagFrames);
        if (has_noise) fit_reference();
        for (int i = 0; i < path_.count; ++i) add_instant(path_.seconds_of_instant(i));
        if (has_noise) measure_noise();
        for (std::size_t i = 0; i < request_.base.techniques.size(); ++i) {
            measure_row(i);
            if (request_.on_finished_row) request_.on_finished_row();
        }
        lag_.complete = true;
    }

private:
    /// The mirror pixels and the reference picture at one instant.
    struct ReferenceAtInstant {
        double seconds = 0;
        std::vector<std::uint32_t> hits; ///< as in Comparison::mirror_hits
        measure::Mask mirrors;
        measure::Picture reference;
    };

    void begin_progress(const std::string& label, std::size_t index, int frames) {
        report_row(request_.watcher, label, index, request_.base.techniques.size() + 1);
        frames_done_ = 0;
        frames_expected_ = frames;
    }

    Frame render_frame(const std::string& technique, double seconds) {
        FrameSpec spec = request_.base;
        spec.techniques = {technique};
        spec.time = seconds;
        spec.model =
            RenderedWork::required; // gives the same pictures, and their times are not used
        const Frame made = session_.frame(spec);
        report_frame(request_.watcher, ++frames_done_, frames_expected_);
        return made;
    }
    /// Begins a run of frames without history. `frames_before`: frames of the progress that count
    /// as rendered, because earlier runs made them unnecessary.
    void begin_without_history(int frames_before) {
        session_.forget();
        frames_done_ = frames_before;
    }

    SettledPicture render_still(const std::string& technique, double seconds) {
        const int before = frames_done_;
        begin_without_history(before);
        SettledPicture still;
        int unchanged = 0;
        for (int k = 1; k <= kMaxLagFrames && !still.rests; ++k) {
            TechniqueResult part = render_frame(technique, seconds).read();
            unchanged = have_equal_bytes(part.hdr, still.part.hdr) ? unchanged + 1 : 0;
            still.part = std::move(part);
            still.frames = k - unchanged;
            // Light needs one frame to pass from mirror to mirror. Until it arrives, successive
            // pictures may be equal and black, for as many frames as there are mirrors.
            still.rests = !still.part.remembers || unchanged >= mirrors_;
        }
        frames_done_ = before + kMaxLagFrames;
        return still;
    }

    /// Lowers the number of the reference's rays so that all instants fit into
    /// `reference_seconds`, by the time of a coarse picture.
    void fit_reference() {
        const int wanted = find_lobe_rays(request_.reference);
        const uvec2 size = request_.base.size;
        const std::string coarse = choose_coarse_technique(request_.reference, size);
        const int rays = find_lobe_rays(coarse);
        lag_.wanted_reference_rays = lag_.reference_rays = wanted;
        if (rays == wanted) return;
        const auto begin = SteadyClock::now();
        render_still(coarse, path_.start);
        frames_done_ = 0;
        lag_.reference_rays = choose_refined_rays(wanted, rays, ms_since(begin) / 1000,
                                                  2 * request_.reference_seconds /
                                                      (path_.count + 1)); // for one of two pictures
        request_.reference = set_lobe_rays(request_.reference, lag_.reference_rays);
    }

    void add_instant(double seconds) {
        const TechniqueResult reference = render_still(request_.reference, seconds).part;
        std::vector<std::uint32_t> hits = !reference.hits.empty()
                                              ? reference.hits
                                              : render_still("raytrace:depth=1", seconds).part.hits;
        const measure::Mask mirrors = measure::mask_mirrors(hits);
        instants_.push_back({seconds, std::move(hits), mirrors, reference.hdr});
    }

    /// Draws the first instant once more with other random rays than the reference and the rows.
    void measure_noise() {
        std::vector<std::string> others = request_.base.techniques;
        others.push_back(request_.reference);
        const std::string second = set_lobe_seed(request_.reference, ReferenceSeeds(others).next());
        const ReferenceAtInstant& first = instants_.front();
        lag_.reference_flip_floor = masked_difference(render_still(second, first.seconds).part.hdr,
                                                      first.reference, first)
                                        .flip;
    }

    void measure_row(std::size_t index) {
        const std::string& text = request_.base.techniques[index];
        const std::string label = parse_technique(text).label;
        begin_progress("lag of " + label, index + 1, count_row_frames());
        report::LagRow row;
        row.label = label;
        stills_.clear();
        for (const ReferenceAtInstant& instant : instants_)
            if (!add_settled_picture(row, text, instant))
                return lag_.without_history.push_back(label);
        row.after_black = measure_settling(text, 0);
        row.after_jump = measure_settling(text, kMaxLagFrames);
        lag_.rows.push_back(std::move(row)); // keeps partial results if a signal comes
        for (const double speed : request_.speeds)
            lag_.rows.back().speeds.push_back(
                measure_at_speed(text, speed, lag_.rows.back().worst));
    }

    measure::Difference masked_difference(const measure::Picture& a, const measure::Picture& b,
                                          const ReferenceAtInstant& instant) const {
        return picture_difference(a, b, instant.mirrors, request_.base.exposure);
    }

    /// Adds the picture of the scene at rest. Returns false if the technique reads no contents of
    /// the last frame, and therefore has no lag.
    bool add_settled_picture(report::LagRow& row, const std::string& text,
                             const ReferenceAtInstant& instant) {
        const SettledPicture found = render_still(text, instant.seconds);
        if (!found.part.remembers) return false;
        stills_.push_back(found.part.hdr);
        row.still_frames = std::max(row.still_frames, found.frames);
        row.restless_stills += !found.rests;
        row.still_reference_errors.push_back(
            masked_difference(stills_.back(), instant.reference, instant));
        return true;
    }

    /// Compares frames at the first instant with the picture of the scene at rest. Before these
    /// frames, `before` frames show another instant.
    report::SettlingAfterCut measure_settling(const std::string& text, int before) {
        report::SettlingAfterCut settling;
        begin_without_history(frames_done_);
        for (int k = 0; k < before; ++k) render_frame(text, lag_.jump_from);
        for (int k = 0; k < kMaxLagFrames; ++k) {
            const measure::Difference error = difference_without_flip(
                render_frame(text, path_.start).hdr(), stills_.front(), instants_.front().mirrors,
                request_.base.exposure);
            settling.rmse.push_back(error.rmse);
            settling.max.push_back(error.max);
        }
        settling.rmse_settled = measure::find_settled_frame(settling.rmse,
                                                            measure::kMaxSettledError);
        settling.max_settled = measure::find_settled_frame(settling.max, measure::kMaxSettledError);
        return settling;
    }

    /// Measures a speed, and replaces `worst` by each instant with a larger FLIP.
    report::LagAtSpeed measure_at_speed(const std::string& text, double speed,
                                        std::optional<measure::WorstLag>& worst) {
        report::LagAtSpeed lag{.speed = speed};
        const int between = path_.frames_per_instant(speed),
                  count = count_frames(speed) - kPathWarmup;
        begin_without_history(frames_done_);
        for (int k = -kPathWarmup; k < count; ++k) {
            const Frame moving = render_frame(text, path_.seconds_of_frame(speed, k));
            if (k < 0 || k % between != 0) continue;
            const auto i = static_cast<std::size_t>(k / between);
            const measure::Picture picture = moving.hdr();
            lag.errors.push_back(masked_difference(picture, stills_[i], instants_[i]));
            lag.reference_errors.push_back(
                masked_difference(picture, instants_[i].reference, instants_[i]));
            // The FLIP of an instant without a mirror is NaN, and never larger.
            if (const double flip = lag.errors.back().flip; flip > (worst ? worst->flip : 0))
                worst = {speed,
                         instants_[i].seconds,
                         flip,
                         picture,
                         stills_[i],
                         instants_[i].reference,
                         instants_[i].hits};
        }
        return lag;
    }

    int count_frames(double speed) const {
        return kPathWarmup + (path_.count - 1) * path_.frames_per_instant(speed) + 1;
    }
    /// Returns the largest number of frames that the measurement of a row may take, for the display
    /// of progress.
    int count_row_frames() const {
        int frames = path_.count * kMaxLagFrames + 3 * kMaxLagFrames;
        for (const double speed : request_.speeds) frames += count_frames(speed);
        return frames;
    }

    Session& session_;
    LagRequest request_;
    report::LagResults& lag_;
    LagInstants path_;
    int mirrors_ = 0;
    std::vector<ReferenceAtInstant> instants_;
    /// Still pictures of the current technique, one per instant.
    std::vector<measure::Picture> stills_;
    int frames_done_ = 0, frames_expected_ = 0; ///< frames of the current row
};

/// Returns the reference. If the rays of the reference are random, it gets a seed that no row has.
std::string choose_reference_unlike_rows(const std::string& reference,
                                         const std::vector<std::string>& rows,
                                         const scene::Scene& scene) {
    if (!draws_lobe_rays(reference) && !draws_environment_rays(reference, scene)) return reference;
    return set_lobe_seed(reference, ReferenceSeeds(rows).next());
}

void run_lag(const StudyInput& input) {
    Request base = input.request.base;
    if (input.request.both_models)
        base.techniques.erase(std::unique(base.techniques.begin(), base.techniques.end()),
                              base.techniques.end());
    measure_lag(input.session,
                {.base = base,
                 .reference = choose_reference_unlike_rows(input.request.reference, base.techniques,
                                                           base.scene),
                 .reference_seconds = input.request.reference_seconds,
                 .watcher = input.request.watcher,
                 .on_finished_row = input.tell},
                *(input.comparison.lag = std::make_shared<report::LagResults>()));
}

const RegisteredStudy kLagStudy{
    {.name = "lag",
     .help = "also measure how far rows that read last frame's captures lag behind a moving scene; "
             "about 2300 frames per row",
     .order = 30,
     .run = run_lag}};

} // namespace

void measure_lag(Session& session, const LagRequest& request, report::LagResults& lag) {
    lag.complete = false;
    LagMeasurement(session, request, lag).measure_rows();
}

} // namespace catoptric::study
