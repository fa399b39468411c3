// The study `truth-causes`: the distance of simple ray tracing to path tracing, by cause. Simple
// ray tracing draws glass as a diffuse surface and rough surfaces as if they were sharp. A chain of
// references removes one simplification after the other: first those of surfaces, which gives the
// usual reference, then those of light, until the last reference is path traced. Each step of the
// chain counts by the squared error that it removes.
#include "measure/display.hpp"
#include "measure/masks.hpp"
#include "measure/metric.hpp"
#include "measure/picture_mean.hpp"
#include "measure/pixel_error.hpp"
#include "report/text.hpp"
#include "scene/light.hpp"
#include "scene/material_facts.hpp"
#include "session/session.hpp"
#include "shared.h"
#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

namespace catoptric::study {

namespace {

constexpr const char* kTruthCausesMetricName = "truth_causes";
/// Points of each lamp in the reference with large lamps, unless the scene has too many lamps.
constexpr std::size_t kPointsOfLamp = 64;
/// Most lights in a scene with glass, in which rays branch: each ray goes to all lights, and an
/// invocation may take kMaxTraceSteps steps only.
constexpr std::size_t kMostLightsBesideGlass = 16;
/// Rays to the environment from each surface in a frame of the reference with its shadows.
constexpr int kRaysToEnvironment = 64;
/// A squared error below this number of standard deviations of its noise counts as 0.
constexpr double kDeviationsOfNoError = 3;
/// A squared error below this number is due to rounding in means of many equal rays.
constexpr double kRoundingError = 1e-10;

/// A reference of the chain: the scene with settings of its light, and the technique.
struct ChainReference {
    std::string removed_cause; ///< what the reference before simplifies; empty for the first
    scene::Scene scene;
    std::string technique;
};

bool has_glass(const scene::Scene& scene) {
    return std::ranges::any_of(scene.objects, [&](const scene::Object& object) {
        return scene::is_glass(scene.materials[object.material]);
    });
}

/// Returns how many points each lamp gets; 1 if no lamp has an area, or no more points fit.
int choose_lamp_points(const scene::Scene& scene) {
    const std::size_t others = scene.punctual.size(), all = scene::list_lights(scene).size(),
                      limit = has_glass(scene) ? kMostLightsBesideGlass
                                               : std::size_t{shared::kMaxLights};
    if (all <= others || others >= limit) return 1;
    const std::size_t lamps = all - others, most = (limit - others) / lamps;
    return static_cast<int>(std::clamp<std::size_t>(most, 1, kPointsOfLamp));
}

/// Returns the scene with diffuse surfaces in place of glass. They have the glass's base colour.
scene::Scene replace_glass(scene::Scene scene) {
    for (scene::Object& object : scene.objects)
        if (scene::is_glass(scene.materials[object.material])) object.mirror = false;
    for (scene::Material& material : scene.materials)
        if (scene::is_glass(material)) material.transmission = 0;
    return scene;
}

/// Returns the chain from simple ray tracing to path tracing. Steps that change nothing in this
/// scene are left out.
std::vector<ChainReference> make_reference_chain(scene::Scene scene) {
    scene.light_samples = 1, scene.environment_shadows = 0;
    const std::string usual = choose_reference("", scene);
    std::vector<ChainReference> chain;
    const bool shows_glass = has_glass(scene);
    if (shows_glass) chain.push_back({"", replace_glass(scene), kReference});
    chain.push_back({shows_glass ? "glass" : "", scene, kReference});
    if (usual != kReference) chain.push_back({"rough lobes", scene, usual});
    scene::Scene refined = scene;
    if (const int points = choose_lamp_points(scene); points > 1) {
        refined.light_samples = points;
        chain.push_back({"light as a point", refined, usual});
    }
    if (scene.environment) {
        refined.environment_shadows = kRaysToEnvironment;
        chain.push_back({"occlusion of the environment", refined, usual});
    }
    chain.push_back({"light between surfaces", std::move(scene), kPathReference});
    return chain;
}

/// Renders one reference of the chain, as two means of frames if it has noise.
class ChainPictures {
public:
    ChainPictures(const StudyInput& input, ChainReference reference)
        : technique_(input.request.reference_seconds > 0
                         ? choose_coarse_technique(reference.technique, input.request.base.size)
                         : reference.technique),
          request_(input.request.base), watcher_(input.request.watcher),
          has_noise_(is_noisy(technique_, reference.scene)),
          session_(input.engine, reference.scene) {
        request_.scene = std::move(reference.scene);
        request_.model = RenderedWork::everything;
        request_.time = input.request.base.instant(input.request.base.total());
        request_.animate = false;
        request_.warmup = 0, request_.frames = 1;
    }

    /// Adds a frame to each half. Does nothing for a reference without noise that has its picture.
    void add_frames(ReferenceSeeds& seeds) {
        if (!has_noise_ && halves_[0].count() > 0) return;
        for (measure::PictureMean& half : halves_) {
            request_.techniques = {has_noise_ ? set_lobe_seed(technique_, seeds.next())
                                              : technique_};
            half.add(run(session_, request_, watcher_).parts.front().hdr);
            if (!has_noise_) return;
        }
    }
    int frame_count() const { return halves_[0].count(); }
    /// Returns the mean of the first or the second half; the one picture of a reference without
    /// noise.
    measure::Picture half(std::size_t index) const {
        return halves_[has_noise_ ? index : 0].mean();
    }

private:
    std::string technique_;
    Request request_;
    const Watcher& watcher_;
    bool has_noise_;
    Session session_;
    std::array<measure::PictureMean, 2> halves_;
};

/// The distance of a reference to the path-traced one over the pixels of a mask.
struct ChainDistance {
    /// Mean of (X - A)(Y - B) over the halves, after values are clamped to 0..1 as on a display.
    /// The noise of the halves adds nothing, except where it crosses 0 or 1.
    double squared_error = 0;
    double deviation = 0; ///< standard deviation of the squared error by the noise
    double flip = 0;      ///< mean of the FLIP of X and A, and of Y and B
};

/// Two halves of a picture, after exposure, and as displayed.
struct ShownHalves {
    std::array<measure::Picture, 2> light, display;
};

ShownHalves show_halves(const ChainPictures& pictures, double exposure) {
    ShownHalves shown;
    for (std::size_t i = 0; i < 2; ++i) {
        shown.light[i] = measure::apply_exposure(pictures.half(i), exposure);
        shown.display[i] = measure::to_unrounded_display(pictures.half(i), exposure);
    }
    return shown;
}

ChainDistance chain_distance(const ShownHalves& x, const ShownHalves& truth,
                             const measure::Mask& mask) {
    double sum = 0, squares = 0, values = 0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) continue;
        std::array<dvec3, 2> error;
        for (std::size_t half = 0; half < 2; ++half)
            error[half] = measure::clamp_pixel(x.light[half].pixels[i]) -
                          measure::clamp_pixel(truth.light[half].pixels[i]);
        const dvec3 product = error[0] * error[1],
                    noise = (error[0] + error[1]) / 2.0 * (error[0] - error[1]);
        sum += product.x + product.y + product.z;
        const double total = noise.x + noise.y + noise.z; // the channels share their paths
        squares += total * total;
        values += 3;
    }
    ChainDistance distance{sum / values, std::sqrt(squares) / values};
    for (std::size_t half = 0; half < 2; ++half)
        distance.flip += measure::flip_mean(measure::flip(x.display[half], truth.display[half]),
                                            mask) /
                         2;
    return distance;
}

/// The part of the distance that a step of the chain removes, over one mask.
struct CausePart {
    ChainDistance before, after;
    double share = 0; ///< of the squared error of the first reference; 0 if this is noise
};

/// Returns the part of each step. The shares add up to 1, or are all 0 if the first reference does
/// not differ from path tracing by more than the noise.
std::vector<CausePart> split_chain_distance(const std::vector<ShownHalves>& chain,
                                            const measure::Mask& mask) {
    std::vector<ChainDistance> distances;
    for (const ShownHalves& shown : chain)
        distances.push_back(chain_distance(shown, chain.back(), mask));
    distances.back().squared_error = distances.back().deviation = 0; // to itself
    // The FLIP between the halves of path tracing is the noise floor.
    distances.back().flip = measure::flip_mean(
        measure::flip(chain.back().display[0], chain.back().display[1]), mask);
    const ChainDistance& whole = distances.front();
    const bool differs = whole.squared_error >
                         std::max(kDeviationsOfNoError * whole.deviation, kRoundingError);
    std::vector<CausePart> parts;
    for (std::size_t i = 1; i < distances.size(); ++i)
        parts.push_back({distances[i - 1], distances[i],
                         differs ? (distances[i - 1].squared_error - distances[i].squared_error) /
                                       whole.squared_error
                                 : 0});
    return parts;
}

measure::MetricParts part_values(const std::string& cause, const CausePart& all,
                                 const CausePart& mirrors) {
    return {"cause",
            cause,
            {{"share", all.share},
             {"squared_error", all.before.squared_error},
             {"squared_error_left", all.after.squared_error},
             {"deviation", all.before.deviation},
             {"flip", all.before.flip},
             {"flip_left", all.after.flip},
             {"mirrors_share", mirrors.share},
             {"mirrors_squared_error", mirrors.before.squared_error},
             {"mirrors_squared_error_left", mirrors.after.squared_error},
             {"mirrors_deviation", mirrors.before.deviation},
             {"mirrors_flip", mirrors.before.flip},
             {"mirrors_flip_left", mirrors.after.flip}}};
}

void set_truth_causes(const StudyInput& input, const std::vector<std::string>& causes,
                      const std::vector<std::unique_ptr<ChainPictures>>& chain) {
    std::vector<ShownHalves> shown;
    for (const std::unique_ptr<ChainPictures>& pictures : chain)
        shown.push_back(show_halves(*pictures, input.request.base.exposure));
    const std::vector<std::uint32_t>& hits = input.truth.hits();
    const std::vector<CausePart> all = split_chain_distance(shown, measure::mask_all(hits)),
                                 mirrors = split_chain_distance(shown, measure::mask_mirrors(hits));
    std::vector<measure::MetricParts> list;
    for (std::size_t i = 0; i < causes.size(); ++i)
        list.push_back(part_values(causes[i], all[i], mirrors[i]));
    for (report::Row& row : input.comparison.rows)
        measure::set_study_metric(row, kTruthCausesMetricName, list);
}

void split_path_distance(const StudyInput& input) {
    std::vector<std::string> causes, rows = input.request.base.techniques;
    rows.push_back(input.request.reference);
    ReferenceSeeds seeds(rows);
    std::vector<std::unique_ptr<ChainPictures>> chain;
    for (ChainReference& reference : make_reference_chain(input.request.base.scene)) {
        if (!chain.empty()) causes.push_back(reference.removed_cause);
        chain.push_back(std::make_unique<ChainPictures>(input, std::move(reference)));
    }
    const auto start = std::chrono::steady_clock::now();
    const auto most = static_cast<std::size_t>(
        std::max(std::ceil(input.request.reference_seconds), 1.0));
    double seconds = 0, round = 0;
    do {
        report_row(input.request.watcher,
                   "references of the truth causes, " +
                       std::to_string(chain.back()->frame_count()) + " frames a half",
                   std::min(static_cast<std::size_t>(seconds), most), most);
        for (const std::unique_ptr<ChainPictures>& pictures : chain) pictures->add_frames(seeds);
        const double before = seconds;
        seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        round = seconds - before;
    } while (seconds + round < input.request.reference_seconds);
    set_truth_causes(input, causes, chain);
    input.tell();
}

double find_part_number(const measure::MetricParts& parts, const std::string& name) {
    for (const auto& [what, value] : parts.values)
        if (const auto* number = std::get_if<double>(&value); what == name && number != nullptr)
            return *number;
    return NAN;
}

std::string format_square(double square) {
    return std::isfinite(square) ? fmt::format("{:.2e}", square) : std::string(report::kEmptyCell);
}

report::ReportTable make_truth_cause_table(const report::Comparison& comparison,
                                           const std::string& title, const std::string& prefix) {
    report::ReportTable table{
        title,
        {report::text_column("Cause"), "Share, %", "Squared error",
         "Squared error without the cause", "Deviation", "FLIP", "FLIP without the cause"},
        "The table compares simple ray tracing with path tracing. Each line removes one more cause "
        "of the difference, in this order. Glass: simple ray tracing draws it as a diffuse "
        "surface. Rough lobes: simple ray tracing draws rough mirrors as sharp, and other rough "
        "surfaces without their lobe. The usual reference lacks neither, so the first further line "
        "has its distance to path tracing. Share: the squared error that the line removes, "
        "in percent of the squared error in the first line. All shares are 0 if that squared "
        "error is below three deviations. Squared errors use two halves of each reference, so "
        "noise adds nothing unless it crosses 0 or 1. Deviation: standard deviation of the "
        "squared error by noise. FLIP includes noise; the last cell is the noise of path tracing. "
        "Light between surfaces includes caustics and the error of --ambient."};
    if (comparison.rows.empty()) return table;
    const measure::MetricValue value = measure::study_metric(comparison.rows.front(),
                                                             kTruthCausesMetricName);
    const auto* list = std::get_if<std::vector<measure::MetricParts>>(&value);
    if (list == nullptr) return table;
    for (const measure::MetricParts& parts : *list) {
        const auto number = [&](const char* name) {
            return find_part_number(parts, prefix + name);
        };
        table.rows.push_back(
            {parts.name, report::format_fixed(100 * number("share"), 1),
             format_square(number("squared_error")), format_square(number("squared_error_left")),
             format_square(number("deviation")), report::format_fixed(number("flip"), 4),
             report::format_fixed(number("flip_left"), 4)});
    }
    return table;
}

std::vector<report::ReportTable> make_truth_cause_tables(const report::Comparison& comparison) {
    return {
        make_truth_cause_table(comparison, "Distance to path tracing by cause, whole picture", ""),
        make_truth_cause_table(comparison, "Distance to path tracing by cause, mirrors",
                               "mirrors_")};
}

const RegisteredStudy kTruthCausesStudy{
    {.name = "truth-causes",
     .help = "also split the distance of simple ray tracing to path tracing into glass, rough "
             "lobes, lamps as points, occlusion of the environment, and light between surfaces; "
             "takes --reference-seconds",
     .order = 60,
     .run = split_path_distance,
     .metrics = {{.name = kTruthCausesMetricName,
                  .help = "distance of simple ray tracing to path tracing, by cause; the same "
                          "in each row",
                  .order = 795,
                  .get = measure::Metric::FromStudy{}}},
     .part = {.order = 710, .tables = make_truth_cause_tables}}};

} // namespace

} // namespace catoptric::study
