#include "study/compare_row.hpp"

#include "core/mirror_id.hpp"
#include "measure/display.hpp"
#include "measure/flip.hpp"
#include "measure/masks.hpp"
#include "measure/metric.hpp"
#include "measure/picture.hpp"
#include "measure/statistics.hpp"
#include "report/comparison.hpp"
#include "session/access.hpp"
#include "session/technique_choice.hpp"

#include <algorithm>
#include <numeric>

namespace catoptric::study {

namespace {

/// Returns the mean of each whole cycle of successive samples, each as a round of its own.
std::vector<std::vector<double>> average_cycles(const std::vector<std::vector<double>>& rounds,
                                                std::size_t cycle) {
    std::vector<double> all;
    for (const std::vector<double>& round : rounds)
        all.insert(all.end(), round.begin(), round.end());
    cycle = std::min(cycle, all.size());
    std::vector<std::vector<double>> means;
    for (auto from = all.begin(); all.end() - from >= static_cast<std::ptrdiff_t>(cycle);) {
        const auto to = from + static_cast<std::ptrdiff_t>(cycle);
        means.push_back({std::accumulate(from, to, 0.0) / static_cast<double>(cycle)});
        from = to;
    }
    return means;
}

template <typename Value>
measure::SampleSummary summarise_frames(const MeasuredFrames& frames, Value&& value) {
    std::vector<std::vector<double>> samples;
    for (const std::vector<FrameTimes>& round : frames.rounds) {
        samples.emplace_back();
        for (const FrameTimes& frame : round) samples.back().push_back(value(frame));
    }
    return measure::summarise(frames.cycle > 1 ? average_cycles(samples, frames.cycle) : samples);
}

HostTimes summarise_host_times(const MeasuredFrames& frames) {
    const auto part = [&](double HostTimes::*which) {
        return summarise_frames(frames, [&](const FrameTimes& frame) { return frame.host.*which; })
            .median;
    };
    return {part(&HostTimes::update), part(&HostTimes::hierarchy), part(&HostTimes::compile),
            part(&HostTimes::record)};
}

/// Returns the frames whose passes are kept one by one (kMaxDetailedFrames).
MeasuredFrames keep_frames_with_passes(MeasuredFrames frames) {
    for (std::vector<FrameTimes>& round : frames.rounds)
        std::erase_if(round, [](const FrameTimes& frame) { return frame.passes.empty(); });
    std::erase_if(frames.rounds,
                  [](const std::vector<FrameTimes>& round) { return round.empty(); });
    return frames;
}

/// Returns the names of all passes that occur in some frame, in order of execution. Frames differ
/// in their passes, because captures that are kept are not rendered again.
std::vector<std::string> pass_names(const MeasuredFrames& measured) {
    std::vector<std::string> names;
    for (const std::vector<FrameTimes>& round : measured.rounds)
        for (const FrameTimes& frame : round)
            for (std::size_t i = 0; i < frame.passes.size(); ++i) {
                if (std::ranges::find(names, frame.passes[i].name) != names.end()) continue;
                // Inserts the pass behind its predecessor in this frame.
                const auto before = i == 0 ? names.begin()
                                           : std::next(std::ranges::find(names,
                                                                         frame.passes[i - 1].name));
                names.insert(before, frame.passes[i].name);
            }
    return names;
}

/// Returns whether a picture's mirrors are black, except for pixels at their outlines, while the
/// reference shows something.
bool draws_mirrors_black(const measure::Picture& picture, const measure::Picture& truth,
                         const std::vector<std::uint32_t>& hits) {
    std::size_t pixels = 0, black = 0, wanted_black = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!measure::first_mirror(hits[i])) continue;
        ++pixels;
        black += picture.pixels[i] == vec3(0);
        wanted_black += truth.pixels[i] == vec3(0);
    }
    constexpr double kMinBlackPixelShare = .99;
    return pixels > 0 &&
           static_cast<double>(black) >= kMinBlackPixelShare * static_cast<double>(pixels) &&
           static_cast<double>(wanted_black) < kMinBlackPixelShare * static_cast<double>(pixels);
}

/// Sets the row's estimates against the halves of a reference with noise, over all masks.
void estimate_noise(report::Row& row, const measure::NoisyHalves& halves,
                    const std::vector<std::uint32_t>& hits, double exposure) {
    const measure::Picture found = measure::apply_exposure(row.hdr, exposure);
    std::vector<measure::NoiseFreeError> estimates;
    for (const measure::Mask& mask : measure::compute_masks(hits))
        estimates.push_back(measure::estimate_noise_free(found, halves, mask, row.flip_map));
    measure::set_noise(row, estimates);
}

} // namespace

std::vector<float> compute_flip_map(const measure::Picture& picture, const ComparedReference& truth,
                                    double exposure) {
    if (truth.halves != nullptr)
        return measure::flip_against_halves(picture, *truth.halves, exposure);
    return measure::flip(measure::to_unrounded_display(picture, exposure),
                         measure::to_unrounded_display(truth.hdr, exposure));
}

measure::Difference masked_error(const measure::Picture& picture, const ComparedReference& truth,
                                 const measure::Mask& mask, std::span<const float> flip_map,
                                 double exposure) {
    const measure::Picture found = measure::apply_exposure(picture, exposure);
    if (truth.halves != nullptr)
        return measure::difference_from_halves(found, *truth.halves, mask, flip_map);
    return measure::difference(found, measure::apply_exposure(truth.hdr, exposure), mask, flip_map);
}

measure::Errors masked_errors(const measure::Picture& picture, const ComparedReference& truth,
                              std::span<const float> flip_map,
                              const std::vector<std::uint32_t>& hits, std::size_t mirrors,
                              double exposure) {
    const measure::Picture found = measure::apply_exposure(picture, exposure),
                           wanted = measure::apply_exposure(truth.hdr, exposure);
    const auto against = [&](const measure::Mask& mask) {
        return masked_error(found, {wanted, truth.halves}, mask, flip_map, 0);
    };
    measure::Errors errors;
    const std::vector<measure::Mask> masks = measure::compute_masks(hits);
    for (std::size_t i = 0; i < masks.size(); ++i)
        errors.*measure::row_masks()[i].error = against(masks[i]);
    for (std::size_t i = 0; i < mirrors; ++i)
        errors.error_per_mirror.push_back(
            against(measure::mask_one_mirror(hits, MirrorId::from_index(i))));
    return errors;
}

void fill_row_errors(report::Row& row, const TechniqueResult& part, const ComparedReference& truth,
                     const std::vector<std::uint32_t>& hits, std::size_t mirrors, double exposure) {
    row.hdr = part.hdr;
    row.display = part.display;
    row.flip_map = compute_flip_map(part.hdr, truth, exposure);
    static_cast<measure::Errors&>(row) = masked_errors(part.hdr, truth, row.flip_map, hits, mirrors,
                                                       exposure);
    if (truth.halves != nullptr) estimate_noise(row, *truth.halves, hits, exposure);
    row.mirrors_black = draws_mirrors_black(part.hdr, truth.hdr, hits);
    row.mean = measure::mean_of(part.hdr, measure::ValueRange::unclamped);
    row.mean_clamped = measure::mean_of(part.hdr, measure::ValueRange::clamped);
}

report::Row describe_row(const std::string& text, const TechniqueResult& part) {
    const ParsedTechnique choice = parse_technique(text);
    report::Row row;
    row.technique = choice.technique;
    row.traits = choice.of_technique;
    row.label = choice.label;
    row.settings = choice.settings;
    row.image = choice.file_name;
    row.plan = part.plan;
    row.model = work_name(part.model);
    for (const auto& [what, why, saves, error] : part.left_out)
        row.left_out.push_back({what, why, saves, error});
    row.scene_passes = part.scene_passes;
    row.scene_draws = part.scene_draws;
    row.memory_bytes = part.memory_bytes;
    if (part.rays) row.rays = RayCounts{part.rays->primary, part.rays->mirror, part.rays->shadow};
    row.traced_fraction = part.traced_fraction;
    if (part.auto_face)
        row.auto_face = report::AutoFace{part.auto_face->edge, part.auto_face->needs};
    return row;
}

/// If the row is alone in its frames, its time runs from the first to the last timestamp.
void fill_row_times(report::Row& row, const MeasuredFrames& frames, const std::string& prefix,
                    bool on_processor) {
    const auto mine = [&](const PassTime& pass) { return pass.name.starts_with(prefix); };
    const MeasuredFrames detailed = keep_frames_with_passes(frames);
    row.gpu_ms = prefix.empty() ? summarise_frames(
                                      frames, [](const FrameTimes& frame) { return frame.gpu_ms; })
                                : summarise_frames(detailed, [&](const FrameTimes& frame) {
                                      double sum = 0;
                                      for (const PassTime& pass : frame.passes)
                                          sum += mine(pass) ? pass.ms() : 0;
                                      return sum;
                                  });
    const auto summary = [&](double FrameTimes::*which) {
        return summarise_frames(frames, [&](const FrameTimes& frame) { return frame.*which; });
    };
    row.wait_ms = summary(&FrameTimes::wait_ms);
    row.cpu_record_ms = summary(&FrameTimes::record_ms);
    row.wall_ms = summary(&FrameTimes::wall_ms);
    if (on_processor) row.cpu_ms = summary(&FrameTimes::cpu_ms);
    row.on_processor = on_processor && prefix.empty();
    row.closure = summarise_frames(
        frames, [](const FrameTimes& frame) { return frame.passes_ms / frame.wall_ms; });
    row.host_ms = summarise_frames(frames,
                                   [](const FrameTimes& frame) { return frame.host.sum(); });
    row.frame_ms = summarise_frames(frames,
                                    [](const FrameTimes& frame) { return frame.frame_ms(); });
    row.host_parts = summarise_host_times(frames);
    row.passes.clear();
    for (const std::string& name : pass_names(detailed))
        if (name.starts_with(prefix))
            row.passes.push_back({name, summarise_frames(detailed, [&](const FrameTimes& frame) {
                                      const auto pass = std::ranges::find(frame.passes, name,
                                                                          &PassTime::name);
                                      return pass == frame.passes.end() ? 0 : pass->ms();
                                  })});
}

} // namespace catoptric::study
