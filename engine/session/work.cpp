#include "session/work.hpp"

#include "session/access.hpp"
#include "session/watcher.hpp"

namespace catoptric::session {

std::vector<PassWork> count_frame_work(Session& session, const Request& request,
                                       const Watcher& watcher) {
    const WatchedWork watched(watcher);
    session.forget();
    const int last = request.warmup + 1;
    std::vector<PassWork> work;
    for (int k = 1; k <= last; ++k) {
        FrameSpec spec = request;
        spec.time = request.instant(k);
        // Which captures a frame draws in turns depends on its number, so none is typical.
        const Frame frame = Access::render_frame(session, spec,
                                                 {.counts_work = k == last, .ignores_turns = true});
        frame.times(); // waits, so that a stop signal takes effect soon
        if (k == last) work = Access::pass_work(frame);
        report_frame(watcher, k, last);
    }
    return work;
}

} // namespace catoptric::session
