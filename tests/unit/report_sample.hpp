#pragma once

#include "report/writer.hpp"

#include <string>
#include <vector>

// A made-up comparison, for tests of reports.
namespace catoptric::report::sample {

using measure::Difference;
using measure::Picture;
using measure::SampleSummary;

/// Returns the times of six rounds: half are `ms` times 1 + jitter, half are `ms` times 1 - jitter.
/// Without jitter, two summaries tie only if they are equal.
inline SampleSummary times(double ms, double jitter = 0) {
    const double more = ms * (1 + jitter), less = ms * (1 - jitter);
    SampleSummary made{ms, ms * 0.9, ms * 1.1, ms * 0.05, 3, {ms * 0.9, ms, ms * 1.1}};
    made.rounds = {less, more, less, more, less, more};
    made.ci95 = {less, more};
    return made;
}

inline Difference error_of(double rmse, double flip) {
    Difference error;
    error.pixels = 6;
    error.rmse = rmse;
    error.mae = rmse / 2;
    error.flip = flip;
    if (rmse > 0) error.psnr = 20;
    error.p99 = error.max = rmse * 2;
    error.max_x = error.max_y = 1;
    error.off = flip / 4;
    error.longest_line = 1 + 32 * flip;
    return error;
}

inline Row row(const std::string& label, double ms, double rmse, double flip,
               std::vector<Setting> more = {}) {
    Row made;
    made.label = label;
    made.technique = label.substr(0, label.find(':'));
    made.settings = std::move(more);
    made.scene_passes = 6;
    made.scene_draws = 26;
    made.gpu_ms = made.cpu_record_ms = made.wall_ms = times(ms);
    made.passes = {{"shadow", times(ms / 2)}, {"view", times(ms / 2)}};
    made.error = made.error_first_order = made.error_all = error_of(rmse, flip);
    made.error_per_mirror = {error_of(rmse, flip), error_of(rmse / 2, flip)};
    made.memory_bytes = 1 << 20;
    made.hdr = made.display = Picture(4, 3);
    made.flip_map.assign(12, 0.25F);
    made.image = made.technique;
    return made;
}

inline Setting number(const std::string& name, int value, bool changed = false) {
    return {name, std::to_string(value), double(value), changed};
}

inline Setting choice(const std::string& name, const std::string& value, bool changed = false) {
    return {name, value, {}, changed};
}

inline Row naive(int bounces, double ms, double rmse, double flip) {
    Row made = row(bounces == 3 ? "naive" : "naive:bounces=" + std::to_string(bounces), ms, rmse,
                   flip, {number("bounces", bounces, bounces != 3), number("face", 256)});
    made.image += std::to_string(bounces);
    return made;
}

inline Row unorm8(int range, double rmse) {
    const std::string label = "parallax:distance=unorm8";
    return row(range == 200 ? label : label + ",range=" + std::to_string(range), 8, rmse, 0.2,
               {number("face", 256), choice("distance", "unorm8", true),
                number("range", range, range != 200)});
}

inline Comparison comparison(std::vector<Row> rows) {
    Comparison made;
    made.version = "0.1.0";
    made.commit = "abc1234";
    made.date = "2026-11-24T03:05:10Z";
    made.command = {"catoptric", "compare", "-o", "out"};
    made.device = {"Card", "Driver 1", "Vulkan 1.3", "discrete", 0};
    made.scene = {"cornell-mirrors", 16394, 4, "deadbeef", true};
    made.width = 4, made.height = 3;
    made.frames = 20, made.warmup = 8, made.rounds = 6;
    made.load_start = .25, made.load_end = 1.5;
    made.reference_technique = "raytrace";
    made.reference_label = "raytrace:depth=16";
    made.reference_settings = {number("depth", 16), choice("shadow", "ray")};
    made.reference_gpu_ms = times(12);
    made.reference_display = Picture(4, 3);
    made.rows = std::move(rows);
    return made;
}

/// Returns a comparison of four rows. `parallax` beats `reuse`, and the last row is the reference
/// itself.
inline Comparison usual() {
    Row exact = row("raytrace:depth=16", 12, 0, 0,
                    {number("depth", 16, true), choice("sphere", "mesh")});
    exact.is_reference = true;
    exact.rays = RayCounts{12, 6, 18};
    Comparison made = comparison(
        {naive(0, 2, 0.3, 0.5), row("reuse", 7, 0.09, 0.2, {number("face", 256)}),
         row("parallax", 6, 0.03, 0.1, {choice("distance", "r32f")}), exact});
    made.pareto = {0, 2, 3};
    return made;
}

/// Returns the text of report.md.
inline std::string said(const Comparison& made) { return to_markdown(made); }

} // namespace catoptric::report::sample
