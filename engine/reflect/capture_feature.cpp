// The captures into which mirrors of this frame look, and their filtered levels for rough mirrors.
// Mirrors in captures show the captures of the last frame.
#include "reflect/captures.hpp"
#include "reflect/feature.hpp"

#include <algorithm>

namespace catoptric::reflect {

namespace {

bool has_shared_captures(const TechniqueChoice& choice) {
    return choice.technique->traits.captures == TechniqueTraits::Captures::shared;
}

/// Returns whether some technique needs captures. Traced mirrors are drawn from captures inside
/// mirrored views, so they need captures there.
bool needs_captures(const FrameDeclaration& frame) {
    if (!is_rasterised(frame) || frame.assignment.of_mirror.empty()) return false;
    return std::ranges::any_of(frame.choices(), [&](const TechniqueChoice& choice) {
        return has_shared_captures(choice) ||
               (frame.is_mixed() && choice.technique->traits.draws_mirrored_views);
    });
}

/// Returns the options of the captures of one technique's mirrors.
render::CaptureOptions choose_options(FrameDeclaration& frame, const TechniqueChoice& choice) {
    if (has_shared_captures(choice)) {
        render::CaptureOptions options = choice.technique->capture(frame.inputs, choice.settings);
        options.lighting = frame.light_with(choose_shadow_map(choice.shared.shadow));
        return options;
    }
    render::CaptureOptions options{.face = 0, .lighting = frame.lighting};
    if (choice.shared.others.face) {
        options.face = *choice.shared.others.face;
        // Parallax correction of mirrors in captures reads the distance.
        options.distance = TexelFormat::r32f;
    }
    return options;
}

/// Returns the capture options of each mirror: the options of its technique, extended by data that
/// searches need which read captures of other mirrors.
std::vector<render::CaptureOptions> choose_options(FrameDeclaration& frame) {
    std::vector<render::CaptureOptions> of_choice;
    render::CaptureOptions shared;
    for (const TechniqueChoice& choice : frame.choices()) {
        of_choice.push_back(choose_options(frame, choice));
        if (!has_shared_captures(choice) || !choice.shared.search.reads_others()) continue;
        const render::CaptureOptions& options = of_choice.back();
        shared.surfaces = shared.surfaces || options.surfaces;
        shared.second_layer = shared.second_layer || options.second_layer;
        shared.blended_alpha = std::min(shared.blended_alpha, options.blended_alpha);
        shared.distance = TexelFormat::r32f;
    }
    std::vector<render::CaptureOptions> of_mirror;
    for (const std::uint32_t choice : frame.assignment.of_mirror) {
        render::CaptureOptions options = of_choice[choice];
        if (!options.distance) options.distance = shared.distance;
        options.surfaces = options.surfaces || shared.surfaces;
        options.second_layer = options.second_layer || shared.second_layer;
        options.blended_alpha = std::min(options.blended_alpha, shared.blended_alpha);
        of_mirror.push_back(options);
    }
    return of_mirror;
}

/// Returns how a mirror is drawn inside captures: by look-ups in the captures of the last frame.
/// Without such a capture, the mirror is black.
render::MirrorShader choose_captured_look(const FrameDeclaration& frame, std::uint32_t mirror) {
    const render::CaptureUpdate& update = *frame.captures;
    const TechniqueChoice& choice = frame.choices()[frame.assignment.of_mirror[mirror]];
    const bool is_kept = update.kept != nullptr;
    render::MirrorShader look;
    if (!update.last || !update.last->places[mirror].has_capture() ||
        (!update.was_there[mirror] && is_kept))
        return look;
    look.fragment = has_shared_captures(choice) ? choice.technique->in_captures
                                                : "reflect/parallax.frag";
    look.captures = update.last;
    look.constants.emplace_back("refract_model", other_view_refraction(choice.shared.refract));
    look.blank = !update.was_there[mirror];
    // The previous contents are requested even if the mirror is drawn black, because only requested
    // images exist in the next frame. Images of kept captures exist without a request.
    if (!look.blank || !is_kept)
        frame.levels->add_lookup(frame.graph, std::span(&mirror, 1), choice.shared, look, true);
    return look;
}

render::MirrorShaders choose_captured_looks(const FrameDeclaration& frame) {
    render::MirrorShaders looks;
    for (std::uint32_t i = 0; i < frame.assignment.of_mirror.size(); ++i) {
        render::MirrorShader look = choose_captured_look(frame, i);
        const auto found = std::ranges::find_if(
            looks.looks, [&](const render::MirrorShader& other) {
                return other.fragment == look.fragment && other.constants == look.constants &&
                       other.images == look.images;
            });
        looks.of_mirror.push_back(static_cast<std::uint32_t>(found - looks.looks.begin()));
        if (found == looks.looks.end()) looks.looks.push_back(std::move(look));
    }
    return looks;
}

void declare_captures(FrameDeclaration& frame) {
    std::vector<render::CaptureOptions> options = choose_options(frame);
    const CaptureHistory& history = frame.continued_history();
    if (frame.probes || frame.history.ignores_turns)
        for (render::CaptureOptions& one : options) one.every = 1;
    frame.captures = history.model.is_everything && !render::take_turns(options)
                         ? render::update_all_captures(frame.graph, frame.inputs, "capture",
                                                       std::move(options))
                         : render::update_required_captures(
                               frame.graph, frame.inputs, "capture", options, history.model,
                               {history.before, history.comparisons, history.most});
    frame.outputs.captures = frame.captures->captures;
    frame.outputs.kept = frame.captures->kept;
    std::vector<SharedKnobs> knobs;
    for (const std::uint32_t choice : frame.assignment.of_mirror)
        knobs.push_back(frame.choices()[choice].shared);
    frame.levels.emplace(frame.graph, frame.inputs, frame.captures->captures, knobs);
    frame.captured_looks = choose_captured_looks(frame);
}

bool has_captures(const FrameDeclaration& frame) { return frame.captures.has_value(); }

constexpr FrameFeature kCaptureFeature{.name = "captures",
                                       .order = feature_order::kCaptures,
                                       .applies = needs_captures,
                                       .add = declare_captures};
const RegisteredFeature kCaptureRegistration{kCaptureFeature};

constexpr FrameFeature kCapturePassFeature{
    .name = "passes of captures",
    .order = feature_order::kCapturePasses,
    .applies = has_captures,
    .add = [](FrameDeclaration& frame) {
        render::add_captures(frame.graph, frame.inputs, *frame.captures->captures,
                             std::move(frame.captured_looks), frame.captures->work);
        render::add_comparison_pass(frame.graph, frame.inputs, *frame.captures);
    }};
const RegisteredFeature kCapturePassRegistration{kCapturePassFeature};

constexpr FrameFeature kFilterFeature{
    .name = "filtered levels",
    .order = feature_order::kFilters,
    .applies = has_captures,
    .add = [](FrameDeclaration& frame) { frame.levels->add_passes(frame.graph); }};
const RegisteredFeature kFilterRegistration{kFilterFeature};

} // namespace

} // namespace catoptric::reflect
