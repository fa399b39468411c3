#include "study/causes.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "measure/causes.hpp"
#include "measure/display.hpp"
#include "measure/masks.hpp"
#include "measure/picture_mean.hpp"
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
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace catoptric::study {

namespace {

/// A cause that the technique's own shader can ablate, with or without the others.
struct AblatableCause {
    const char* name;
    std::uint32_t mends; ///< sum of shared::kAblate...
};

constexpr AblatableCause kAblatableCauses[] = {
    {"direction", shared::kAblateDistance | shared::kAblateDirection},
    {"hidden target", shared::kAblateHiddenPoints},
    {"texels", shared::kAblateTexelColour},
    {"mirror in mirror", shared::kAblateMirrorReflections | shared::kAblateSelfReflection},
    {"shadow map", shared::kAblateShadows}};
constexpr std::size_t kCauseCount = std::size(kAblatableCauses);
constexpr std::uint32_t kAllCauses = (1U << kCauseCount) - 1;

/// Returns the flags of all causes that the coalition removes, as a sum of shared::kAblate... Bit i
/// of `coalition` stands for cause i.
std::uint32_t ablation_flags(std::uint32_t coalition) {
    std::uint32_t ablated = 0;
    for (std::size_t i = 0; i < kCauseCount; ++i)
        if ((coalition >> i & 1U) != 0) ablated |= kAblatableCauses[i].mends;
    return ablated;
}

/// A picture of a row with some causes removed.
struct AblatedPicture {
    std::uint32_t flags = 0; ///< sum of shared::kAblate...
    /// Whether it is the mean of pictures with different random directions, in two halves.
    bool is_mean = false;
    auto operator<=>(const AblatedPicture&) const = default;
};

constexpr std::uint32_t kAblateLobeLookup = shared::kAblateFilter | shared::kAblateDistanceLaw |
                                            shared::kAblateLobeShape;

/// How a row looks rough mirrors up.
enum class LobeLookup { sharply, in_filtered_levels, by_rays };

LobeLookup read_lobe_lookup(const std::string& technique) {
    const ParsedTechnique choice = parse_technique(technique);
    const auto rough = std::ranges::find(choice.settings, "rough", &Setting::name);
    if (rough == choice.settings.end() || rough->text == "none") return LobeLookup::sharply;
    return rough->text == "rays" ? LobeLookup::by_rays : LobeLookup::in_filtered_levels;
}

/// The earlier frames whose history a picture uses. The picture leaves this history unchanged.
struct HistorySourceFrames {
    std::string technique;
    bool is_settled = false; ///< history of this very instant: nothing is a frame late
    auto operator<=>(const HistorySourceFrames&) const = default;
};

/// Returns the technique with distances stored as 32-bit floats.
std::string with_float_distances(const std::string& technique) {
    const ParsedTechnique choice = parse_technique(technique);
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
    request.until_settled = !request.animate; // once the history repeats, it stays the same
    request.techniques = {history.technique};
    request.model = RenderedWork::required; // gives the same pictures, and their times are not used
    return request;
}

using MirrorPixelValues = std::vector<double>;

MirrorPixelValues subtract(const MirrorPixelValues& from, const MirrorPixelValues& what) {
    MirrorPixelValues left(from.size());
    std::ranges::transform(from, what, left.begin(), std::minus());
    return left;
}

/// Returns the values of the pixels where `chosen` equals `told`, and 0 for all other pixels.
MirrorPixelValues keep_chosen(const std::vector<bool>& chosen, bool told,
                              MirrorPixelValues values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (chosen[i] != told) values[i] = 0;
    return values;
}

/// The histories that pictures of a row use. Some of them may be equal.
struct HistorySources {
    HistorySourceFrames row, row_settled;
    HistorySourceFrames stored, settled; ///< frames with distances stored as 32-bit floats
};

HistorySources choose_history_sources(const Request& base, const std::string& technique) {
    const std::string full = with_float_distances(technique);
    return {choose_history_source(base, technique, false),
            choose_history_source(base, technique, true), choose_history_source(base, full, false),
            choose_history_source(base, full, true)};
}

using PictureWithHistory = std::pair<HistorySourceFrames, AblatedPicture>;

/// Pictures of a row with causes removed, and the parts of its error that follow from their errors.
class CauseLadder {
public:
    /// `has_noise`: the reference has noise, because some surface reflects by a lobe.
    CauseLadder(const Request& base, const std::string& technique, bool has_noise)
        : histories_(choose_history_sources(base, technique)), has_noise_(has_noise),
          lookup_(read_lobe_lookup(technique)) {}

    PictureWithHistory row() const { return {histories_.row, {}}; }

    /// Returns the pictures that are needed with each history.
    std::map<HistorySourceFrames, std::set<AblatedPicture>> pictures() const {
        std::map<HistorySourceFrames, std::set<AblatedPicture>> wanted;
        for (const HistorySourceFrames& history :
             {histories_.row, histories_.row_settled, histories_.stored, histories_.settled})
            wanted[history].insert(AblatedPicture{});
        for (std::size_t i = 0; i < kCauseCount && !has_noise_; ++i)
            wanted[histories_.row].insert({ablation_flags(1U << i)});
        for (std::uint32_t coalition = 0; coalition <= kAllCauses; ++coalition)
            wanted[histories_.settled].insert(picture_of(coalition));
        for (const std::uint32_t flags : lobe_steps())
            wanted[histories_.settled].insert({flags, true});
        return wanted;
    }

    /// Returns the parts of the row's error. `errors`: squared errors of the mirrors' pixels in all
    /// listed pictures. `disagree`: pixels where rasteriser and rays see different mirrors.
    std::vector<measure::PixelCause>
    split_error(const std::map<PictureWithHistory, MirrorPixelValues>& errors,
                const std::vector<bool>& disagree) const {
        const auto of = [&](const HistorySourceFrames& history,
                            const AblatedPicture& picture = {}) -> const MirrorPixelValues& {
            return errors.at({history, picture});
        };
        const auto shapley_values = [&](std::size_t players, const auto& picture_of) {
            measure::ShapleyValues values(players, disagree.size());
            for (std::uint32_t coalition = 0; coalition < 1U << players; ++coalition)
                values.add(coalition, of(histories_.settled, picture_of(coalition)));
            return values;
        };
        const auto negate = [&](const MirrorPixelValues& values) {
            return subtract(MirrorPixelValues(values.size()), values);
        };
        const MirrorPixelValues &row = of(histories_.row),
                                &left = of(histories_.settled, picture_of(kAllCauses)),
                                format = subtract(row, of(histories_.stored));
        std::vector<measure::PixelCause> parts{
            {"storage format", format, format},
            {"last frame", subtract(of(histories_.stored), of(histories_.settled)),
             subtract(row, of(histories_.row_settled))}};
        const auto add_step = [&](const char* cause, const AblatedPicture& with,
                                  std::uint32_t without) {
            parts.push_back(
                {cause,
                 subtract(of(histories_.settled, with), of(histories_.settled, {without, true})),
                 {}});
        };
        if (has_noise_) add_step("noise", {}, lobe_steps().front());
        if (has_noise_ && lookup_ == LobeLookup::sharply)
            add_step("lobe shape", {0, true}, kAblateLobeLookup);
        if (has_noise_ && lookup_ == LobeLookup::in_filtered_levels) {
            add_step("filter", {0, true}, shared::kAblateFilter);
            const measure::ShapleyValues values = shapley_values(2, lobe_picture_of);
            parts.push_back({"distance law", negate(values.worth(0)), {}});
            parts.push_back({"lobe shape", negate(values.worth(1)), {}});
        }
        const measure::ShapleyValues values = shapley_values(
            kCauseCount, [this](std::uint32_t coalition) { return picture_of(coalition); });
        for (std::size_t i = 0; i < kCauseCount; ++i) {
            parts.push_back({kAblatableCauses[i].name, negate(values.worth(i)), {}});
            if (!has_noise_)
                parts.back().alone = subtract(row, of(histories_.row, {ablation_flags(1U << i)}));
        }
        parts.push_back(
            {"silhouettes", keep_chosen(disagree, true, left), keep_chosen(disagree, true, row)});
        parts.push_back({"rest", keep_chosen(disagree, false, left), {}});
        return parts;
    }

private:
    /// Returns the picture without a coalition of kAblatableCauses.
    AblatedPicture picture_of(std::uint32_t coalition) const {
        return {ablation_flags(coalition) | (has_noise_ ? kAblateLobeLookup : 0), has_noise_};
    }
    /// Returns the picture without filter and a coalition of distance law and lobe shape.
    static AblatedPicture lobe_picture_of(std::uint32_t coalition) {
        return {shared::kAblateFilter | ((coalition & 1U) != 0 ? shared::kAblateDistanceLaw : 0) |
                    ((coalition & 2U) != 0 ? shared::kAblateLobeShape : 0),
                true};
    }
    /// Returns the flags of the mean pictures between the row and picture_of(0), and of
    /// the latter. The first has no noise, and the error of the row otherwise.
    std::vector<std::uint32_t> lobe_steps() const {
        std::vector<std::uint32_t> steps;
        if (has_noise_ && lookup_ != LobeLookup::by_rays) steps.push_back(0);
        if (has_noise_ && lookup_ == LobeLookup::in_filtered_levels)
            for (std::uint32_t coalition = 0; coalition < 3; ++coalition)
                steps.push_back(lobe_picture_of(coalition).flags);
        if (has_noise_) steps.push_back(kAblateLobeLookup);
        return steps;
    }

    HistorySources histories_;
    bool has_noise_;
    LobeLookup lookup_;
};

/// Throws `usage` for another reference than a default one, because removed causes are replaced by
/// rays of the default reference.
void check_default_reference(const std::string& reference) {
    const ParsedTechnique found = parse_technique(reference);
    check(std::ranges::any_of(std::array{kReference, kRoughReference},
                              [&](const char* text) {
                                  const ParsedTechnique wanted = parse_technique(text);
                                  return found.technique == wanted.technique &&
                                         found.settings == wanted.settings;
                              }),
          Failure::usage, "--causes: wanted the default reference, ", kReference,
          ", whose rays tell causes apart, found '", reference, "'");
}

/// Throws `usage` for techniques with light between surfaces, because the rays that replace removed
/// causes have no such light, and for techniques that hide the environment from surfaces.
void check_ambient_light(const CompareRequest& request) {
    check(request.base.scene.environment_shadows == 0, Failure::usage,
          "--causes: wanted --environment-shadows 0, found ",
          request.base.scene.environment_shadows,
          "; the rays that replace removed causes are lit by the whole environment");
    for (const std::string& text : request.base.techniques) {
        check(!read_plan(text).has_probe_light(), Failure::usage,
              "--causes: wanted rows without light probes, found '", text,
              "'; causes of error in their light are not known");
        check(!read_plan(text).occludes_environment(), Failure::usage,
              "--causes: wanted rows without ambient occlusion, found '", text,
              "'; the reference is lit by the whole environment");
    }
}

/// Throws `usage` for rough mirrors of glass or with a clear coat, because the code that removes
/// causes draws directions of the lobes of other mirrors only, and for another reference than the
/// scene's default.
void check_causes(const CompareRequest& request, int, report::Comparison&) {
    check_ambient_light(request);
    const scene::Scene& scene = request.base.scene;
    for (const std::size_t i : scene::mirrors(scene)) {
        const scene::Material& material = scene.materials[scene.objects[i].material];
        check(!scene::may_reflect_by_lobe(scene, scene.objects[i]) ||
                  !(scene::is_glass(material) || scene::has_clear_coat(material)),
              Failure::usage,
              "--causes: wanted rough mirrors without glass or clear coat, found mirror ",
              quote(scene.objects[i].name), "; causes of error in its reflections are not known");
    }
    const std::string wanted = choose_reference("", scene);
    check(parse_technique(request.reference).settings == parse_technique(wanted).settings,
          Failure::usage, "--causes: wanted the default reference of this scene, ", wanted,
          ", found '", request.reference, "'");
}

void measure_causes(const StudyInput& input) {
    const CompareRequest& request = input.request;
    std::vector<report::Row>& rows = input.comparison.rows;
    const ReferencePicture& truth = input.truth.get("1");
    std::optional<CauseFinder> finder;
    for (std::size_t i = 0; i < request.base.techniques.size(); ++i) {
        const std::string& text = request.base.techniques[i];
        // Plans are left out, because their error belongs to several searches.
        const bool is_plan = !read_plan(text).is_technique;
        const bool is_twin = request.both_models &&
                             rows[i].model == work_name(RenderedWork::required);
        if (!rows[i].lookup || is_plan || is_twin) continue;
        report_row(request.watcher, "causes of " + text, i, rows.size());
        if (!finder)
            finder.emplace(input.session, request.base, truth.part.hdr, input.truth.hits(),
                           request.watcher, truth.compared().halves);
        rows[i].causes = std::make_shared<report::Causes>(finder->find(text));
        input.tell();
    }
}

const RegisteredStudy kErrorCausesStudy{
    {.name = "causes",
     .help = "also split each row's error by cause; draws at least 32 more pictures per row",
     .order = 20,
     .check_reference = check_default_reference,
     .prepare = check_causes,
     .run = measure_causes}};

} // namespace

void render_ablated(Session& session, const Request& request,
                    const std::vector<std::uint32_t>& ablated, const PictureVisitor& visit,
                    const Watcher& watcher) {
    FrameLoop frames(session, request);
    for (int k = 1; k < request.total(); ++k) frames.render_next(), throw_if_stopped(watcher);
    FrameSpec aside = request;
    aside.time = request.instant(request.total());
    aside.timing = PassTimingMode::pipelined;
    aside.keeps_history = true;
    constexpr std::uint32_t kFlags = (1U << shared::kAblateDrawBits) - 1;
    for (std::size_t entry = 0; entry < ablated.size(); ++entry) {
        // Rays of tracers depend on the seed, and those of searches on the number in `ablated`.
        aside.seed = request.seed + (ablated[entry] >> shared::kAblateDrawBits);
        const std::uint32_t hook = (ablated[entry] & kFlags) != 0 ? ablated[entry] : 0;
        visit(entry, Access::render_frame(session, aside, {.ablated = hook}).hdr());
        throw_if_stopped(watcher);
    }
}

CauseFinder::CauseFinder(Session& session, const Request& base, const measure::Picture& truth,
                         const std::vector<std::uint32_t>& hits, const Watcher& watcher,
                         const measure::NoisyHalves* halves)
    : session_(session), base_(base), truth_(truth), hits_(hits), watcher_(watcher),
      halves_(halves), pixels_(measure::mirror_pixels(hits)) {
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
        disagree_.push_back(drawn != measure::first_mirror(hits[place]).number());
    }
}

/// Returns the squared error of a pixel in a picture that has two halves `a` and `b`, or is both of
/// them. With halves of the reference, the estimate is unbiased: each factor has a half of its own.
double CauseFinder::pixel_error(const measure::Picture& a, const measure::Picture& b,
                                std::size_t place) const {
    const auto shown = [&](const measure::Picture& picture) {
        return measure::apply_exposure(picture.pixels[place], base_.exposure);
    };
    if (halves_ == nullptr) return measure::squared_error(shown(a), shown(truth_));
    const vec3 values[] = {shown(a), shown(b), halves_->a.pixels[place], halves_->b.pixels[place]};
    if (!std::ranges::all_of(values, measure::is_finite_pixel)) return NAN;
    dvec3 in_range[4];
    std::ranges::transform(values, in_range, measure::clamp_pixel);
    const auto& [x, y, truth_a, truth_b] = in_range;
    return (glm::dot(x - truth_a, y - truth_b) + glm::dot(x - truth_b, y - truth_a)) / 6;
}

report::Causes CauseFinder::find(const std::string& technique) const {
    const CauseLadder ladder(base_, technique, halves_ != nullptr);
    std::map<PictureWithHistory, MirrorPixelValues> errors;
    measure::Mask off(hits_.size());
    for (const auto& [history, pictures] : ladder.pictures()) {
        std::vector<std::uint32_t> ablated;
        std::vector<AblatedPicture> shown; // of each entry of `ablated`
        for (const AblatedPicture& picture : pictures) {
            // The last bit of a picture's number is its half.
            for (std::uint32_t i = 0; i < (picture.is_mean ? 2 * kFramesPerHalf : 1); ++i) {
                const std::uint32_t number = picture.is_mean ? i + 2 : 0;
                ablated.push_back(picture.flags | number << shared::kAblateDrawBits);
                shown.push_back(picture);
            }
        }
        std::array<measure::PictureMean, 2> means;
        const auto judge = [&](std::size_t entry, const measure::Picture& picture) {
            means[ablated[entry] >> shared::kAblateDrawBits & 1U].add(picture);
            if (entry + 1 < shown.size() && shown[entry + 1] == shown[entry]) return;
            const measure::Picture a = means[0].mean(),
                                   b = shown[entry].is_mean ? means[1].mean() : a;
            means = {};
            const PictureWithHistory key{history, shown[entry]};
            MirrorPixelValues& values = errors[key];
            for (const std::size_t place : pixels_) {
                values.push_back(pixel_error(a, b, place));
                if (key == ladder.row())
                    off[place] = measure::differs_visibly(
                        measure::apply_exposure(a.pixels[place], base_.exposure),
                        measure::apply_exposure(truth_.pixels[place], base_.exposure));
            }
        };
        render_ablated(session_, make_history_request(base_, history), ablated, judge, watcher_);
    }
    return measure::summarise_causes(hits_, off, errors.at(ladder.row()),
                                     ladder.split_error(errors, disagree_));
}

} // namespace catoptric::study
