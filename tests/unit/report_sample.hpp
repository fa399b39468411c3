#pragma once

#include "reflect/technique.hpp"
#include "report/writer.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

// A made-up comparison, for tests of reports.
namespace catoptric::report::sample {

using measure::Difference;
using measure::Picture;
using measure::SampleSummary;

/// Returns the times of six rounds: half are `ms` times 1 + jitter, half are `ms` times 1 - jitter.
/// Without jitter, two summaries tie only if they are equal.
inline SampleSummary make_time_samples(double ms, double jitter = 0) {
    const double more = ms * (1 + jitter), less = ms * (1 - jitter);
    SampleSummary made{ms, ms * 0.9, ms * 1.1, ms * 0.05, 3, {ms * 0.9, ms, ms * 1.1}};
    made.rounds = {less, more, less, more, less, more};
    made.ci95 = {less, more};
    return made;
}

inline Difference make_difference_of_errors(double rmse, double flip) {
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

inline Row make_row(const std::string& label, double ms, double rmse, double flip,
                    std::vector<Setting> more = {}) {
    Row made;
    made.label = label;
    made.technique = label.substr(0, label.find(':'));
    for (const reflect::Technique* technique : reflect::techniques())
        if (technique->name == made.technique) made.traits = &technique->traits;
    made.settings = std::move(more);
    made.scene_passes = 6;
    made.scene_draws = 26;
    made.gpu_ms = made.cpu_record_ms = made.wall_ms = make_time_samples(ms);
    made.passes = {{"shadow", make_time_samples(ms / 2)}, {"view", make_time_samples(ms / 2)}};
    made.error = made.error_first_order = made.error_all = make_difference_of_errors(rmse, flip);
    made.error_per_mirror = {make_difference_of_errors(rmse, flip),
                             make_difference_of_errors(rmse / 2, flip)};
    made.memory_bytes = 1 << 20;
    made.hdr = made.display = Picture(4, 3);
    made.flip_map.assign(12, 0.25F);
    made.image = made.technique;
    return made;
}

inline Setting make_number_setting(const std::string& name, int value, bool changed = false) {
    return {name, std::to_string(value), double(value), changed};
}

inline Setting make_choice_setting(const std::string& name, const std::string& value,
                                   bool changed = false) {
    return {name, value, {}, changed};
}

inline Row make_naive_row(int bounces, double ms, double rmse, double flip) {
    Row made = make_row(
        bounces == 3 ? "naive" : "naive:bounces=" + std::to_string(bounces), ms, rmse, flip,
        {make_number_setting("bounces", bounces, bounces != 3), make_number_setting("face", 256)});
    made.image += std::to_string(bounces);
    return made;
}

inline Row make_unorm8_row(int range, double rmse) {
    const std::string label = "parallax:distance=unorm8";
    return make_row(range == 200 ? label : label + ",range=" + std::to_string(range), 8, rmse, 0.2,
                    {make_number_setting("face", 256),
                     make_choice_setting("distance", "unorm8", true),
                     make_number_setting("range", range, range != 200)});
}

inline Comparison make_comparison(std::vector<Row> rows) {
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
    made.reference_settings = {make_number_setting("depth", 16),
                               make_choice_setting("shadow", "ray")};
    made.reference_gpu_ms = make_time_samples(12);
    made.reference_hdr = made.reference_display = Picture(4, 3);
    made.mirror_hits = std::vector<std::uint32_t>(12, 1);
    made.rows = std::move(rows);
    return made;
}

/// Returns a comparison of four rows. `parallax` beats `reuse`, and the last row is the reference
/// itself.
inline Comparison make_usual_comparison() {
    Row exact = make_row(
        "raytrace:depth=16", 12, 0, 0,
        {make_number_setting("depth", 16, true), make_choice_setting("sphere", "mesh")});
    exact.is_reference = true;
    exact.rays = RayCounts{12, 6, 18};
    Comparison made = make_comparison(
        {make_naive_row(0, 2, 0.3, 0.5),
         make_row("reuse", 7, 0.09, 0.2, {make_number_setting("face", 256)}),
         make_row("parallax", 6, 0.03, 0.1, {make_choice_setting("distance", "r32f")}), exact});
    made.pareto = {0, 2, 3};
    return made;
}

/// Returns the data of the first chart in a page, from character `from` on.
inline nlohmann::json read_chart_data(const std::string& html, std::size_t from = 0) {
    const std::string open = "json\">";
    const std::size_t begin = html.find(open, from) + open.size();
    return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

/// Returns the text of report.md.
inline std::string report_text_of_comparison(const Comparison& made) { return to_markdown(made); }

} // namespace catoptric::report::sample
