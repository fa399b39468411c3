#include "app/compare.hpp"

#include "app/causes.hpp"
#include "app/compare_row.hpp"
#include "app/lag.hpp"
#include "app/light_edges.hpp"
#include "app/oracle.hpp"
#include "app/plan_file.hpp"
#include "app/truths.hpp"
#include "app/views.hpp"
#include "core/error.hpp"
#include "measure/difference.hpp"
#include "measure/judge.hpp"
#include "measure/masks.hpp"
#include "reflect/technique.hpp"
#include "scene/load.hpp"

#include <algorithm>
#include <new>

namespace catoptric::app {

namespace {

bool same(const TechniqueChoice& a, const TechniqueChoice& b) {
    return a.technique == b.technique && a.settings == b.settings;
}

bool is_set(const report::Row& row, std::string_view knob, std::string_view text) {
    return std::ranges::any_of(row.settings, [&](const report::Setting& setting) {
        return setting.name == knob && setting.text == text;
    });
}

/// Runs rows one by one or together, judges each against the reference at its sample count.
class Comparer {
public:
    Comparer(Engine& engine, const CompareRequest& request)
        : engine_(engine), request_(request), compiled_before_(engine.compiled()),
          session_(engine, request.base.scene),
          truths_(session_, request_.base, request_.reference, request_.watcher) {
        if (request_.base.techniques.empty()) request_.base.techniques = default_techniques();
        check_rows(request_.base.techniques); // before any work
        for (const std::string& text : request_.base.techniques)
            reflect::assign(read_plan(text), mirror_names(request_.base.scene));
        check_has_mirror(request_.base.scene);
        mirrors_ = scene::mirrors(request_.base.scene).size();
        comparison_.views = drawn_views(request_.base, request_.views);
    }

    report::Comparison run() {
        start();
        try {
            // Masks: what one ray through each pixel centre meets.
            hits_ = truths_.hits();
            fill_reference();
            fill_clear();
            request_.together ? run_together() : run_apart();
            if (!comparison_.views.empty()) add_views();
            if (request_.lag) add_lag();
            comparison_.complete = true;
        } catch (const Error& error) {
            if (comparison_.rows.empty() && !is_stop(error.failure)) throw;
            comparison_.stopped = error;
        } catch (const std::bad_alloc&) {
            if (comparison_.rows.empty()) throw;
            comparison_.stopped = Error(Failure::exhausted, "out of memory");
        }
        fill_setup();
        return std::move(comparison_);
    }

private:
    void start() {
        const Request& base = request_.base;
        const DeviceInfo& device = engine_.device();
        comparison_.version = version();
        comparison_.commit = commit();
        comparison_.command = request_.command;
        comparison_.complete = false;
        comparison_.asked = base.techniques.size();
        comparison_.device = {device.name, device.driver, device.api, device.type, device.threads};
        comparison_.scene = {base.scene.name,
                             scene::triangle_count(base.scene),
                             mirrors_,
                             scene::hash(base.scene),
                             scene::hash(base.scene) == scene::hash(scene::cornell_mirrors()),
                             facts_of(base.camera)};
        comparison_.width = static_cast<int>(base.size.x);
        comparison_.height = static_cast<int>(base.size.y);
        comparison_.frames = base.frames;
        comparison_.warmup = base.warmup;
        comparison_.time = base.time;
        comparison_.ambient = base.ambient;
        comparison_.exposure = base.exposure;
        comparison_.timing = base.timing == Timing::isolated ? "isolated" : "pipelined";
        comparison_.together = request_.together;
        comparison_.warnings = base.scene.warnings;
    }

    void fill_setup() {
        const Setup setup = session_.setup();
        const Compiled compiled = engine_.compiled();
        constexpr const char* kCacheUse[] = {"none", "made", "used"}; // by CacheUse
        comparison_.setup = {request_.base.load_ms,
                             setup.upload_ms,
                             setup.hierarchy_ms,
                             compiled.ms - compiled_before_.ms,
                             compiled.pipelines - compiled_before_.pipelines,
                             kCacheUse[static_cast<std::size_t>(engine_.cache_use())]};
    }

    /// What it costs to clear the cubes of all mirrors once and draw nothing.
    void fill_clear() {
        const Request& base = request_.base;
        std::vector<double> samples;
        for (int k = 1; k <= base.total(); ++k) {
            const FrameTimes times = session_.clear_cubes();
            if (k > base.warmup) samples.push_back(times.passes_ms());
            request_.watcher.check_stopped();
        }
        comparison_.clear_ms = measure::summarise(samples);
    }

    void fill_reference() {
        const TechniqueChoice choice = parse_technique(request_.reference);
        comparison_.reference_technique = choice.technique;
        comparison_.reference_label = choice.label;
        comparison_.reference_settings = choice.settings;
        comparison_.reference_gpu_ms = measure::summarise(truths_.at("1").gpu_ms);
        comparison_.reference_display = truths_.at("1").part.display;
    }

    /// Where the row's mirrors looked and what its captures cut off: a run of its own, since saying
    /// so costs time. No lookup for rows that do not look into captures.
    Part looked_up(const std::string& text) {
        Request request = request_.base;
        request.techniques = {text};
        request.frames = 1;
        request.warmup = 1;
        request.time = request_.base.instant(request_.base.total());
        request.animate = false;
        request.with_lookup = true;
        Part part = std::move(app::run(session_, request, request_.watcher).parts.front());
        const bool looks = std::ranges::any_of(part.lookup,
                                               [](const vec4& pixel) { return pixel.w > 0; });
        if (!looks) part.lookup.clear();
        if (looks && !oracle_) oracle_.emplace(request);
        return part;
    }

    /// Splits the row's error by cause.
    report::Causes causes_of(const std::string& text, const report::Row& row) {
        if (!finder_)
            finder_.emplace(session_, request_.base, truths_.at("1").part.hdr, hits_,
                            request_.watcher);
        report::Causes causes = finder_->find(text);
        causes.at_light_edges = row.light_edges->share;
        return causes;
    }

    void add(const std::string& text, const Part& part, const std::vector<FrameTimes>& frames) {
        report::Row row = make_row(text, part, frames);
        // Together the host's work is that of all rows, which none can be blamed for.
        row.moves = request_.base.animate && !request_.together &&
                    scene::is_animated(request_.base.scene);
        const Part looked = !part.rays || part.traced_fraction ? looked_up(text) : Part();
        const std::vector<vec4>& lookup = looked.lookup;
        row.saturated_texels = looked.saturated;
        if (looked.saturated.value_or(0) > 0)
            comparison_.warnings.push_back(
                "'" + text + "': " + std::to_string(*looked.saturated) +
                " texels of its captures are brighter than 65504, where colour=half ends");
        for (const std::string& note : part.notes)
            comparison_.warnings.push_back("'" + text + "': " + note);
        if (!lookup.empty())
            row.lookup = measure::lookup_error(
                oracle_->judge(lookup, is_set(row, "mirrors", "left_out")));
        const std::string samples = sample_count(parse_technique(text));
        const Part& truth = truths_.at(samples).part;
        fill_errors(row, part, truth, hits_, mirrors_);
        if (!lookup.empty()) row.light_edges = light_edges_of(row, truth, hits_, lookup, *oracle_);
        const bool is_plan = !read_plan(text).is_technique; // which no one search can be blamed for
        if (!lookup.empty() && request_.causes && !is_plan &&
            same(parse_technique(request_.reference), parse_technique(kReference)))
            row.causes = causes_of(text, row);
        row.is_reference = same(parse_technique(text),
                                parse_technique(reference_at(request_.reference, samples)));
        comparison_.rows.push_back(std::move(row));
        comparison_.pareto = measure::front_of(comparison_.rows);
        tell();
    }

    void tell() {
        fill_setup();
        if (request_.on_finished_row) request_.on_finished_row(comparison_);
    }

    void run_apart() {
        const std::vector<std::string>& texts = request_.base.techniques;
        for (std::size_t i = 0; i < texts.size(); ++i) {
            request_.watcher.row(texts[i], i, texts.size());
            Request request = request_.base;
            request.techniques = {texts[i]};
            const Result result = app::run(session_, request, request_.watcher);
            add(texts[i], result.parts.front(), result.frames);
        }
    }

    void run_together() {
        request_.watcher.row("all rows in one frame", 0, 1);
        const Result result = app::run(session_, request_.base, request_.watcher);
        for (std::size_t i = 0; i < result.parts.size(); ++i)
            add(request_.base.techniques[i], result.parts[i], result.frames);
    }

    void add_views() {
        measure_views(session_,
                      {.base = request_.base,
                       .reference = request_.reference,
                       .watcher = request_.watcher,
                       .on_finished_view = [this] { tell(); }},
                      comparison_);
    }

    void add_lag() {
        measure_lag(session_,
                    {.base = request_.base,
                     .reference = request_.reference,
                     .watcher = request_.watcher,
                     .on_finished_row = [this] { tell(); }},
                    comparison_.lag.emplace());
    }

    Engine& engine_;
    CompareRequest request_;
    Compiled compiled_before_; ///< by the engine, for others
    Session session_;          ///< of all rows
    std::size_t mirrors_ = 0;
    Truths truths_;
    std::vector<std::uint32_t> hits_;
    std::optional<Oracle> oracle_;
    std::optional<CauseFinder> finder_;
    report::Comparison comparison_;
};

} // namespace

std::vector<std::string> default_techniques() {
    std::vector<std::string> rows;
    for (const reflect::Technique* technique : reflect::techniques())
        rows.insert(rows.end(), technique->compared.begin(), technique->compared.end());
    return rows;
}

void check_has_mirror(const scene::Scene& scene) {
    check(!scene::mirrors(scene).empty(), Failure::bad_data, "scene '", scene.name,
          "': wanted a mirror, whose reflections are what is compared, found none. To make one, "
          "give its "
          "material metallicFactor 1, roughnessFactor 0 and a white base colour in glTF, or illum "
          "3 and "
          "Ks 1 1 1 in an .mtl");
}

void check_rows(const std::vector<std::string>& techniques) {
    std::vector<reflect::Plan> plans;
    for (const std::string& text : techniques) {
        reflect::Plan plan = read_plan(text);
        for (const reflect::Plan& other : plans)
            check(!plan.same_as(other), Failure::usage, "technique '", text,
                  "' is asked for twice");
        plans.push_back(std::move(plan));
    }
}

report::Comparison compare(Engine& engine, const CompareRequest& request) {
    return Comparer(engine, request).run();
}

} // namespace catoptric::app
