#include "report/rows.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace catoptric::report {

namespace {

bool holds(const Row& row, const Wanted& wanted) {
    return std::ranges::any_of(row.settings, [&](const Setting& setting) {
        return setting.name == wanted.knob && setting.text == wanted.text;
    });
}

bool changes_only(const Row& row, std::span<const Wanted> wanted) {
    return std::ranges::all_of(row.settings, [&](const Setting& setting) {
        return !setting.changed ||
               std::ranges::find(wanted, setting.name, &Wanted::knob) != wanted.end();
    });
}

} // namespace

const Row* find_row(const Comparison& comparison, std::string_view technique,
                    std::span<const Wanted> wanted) {
    const auto fits = [&](const Row& row) {
        return row.technique == technique && changes_only(row, wanted) &&
               std::ranges::all_of(wanted, [&](const Wanted& one) { return holds(row, one); });
    };
    const auto found = std::ranges::find_if(comparison.rows, fits);
    return found == comparison.rows.end() ? nullptr : &*found;
}

const Row* find_parallax(const Comparison& comparison) {
    const Wanted wanted[] = {{"distance", "r32f"}};
    return find_row(comparison, "parallax", wanted);
}

const Row* find_ray_traced(const Comparison& comparison) {
    const Wanted wanted[] = {{"depth", "8"}, {"sphere", "mesh"}};
    return find_row(comparison, "raytrace", wanted);
}

const Row* find_naive(const Comparison& comparison, int bounces) {
    const std::string text = std::to_string(bounces);
    const Wanted wanted[] = {{"bounces", text}};
    return find_row(comparison, "naive", wanted);
}

bool failed(const Row& row) { return row.error.nonfinite > 0 || row.error_all.nonfinite > 0; }

bool judged(const Row* row) {
    return row != nullptr && !failed(*row) && std::isfinite(row->error.rmse);
}

bool is_ray_traced(const Row& row) { return row.technique == "raytrace"; }

bool on_front(const Comparison& comparison, const Row& row) {
    return std::ranges::any_of(comparison.pareto, [&](std::size_t index) {
        return index < comparison.rows.size() && &comparison.rows[index] == &row;
    });
}

measure::Candidate candidate_of(const Row& row) {
    if (failed(row)) return {NAN, NAN, NAN, NAN};
    return {row.gpu_ms.median, row.gpu_ms.p05, row.gpu_ms.p95, row.error.flip};
}

bool beats(const Row& a, const Row& b) { return measure::beats(candidate_of(a), candidate_of(b)); }

bool is_faster(const Row& a, const Row& b) { return a.gpu_ms.p95 < b.gpu_ms.p05; }

} // namespace catoptric::report
