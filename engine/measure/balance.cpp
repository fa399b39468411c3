#include "measure/balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

/// Returns the cost of the first of these kinds that has one, ns; NaN if none has.
double find_ns(const DeviceCosts& costs, std::initializer_list<WorkKind> kinds) {
    for (const WorkKind kind : kinds)
        if (const auto unit = std::ranges::find(costs.units, kind, &UnitCost::kind);
            unit != costs.units.end())
            return unit->ns;
    return NAN;
}

/// Returns "1.2 G/s" for a cost of a unit in nanoseconds; "unknown" for NaN.
std::string format_rate(double ns, const char* unit) {
    if (!(ns > 0)) return fmt::format("unknown {}", unit);
    double rate = 1e9 / ns;
    for (const char* prefix : {"", " k", " M", " G"}) {
        if (rate < 1000) return fmt::format("{:.3g}{} {}", rate, prefix, unit);
        rate /= 1000;
    }
    return fmt::format("{:.3g} T {}", rate, unit);
}

} // namespace

std::optional<Balance> find_balance(const DeviceCosts& costs, int lanes) {
    using enum WorkKind;
    const auto or_none = [](double ns) { return std::isnan(ns) ? 0 : ns; };
    Balance balance{.lookup_ns = find_ns(costs, {colour_lookups, colour_lanes}),
                    .fragment_ns = find_ns(costs, {fragments}),
                    .byte_ns = find_ns(costs, {bytes}),
                    .is_of_subgroups = std::isnan(find_ns(costs, {colour_lookups}))};
    const double one_by_one = or_none(find_ns(costs, {mirror_rays})) +
                              kNodesPerRay * or_none(find_ns(costs, {nodes}));
    const double together = kNodesPerRay * or_none(find_ns(costs, {node_lanes}));
    balance.ray_ns = balance.is_of_subgroups ? lanes * one_by_one + together
                                             : one_by_one + together / lanes;
    if (!(balance.lookup_ns > 0) || !(balance.ray_ns > 0)) return std::nullopt;
    return balance;
}

std::string describe_balance(const Balance& balance) {
    const double rays = balance.rays_per_lookup();
    const bool is_usual = rays >= kGameCardBalance.low && rays <= kGameCardBalance.high;
    const char* of = balance.is_of_subgroups ? " of subgroups" : "";
    return fmt::format(
        "per second {}{}, {} of {:g} nodes{}, {}, {}; a look-up takes as long as {:.2g} rays, {} "
        "cards that games run on ({:g} to {:g}){}",
        format_rate(balance.lookup_ns, "look-ups"), of, format_rate(balance.ray_ns, "rays"),
        kNodesPerRay, of, format_rate(balance.fragment_ns, "fragments"),
        format_rate(balance.byte_ns, "bytes"), rays, is_usual ? "as on" : "unlike",
        kGameCardBalance.low, kGameCardBalance.high,
        is_usual ? "" : ", so that this device's order of rows need not be theirs");
}

} // namespace catoptric::measure
