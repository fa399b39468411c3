#include "measure/stress.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace catoptric::measure {

namespace {

/// Returns the measured value as a share of the limit. Above 1 the case does not hold.
double load(const StressCase& one) {
    if (std::isnan(one.measured)) return std::numeric_limits<double>::infinity();
    if (one.limit > 0) return one.measured / one.limit;
    return one.holds() ? 0 : std::numeric_limits<double>::infinity();
}

} // namespace

std::string name_of(Verdict verdict) {
    switch (verdict) {
    case Verdict::pass: return "pass";
    case Verdict::fail: return "fail";
    case Verdict::quality_warning: return "quality-warning";
    case Verdict::unsupported: return "unsupported";
    case Verdict::waived: return "waived";
    }
    return "";
}

const StressCase* StressRow::worst() const {
    const auto found = std::ranges::max_element(cases, {}, [](const StressCase& one) {
        return std::pair(!one.holds() && !one.is_quality, load(one));
    });
    return found == cases.end() ? nullptr : &*found;
}

std::vector<std::string> Stress::not_run() const {
    std::vector<std::string> all;
    for (const StressRow& row : rows) {
        if (row.verdict == Verdict::unsupported) all.push_back(row.id + ": " + row.remark);
        for (const NotRun& part : row.not_run)
            all.push_back(row.id + ", " + part.what + ": " + part.why);
    }
    return all;
}

bool Stress::failed() const {
    return std::ranges::any_of(rows,
                               [](const StressRow& row) { return row.verdict == Verdict::fail; });
}

} // namespace catoptric::measure
