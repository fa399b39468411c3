#include "compare.hpp"

#include "core/error.hpp"
#include "measure/halves.hpp"
#include "measure/interval.hpp"
#include "measure/judge.hpp"
#include "measure/masks.hpp"
#include "measure/setup.hpp"
#include "measure/statistics.hpp"
#include "reflect/technique.hpp"
#include "report/comparison.hpp"
#include "scene/pose.hpp"
#include "session/access.hpp"
#include "session/device_facts.hpp"
#include "session/exposure.hpp"
#include "session/processor.hpp"
#include "session/scene_info.hpp"
#include "session/technique_choice.hpp"
#include "session/watcher.hpp"
#include "study/compare_checks.hpp"
#include "study/compare_row.hpp"
#include "study/compare_settings.hpp"
#include "study/compare_to_target.hpp"
#include "study/light_model_warnings.hpp"
#include "study/picture_rows.hpp"
#include "study/plan_certificate.hpp"
#include "study/reference_cache.hpp"
#include "study/row_judge.hpp"
#include "study/row_run.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <ctime>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>

namespace catoptric::study {

namespace {

/// Number of samples over each pixel's area against which pictures of pixel centres are compared,
/// and the longest time for rendering these samples.
constexpr const char* kAreaSamples = "16";
constexpr double kMaxAreaSeconds = 10;

bool is_same_choice(const ParsedTechnique& a, const ParsedTechnique& b) {
    return a.technique == b.technique && a.settings == b.settings;
}

/// Compares the bits, so that a NaN equals itself.
bool have_equal_pixels(const measure::Picture& a, const measure::Picture& b) {
    return std::ranges::equal(std::as_bytes(std::span(a.pixels)),
                              std::as_bytes(std::span(b.pixels)));
}

/// Returns text such as "2026-11-24T03:05:10Z".
std::string utc_now() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    ::gmtime_r(&now, &utc);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%FT%TZ", &utc)};
}

/// Measures the rows of a comparison in rounds, one by one or together in each frame. Compares each
/// row with the reference of the same sample count.
class ComparisonRunner {
public:
    ComparisonRunner(Engine& engine, const CompareRequest& request,
                     const std::optional<NoiseFloorTarget>& noise_target)
        : engine_(engine), request_(replace_auto_reference(request)), noise_target_(noise_target),
          compiled_before_(Access::compiled_pipelines(engine)),
          shared_session_(engine, request_.base.scene),
          truths_(shared_session_, request_.base, request_.reference, request_.watcher,
                  request_.reference_seconds),
          judge_(shared_session_, truths_, request_.base, request_.watcher) {
        if (request_.base.techniques.empty())
            request_.base.techniques = default_techniques(request_.base);
        check_compare_request(request_); // refuses a bad request before any work
        for (const StudyChoice& choice : requested_studies())
            if (const Study& study = find_study(choice.name); study.prepare != nullptr)
                study.prepare(request_, choice.count, comparison_);
    }

    report::Comparison run_all() {
        resolve_exposure(shared_session_, request_.base);
        list_rows();
        prepare();
        // Certificates are read now, because a plan's file may change or vanish while rows are
        // measured.
        const auto certificates = read_certificates(request_.base.techniques);
        try {
            if (!request_.reference_file.empty()) truths_.keep_in_file(request_.reference_file);
            fill_noise();
            measure_rounds();
            add_certificates(certificates, comparison_);
            reduce_noise();
            measure_centre_error();
            truths_.write_file();
            add_picture_rows();
            for (const StudyChoice& choice : requested_studies())
                find_study(choice.name)
                    .run({.engine = engine_,
                          .session = shared_session_,
                          .request = request_,
                          .count = choice.count,
                          .texts = choice.texts,
                          .noise_target = noise_target_,
                          .truth = truths_,
                          .comparison = comparison_,
                          .tell = [this] { report_progress(); },
                          .warn =
                              [this](const std::string& warning) {
                                  study_warnings_.push_back(warning);
                              }});
            comparison_.complete = true;
        } catch (const Error& error) {
            if (comparison_.rows.empty() && !is_signal(error.failure)) throw;
            comparison_.stopped = error;
        } catch (const std::bad_alloc&) {
            if (comparison_.rows.empty()) throw;
            comparison_.stopped = Error(Failure::exhausted, "out of memory");
        }
        fill_circumstances();
        return std::move(comparison_);
    }

private:
    void list_rows() {
        std::vector<std::string>& texts = request_.base.techniques;
        const std::vector<std::string> asked = std::exchange(texts, {});
        for (const std::string& text : asked) {
            texts.push_back(text);
            models_.push_back(request_.both_models ? RenderedWork::everything
                                                   : request_.base.model);
            if (!request_.both_models) continue;
            texts.push_back(text);
            models_.push_back(RenderedWork::required);
        }
    }

    void prepare() {
        fill_settings(request_, comparison_);
        comparison_.date = utc_now();
        comparison_.asked = request_.base.techniques.size() + request_.pictures.size();
        comparison_.device = make_device_facts(engine_);
        comparison_.load_start = read_machine_load();
        for (const StudyChoice& choice : requested_studies())
            comparison_.studies.push_back(choice.name);
        if (truths_.has_noise()) comparison_.studies.emplace_back(measure::kNoiseMetricName);
    }

    /// Returns the studies that were asked for, in the order of the table.
    std::vector<StudyChoice> requested_studies() const {
        std::vector<StudyChoice> choices;
        for (const Study& study : studies())
            if (const auto choice = std::ranges::find(request_.studies, study.name,
                                                      &StudyChoice::name);
                choice != request_.studies.end())
                choices.push_back(*choice);
        return choices;
    }

    /// Fills facts that are known only after rows were measured.
    void fill_circumstances() {
        const SetupTimes setup = Access::setup_times(shared_session_);
        const CompiledPipelines compiled = Access::compiled_pipelines(engine_);
        constexpr const char* kCacheStateNames[] = {"none", "made",
                                                    "used"}; // texts indexed by PipelineCacheState
        comparison_.setup = std::make_shared<measure::SetupFacts>(measure::SetupFacts{
            request_.base.load_ms, setup.upload_ms, setup.hierarchy_ms,
            compiled.ms - compiled_before_.ms, compiled.pipelines - compiled_before_.pipelines,
            kCacheStateNames[static_cast<std::size_t>(Access::pipeline_cache_state(engine_))]});
        comparison_.load_end = read_machine_load();
        comparison_.warnings = request_.base.scene.warnings;
        for (const std::vector<std::string>& warnings : row_warnings_)
            comparison_.warnings.insert(comparison_.warnings.end(), warnings.begin(),
                                        warnings.end());
        comparison_.warnings.insert(comparison_.warnings.end(), study_warnings_.begin(),
                                    study_warnings_.end());
        comparison_.pareto = measure::find_pareto_front(comparison_.rows);
    }

    /// Returns the times of clearing the cubes of all mirrors without drawing, for as many frames
    /// as a row has in the round.
    std::vector<double> measure_clear_times(int round, int warmup) {
        const int frames = frames_of_round(request_.base.frames, comparison_.rounds, round);
        std::vector<double> samples;
        for (int k = 0; k < warmup + frames; ++k) {
            const FrameTimes times = Access::measure_clear_time(shared_session_);
            if (k >= warmup) samples.push_back(times.passes_ms);
            throw_if_stopped(request_.watcher);
        }
        return samples;
    }

    /// Fills the figures of the reference that change while its noise is reduced.
    void fill_noise() {
        comparison_.reference_gpu_ms = measure::summarise(truths_.get("1").gpu_ms);
        comparison_.reference_hdr = truths_.get("1").part.hdr;
        comparison_.reference_display = truths_.get("1").part.display;
        comparison_.mirror_hits = truths_.hits();
        if (!truths_.has_noise()) return;
        comparison_.noise = std::make_shared<measure::ReferenceNoise>(truths_.measure_noise("1"));
        comparison_.noise->most_seconds = request_.reference_seconds;
        std::vector<const report::Row*> rows;
        for (const report::Row& row : comparison_.rows) rows.push_back(&row);
        comparison_.noise->wanted_floor = measure::target_noise_floor(rows);
    }

    /// Adds frames to a reference with noise, and judges the rows again. Rows with another number
    /// of samples per pixel have a reference of their own; all references share
    /// --reference-seconds.
    void reduce_noise() {
        if (!truths_.has_noise()) return;
        std::map<std::string, std::vector<std::size_t>> groups; // rows by sample count
        for (std::size_t i = 0; i < comparison_.rows.size(); ++i)
            groups[sample_count(parse_technique(request_.base.techniques[i]))].push_back(i);
        for (const auto& [samples, rows] : groups)
            while (truths_.grow(
                samples, request_.reference_seconds / static_cast<double>(groups.size()),
                noise_target_.value_or(NoiseFloorTarget{.floor = target_noise_floor(rows)}))) {
                for (const std::size_t row : rows)
                    compute_row_errors(row, judged_[row].part, judged_[row].number);
                fill_noise();
                report_progress();
            }
        judged_.clear();
    }

    /// Measures the FLIP over the mirrors between the default reference, whose pixels are their
    /// centres, and the mean of kAreaSamples samples over each pixel's area. Does nothing for other
    /// references, which may refuse samples, and if the samples would take longer than
    /// kMaxAreaSeconds.
    void measure_centre_error() {
        if (truths_.has_noise() ||
            !is_same_choice(parse_technique(request_.reference), parse_technique(kReference)) ||
            comparison_.reference_gpu_ms.median * std::stoi(kAreaSamples) > 1000 * kMaxAreaSeconds)
            return;
        const ComparedReference area = truths_.get(kAreaSamples).compared();
        const std::vector<float> map = compute_flip_map(truths_.get("1").part.hdr, area,
                                                        request_.base.exposure);
        comparison_.reference_area_flip = measure::flip_mean(map,
                                                             measure::mask_mirrors(truths_.hits()));
    }

    double target_noise_floor(const std::vector<std::size_t>& indices) const {
        std::vector<const report::Row*> rows;
        for (const std::size_t index : indices) rows.push_back(&comparison_.rows[index]);
        return measure::target_noise_floor(rows);
    }

    /// The result of a row's last frame and its number, to compute the row's errors again later.
    struct JudgedPicture {
        TechniqueResult part;
        int number = 0; ///< number of the frame, from 1
    };

    void compute_row_errors(std::size_t index, const TechniqueResult& part, int number) {
        row_warnings_[index] = judge_.fill(comparison_.rows[index], request_.base.techniques[index],
                                           part, number);
        std::ranges::move(light_model_warnings(request_, request_.base.techniques[index],
                                               comparison_.rows[index].label,
                                               comparison_.reference_settings),
                          std::back_inserter(row_warnings_[index]));
    }

    void add_row(const std::string& text, const TechniqueResult& part) {
        report::Row row = describe_row(text, part);
        // If all rows share a frame, the host's work cannot be divided among the rows.
        row.moves = request_.base.animate && !request_.together &&
                    scene::is_animated(request_.base.scene);
        const std::string samples = sample_count(parse_technique(text));
        row.is_reference = is_same_choice(
            parse_technique(text), parse_technique(set_samples(request_.reference, samples)));
        if (request_.both_models && part.model == RenderedWork::required) {
            row.label += ", model=required";
            row.image += "-required";
        }
        comparison_.rows.push_back(std::move(row));
        row_warnings_.emplace_back();
        judged_.emplace_back();
        prefixes_.push_back(part.prefix);
        cycles_.push_back(part.capture_budget ? part.capture_budget->every : 1);
    }

    /// Adds the rows whose pictures are files, after all rows that are drawn. Studies of drawn rows
    /// leave them out.
    void add_picture_rows() {
        const ComparedReference truth = truths_.get("1").compared();
        const std::vector<std::uint32_t>& hits = truths_.hits();
        const double exposure = request_.base.exposure;
        for (std::size_t i = 0; i < request_.pictures.size(); ++i) {
            const auto& [name, path] = request_.pictures[i];
            const std::string file = *find_view_picture(path, 0);
            const measure::Picture picture = read_row_picture(file, exposure);
            const report::Row& row = comparison_.rows.emplace_back(
                make_picture_row(name, i, picture, truth, hits,
                                 scene::mirrors(request_.base.scene).size(), exposure));
            row_warnings_.push_back(
                picture_row_warnings(name, file, picture, row.error.rmse, truth, hits, exposure));
        }
    }

    void report_progress() {
        fill_circumstances();
        if (request_.on_finished_row) request_.on_finished_row(comparison_);
    }

    /// Returns the groups of rows that share frames: one row each, or all rows with `together`.
    std::vector<std::vector<std::string>> group_rows() const {
        const std::vector<std::string>& texts = request_.base.techniques;
        if (request_.together) return {texts};
        std::vector<std::vector<std::string>> groups;
        for (const std::string& text : texts) groups.push_back({text});
        return groups;
    }

    void measure_rounds() {
        const PinnedThreads held;
        comparison_.device.held_threads = static_cast<int>(held.count());
        for (int round = 0; round < comparison_.rounds; ++round) measure_rows(round);
        if (repeats_first_round()) repeat_first_round();
        runs_.clear(); // frees also the device memory of their histories
    }

    void measure_rows(int round) {
        clear_ms_.push_back(measure_clear_times(round, round == 0 ? request_.base.warmup : 0));
        comparison_.clear_ms = measure::summarise(clear_ms_);
        const std::vector<std::vector<std::string>> all = group_rows();
        // Every second round measures the rows in reverse order. The same row then never always
        // follows another, whose remaining work could disturb it.
        for (std::size_t place = 0; place < all.size(); ++place) {
            const std::size_t group = round % 2 == 0 ? place : all.size() - 1 - place;
            report_row(request_.watcher,
                       describe_group(group) + ", round " + std::to_string(round + 1) + " of " +
                           std::to_string(comparison_.rounds),
                       static_cast<std::size_t>(round) * all.size() + place,
                       count_measurements(all.size()));
            measure_group(group, all[group], round);
        }
        // If the first round will be measured again, files are not written now, because that would
        // interrupt the device.
        const bool is_followed = round + 1 == comparison_.rounds && repeats_first_round();
        if (round > 0 && !is_followed) report_progress();
    }

    /// Returns the label of the rows that are measured together, for the watcher.
    std::string describe_group(std::size_t group) const {
        std::string text = request_.together ? "all rows in one frame"
                                             : group_rows()[group].front();
        if (request_.both_models) text += ", model " + work_name(models_[group]);
        return text;
    }

    int count_first_frames() const {
        return frames_of_round(request_.base.frames, comparison_.rounds, 0);
    }

    bool repeats_first_round() const {
        return request_.repeats_first_round.value_or(
            must_repeat_first_round(comparison_.device.type));
    }

    /// Measures the first round again, without other work on the device. Afterwards computes errors
    /// of the last round's pictures, which would have interrupted the device.
    void repeat_first_round() {
        std::vector<double> clear_ms = measure_clear_times(0, 0);
        for (std::size_t group = 0; group < runs_.size(); ++group) {
            report_row(request_.watcher, describe_group(group) + ", first round again",
                       static_cast<std::size_t>(comparison_.rounds) * runs_.size() + group,
                       count_measurements(runs_.size()));
            runs_[group]->repeat_first_round();
            runs_[group]->suspend_frames();
        }
        clear_ms_.front() = std::move(clear_ms);
        comparison_.clear_ms = measure::summarise(clear_ms_);
        for (std::size_t group = 0; group < runs_.size(); ++group) {
            runs_[group]->replace_first_round();
            for (std::size_t i = 0; i < runs_[group]->technique_count(); ++i)
                fill_times(group + i, *runs_[group]);
        }
        for (const auto& [index, picture] : unjudged_) judge_row(index, picture);
        unjudged_.clear();
        report_progress();
    }

    /// Returns how often a row is measured in all rounds.
    std::size_t count_measurements(std::size_t rows) const {
        return (static_cast<std::size_t>(comparison_.rounds) + (repeats_first_round() ? 1 : 0)) *
               rows;
    }

    void judge_row(std::size_t index, const JudgedPicture& picture) {
        compute_row_errors(index, picture.part, picture.number);
        if (truths_.has_noise()) judged_[index] = picture;
    }

    void fill_times(std::size_t index, const RowMeasurement& run) {
        report::Row& row = comparison_.rows[index];
        fill_row_times(row, {run.rounds(), cycles_[index]}, prefixes_[index],
                       comparison_.device.type == "cpu");
        row.noisy = run.is_noisy();
        row.waited = run.wait_share();
    }

    /// Measures one round of a row. Computes the row's errors after the first round, and again if
    /// its last picture differs.
    void measure_group(std::size_t group, const std::vector<std::string>& texts, int round) {
        const bool first = round == 0, last = round + 1 == comparison_.rounds;
        if (first) {
            Request request = request_.base;
            request.techniques = texts;
            request.model = models_[group];
            runs_.push_back(
                std::make_unique<RowMeasurement>(shared_session_, request, request_.watcher,
                                                 repeats_first_round() ? count_first_frames() : 0));
        }
        RowMeasurement& run = *runs_[group];
        run.measure_round(frames_of_round(request_.base.frames, comparison_.rounds, round));
        const std::vector<TechniqueResult> parts = first || last ? run.results()
                                                                 : std::vector<TechniqueResult>();
        run.suspend_frames();
        for (std::size_t i = 0; i < texts.size(); ++i) {
            const std::size_t index = group + i;
            if (first) add_row(texts[i], parts[i]);
            fill_times(index, run);
            const report::Row& row = comparison_.rows[index];
            const bool changed = last && !first &&
                                 (request_.base.animate ||
                                  !have_equal_pixels(row.hdr, parts[i].hdr));
            if (changed && repeats_first_round())
                unjudged_.push_back({index, {parts[i], run.frame_number()}});
            else if (first || changed)
                judge_row(index, {parts[i], run.frame_number()});
            if (first) report_progress();
        }
    }

    Engine& engine_;
    CompareRequest request_;
    std::optional<NoiseFloorTarget> noise_target_; ///< none: the errors of the rows decide
    /// Pipelines that the engine compiled before this comparison.
    CompiledPipelines compiled_before_;
    Session shared_session_; ///< shared by all rows
    ReferenceCache truths_;
    RowErrorJudge judge_;
    std::vector<RenderedWork> models_; ///< models of the rows
    std::vector<std::unique_ptr<RowMeasurement>>
        runs_;                                  ///< one per row, or one for all rows together
    std::vector<std::string> prefixes_;         ///< prefixes of the rows' passes
    std::vector<std::size_t> cycles_;           ///< MeasuredFrames::cycle of the rows
    std::vector<std::vector<double>> clear_ms_; ///< clear times by round
    std::vector<std::vector<std::string>> row_warnings_;
    std::vector<std::string> study_warnings_;
    std::vector<JudgedPicture>
        judged_; ///< last result of each row; default without noise of the reference
    std::vector<std::pair<std::size_t, JudgedPicture>>
        unjudged_; ///< pictures of the last round, with the row's index
    report::Comparison comparison_;
};

} // namespace

report::Comparison compare(Engine& engine, const CompareRequest& request) {
    return compare_to_noise_target(engine, request, {});
}

report::Comparison compare_to_noise_target(Engine& engine, const CompareRequest& request,
                                           const std::optional<NoiseFloorTarget>& target) {
    const WatchedWork watched(request.watcher);
    return ComparisonRunner(engine, request, target).run_all();
}

} // namespace catoptric::study
