#include "measure/findings.hpp"

#include "measure/interval.hpp"
#include "measure/judge.hpp"
#include "measure/rows.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

std::optional<UndrawnDielectrics> find_undrawn_dielectrics(const Comparison& comparison) {
    UndrawnDielectrics finding;
    for (const Row& row : comparison.rows) {
        const Difference& error = row.error_dielectrics;
        if (error.pixels == 0 || std::isnan(error.flip)) continue;
        finding.share = static_cast<double>(error.pixels) /
                        static_cast<double>(row.error_all.pixels);
        const bool traces_all = row.rays && !row.traced_fraction;
        if (traces_all)
            finding.tracing.push_back(&row);
        else if (finding.best == nullptr || error.flip < finding.best->error_dielectrics.flip)
            finding.best = &row;
    }
    if (finding.best == nullptr) return {};
    return finding;
}

std::optional<ClearCost> find_clear_cost(const Comparison& comparison) {
    const Row* one = find_naive_row(comparison, 0);
    const Row* two = find_seed_row(comparison, TechniqueTraits::SeedPart::last_captures);
    if (one == nullptr || two == nullptr) return {};
    const SampleSummary &without = one->elapsed_ms(), &reused = two->elapsed_ms();
    ClearCost finding{one, two, median_ratio_interval(without.rounds, reused.rounds).low > 1};
    if (!comparison.clear_ms) return finding;
    const double clear = comparison.clear_ms->median;
    finding.clear_ms = clear;
    finding.gap = (without.median + clear - reused.median) / reused.median;
    std::vector<double> with_clear = without.rounds;
    const std::vector<double>& clears = comparison.clear_ms->rounds;
    with_clear.resize(std::min(with_clear.size(), clears.size()));
    for (std::size_t i = 0; i < with_clear.size(); ++i) with_clear[i] += clears[i];
    if (finding.one_is_slower)
        finding.verdict = ClearCost::Verdict::slower_without;
    else if (!(median_ratio_interval(with_clear, reused.rounds).low > 1))
        finding.verdict = ClearCost::Verdict::too_little;
    return finding;
}

std::optional<DistanceFormatResult> find_distance_format(const Comparison& comparison) {
    const auto eight_bits = [&](std::string_view range) -> const Row* {
        const KnobText wanted[] = {{"distance", "unorm8"}, {"range", range}};
        const Row* row = find_seed_row(comparison, TechniqueTraits::SeedPart::parallax, wanted);
        return has_known_error(row) ? row : nullptr;
    };
    DistanceFormatResult finding{
        find_seed_row(comparison, TechniqueTraits::SeedPart::last_captures),
        find_parallax_row(comparison), eight_bits("200"), eight_bits("1000")};
    if (!has_known_error(finding.plain) || !has_known_error(finding.full)) return {};
    if (finding.near == nullptr && finding.far == nullptr) return {};
    finding.near_is_worse = finding.near != nullptr &&
                            finding.near->error.rmse > finding.plain->error.rmse;
    return finding;
}

std::optional<BouncesResult> find_bounces_result(const Comparison& comparison) {
    BouncesResult finding;
    for (int i = 1; has_known_error(find_naive_row(comparison, i)); ++i)
        finding.steps.push_back(find_naive_row(comparison, i));
    if (finding.steps.size() < 2) return {};
    const double rest = finding.steps.back()->error.rmse;
    finding.fall = finding.steps.front()->error.rmse - rest;
    finding.helps = finding.fall > kEightBitStep;
    const Row* corrected = find_parallax_row(comparison);
    if (has_known_error(corrected) &&
        2 * corrected->error.rmse * corrected->error.rmse < rest * rest)
        finding.dominated_by = corrected;
    return finding;
}

std::optional<ParallaxPrice> find_parallax_price(const Comparison& comparison) {
    const Row* two = find_seed_row(comparison, TechniqueTraits::SeedPart::last_captures);
    const Row* three = find_parallax_row(comparison);
    if (two == nullptr || three == nullptr || !(two->time_ms().median > 0)) return {};
    ParallaxPrice finding{two, three, RowJudge(comparison.rows).times(*three, *two),
                          time_ratio_interval(*three, *two)};
    finding.more = three->time_ms().median / two->time_ms().median - 1;
    if (three->memory_bytes > two->memory_bytes)
        finding.more_bytes = three->memory_bytes - two->memory_bytes;
    return finding;
}

std::optional<RayTracingTime> find_ray_tracing_time(const Comparison& comparison) {
    const Row* three = find_parallax_row(comparison);
    const Row* traced = find_ray_traced_row(comparison);
    if (three == nullptr || traced == nullptr || !(three->time_ms().median > 0)) return {};
    return RayTracingTime{three, traced, RowJudge(comparison.rows).times(*traced, *three),
                          time_ratio_interval(*traced, *three),
                          traced->time_ms().median / three->time_ms().median};
}

} // namespace catoptric::measure
