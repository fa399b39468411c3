#include "stress/run.hpp"

#include "core/error.hpp"
#include "session/device_facts.hpp"
#include "session/watcher.hpp"
#include "stress/property.hpp"

#include <algorithm>
#include <chrono>
#include <new>

namespace catoptric::stress {

namespace {

report::StressVerdict judge_row(const report::StressRow& row) {
    if (row.cases.empty()) return report::StressVerdict::unsupported;
    bool looks_worse = false;
    for (const report::StressCase& one : row.cases) {
        if (one.is_within_limit()) continue;
        if (!one.is_quality) return report::StressVerdict::fail;
        looks_worse = true;
    }
    return looks_worse ? report::StressVerdict::quality_warning : report::StressVerdict::pass;
}

report::StressRow judge_property(session::Engine& engine, const StressRequest& request,
                                 const Property& property) {
    report::StressRow row{std::string(property.id),
                          std::string(property.stimulus),
                          std::string(property.property),
                          {},
                          std::string(property.not_covered),
                          {},
                          {},
                          0,
                          {},
                          std::string(property.turned_red_by)};
    const auto start = std::chrono::steady_clock::now();
    Bench bench(engine, request.watcher, request.size, request.seed, row);
    try {
        property.judge(bench);
        check(!row.cases.empty() || !row.not_run.empty(), Failure::internal, "property ", row.id,
              " judged nothing");
        row.verdict = judge_row(row);
        if (row.cases.empty()) row.remark = "nothing of it could be run";
    } catch (const Error& error) {
        if (bench.ends_run(error)) throw;
        row.remark = error.what();
        // If the row has an error from before the device ran out of memory, the row stays an error.
        if (is_refusal(error) && judge_row(row) != report::StressVerdict::fail) {
            row.verdict = report::StressVerdict::unsupported;
            row.cases.clear(), row.pictures.clear(), row.not_run.clear();
        } else {
            row.verdict = report::StressVerdict::fail;
        }
    }
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return row;
}

} // namespace

report::StressResults run_properties(session::Engine& engine, const StressRequest& request) {
    const session::WatchedWork watched(request.watcher);
    std::vector<const Property*> chosen;
    for (const std::string& id : request.only) chosen.push_back(&find_property(id));
    if (chosen.empty()) chosen = properties();
    report::StressResults stress{session::version(),
                                 session::commit(),
                                 request.command,
                                 false,
                                 chosen.size(),
                                 {},
                                 session::make_device_facts(engine),
                                 static_cast<int>(request.size.x),
                                 static_cast<int>(request.size.y),
                                 request.seed,
                                 {}};
    try {
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            report_row(request.watcher, std::string(chosen[i]->id), i, chosen.size());
            stress.rows.push_back(judge_property(engine, request, *chosen[i]));
            if (request.on_finished_row) request.on_finished_row(stress);
        }
        stress.complete = true;
    } catch (const Error& error) {
        if (stress.rows.empty() && !is_signal(error.failure)) throw;
        stress.stopped = error;
    } catch (const std::bad_alloc&) {
        if (stress.rows.empty()) throw;
        stress.stopped = Error(Failure::exhausted, "out of memory");
    }
    return stress;
}

} // namespace catoptric::stress
