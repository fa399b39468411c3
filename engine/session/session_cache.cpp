// Keeps captures from frame to frame, and limits how many a frame draws again.
#include "require/model.hpp"
#include "session/session_impl.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::app {

namespace {

bool has_capture_limit(const FrameSpec& spec) {
    return spec.most_captures > 0 || spec.budget_ms > 0;
}

/// Returns the milliseconds of passes that draw, keep and compare captures.
double sum_capture_milliseconds(const graph::GraphFrameTimes& times, const std::string& prefix) {
    double ms = 0;
    for (const graph::GraphPassTime& pass : times.passes)
        if (pass.name.starts_with(prefix + "capture")) ms += pass.end_ms - pass.begin_ms;
    return ms;
}

} // namespace

void check_capture_limit(const FrameSpec& spec) {
    const bool is_limited = spec.most_captures > 0 || spec.budget_ms != 0;
    check(
        !is_limited || spec.model == RenderedWork::required, Failure::usage,
        "limits of captures (most_captures, budget_ms): wanted the model required, found everything");
    check(spec.most_captures == 0 || spec.budget_ms == 0, Failure::usage,
          "captures that a frame draws are limited by number (", spec.most_captures,
          ") and by milliseconds (", spec.budget_ms, "): wanted one of them");
    check(spec.budget_ms == 0 || (spec.budget_ms > 0 && std::isfinite(spec.budget_ms)),
          Failure::usage, "the milliseconds for captures must be finite and above 0, not ",
          spec.budget_ms);
}

std::vector<reflect::PreviousCaptureHistory>
Session::Impl::find_capture_histories(const FrameSpec& spec,
                                      const require::RequiredWorkModel& model, bool follows) {
    std::vector<reflect::PreviousCaptureHistory> keeping(
        plans.size(), {model, nullptr, spec.keeps_history ? nullptr : &comparisons});
    for (std::size_t i = 0; i < plans.size(); ++i) keeping[i].most = most_captures(spec, i, model);
    for (std::size_t i = 0; follows && i < kept.size(); ++i) {
        keeping[i].before = kept[i];
        render::read_finished_face_comparisons(
            kept[i], [&](std::uint64_t frame) { return runner.has_ended({frame}); });
    }
    return keeping;
}

void Session::Impl::store_captures_of_frame(const FrameGraph& frame,
                                            graph::SubmittedFrameTicket ticket) {
    kept.clear();
    for (const TechniqueGraphPart& part : frame.parts) {
        kept.push_back(part.outputs.kept);
        if (!kept.back()) continue;
        kept.back()->frame = ticket.frame;
        comparisons.mark_comparison_buffer_used(kept.back()->differing, ticket.frame);
    }
}

void Session::Impl::wait_for_needed_results(const FrameSpec& spec) {
    const auto must_learn = [&](const std::shared_ptr<render::CaptureCache>& one) {
        return one && render::must_read_face_comparisons(*one, has_capture_limit(spec));
    };
    const auto learns = std::ranges::find_if(kept, must_learn);
    if (learns != kept.end() && !runner.has_ended({(*learns)->frame}))
        runner.wait_for_frame({(*learns)->frame});
    read_capture_times();
}

void Session::Impl::read_capture_times() {
    if (!timed) return;
    // The times of the frame may have been overwritten by frames that keep the history unchanged.
    if (last->frame < timed->ticket.frame + read_by.size()) {
        const graph::GraphFrameTimes& times = runner.wait_for_frame(timed->ticket);
        paces.resize(timed->drawn.size());
        for (std::size_t i = 0; i < paces.size(); ++i)
            paces[i].add(sum_capture_milliseconds(times, timed->drawn[i].first),
                         timed->drawn[i].second);
    }
    timed.reset();
}

std::uint32_t Session::Impl::most_captures(const FrameSpec& spec, std::size_t part,
                                           const require::RequiredWorkModel& model) const {
    if (spec.keeps_history || !has_capture_limit(spec)) return 0;
    if (spec.budget_ms == 0) return spec.most_captures;
    const auto captured = static_cast<std::uint32_t>(
        std::ranges::count_if(model.mirrors, &require::MirrorRequirements::is_captured));
    return part < paces.size() ? paces[part].count_affordable_captures(spec.budget_ms, captured)
                               : captured;
}

void Session::Impl::mark_frame_for_capture_timing(const FrameGraph& frame,
                                                  graph::SubmittedFrameTicket ticket) {
    timed = {ticket, {}};
    for (const TechniqueGraphPart& part : frame.parts)
        timed->drawn.emplace_back(part.prefix,
                                  part.capture_budget ? part.capture_budget->drawn : 0);
}

} // namespace catoptric::app
