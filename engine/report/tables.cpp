#include "report/tables.hpp"

#include "report/rows.hpp"
#include "report/seed_table.hpp"
#include "report/text.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace catoptric::report {

namespace {

std::string nothing() { return std::string(kNothing); }

std::string range_text(const measure::Summary& times, int decimals) {
    return fixed(times.p05, decimals) + "–" + fixed(times.p95, decimals);
}

const Row* ours(const Comparison& comparison, const SeedRow& seed) {
    if (seed.inter_reflections >= 0) return find_naive(comparison, seed.inter_reflections);
    if (seed.technique == "parallax") return find_parallax(comparison);
    if (seed.technique == "raytrace") return find_ray_traced(comparison);
    return find_row(comparison, seed.technique);
}

std::vector<std::string> theirs(const SeedRow& seed) {
    const bool counted = seed.inter_reflections >= 0;
    return {std::string(seed.implementation),
            counted ? std::to_string(seed.inter_reflections) : nothing(),
            seed.scene_passes > 0 ? std::to_string(seed.scene_passes) : nothing(),
            fixed(seed.fps, seed.fps < 20 ? 1 : 0), fixed(seed.ms, 1)};
}

std::vector<std::string> measured(const Row& row, int decimals) {
    return {row.label,
            std::to_string(row.scene_passes),
            std::to_string(row.scene_draws),
            fixed(row.gpu_ms.median, decimals),
            range_text(row.gpu_ms, decimals),
            fps_text(row.gpu_ms.median),
            error_text(row.error.rmse),
            error_text(row.error.flip),
            error_text(row.error_first_order.rmse)};
}

std::string seed_note(const Comparison& comparison) {
    std::string note =
        "Left: the seed report, frames per second in a browser on a GeForce GTX 770; R by its "
        "formula "
        "for four mirrors. Right: this run; R counted in the executed plan, a cube counted once, "
        "draws "
        "with every face; ms the median and the 5th to 95th percentile; FPS = 1000 / ms; rmse and "
        "FLIP "
        "against the reference over the pixels whose first hit is a mirror; first order leaves out "
        "mirrors seen in mirrors.";
    if (comparison.scene.mirrors != kSeedMirrors)
        note += " This scene has " + std::to_string(comparison.scene.mirrors) +
                " mirrors, so R cannot be the report's.";
    return note;
}

std::string remark(const Comparison& comparison, const Row& row) {
    std::vector<std::string> remarks;
    if (failed(row)) remarks.push_back("failed");
    if (row.is_reference) remarks.push_back("reference");
    if (on_front(comparison, row)) remarks.push_back("front");
    if (row.model != "everything") remarks.push_back("model " + row.model);
    return joined(remarks, ", ");
}

std::vector<std::string> every_figure(const Comparison& comparison, const Row& row, int decimals) {
    const measure::Difference& error = row.error;
    return {row.label,
            std::to_string(row.scene_passes),
            std::to_string(row.scene_draws),
            fixed(row.gpu_ms.median, decimals),
            range_text(row.gpu_ms, decimals),
            fixed(row.wall_ms.median, decimals),
            ms_text(row.cpu_record_ms.median),
            error_text(error.rmse),
            error_text(error.mae),
            error_text(error.flip),
            error.psnr ? fixed(*error.psnr, 1) : nothing(),
            error_text(error.p99),
            error_text(row.error_first_order.rmse),
            error_text(row.error_mirror_in_mirror.rmse),
            error_text(row.error_non_mirror.rmse),
            error_text(row.error_all.rmse),
            mebibytes(row.memory_bytes),
            remark(comparison, row)};
}

} // namespace

Table seed_table(const Comparison& comparison) {
    Table table{"The seed report's Table 1, measured again",
                {{"Implementation", false},
                 {"i"},
                 {"their R"},
                 {"their FPS"},
                 {"their ms"},
                 {"Here", false},
                 {"R"},
                 {"Draws"},
                 {"ms"},
                 {"5–95 %"},
                 {"FPS"},
                 {"rmse"},
                 {"FLIP"},
                 {"rmse, first order"}},
                {},
                {},
                seed_note(comparison)};
    const int decimals = ms_decimals(comparison);
    for (const SeedRow& seed : kSeedTable) {
        std::vector<std::string> cells = theirs(seed);
        const Row* row = ours(comparison, seed);
        std::vector<std::string> right{"not in this run"};
        if (row != nullptr) right = measured(*row, decimals);
        right.resize(table.columns.size() - cells.size(), nothing());
        cells.insert(cells.end(), right.begin(), right.end());
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table rows_table(const Comparison& comparison) {
    Table table{"Every row",
                {{"Row", false},
                 {"R"},
                 {"Draws"},
                 {"ms"},
                 {"5–95 %"},
                 {"wall ms"},
                 {"record ms"},
                 {"rmse"},
                 {"MAE"},
                 {"FLIP"},
                 {"PSNR dB"},
                 {"p99"},
                 {"rmse, first order"},
                 {"rmse, mirror in mirror"},
                 {"rmse, not a mirror"},
                 {"rmse, all"},
                 {"MiB"},
                 {"Remark", false}},
                {},
                {},
                "A row's name leaves out knobs that nobody set. Without another word, errors "
                "are over the pixels whose first hit is a mirror. wall: submit to fence; "
                "record: filling the command buffer; MiB: the frame's images."};
    const int decimals = ms_decimals(comparison);
    for (const Row& row : comparison.rows) {
        table.rows.push_back(every_figure(comparison, row, decimals));
        table.marked.push_back(on_front(comparison, row));
    }
    return table;
}

Table mirror_table(const Comparison& comparison) {
    Table table{
        "Mirror by mirror", {{"Row", false}}, {}, {}, "rmse over the pixels of each mirror."};
    std::size_t mirrors = 0;
    for (const Row& row : comparison.rows) mirrors = std::max(mirrors, row.error_per_mirror.size());
    for (std::size_t i = 1; i <= mirrors; ++i)
        table.columns.push_back({"Mirror " + std::to_string(i)});
    for (const Row& row : comparison.rows) {
        std::vector<std::string> cells{row.label};
        for (const measure::Difference& error : row.error_per_mirror)
            cells.push_back(error_text(error.rmse));
        cells.resize(mirrors + 1, nothing());
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table lookup_table(const Comparison& comparison) {
    Table table{"Where mirrors looked",
                {{"Row", false},
                 {"Pixels"},
                 {"Mean, degrees"},
                 {"95 %"},
                 {"99 %"},
                 {"Wrong object, %"},
                 {"Unknown, %"},
                 {"Miss, %"},
                 {"Traced, %"}},
                {},
                {},
                "Angle between the looked-up and the true direction from the centre of the capture "
                "that was looked into, over mirror pixels "
                "whose reflected ray meets no second mirror, in whichever capture the row looked; "
                "wrong object: "
                "the capture shows another one there; unknown and miss: what the search says of "
                "itself; traced: of "
                "all mirror pixels."};
    const auto percent = [](double share) { return fmt::format("{:.2f}", 100 * share); };
    for (const Row& row : comparison.rows) {
        if (!row.lookup) continue;
        const measure::LookupError& error = *row.lookup;
        table.rows.push_back(
            {row.label, std::to_string(error.pixels), fmt::format("{:.3f}", error.mean_degrees),
             fmt::format("{:.2f}", error.p95_degrees), fmt::format("{:.2f}", error.p99_degrees),
             percent(error.wrong_object), percent(error.unknown), percent(error.miss),
             row.traced_fraction ? percent(*row.traced_fraction) : nothing()});
    }
    return table;
}

} // namespace catoptric::report
