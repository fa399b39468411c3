#include "study/views.hpp"

#include "core/error.hpp"
#include "measure/halves.hpp"
#include "measure/interval.hpp"
#include "measure/views.hpp"
#include "report/comparison.hpp"
#include "scene/pose.hpp"
#include "session/access.hpp"
#include "session/frames.hpp"
#include "session/scene_info.hpp"
#include "session/seeded_camera.hpp"
#include "session/technique_choice.hpp"
#include "session/watcher.hpp"
#include "study/compare_row.hpp"
#include "study/picture_rows.hpp"
#include "study/reference_cache.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>

namespace catoptric::study {

namespace {

constexpr int kPictureGapColumns = 4;

/// Returns the instant at `share` of the period after `start`, rounded to about a thousandth of the
/// period.
double view_instant(double start, double period, double share) {
    const double parts = std::pow(10, 3 - std::floor(std::log10(period))); // steps per second
    return std::floor((start + period * share) * parts) / parts;
}

scene::Camera make_camera(const measure::CameraFacts& facts) {
    return {facts.name,
            facts.eye,
            facts.target,
            facts.up,
            facts.vertical_fov_degrees,
            facts.orthographic_height};
}

/// Returns a request for the picture from a view, as `render` takes it.
Request make_view_request(const Request& base, const measure::View& view) {
    Request request = base;
    request.camera = make_camera(view.camera);
    request.time = view.time;
    request.animate = false;
    request.warmup = 0;
    request.frames = Request().total();
    request.until_settled = true;
    return request;
}

measure::Picture side_by_side(const measure::Picture& left, const measure::Picture& right) {
    measure::Picture both(left.width + kPictureGapColumns + right.width, left.height);
    std::ranges::fill(both.pixels, vec3(1));
    for (int y = 0; y < left.height; ++y) {
        for (int x = 0; x < left.width; ++x) both.at(x, y) = left.at(x, y);
        for (int x = 0; x < right.width; ++x)
            both.at(left.width + kPictureGapColumns + x, y) = right.at(x, y);
    }
    return both;
}

/// Adds the errors of a row's picture in a view. Only `part.hdr` and `part.display` are used.
void add_view_errors(report::Row& row, const TechniqueResult& part, const ReferencePicture& truth,
                     const std::vector<std::uint32_t>& hits, std::size_t mirrors, double exposure) {
    const std::vector<float> flip_map = compute_flip_map(part.hdr, truth.compared(), exposure);
    row.views.push_back(
        masked_errors(part.hdr, truth.compared(), flip_map, hits, mirrors, exposure));
    const double flip = row.views.back().error.flip;
    // A view that shows no mirror pixel has no error, and is never the worst view.
    if (!std::isnan(flip) && (!row.worst || flip > row.views[row.worst->view].error.flip))
        row.worst = std::make_shared<measure::WorstView>(measure::WorstView{
            row.views.size() - 1, side_by_side(part.display, truth.part.display)});
}

/// The reference picture of a view, and the first hits of its camera rays.
struct ViewReference {
    Request at_view;
    ReferenceCache cache;
    std::vector<std::uint32_t> hits;

    ViewReference(Session& session, const ViewsRequest& request, const measure::View& view)
        : at_view(make_view_request(request.base, view)),
          cache(session, at_view, request.reference, request.watcher, request.reference_seconds),
          hits(cache.hits()) {}
    /// Renders the reference pictures of the view for all rows. Reduces their noise for at most
    /// `seconds` in all, until the noise reaches the target. Returns the largest noise floor of the
    /// pictures, by the target's quantity; NaN for references without noise.
    double render(const std::vector<std::string>& rows, double seconds,
                  const NoiseFloorTarget& target) {
        std::set<std::string> sample_counts;
        for (const std::string& text : rows)
            sample_counts.insert(sample_count(parse_technique(text)));
        double floor = NAN;
        for (const std::string& samples : sample_counts) {
            cache.grow(samples, seconds / static_cast<double>(sample_counts.size()), target);
            if (cache.has_noise())
                floor = std::fmax(floor, cache.measure_noise_floor(samples, target.quantity));
        }
        // All references are rendered now, because rendering a reference later would interrupt
        // frames that share captures.
        for (const std::string& samples : sample_counts) cache.get(samples);
        return floor;
    }
};

/// Returns the index after the last view that shares the instant of view `first`, for at most
/// `most` views. Captures of these views settle once, and the reference of each view is kept until
/// then.
std::size_t end_of_instant(const std::vector<measure::View>& views, std::size_t first,
                           std::size_t most) {
    std::size_t end = first + 1;
    while (end < views.size() && end - first < most && views[end].time == views[first].time) ++end;
    return end;
}

constexpr int kMaxViewWarnings = 3; // most warnings of all rows of files

/// Adds the errors of a row of files in view `view` (from 1), if the row has a picture of this
/// view. `warned` counts the warnings of all rows.
void add_picture_error(const ViewsRequest& request, std::size_t index, std::size_t view,
                       const ReferencePicture& truth, const std::vector<std::uint32_t>& hits,
                       std::size_t mirrors, report::Row& row, int& warned) {
    const auto& [name, path] = request.pictures[index];
    const std::optional<std::string> file = find_view_picture(path, view);
    if (!file) return;
    const double exposure = request.base.exposure;
    TechniqueResult part;
    part.hdr = read_row_picture(*file, exposure);
    part.display = measure::to_display(part.hdr, exposure);
    add_view_errors(row, part, truth, hits, mirrors, exposure);
    for (const std::string& warning :
         picture_row_warnings(name + "', '" + view_picture_name(view), *file, part.hdr,
                              row.views.back().error.rmse, truth.compared(), hits, exposure))
        if (request.on_warning && ++warned <= kMaxViewWarnings) request.on_warning(warning);
}

void check_view_count(std::string_view option, int count) {
    constexpr int kMinViewsForInterval = measure::kMinIntervalSamples;
    check(count == 1 || count >= kMinViewsForInterval, Failure::usage, option,
          ": wanted 1 or at least ", kMinViewsForInterval,
          ", because fewer give no 95 % interval of the median, found ", count);
}

void measure_drawn_views(const StudyInput& input) {
    if (!input.comparison.views.empty())
        measure_views(input.session,
                      {.base = input.request.base,
                       .reference = input.request.reference,
                       .reference_seconds = input.request.reference_seconds,
                       .noise_target = input.noise_target,
                       .watcher = input.request.watcher,
                       .pictures = input.request.pictures,
                       .cameras_per_instant = input.request.cameras_per_instant,
                       .on_finished_view = input.tell,
                       .on_warning = input.warn},
                      input.comparison);
}

const RegisteredStudy kViewsStudy{
    {.name = "views",
     .help = "also measure errors over N random views from --seed, at least 6, with intervals (1: "
             "none)",
     .order = 10,
     .number = "N",
     .high = 10'000,
     .check_count = check_view_count,
     .prepare =
         [](const CompareRequest& request, int count, report::Comparison& comparison) {
             comparison.views = draw_views(request.base, count, request.cameras_per_instant);
         },
     .run = measure_drawn_views}};

} // namespace

std::vector<measure::View> draw_views(const Request& request, int count, int cameras_per_instant) {
    check_view_count("views", count);
    check(cameras_per_instant >= 1, Failure::usage,
          "cameras per instant: wanted at least 1, found ", cameras_per_instant);
    std::vector<measure::View> views(count > 1 ? static_cast<std::size_t>(count) : 0);
    if (views.empty()) return views;
    const double period = scene::scene_period(request.scene);
    std::mt19937_64 random(request.seed);
    std::vector<std::uint64_t> seeds;
    for (measure::View& view : views) {
        view.seed = random() >> 32; // a short seed is easy to type, and exact in every JSON reader
        seeds.push_back(view.seed);
        const double share = static_cast<double>(random() >> 32) * 0x1p-32;
        view.time = period > 0 ? view_instant(request.time, period, share) : request.time;
        const auto index = &view - views.data();
        if (index % cameras_per_instant != 0) view.time = views[index - 1].time;
    }
    std::vector<scene::Camera> cameras;
    if (!(period > 0)) cameras = make_seeded_cameras(request.scene, request.time, seeds);
    for (std::size_t i = 0; i < views.size(); ++i)
        views[i].camera = make_camera_facts(
            period > 0 ? make_seeded_camera(request.scene, views[i].time, seeds[i]) : cameras[i],
            views[i].time);
    return views;
}

namespace {

void check_views_request(const ViewsRequest& request, const report::Comparison& comparison) {
    const std::size_t texts = request.base.techniques.size(),
                      row_count = texts + request.pictures.size();
    check(row_count == comparison.rows.size(), Failure::internal, "views of ", row_count,
          " techniques and pictures: wanted as many rows, found ", comparison.rows.size());
    check(request.row_sessions.empty() ? !request.continues_instant
                                       : request.row_sessions.size() == texts,
          Failure::internal, "views: wanted a session for each of ", texts, " techniques, found ",
          request.row_sessions.size());
}

/// Adds the errors of the picture files of a view, from 1.
void add_picture_errors(const ViewsRequest& request, std::size_t view, ViewReference& truth,
                        std::size_t mirrors, report::Comparison& comparison, int& warned) {
    for (std::size_t k = 0; k < request.pictures.size(); ++k)
        add_picture_error(request, k, view, truth.cache.get("1"), truth.hits, mirrors,
                          comparison.rows[request.base.techniques.size() + k], warned);
}

} // namespace

void measure_views(Session& session, const ViewsRequest& request, report::Comparison& comparison) {
    check_views_request(request, comparison);
    const std::vector<std::string>& texts = request.base.techniques;
    const std::size_t count = comparison.views.size(), pictures = texts.size() + 1;
    const std::size_t mirrors = scene::mirrors(request.base.scene).size();
    int warned = 0;
    std::size_t finished = 0; // number of finished pictures
    const auto report_picture = [&](std::size_t view, const std::string& what) {
        report_row(request.watcher,
                   "view " + std::to_string(view + 1) + " of " + std::to_string(count) + ": " +
                       what,
                   finished++, count * pictures);
    };
    double seconds_left = request.reference_seconds;
    std::vector<const report::Row*> rows;
    for (const report::Row& row : comparison.rows) rows.push_back(&row);
    for (std::size_t first = 0, end = 0; first < count; first = end) {
        end = end_of_instant(comparison.views, first,
                             static_cast<std::size_t>(request.cameras_per_instant));
        std::vector<std::unique_ptr<ViewReference>> truths;
        for (std::size_t i = first; i < end; ++i) {
            report_picture(i, "reference");
            truths.push_back(
                std::make_unique<ViewReference>(session, request, comparison.views[i]));
            const double floor = truths.back()->render(
                texts, seconds_left / static_cast<double>(count - i),
                request.noise_target.value_or(
                    NoiseFloorTarget{.floor = measure::target_noise_floor(rows)}));
            if (comparison.noise) comparison.noise->view_floors.push_back(floor);
            seconds_left = std::max(0.0, seconds_left - truths.back()->cache.noisy_seconds());
        }
        for (std::size_t k = 0; k < texts.size(); ++k)
            for (std::size_t i = first; i < end; ++i) {
                report_picture(i, comparison.rows[k].label);
                ViewReference& truth = *truths[i - first];
                Request one = truth.at_view;
                one.techniques = {texts[k]};
                // Both models draw the same picture. The model `required` keeps captures that do
                // not depend on the camera.
                one.model = RenderedWork::required;
                const bool continues = i > first || (first == 0 && request.continues_instant);
                const RunResult result = run_with_history(
                    request.row_sessions.empty() ? session : *request.row_sessions[k], one,
                    request.watcher, continues ? StartHistory::of_last_frame : StartHistory::none);
                add_view_errors(comparison.rows[k], result.parts.front(),
                                truth.cache.get(sample_count(parse_technique(texts[k]))),
                                truth.hits, mirrors, request.base.exposure);
            }
        for (std::size_t i = first; i < end; ++i)
            add_picture_errors(request, i + 1, *truths[i - first], mirrors, comparison, warned);
        if (request.on_finished_view) request.on_finished_view();
    }
    if (warned > kMaxViewWarnings && request.on_warning)
        request.on_warning(std::to_string(warned - kMaxViewWarnings) +
                           " more views of such rows look suspicious in the same way");
}

} // namespace catoptric::study
