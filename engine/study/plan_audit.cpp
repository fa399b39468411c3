#include "study/plan_audit.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "measure/display.hpp"
#include "measure/flip.hpp"
#include "measure/halves.hpp"
#include "measure/masks.hpp"
#include "measure/picture_mean.hpp"
#include "scene/rough_reflectors.hpp"
#include "session/access.hpp"
#include "session/plan_file.hpp"
#include "study/reference_cache.hpp"
#include "study/reference_seeds.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <set>

namespace catoptric::study {

namespace {

using AuditJson = nlohmann::json;

// Frames until captures and mirrors in mirrors are complete.
constexpr int kUncountedFramesOfPlan = 8;
// Frames of each half of a reference with noise, which limit the time of an audit.
constexpr int kMostFramesOfHalf = 8;
constexpr int kLargestLobeSeed = 999'999'999;

/// Returns a member that must be a number from `low` to `high`.
double read_number_member(const AuditJson& object, const char* member, double low, double high,
                          const std::string& place) {
    const AuditJson value = object.value(member, AuditJson());
    const bool fits = value.is_number() && value.get<double>() >= low &&
                      value.get<double>() <= high;
    check(fits, Failure::bad_data, place, ".", member, ": wanted a number from ", low, " to ", high,
          ", found ", value.is_null() ? "nothing" : value.dump());
    return value.get<double>();
}

/// Returns the texts of the proved plans, from the plan with the least error to the chosen plan.
std::vector<std::string> proved_plans(const AuditJson& proofs, const std::string& file) {
    std::vector<std::string> plans;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < proofs.size(); ++i) {
        const std::string place = fmt::format("{}: proofs[{}]", file, i);
        check(proofs[i].is_object(), Failure::bad_data, place, ": wanted an object, found ",
              proofs[i].type_name());
        const AuditJson text = proofs[i].value("technique", AuditJson());
        check(text.is_string(), Failure::bad_data, place, ".technique: wanted text, found ",
              text.is_null() ? "nothing" : text.type_name());
        if (proofs[i].value("keeps_error", AuditJson()) != true) break;
        plans.push_back(text.get<std::string>());
        if (const AuditJson time = proofs[i].value("keeps_time", AuditJson());
            time == true || time == "may")
            chosen = plans.size();
    }
    check(chosen > 0, Failure::bad_data, file,
          ": proofs: wanted a plan that keeps the limits, found none");
    plans.resize(chosen);
    // The rules of the chosen plan are read from this file, because other files with the same rules
    // may have changed.
    if (plans.back().starts_with("plan:")) plans.back() = "plan:" + file;
    for (std::size_t i = 0; i + 1 < plans.size(); ++i)
        check(!plans[i].starts_with("plan:"), Failure::bad_data, file, ": proofs[", i,
              "].technique: wanted a plan that depends on no other file, found ", quote(plans[i]));
    return plans;
}

const PlanAuditRequest& check_audit_request(const PlanAuditRequest& request) {
    check(!request.plans.empty(), Failure::usage, "audit: plans: wanted at least 1, found none");
    check(request.max_error >= 0 && request.max_error <= 1, Failure::usage,
          "audit: limit of error: wanted a number from 0 to 1, found ", request.max_error);
    return request;
}

bool show_same_view(const FrameSpec& a, const FrameSpec& b) {
    return a.techniques == b.techniques && a.camera == b.camera && a.size == b.size &&
           a.time == b.time && a.ambient == b.ambient && a.exposure == b.exposure &&
           a.model == b.model;
}

double ms_between(std::chrono::steady_clock::time_point begin,
                  std::chrono::steady_clock::time_point end) {
    return std::chrono::duration<double, std::milli>(end - begin).count();
}

/// Returns how many samples with this step fit into a row of pixels, with equal margins at both
/// ends.
std::uint32_t samples_at_step(std::uint32_t pixels, std::uint32_t step) {
    const std::uint32_t samples = pixels / step;
    return samples - (pixels - samples) % 2; // both margins must be equal, so the rest must be even
}

} // namespace

PlanAuditRequest read_plan_audit(const std::filesystem::path& file) {
    constexpr std::uintmax_t kMaxBytes = 16U << 20U;
    const std::string name = file.string();
    const auto document = parse_json<AuditJson>(name, read_json_text(file, "a plan", kMaxBytes));
    const auto member = [&](const char* wanted, bool is_list) {
        const AuditJson value = document.is_object() ? document.value(wanted, AuditJson())
                                                     : AuditJson();
        check(is_list ? value.is_array() : value.is_object(), Failure::bad_data, name, ": ", wanted,
              ": wanted the one that 'catoptric choose' writes, found ",
              value.is_null() ? "nothing" : value.type_name());
        return value;
    };
    const AuditJson certificate = member("certificate", false);
    const std::string place = name + ": certificate";
    PlanAuditRequest request;
    request.plans = proved_plans(member("proofs", true), name);
    const AuditJson quantity = certificate.value("quantity", AuditJson());
    check(quantity == "flip" || quantity == "rmse", Failure::bad_data, place,
          ".quantity: wanted \"flip\" or \"rmse\", found ",
          quantity.is_null() ? "nothing" : quantity.dump());
    if (quantity == "rmse") request.quantity = ErrorQuantity::rmse;
    const bool has_limit = !certificate.value("max_error", AuditJson()).is_null();
    request.max_error = read_number_member(certificate, has_limit ? "max_error" : "error_bound", 0,
                                           1, place);
    request.tested.share = read_number_member(certificate, "share", .5, .9999, place);
    request.tested.confidence = read_number_member(certificate, "confidence", .5, .9999, place);
    if (const AuditJson reference = certificate.value("reference", AuditJson());
        reference.is_string())
        request.reference = reference.get<std::string>();
    if (const AuditJson hash = certificate.value("scene_hash", AuditJson()); hash.is_string())
        request.scene_hash = hash.get<std::string>();
    return request;
}

SampledView choose_sampled_view(const scene::Camera& camera, uvec2 size, std::size_t most) {
    SampledView view;
    const auto samples = [&](std::uint32_t step) {
        return uvec2(samples_at_step(size.x, step), samples_at_step(size.y, step));
    };
    const auto is_possible = [&](std::uint32_t step) {
        return samples(step).x > 0 && samples(step).y > 0;
    };
    while (std::size_t{samples(view.step).x} * samples(view.step).y > most &&
           is_possible(view.step + 2))
        view.step += 2;
    view.size = samples(view.step);
    view.first = (size - view.size * view.step) / 2U + uvec2(view.step / 2);
    view.camera = camera;
    // The height of the samples as a share of the picture's height.
    const double height = static_cast<double>(view.size.y * view.step) / size.y;
    const double tangent = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    if (view.size * view.step == size)
        return view; // the whole picture is sampled, with exactly
                     // its own camera
    view.camera.vertical_fov_degrees = glm::degrees(2 * std::atan(tangent * height));
    view.camera.orthographic_height *= height;
    return view;
}

measure::Picture sample_picture(const measure::Picture& picture, const SampledView& view) {
    const uvec2 last = view.first + view.step * (view.size - uvec2(1));
    check(last.x < static_cast<std::uint32_t>(picture.width) &&
              last.y < static_cast<std::uint32_t>(picture.height),
          Failure::internal, "audit: wanted a picture with the pixel ", last.x, ",", last.y,
          ", found ", picture.width, "x", picture.height);
    measure::Picture samples(static_cast<int>(view.size.x), static_cast<int>(view.size.y));
    for (int y = 0; y < samples.height; ++y)
        for (int x = 0; x < samples.width; ++x) {
            const ivec2 pixel = ivec2(view.first) + static_cast<int>(view.step) * ivec2(x, y);
            samples.at(x, y) = picture.at(pixel.x, pixel.y);
        }
    return samples;
}

RunningPlanAudit::RunningPlanAudit(PlanAuditRequest request)
    : request_(std::move(request)), audit_(check_audit_request(request_).tested),
      alarm_(request_.tested), schedule_(request_.pace), ladder_(request_.plans.size()) {}

/// Returns whether the reference can show the scene: rough reflectors need a reference that draws
/// rays from lobes.
bool RunningPlanAudit::can_reference_show(const scene::Scene& scene) const {
    return draws_lobe_rays(request_.reference) || !scene::has_rough_reflector(scene);
}

/// Ray traces two halves of a reference with noise, and returns the difference over the mirrors.
/// Adds frames to both halves until their noise floor is a fifth of the limit of error, or until
/// each half has kMostFramesOfHalf frames. No frame of an audit has the seed of another, or of the
/// audited plan.
measure::Difference RunningPlanAudit::compare_with_halves(Session& session,
                                                          const measure::Picture& samples,
                                                          const FrameSpec& traced) {
    const std::set<int> taken = row_seeds({plan()});
    FrameSpec spec = traced;
    measure::PictureMean a, b;
    measure::Mask mirrors;
    measure::NoisyHalves halves;
    double floor = INFINITY;
    while (a.count() < kMostFramesOfHalf && floor > kNoiseShareOfLimit * request_.max_error) {
        for (measure::PictureMean* half : {&a, &b}) {
            do {
                lobe_seed_ = lobe_seed_ % kLargestLobeSeed + 1;
            } while (taken.contains(lobe_seed_));
            spec.techniques = {set_lobe_seed(request_.reference, lobe_seed_)};
            const TechniqueResult truth = session.frame(spec).read();
            check_is_traced(truth);
            half->add(truth.hdr);
            if (mirrors.empty()) mirrors = measure::mask_mirrors(truth.hits);
        }
        halves = measure::make_halves(a.mean(), b.mean(), spec.exposure);
        floor = request_.quantity == ErrorQuantity::flip
                    ? measure::flip_mean(halves.floor_map, mirrors)
                    : measure::difference(halves.a, halves.b, mirrors, halves.floor_map).rmse;
    }
    return measure::difference_from_halves(
        measure::apply_exposure(samples, spec.exposure), halves, mirrors,
        measure::flip_against_halves(samples, halves, spec.exposure));
}

/// Throws `usage` for a reference without first hits of camera rays, which would count all pixels
/// as mirrors.
void RunningPlanAudit::check_is_traced(const TechniqueResult& truth) const {
    check(!truth.hits.empty(), Failure::usage, "audit: reference: wanted a ray-traced one, found ",
          request_.reference);
}

/// Ray traces the sampled pixels by a reference without noise. Returns the difference between the
/// reference and `samples`, the shown colours of these pixels, over the mirrors.
measure::Difference RunningPlanAudit::compare_with_picture(Session& session,
                                                           const measure::Picture& samples,
                                                           const FrameSpec& traced) {
    const TechniqueResult truth = session.frame(traced).read();
    check_is_traced(truth);
    std::vector<float> map(samples.pixels.size(), 0.0f); // only FLIP needs the map
    if (request_.quantity == ErrorQuantity::flip)
        map = measure::flip(measure::to_unrounded_display(samples, traced.exposure),
                            measure::to_unrounded_display(truth.hdr, traced.exposure));
    return measure::difference(measure::apply_exposure(samples, traced.exposure),
                               measure::apply_exposure(truth.hdr, traced.exposure),
                               measure::mask_mirrors(truth.hits), map);
}

/// Ray traces the samples of a frame and returns the difference over the mirrors. The session's
/// sequence of frames goes on afterwards, also after an exception.
measure::Difference RunningPlanAudit::compare_with_trace(Session& session,
                                                         const measure::Picture& running,
                                                         const FrameSpec& spec) {
    const SampledView view = choose_sampled_view(spec.camera, spec.size, kMostSamples);
    FrameSpec traced = spec;
    traced.techniques = {request_.reference};
    traced.camera = view.camera, traced.size = view.size;
    traced.most_captures = 0, traced.budget_ms = 0;
    const measure::Picture samples = sample_picture(running, view);
    FrameSequence sequence = Access::suspend(session); // keeps choices of the first frame,
                                                       // such as those of `auto`
    measure::Difference difference;
    try {
        difference = is_noisy(request_.reference, session.scene())
                         ? compare_with_halves(session, samples, traced)
                         : compare_with_picture(session, samples, traced);
    } catch (...) {
        Access::resume(session, std::move(sequence));
        throw;
    }
    Access::resume(session, std::move(sequence));
    return difference;
}

void RunningPlanAudit::prepare(Session& session, const FrameSpec& spec) {
    check(can_reference_show(session.scene()), Failure::usage,
          "audit: reference: wanted one with rays=N, because surfaces of '", session.scene().name,
          "' are rough, found ", request_.reference);
    const measure::Picture black(static_cast<int>(spec.size.x), static_cast<int>(spec.size.y));
    compare_with_trace(session, black, spec);
    const Clock::time_point begin = Clock::now();
    compare_with_trace(session, black, spec);
    schedule_.expect_audit(ms_between(begin, Clock::now()));
    is_prepared_ = true;
    ended_ = Clock::now();
}

/// Returns whether the frame begins with the audited plan, however the plan's text is spelt.
bool RunningPlanAudit::shows_plan(const FrameSpec& spec) {
    if (spec.techniques.empty()) return false;
    const std::string& shown = spec.techniques.front();
    if (shown == plan()) return true;
    if (shown != compared_plans_.shown || plan() != compared_plans_.audited)
        compared_plans_ = {shown, plan(), read_plan(shown).is_same(read_plan(plan()))};
    return compared_plans_.are_same;
}

/// Returns whether the frame shows another camera, instant or scene than the last frame.
bool RunningPlanAudit::shows_new_picture(const Session& session, const FrameSpec& spec) {
    const bool is_new = !watched_ || !show_same_view(*watched_, spec) ||
                        Access::session_counters(session).updates != updates_;
    if (is_new) watched_ = spec;
    return is_new;
}

void RunningPlanAudit::audit_frame(Session& session, const Frame& frame, const FrameSpec& spec,
                                   AuditState& state) {
    const measure::Difference difference = compare_with_trace(session, frame.hdr(), spec);
    if (difference.pixels == 0) return; // frames that show no mirror do not count
    state.error = mirror_error(request_.quantity, difference);
    audit_.count_frame(*state.error <= request_.max_error);
    const double least = lower_mirror_error(request_.quantity, difference);
    alarm_.count_frame(least <= request_.max_error);
    state.is_alarm = is_alarmed() && !was_alarmed_;
    was_alarmed_ = is_alarmed();
    assured_share_ = audit_.assured_share();
    // Noise hides a failure with a small probability, so somewhat more frames fail than were seen
    // to.
    if (is_noisy(request_.reference, session.scene()))
        assured_share_ = std::max(0.,
                                  1 - (1 - assured_share_) / (1 - measure::kNoiseMissProbability));
}

/// Changes to the next plan with less error. The audit of this plan begins without evidence.
void RunningPlanAudit::step(double seconds, AuditState& state) {
    state.has_new_plan = ladder_.step(seconds);
    if (state.is_alarm)
        state.message = fmt::format("audit: {} of {} frames break {} <= {:g}", alarm_.failures(),
                                    alarm_.frame_count(), quantity_name(request_.quantity),
                                    request_.max_error);
    if (state.has_new_plan) {
        state.message += (state.is_alarm ? "; " : "audit: ") +
                         fmt::format("the plan is now {}", plan());
        audit_ = alarm_ = measure::Audit(request_.tested);
        was_alarmed_ = false, frames_of_plan_ = 0, assured_share_ = 0;
    } else if (state.is_alarm && ladder_.place() == 0) {
        state.message += "; no surer plan is proved";
    }
}

AuditState RunningPlanAudit::watch_frame(Session& session, const Frame& frame,
                                         const FrameSpec& spec, double seconds) {
    AuditState state;
    const bool is_of_plan = shows_plan(spec);
    if (is_of_plan && !is_prepared_) {
        if (request_.before_audit) request_.before_audit();
        prepare(session, spec);
    }
    const Clock::time_point begin = Clock::now();
    if (Access::session_counters(session).updates != updates_) // an edit may change a surface
        is_paused_ = !can_reference_show(session.scene());
    const bool is_counted = shows_new_picture(session, spec) && is_of_plan && !is_paused_ &&
                            ++frames_of_plan_ > kUncountedFramesOfPlan;
    if (is_counted && schedule_.count_frame(ms_between(ended_, begin))) {
        if (request_.before_audit) request_.before_audit();
        audit_frame(session, frame, spec, state);
        schedule_.add_audit(ms_between(begin, Clock::now()));
    }
    if (is_of_plan && is_alarmed()) step(seconds, state);
    updates_ = Access::session_counters(session).updates;
    ended_ = Clock::now();
    state.plan = ladder_.place();
    state.frames = audit_.frame_count(), state.failures = audit_.failures();
    state.assured_share = assured_share_;
    state.time_share = time_share();
    return state;
}

double RunningPlanAudit::time_share() const {
    return schedule_.frames_ms() > 0 ? schedule_.audits_ms() / schedule_.frames_ms() : 0;
}

std::string RunningPlanAudit::describe() const {
    const std::size_t frames = audit_.frame_count();
    return fmt::format("audit: {} of {} frames keep {} <= {:g}; assured share {:.3f}; {:.1f} % of "
                       "the frames' time{}{}",
                       frames - audit_.failures(), frames, quantity_name(request_.quantity),
                       request_.max_error, assured_share_, 100 * time_share(),
                       is_alarmed() ? "; alarm: too many frames fail" : "",
                       is_paused_ ? "; paused, because a surface is rough" : "");
}

} // namespace catoptric::study
