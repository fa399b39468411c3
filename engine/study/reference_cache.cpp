#include "study/reference_cache.hpp"

#include "compare.hpp"
#include "core/error.hpp"
#include "core/stopwatch.hpp"
#include "measure/masks.hpp"
#include "scene/rough_reflectors.hpp"
#include "session/technique_choice.hpp"
#include "study/reference_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace catoptric::study {

namespace {

/// Returns the rmse between two halves of a reference, as predicted from the variance of their
/// frames. Values are not clamped.
double predict_halves_rmse(const NoisyReference& noisy, const measure::Mask& mask,
                           double exposure) {
    const measure::Picture a = noisy.a.variance(), b = noisy.b.variance();
    double sum = 0, pixels = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (mask[i] == 0) continue;
        const dvec3 both = dvec3(a.pixels[i]) + dvec3(b.pixels[i]);
        sum += (both.x + both.y + both.z) / 3, ++pixels;
    }
    return std::exp2(exposure) * std::sqrt(sum / pixels);
}

/// Thrown between the pieces of a frame that takes too long.
struct OutOfTime {};

/// Most rays of a frame from whose time the time of others is foretold.
constexpr std::uint64_t kMostCoarseRays = std::uint64_t{1} << 18;

} // namespace

int choose_coarse_rays(const std::string& reference, uvec2 size) {
    const int wanted = find_lobe_rays(reference);
    const std::uint64_t pixels = std::uint64_t{size.x} * size.y *
                                 std::stoull(sample_count(parse_technique(reference)));
    if (pixels * static_cast<std::uint64_t>(wanted) <= kMostCoarseRays) return wanted;
    const auto most = static_cast<unsigned>(
        std::min<std::uint64_t>(kMostCoarseRays / pixels, static_cast<std::uint64_t>(wanted)));
    return static_cast<int>(std::bit_floor(std::max(most, 1U)));
}

std::string choose_coarse_technique(const std::string& reference, uvec2 size) {
    const int rays = choose_coarse_rays(reference, size);
    return rays == find_lobe_rays(reference) ? reference : set_lobe_rays(reference, rays);
}

int choose_refined_rays(int wanted, int rays, double frame_seconds, double seconds) {
    const double fit = seconds / (2 * frame_seconds / rays);
    if (!(fit < wanted)) return wanted;
    return static_cast<int>(std::bit_floor(static_cast<unsigned>(std::max(fit, 1.0))));
}

std::string choose_reference(const std::string& asked, const scene::Scene& scene,
                             ReferencePixelKind truth) {
    if (!asked.empty()) return asked;
    if (truth == ReferencePixelKind::paths) return kPathReference;
    const bool is_rough = scene::has_rough_reflector(scene);
    if (truth == ReferencePixelKind::converged)
        return is_rough ? kConvergedRoughReference : kConvergedReference;
    return is_rough ? kRoughReference : kReference;
}

std::string sample_count(const ParsedTechnique& choice) {
    for (const auto& setting : choice.settings)
        if (setting.name == choice.traits().samples) return setting.text;
    return "1";
}

std::string set_samples(const std::string& reference, const std::string& samples) {
    const ParsedTechnique choice = parse_technique(reference);
    if (samples == "1" || choice.traits().samples.empty() || sample_count(choice) != "1")
        return reference;
    return reference + (reference.find(':') == std::string::npos ? ":" : ",") +
           std::string(choice.traits().samples) + "=" + samples;
}

RunResult ReferenceCache::render(const std::string& technique, int number) const {
    Request request = base_;
    request.techniques = {technique};
    request.model = RenderedWork::everything;
    request.warmup = std::min(request.warmup, number - 1);
    request.frames = number - request.warmup;
    if (sample_count(parse_technique(technique)) != "1") {
        // One frame is rendered, because a frame with many samples takes long, and ray-traced
        // frames do not depend on earlier frames.
        request.time = base_.instant(number);
        request.animate = false;
        request.warmup = 0, request.frames = 1;
    }
    return run(session_, request, watcher_);
}

bool is_noisy(const std::string& reference, const scene::Scene& scene) {
    return traces_paths(reference) || draws_environment_rays(reference, scene) ||
           (draws_lobe_rays(reference) && scene::has_rough_reflector(scene));
}

void check_reference_has_file(const std::string& reference, const scene::Scene& scene,
                              const std::filesystem::path& file) {
    check(is_noisy(reference, scene), Failure::usage, "--reference ", file.string(),
          ": wanted a reference with noise, which draws rays from the lobes of rough surfaces; "
          "found one without");
}

bool ReferenceCache::has_noise() const {
    if (!noisy_) noisy_ = is_noisy(reference_, base_.scene);
    return *noisy_;
}

bool ReferenceCache::add_frames(ReferencePicture& reference, int number, double seconds) {
    NoisyReference& noisy = *reference.noisy;
    Request request = base_;
    request.model = RenderedWork::everything;
    request.time = base_.instant(number); // the rays of a frame do not depend on frames before
    request.animate = false;
    request.warmup = 0, request.frames = 1;
    const SteadyClock::time_point start = SteadyClock::now();
    std::vector<RunResult> results;
    Watcher watcher = watcher_; // is told of both halves as of one frame
    watcher.on_frame = {};
    watcher.on_piece = [&](std::uint64_t done, std::uint64_t all) {
        if (watcher_.on_piece) watcher_.on_piece(results.size() * all + done, 2 * all);
        if (ms_since(start) > 1e3 * seconds) throw OutOfTime();
    };
    const std::array seeds{noisy.seeds.next(), noisy.seeds.next()};
    try {
        for (const int seed : seeds) {
            const SteadyClock::time_point frame = SteadyClock::now();
            request.techniques = {set_lobe_seed(noisy.technique, seed)};
            results.push_back(run(session_, request, watcher));
            noisy.frame_seconds = 1e-3 * ms_since(frame);
        }
    } catch (const OutOfTime&) {
        noisy.seconds += 1e-3 * ms_since(start);
        return false;
    }
    noisy.used.insert(noisy.used.end(), seeds.begin(), seeds.end());
    noisy.a.add(results[0].parts.front().hdr);
    noisy.b.add(results[1].parts.front().hdr);
    for (const RunResult& result : results)
        reference.gpu_ms.push_back(result.frames.front().gpu_ms);
    if (reference.part.hdr.pixels.empty())
        reference.part = std::move(results.front().parts.front());
    update_picture(reference);
    noisy.seconds += 1e-3 * ms_since(start);
    report_frame(watcher_, 1, 1);
    return true;
}

bool ReferenceCache::refine(ReferencePicture& reference, int wanted, double seconds) {
    constexpr int kLeastGain = 4;  // for less, the frames so far are worth more
    constexpr double kMargin = .8; // the machine may become slower
    NoisyReference& noisy = *reference.noisy;
    const int rays = find_lobe_rays(noisy.technique),
              refined = choose_refined_rays(wanted, rays, noisy.frame_seconds, kMargin * seconds);
    if (noisy.a.count() > 1 || refined < kLeastGain * rays) return false;
    ReferencePicture finer;
    finer.part = reference.part;
    finer.noisy = std::make_shared<NoisyReference>(noisy.seeds);
    finer.noisy->technique = set_lobe_rays(noisy.technique, refined);
    const bool is_made = add_frames(finer, base_.total(), seconds);
    noisy.seconds += finer.noisy->seconds;
    if (!is_made) return false;
    finer.noisy->seconds = noisy.seconds;
    reference = std::move(finer);
    return true;
}

void ReferenceCache::update_picture(ReferencePicture& reference) const {
    NoisyReference& noisy = *reference.noisy;
    noisy.halves = measure::make_halves(noisy.a.mean(), noisy.b.mean(), base_.exposure);
    // The mean of both halves of the reference, before exposure.
    measure::PictureMean both;
    both.add(noisy.a.mean());
    both.add(noisy.b.mean());
    reference.part.hdr = both.mean();
    reference.part.display = measure::to_display(reference.part.hdr, base_.exposure);
}

void ReferenceCache::read_stored(ReferencePicture& reference) const {
    StoredReference stored = read_reference_file(make_reference_key(base_, reference_), file_);
    NoisyReference& noisy = *reference.noisy;
    for (const int seed : stored.seeds)
        check(noisy.seeds.reserve(seed), Failure::usage, file_.string(), ": a frame has the seed ",
              seed, ", which a row has as well; choose another seed for the row");
    noisy.used = std::move(stored.seeds);
    if (stored.rays > 0 && stored.rays != find_lobe_rays(noisy.technique))
        noisy.technique = set_lobe_rays(noisy.technique, stored.rays);
    noisy.a = std::move(stored.a), noisy.b = std::move(stored.b);
    reference.gpu_ms = std::move(stored.gpu_ms);
    reference.part.label = reference_;
    update_picture(reference);
}

void ReferenceCache::keep_in_file(const std::filesystem::path& file) {
    check_reference_has_file(reference_, base_.scene, file);
    file_ = file;
}

void ReferenceCache::write_file() {
    if (file_.empty()) return;
    const ReferencePicture& reference = get("1");
    const NoisyReference& noisy = *reference.noisy;
    write_reference_file({.a = noisy.a,
                          .b = noisy.b,
                          .seeds = noisy.used,
                          .gpu_ms = reference.gpu_ms,
                          .rays = find_lobe_rays(noisy.technique)},
                         make_reference_key(base_, reference_), file_);
}

ReferencePicture& ReferenceCache::find_reference(const std::string& samples, int number) {
    const std::pair key(samples, frame_to_render(number));
    const auto found = truths_.find(key);
    if (found != truths_.end()) return found->second;
    const std::string technique = set_samples(reference_, samples);
    ReferencePicture made;
    if (has_noise()) {
        std::vector<std::string> rows = base_.techniques;
        rows.push_back(reference_);
        const bool is_kept = !file_.empty() && samples == "1" && key.second == base_.total();
        made.noisy = std::make_shared<NoisyReference>(ReferenceSeeds(rows));
        made.noisy->technique = begins_coarse_ ? choose_coarse_technique(technique, base_.size)
                                               : technique;
        if (is_kept && std::filesystem::exists(file_))
            read_stored(made);
        else
            add_frames(made, key.second);
        made.part.hits.clear(); // with random rays, the second mirror of a pixel is random as well
    } else {
        RunResult result = render(technique, key.second);
        made.part = std::move(result.parts.front());
        for (const FrameTimes& frame : result.frames) made.gpu_ms.push_back(frame.gpu_ms);
    }
    return truths_.emplace(key, std::move(made)).first->second;
}

const ReferencePicture& ReferenceCache::get(const std::string& samples, int number) {
    return find_reference(samples, number);
}

double ReferenceCache::measure_noise_floor(const std::string& samples, ErrorQuantity quantity) {
    const measure::Mask mirrors = measure::mask_mirrors(hits());
    const ReferencePicture& reference = get(samples);
    check(reference.noisy != nullptr, Failure::internal, "the reference has no noise to measure");
    const measure::NoisyHalves& halves = reference.noisy->halves;
    return quantity == ErrorQuantity::flip
               ? measure::flip_mean(halves.floor_map, mirrors)
               : measure::difference(halves.a, halves.b, mirrors, halves.floor_map).rmse;
}

double ReferenceCache::noisy_seconds() const {
    double seconds = 0;
    for (const auto& [key, reference] : truths_)
        if (reference.noisy) seconds += reference.noisy->seconds;
    return seconds;
}

bool ReferenceCache::grow(const std::string& samples, double seconds,
                          const NoiseFloorTarget& target) {
    if (!has_noise()) return false;
    ReferencePicture& reference = find_reference(samples, base_.total());
    const auto whole = static_cast<std::size_t>(std::max(std::ceil(seconds), 1.0));
    const int wanted = find_lobe_rays(reference_);
    const auto is_done = [&] { // a floor of NaN, without a mirror pixel, is done, too
        const NoisyReference& noisy = *reference.noisy;
        const double floor = measure_noise_floor(samples, target.quantity);
        const bool is_coarse = find_lobe_rays(noisy.technique) * noisy.a.count() < wanted;
        return std::isnan(floor) || noisy.seconds + 2 * noisy.frame_seconds >= seconds ||
               !(is_coarse || floor > target.floor);
    };
    const auto report = [&](bool has_grown) {
        const NoisyReference& noisy = *reference.noisy;
        report_row(watcher_,
                   "reference " + noisy.technique + ", " + std::to_string(noisy.a.count()) +
                       " frames a half",
                   has_grown ? static_cast<std::size_t>(noisy.seconds) : 0, whole);
    };
    bool has_grown = false;
    for (; !is_done(); has_grown = true) {
        const double left = seconds - reference.noisy->seconds;
        report(has_grown);
        if (refine(reference, wanted, left)) continue;
        if (reference.noisy->seconds + 2 * reference.noisy->frame_seconds >= seconds ||
            !add_frames(reference, base_.total(), seconds - reference.noisy->seconds))
            break;
    }
    return has_grown;
}

measure::ReferenceNoise ReferenceCache::measure_noise(const std::string& samples) {
    const ReferencePicture& reference = get(samples);
    check(reference.noisy != nullptr, Failure::internal, "the reference has no noise to measure");
    const NoisyReference& noisy = *reference.noisy;
    const measure::Mask mirrors = measure::mask_mirrors(hits());
    const measure::NoiseFreeError between = measure::estimate_noise_free(
        noisy.halves.a, noisy.halves, mirrors, noisy.halves.floor_map);
    return {.frames = noisy.a.count(),
            .rays = find_lobe_rays(noisy.technique),
            .wanted_rays = find_lobe_rays(reference_),
            .seconds = noisy.seconds,
            .flip_floor = between.flip_floor,
            .halves_rmse = between.halves_rmse,
            .predicted_rmse = predict_halves_rmse(noisy, mirrors, base_.exposure)};
}

const std::vector<std::uint32_t>& ReferenceCache::hits(int number) {
    const std::vector<std::uint32_t>& known = get("1", number).part.hits;
    if (!known.empty()) return known;
    // If the reference is not ray traced, or has random rays, a separate ray-traced picture
    // provides the first hits.
    std::vector<std::uint32_t>& traced = hits_[frame_to_render(number)];
    if (traced.empty())
        traced = std::move(render("raytrace:depth=1", frame_to_render(number)).parts.front().hits);
    return traced;
}

} // namespace catoptric::study
