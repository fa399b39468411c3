#include "study/causes.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "measure/causes.hpp"
#include "measure/display.hpp"
#include "measure/lines.hpp"
#include "measure/masks.hpp"
#include "measure/pixel_error.hpp"
#include "measure/shapley.hpp"
#include "report/comparison.hpp"
#include "scene/rough_reflectors.hpp"
#include "session/access.hpp"
#include "session/frames.hpp"
#include "session/plan_file.hpp"
#include "session/technique_choice.hpp"
#include "session/watcher.hpp"
#include "shared.h"
#include "study/study.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

namespace catoptric::app {

namespace {

/// A cause that the technique's own shader can ablate, with or without the others.
struct AblatableErrorCause {
    const char* name;
    std::uint32_t mends; ///< sum of shared::kAblate...
};

constexpr AblatableErrorCause kAblatableCauses[] = {
    {"direction", shared::kAblateDistance | shared::kAblateDirection},
    {"hidden target", shared::kAblateHiddenPoints},
    {"texels", shared::kAblateTexelColour},
    {"mirror in mirror", shared::kAblateMirrorReflections | shared::kAblateSelfReflection},
    {"shadow map", shared::kAblateShadows}};
constexpr std::size_t kAblatableCauseCount = std::size(kAblatableCauses);
constexpr std::uint32_t kAllErrorCausesMask = (1U << kAblatableCauseCount) - 1;

/// Returns the flags of all causes that the coalition removes, as a sum of shared::kAblate... Bit i
/// of `coalition` stands for cause i.
std::uint32_t combine_ablation_flags(std::uint32_t coalition) {
    std::uint32_t ablated = 0;
    for (std::size_t i = 0; i < kAblatableCauseCount; ++i)
        if ((coalition >> i & 1U) != 0) ablated |= kAblatableCauses[i].mends;
    return ablated;
}

/// The earlier frames whose history a picture uses. The picture leaves this history unchanged.
struct HistorySourceFrames {
    std::string technique;
    bool is_settled = false; ///< history of this very instant: nothing is a frame late
    auto operator<=>(const HistorySourceFrames&) const = default;
};

/// Returns the technique with distances stored as 32-bit floats.
std::string technique_with_float_distances(const std::string& technique) {
    const TechniqueChoice choice = parse_technique(technique);
    const bool is_full = std::ranges::none_of(choice.settings, [](const auto& setting) {
        return setting.name == "distance" && setting.text != "r32f";
    });
    if (is_full) return technique;
    std::string text = choice.technique;
    char separator = ':';
    for (const auto& setting : choice.settings) {
        if (!setting.changed || setting.name == "distance" || setting.name == "range") continue;
        text += separator + setting.name + "=" + setting.text;
        separator = ',';
    }
    return text;
}

constexpr int kSettlingFrames =
    16; // frames; deeper bounces are below a rounding of the picture's halves

/// Returns the frames that precede the judged picture. These are the row's own frames, or frames of
/// a scene that stands still at the instant of the last picture. Returns the latter if both give
/// the same picture.
HistorySourceFrames choose_history_source(const Request& base, const std::string& technique,
                                          bool is_settled) {
    const bool may_lag = base.animate || base.total() <= kSettlingFrames;
    return {technique, is_settled || !may_lag};
}

Request make_history_request(const Request& base, const HistorySourceFrames& history) {
    Request request = base;
    if (!base.animate || history.is_settled) {
        request.time = base.instant(base.total());
        request.animate = false;
    }
    request.frames = 1;
    request.warmup = history.is_settled ? kSettlingFrames : base.total() - 1;
    request.techniques = {history.technique};
    request.model = RenderedWork::required; // gives the same pictures, and their times are not used
    return request;
}

using MirrorPixelValues = std::vector<double>;

MirrorPixelValues subtract_pixel_values(const MirrorPixelValues& from,
                                        const MirrorPixelValues& what) {
    MirrorPixelValues left(from.size());
    std::ranges::transform(from, what, left.begin(), std::minus());
    return left;
}

/// Returns the values of the pixels where `chosen` equals `told`, and 0 for all other pixels.
MirrorPixelValues keep_values_of_chosen_pixels(const std::vector<bool>& chosen, bool told,
                                               MirrorPixelValues values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (chosen[i] != told) values[i] = 0;
    return values;
}

/// The histories that pictures of a row use. Some of them may be equal.
struct ErrorHistorySources {
    HistorySourceFrames row, row_settled;
    HistorySourceFrames stored, settled; ///< frames with distances stored as 32-bit floats
};

ErrorHistorySources choose_history_sources(const Request& base, const std::string& technique) {
    const std::string full = technique_with_float_distances(technique);
    return {choose_history_source(base, technique, false),
            choose_history_source(base, technique, true), choose_history_source(base, full, false),
            choose_history_source(base, full, true)};
}

/// Returns, for each history, the sets of removed causes for which a picture is rendered.
std::map<HistorySourceFrames, std::vector<std::uint32_t>>
list_needed_ablations(const ErrorHistorySources& histories) {
    std::map<HistorySourceFrames, std::vector<std::uint32_t>> wanted;
    for (const HistorySourceFrames& history :
         {histories.row, histories.row_settled, histories.stored})
        wanted[history] = {0};
    for (std::size_t i = 0; i < kAblatableCauseCount; ++i) wanted[histories.row].push_back(1U << i);
    std::vector<std::uint32_t>& all = wanted[histories.settled];
    all.resize(kAllErrorCausesMask + 1);
    std::iota(all.begin(), all.end(), 0U);
    return wanted;
}

/// Squared errors of the mirrors' pixels.
struct AblatedPixelErrors {
    measure::ShapleyValues shapley; ///< Shapley values with the history `settled`
    /// Errors of those sets of removed causes whose pictures are evaluated one by one.
    std::map<std::pair<HistorySourceFrames, std::uint32_t>, MirrorPixelValues> kept;
    measure::Mask off; ///< pixels that are off in the row's own picture
};

std::vector<measure::PixelErrorCause> compute_cause_shares(const ErrorHistorySources& histories,
                                                           const AblatedPixelErrors& errors,
                                                           const std::vector<bool>& disagree) {
    const auto of = [&](const HistorySourceFrames& history,
                        std::uint32_t coalition = 0) -> const MirrorPixelValues& {
        return errors.kept.at({history, coalition});
    };
    const MirrorPixelValues &row = of(histories.row),
                            &left = of(histories.settled, kAllErrorCausesMask),
                            format = subtract_pixel_values(row, of(histories.stored));
    std::vector<measure::PixelErrorCause> parts{
        {"storage format", format, format},
        {"last frame", subtract_pixel_values(of(histories.stored), of(histories.settled)),
         subtract_pixel_values(row, of(histories.row_settled))}};
    for (std::size_t i = 0; i < kAblatableCauseCount; ++i)
        parts.push_back({kAblatableCauses[i].name,
                         subtract_pixel_values(MirrorPixelValues(row.size()),
                                               errors.shapley.shapley_values_of_player(i)),
                         subtract_pixel_values(row, of(histories.row, 1U << i))});
    parts.push_back({"silhouettes", keep_values_of_chosen_pixels(disagree, true, left),
                     keep_values_of_chosen_pixels(disagree, true, row)});
    parts.push_back({"rest", keep_values_of_chosen_pixels(disagree, false, left), {}});
    return parts;
}

/// Throws `usage` for another reference than the default, because removed causes are replaced by
/// rays of the default reference.
void check_reference_is_default(const std::string& reference) {
    const TechniqueChoice found = parse_technique(reference), wanted = parse_technique(kReference);
    check(found.technique == wanted.technique && found.settings == wanted.settings, Failure::usage,
          "--causes: wanted the default reference, ", kReference,
          ", whose rays tell causes apart, found '", reference, "'");
}

/// Throws `usage` for techniques with light between surfaces, because the rays that replace removed
/// causes have no such light.
void check_light_is_ambient(const CompareRequest& request) {
    for (const std::string& text : request.base.techniques)
        check(!read_technique_plan(text).uses_light_probes(), Failure::usage,
              "--causes: wanted rows without light probes, found '", text,
              "'; causes of error in their light are not known");
}

/// Throws for scenes with rough mirrors, because the code that removes causes supports perfect
/// mirrors only.
void check_mirrors_are_sharp(const CompareRequest& request, int, report::Comparison&) {
    check_light_is_ambient(request);
    const scene::Scene& scene = request.base.scene;
    for (const std::size_t i : scene::mirrors(scene))
        check(!scene::may_reflect_by_lobe(scene, scene.objects[i]), Failure::usage,
              "--causes: wanted mirrors that reflect sharply, found rough mirror ",
              quote_text_with_escapes(scene.objects[i].name),
              "; causes of error in rough reflections are not known");
}

void measure_error_causes(const StudyInput& input) {
    const CompareRequest& request = input.request;
    std::vector<report::Row>& rows = input.comparison.rows;
    std::optional<ErrorCauseFinder> finder;
    for (std::size_t i = 0; i < request.base.techniques.size(); ++i) {
        const std::string& text = request.base.techniques[i];
        // Plans are left out, because their error belongs to several searches.
        const bool is_plan = !read_technique_plan(text).is_technique;
        const bool is_twin = request.both_models &&
                             rows[i].model == rendered_work_name(RenderedWork::required);
        if (!rows[i].lookup || is_plan || is_twin) continue;
        report_row_to_watcher(request.watcher, "causes of " + text, i, rows.size());
        if (!finder)
            finder.emplace(input.session, request.base, input.truth.get_reference("1").part.hdr,
                           input.truth.find_mirror_hits(), request.watcher);
        rows[i].causes = std::make_shared<report::Causes>(finder->find(text));
        input.tell();
    }
}

const RegisteredStudy kErrorCausesStudy{
    {.name = "causes",
     .help = "also split each row's error by cause; draws at least 32 more pictures per row",
     .order = 20,
     .check_reference = check_reference_is_default,
     .prepare = check_mirrors_are_sharp,
     .run = measure_error_causes}};

} // namespace

void render_ablated_pictures(Session& session, const Request& request,
                             const std::vector<std::uint32_t>& ablated, const PictureVisitor& visit,
                             const Watcher& watcher) {
    FrameLoop frames(session, request);
    for (int k = 1; k < request.total(); ++k) frames.render_next(), throw_if_stopped(watcher);
    FrameSpec aside = request;
    aside.time = request.instant(request.total());
    aside.timing = PassTimingMode::pipelined;
    aside.keeps_history = true;
    for (std::size_t entry = 0; entry < ablated.size(); ++entry) {
        visit(entry, Access::render_frame(session, aside, {.ablated = ablated[entry]}).hdr());
        throw_if_stopped(watcher);
    }
}

ErrorCauseFinder::ErrorCauseFinder(Session& session, const Request& base,
                                   const measure::Picture& truth,
                                   const std::vector<std::uint32_t>& hits, const Watcher& watcher)
    : study_session_(session), base_(base), truth_(truth), hits_(hits), watcher_(watcher),
      pixels_(measure::list_mirror_pixels(hits)) {
    // This technique follows no ray through other mirrors. Its look-ups therefore name the mirror
    // that the rasteriser draws in each pixel.
    Request request = make_history_request(base, {"naive:bounces=1,face=1,shadow=none", false});
    request.warmup = 0, request.time = base.instant(base.total()), request.animate = false;
    request.with_lookup = true;
    const RunResult result = run(session, request);
    for (const std::size_t place : pixels_) {
        const vec4& looked = result.parts.front().lookup[place];
        const std::uint32_t drawn = looked.w > 0
                                        ? (static_cast<std::uint32_t>(looked.w) - 1) / 8 + 1
                                        : 0;
        disagree_.push_back(drawn !=
                            measure::first_mirror_of_hit_word(hits[place]).mirror_number());
    }
}

report::Causes ErrorCauseFinder::find(const std::string& technique) const {
    const ErrorHistorySources histories = choose_history_sources(base_, technique);
    AblatedPixelErrors found{measure::ShapleyValues(kAblatableCauseCount, pixels_.size()),
                             {},
                             measure::Mask(hits_.size())};
    for (const auto& [history, coalitions] : list_needed_ablations(histories)) {
        std::vector<std::uint32_t> ablated;
        std::ranges::transform(coalitions, std::back_inserter(ablated), combine_ablation_flags);
        const auto judge = [&](std::size_t entry, const measure::Picture& picture) {
            const std::uint32_t coalition = coalitions[entry];
            MirrorPixelValues errors;
            for (const std::size_t place : pixels_) {
                const vec3 shown = measure::apply_exposure(picture.pixels[place], base_.exposure),
                           truth = measure::apply_exposure(truth_.pixels[place], base_.exposure);
                errors.push_back(measure::squared_error(shown, truth));
                if (history == histories.row && coalition == 0)
                    found.off[place] = measure::differs_visibly(shown, truth);
            }
            if (history == histories.settled) found.shapley.add_coalition_value(coalition, errors);
            if (std::popcount(coalition) <= 1 || coalition == kAllErrorCausesMask)
                found.kept[{history, coalition}] = std::move(errors);
        };
        render_ablated_pictures(study_session_, make_history_request(base_, history), ablated,
                                judge, watcher_);
    }
    return measure::summarise_error_causes(hits_, found.off, found.kept.at({histories.row, 0}),
                                           compute_cause_shares(histories, found, disagree_));
}

} // namespace catoptric::app
