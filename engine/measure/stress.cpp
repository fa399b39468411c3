#include "measure/stress.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace catoptric::measure {

namespace {

/// Returns the measured value as a share of the limit. Above 1 the case does not hold.
double over_limit(const StressCase& one) {
    if (std::isnan(one.measured)) return std::numeric_limits<double>::infinity();
    if (one.limit > 0) return one.measured / one.limit;
    return one.is_within_limit() ? 0 : std::numeric_limits<double>::infinity();
}

} // namespace

std::string verdict_name(StressVerdict verdict) {
    switch (verdict) {
    case StressVerdict::pass: return "pass";
    case StressVerdict::fail: return "fail";
    case StressVerdict::quality_warning: return "quality-warning";
    case StressVerdict::unsupported: return "unsupported";
    case StressVerdict::waived: return "waived";
    }
    return "";
}

const StressCase* StressRow::worst_case() const {
    const auto found = std::ranges::max_element(cases, {}, [](const StressCase& one) {
        return std::pair(!one.is_within_limit() && !one.is_quality, over_limit(one));
    });
    return found == cases.end() ? nullptr : &*found;
}

std::vector<std::string> StressResults::parts_not_run() const {
    std::vector<std::string> all;
    for (const StressRow& row : rows) {
        if (row.verdict == StressVerdict::unsupported) all.push_back(row.id + ": " + row.remark);
        for (const SkippedPart& part : row.not_run)
            all.push_back(row.id + ", " + part.what + ": " + part.why);
    }
    return all;
}

bool StressResults::has_failed_row() const {
    return std::ranges::any_of(
        rows, [](const StressRow& row) { return row.verdict == StressVerdict::fail; });
}

} // namespace catoptric::measure
