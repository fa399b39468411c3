// Keeps captures from frame to frame, and limits how many a frame draws again.
#include "require/model.hpp"
#include "session/session_impl.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace catoptric::session {

namespace {

bool has_capture_limit(const FrameSpec& spec) {
    return spec.most_captures > 0 || spec.budget_ms > 0;
}

/// Returns the milliseconds of passes that draw, keep and compare captures.
double sum_capture_ms(const graph::GraphFrameTimes& times, const std::string& prefix) {
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

std::vector<reflect::CaptureHistory>
Session::Impl::find_capture_histories(const FrameSpec& spec, const FrameHooks& hooks,
                                      std::size_t plan_count, const require::WorkModel& model,
                                      bool follows) {
    std::vector<reflect::CaptureHistory> keeping(
        plan_count, {.model = model,
                     .comparisons = spec.keeps_history ? nullptr : &comparisons,
                     .ignores_turns = hooks.ignores_turns});
    for (std::size_t i = 0; i < keeping.size(); ++i)
        keeping[i].most = most_captures(spec, i, model);
    for (std::size_t i = 0; follows && i < history.captures.size(); ++i) {
        keeping[i].before = history.captures[i];
        render::read_comparisons(history.captures[i],
                                 [&](std::uint64_t frame) { return runner.has_ended({frame}); });
    }
    return keeping;
}

void Session::Impl::store_history(const FrameSpec& spec, const render::FrameFacts& facts,
                                  const FrameGraph& frame, graph::FrameTicket ticket) {
    history.last = facts;
    history.captures.clear();
    for (const FramePart& part : frame.parts) {
        history.captures.push_back(part.outputs.kept);
        if (!part.outputs.kept) continue;
        part.outputs.kept->frame = ticket.frame;
        comparisons.mark_used(part.outputs.kept->differing, ticket.frame);
    }
    if (spec.budget_ms == 0) return;
    history.timed = {ticket.frame, {}};
    for (const FramePart& part : frame.parts)
        history.timed->drawn.emplace_back(part.prefix,
                                          part.capture_budget ? part.capture_budget->drawn : 0);
}

void Session::Impl::wait_for_results(const FrameSpec& spec) {
    const auto must_learn = [&](const std::shared_ptr<render::CaptureCache>& one) {
        return one && render::must_read_comparisons(*one, has_capture_limit(spec));
    };
    const auto learns = std::ranges::find_if(history.captures, must_learn);
    if (learns != history.captures.end() && !runner.has_ended({(*learns)->frame}))
        runner.wait_for({(*learns)->frame});
    read_capture_times();
}

void Session::Impl::read_capture_times() {
    if (!history.timed) return;
    const TimedFrame timed = *std::exchange(history.timed, std::nullopt);
    // The times of the frame may have been overwritten by frames that keep the history unchanged.
    if (last->frame >= timed.frame + read_by.size()) return;
    const graph::GraphFrameTimes& times = runner.wait_for({timed.frame});
    history.costs.resize(timed.drawn.size());
    for (std::size_t i = 0; i < timed.drawn.size(); ++i)
        history.costs[i].add(sum_capture_ms(times, timed.drawn[i].first), timed.drawn[i].second);
}

std::uint32_t Session::Impl::most_captures(const FrameSpec& spec, std::size_t part,
                                           const require::WorkModel& model) const {
    if (spec.keeps_history || !has_capture_limit(spec)) return 0;
    if (spec.budget_ms == 0) return spec.most_captures;
    const auto captured = static_cast<std::uint32_t>(
        std::ranges::count_if(model.mirrors, &require::MirrorRequirements::is_captured));
    return part < history.costs.size()
               ? history.costs[part].count_affordable(spec.budget_ms, captured)
               : captured;
}

} // namespace catoptric::session
