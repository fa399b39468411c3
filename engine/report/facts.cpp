// Writes facts about a run, and cautions for the reader, into reports.
#include "measure/halves.hpp"
#include "measure/judge.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

std::string describe_device(const DeviceFacts& device) {
    std::string threads;
    if (device.threads > 0) threads = fmt::format(", {} threads", device.threads);
    if (device.lanes > 0) threads += fmt::format(", {} lanes", device.lanes);
    if (device.held_threads > 0)
        threads += fmt::format(", {} of them held on a processor each", device.held_threads);
    const std::string profile = device.profile.empty() ? "" : ", profile " + device.profile;
    const std::string calibrated = device.calibration.empty() ? "" : ", calibrated";
    return fmt::format("{} ({}{}{}{})", device.name, device.type, threads, profile, calibrated);
}

std::string describe_settings(const Comparison& comparison) {
    return fmt::format("t = {} s, ambient {}, exposure {} stops, model {}", comparison.time,
                       comparison.ambient, comparison.exposure, comparison.model);
}

/// Returns text such as "3 lights, environment studio".
std::string describe_lights(const SceneFacts& scene) {
    const measure::SceneContents& contents = measure::read_scene_contents(scene);
    std::string text = fmt::format("{} light{}", contents.lights.size(),
                                   contents.lights.size() == 1 ? "" : "s");
    if (!contents.environment) return text + ", no environment";
    const EnvironmentFacts& environment = *contents.environment;
    text += ", environment " + environment.name;
    if (environment.scale != 1) text += fmt::format(" times {}", environment.scale);
    if (environment.rotation_degrees != 0)
        text += fmt::format(" turned by {} degrees", environment.rotation_degrees);
    return text;
}

std::string describe_cache(const std::string& cache) {
    if (cache == "used") return "with the cache on disk";
    return cache == "made" ? "the cache on disk was empty" : "no cache on disk";
}

/// Returns the reference, its time, and how much noise it has.
std::string describe_reference(const Comparison& comparison) {
    std::string text = comparison.reference_label + ", " +
                       format_ms(comparison.reference_gpu_ms.median) + " ms";
    if (std::isfinite(comparison.reference_area_flip))
        text += "; one ray through each pixel's centre, FLIP " +
                format_error(comparison.reference_area_flip) +
                " over the mirrors from the mean over the pixel's area (--truth converged)";
    if (!comparison.noise) return text;
    const measure::ReferenceNoise& noise = *comparison.noise;
    text += fmt::format(
        " a frame, two halves of {} frames {}with {} seeds in {} s; between the halves "
        "FLIP {}, rmse {}",
        noise.frames, noise.rays == noise.wanted_rays ? "" : fmt::format("of {} rays ", noise.rays),
        2 * noise.frames, format_fixed(noise.seconds, 1), format_error(noise.flip_floor),
        format_error(noise.halves_rmse));
    if (std::isfinite(noise.predicted_rmse))
        text += fmt::format(" (their variance predicts {})", format_error(noise.predicted_rmse));
    return text;
}

} // namespace

std::string describe_setup(const SetupFacts& setup) {
    std::vector<std::string> parts;
    if (setup.load_ms) parts.push_back("load " + format_ms(*setup.load_ms) + " ms");
    parts.push_back("upload " + format_ms(setup.upload_ms) + " ms");
    parts.push_back(setup.hierarchy_ms > 0 ? "hierarchy " + format_ms(setup.hierarchy_ms) + " ms"
                                           : "no hierarchy");
    parts.push_back(fmt::format("{} pipelines {} ms, {}", setup.pipelines,
                                format_ms(setup.compile_ms), describe_cache(setup.pipeline_cache)));
    return join_texts(parts, "; ");
}

std::vector<ReportHeaderLine> list_facts(const Comparison& comparison) {
    std::vector<ReportHeaderLine> lines{
        {"Scene",
         fmt::format("{}, {} triangles, {} mirrors, hash {}", comparison.scene.name,
                     comparison.scene.triangles, comparison.scene.mirrors, comparison.scene.hash)},
        {"Light", describe_lights(comparison.scene)},
        {"Picture", fmt::format("{}x{}, {}", comparison.width, comparison.height,
                                describe_settings(comparison))},
        {"Device", describe_device(comparison.device)},
        {"Driver", comparison.device.driver + ", " + comparison.device.api},
        {"Timing",
         fmt::format("{}, {}, {} frames in {} rounds, after {} of warm-up", comparison.timing,
                     comparison.together ? "all rows in one command buffer"
                                         : "one row after another",
                     comparison.frames, comparison.rounds, comparison.warmup)},
        {"Load",
         fmt::format("{} runnable threads at the start, {} at the end",
                     format_fixed(comparison.load_start, 2), format_fixed(comparison.load_end, 2))},
        {"Reference", describe_reference(comparison)},
        {"Program", fmt::format("catoptric {}, commit {}", comparison.version, comparison.commit)},
        {"Date", comparison.date},
        {"Command", join_texts(comparison.command, " ")},
    };
    if (const std::string& balance = comparison.device.balance; !balance.empty()) {
        const auto driver = std::ranges::find(lines, "Driver", &ReportHeaderLine::name);
        lines.insert(driver, {"Balance", balance});
    }
    return lines;
}

std::vector<std::string> list_cautions(const Comparison& comparison) {
    std::vector<std::string> list;
    if (!comparison.complete)
        list.push_back("Incomplete, " + describe_incomplete_run(comparison) + ".");
    const bool by_processor_time = measure::judged_time(comparison) == "cpu_ms";
    if (comparison.device.type == "cpu")
        list.push_back(std::string("This device is a processor: ") +
                       (by_processor_time
                            ? "rows are judged by processor time of its software driver and of "
                              "this program (cpu ms), which other programs lengthen little"
                            : "\"GPU time\" here is time of its software driver") +
                       ". What it says of speed holds for such a device, not for a graphics card.");
    if (const std::vector<const Row*> noisy = measure::find_noisy_rows(comparison); !noisy.empty())
        list.push_back(
            fmt::format("Noisy: {} of {} rows had to wait for a processor, others were at work "
                        "beside, and {} times are not to be trusted: {}.",
                        noisy.size(), comparison.rows.size(),
                        by_processor_time ? "their device" : "these", join_labels(noisy)));
    if (comparison.noise && comparison.noise->is_coarse())
        list.push_back(fmt::format(
            "The reference is coarse: each half has {} of {} rays for a pixel{}.",
            comparison.noise->rays * comparison.noise->frames, comparison.noise->wanted_rays,
            comparison.complete ? fmt::format(", which fit into --reference-seconds {:g}",
                                              comparison.noise->most_seconds)
                                : ", and is refined once all rows are measured"));
    if (comparison.noise && !comparison.noise->is_target_reached())
        list.push_back(fmt::format(
            "The reference is noisy: FLIP between its halves is {}, more than a fifth of the least "
            "FLIP of a row. More --reference-seconds than {:g} reduce it.",
            format_error(comparison.noise->flip_floor), comparison.noise->most_seconds));
    if (comparison.path_distance)
        list.push_back(describe_path_distance(*comparison.path_distance, comparison.rows));
    if (comparison.together)
        list.push_back("All rows ran in one command buffer: a row's ms is the sum of its passes.");
    for (const Row& row : comparison.rows)
        if (measure::has_nonfinite_pixels(row))
            list.push_back(
                fmt::format("{} failed: {} pixels are no finite numbers, and its figures "
                            "leave them out.",
                            row.label, row.error_all.nonfinite));
    list.insert(list.end(), comparison.warnings.begin(), comparison.warnings.end());
    return list;
}

} // namespace catoptric::report
