// Comparisons of techniques, as lists of rows.
#include "binding.hpp"

#include <catoptric/compare.hpp>
#include <catoptric/error.hpp>
#include <catoptric/report.hpp>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace catoptric::python {

namespace {

/// Returns PSNR as a number, so that a column of a table has one type.
double psnr_as_number(const measure::Difference& error) {
    if (error.psnr) return *error.psnr;
    return error.rmse == 0 ? std::numeric_limits<double>::infinity()
                           : std::numeric_limits<double>::quiet_NaN();
}

void add_errors(nb::dict& line, const measure::Errors& errors) {
    const measure::Difference& error = errors.error;
    line["flip"] = error.flip;
    line["rmse"] = error.rmse;
    line["mae"] = error.mae;
    line["psnr"] = psnr_as_number(error);
    line["p99"] = error.p99;
    line["max"] = error.max;
    line["off"] = error.off;
    line["nonfinite"] = error.nonfinite;
    line["flip_all"] = errors.error_all.flip;
    line["rmse_all"] = errors.error_all.rmse;
}

nb::list list_rows(const measure::Comparison& comparison) {
    nb::list lines;
    for (std::size_t k = 0; k < comparison.rows.size(); ++k) {
        const measure::Row& row = comparison.rows[k];
        nb::dict line;
        line["technique"] = row.technique;
        line["label"] = row.label;
        line["gpu_ms"] = row.gpu_ms.median;
        line["gpu_ms_low"] = row.gpu_ms.ci95.low;
        line["gpu_ms_high"] = row.gpu_ms.ci95.high;
        line["frame_ms"] = row.frame_ms.median;
        line["cpu_ms"] = row.cpu_ms.n > 0 ? row.cpu_ms.median : NAN;
        line["judged_time"] = row.time_metric();
        line["noisy"] = row.noisy;
        add_errors(line, row);
        line["front"] = std::ranges::find(comparison.pareto, k) != comparison.pareto.end();
        line["scene_passes"] = row.scene_passes;
        line["scene_draws"] = row.scene_draws;
        line["memory_bytes"] = row.memory_bytes;
        line["model"] = row.model;
        lines.append(line);
    }
    return lines;
}

scene::Camera make_camera(const measure::CameraFacts& facts) {
    return {.name = facts.name,
            .eye = facts.eye,
            .target = facts.target,
            .up = facts.up,
            .vertical_fov_degrees = facts.vertical_fov_degrees,
            .orthographic_height = facts.orthographic_height};
}

nb::list list_views(const measure::Comparison& comparison) {
    nb::list lines;
    for (const measure::Row& row : comparison.rows)
        for (std::size_t k = 0; k < row.views.size(); ++k) {
            const measure::View& view = comparison.views[k];
            nb::dict line;
            line["view"] = k + 1;
            line["technique"] = row.technique;
            line["label"] = row.label;
            add_errors(line, row.views[k]);
            line["seed"] = view.seed;
            line["time"] = view.time;
            line["camera"] = make_camera(view.camera);
            lines.append(line);
        }
    return lines;
}

std::optional<std::string> find_stop(const measure::Comparison& comparison) {
    if (!comparison.stopped) return std::nullopt;
    return comparison.stopped->what();
}

session::Request make_request(const scene::Scene& scene, const std::vector<std::string>& techniques,
                              const std::pair<std::int64_t, std::int64_t>& size,
                              const std::optional<scene::Camera>& camera, double time,
                              std::optional<double> exposure, std::optional<double> ambient,
                              std::uint64_t seed, const std::string& model, int frames,
                              int warmup) {
    const SceneDefaults defaults = choose_defaults(scene, camera, ambient, exposure);
    session::Request request;
    request.scene = scene;
    request.techniques = techniques;
    request.camera = defaults.camera;
    request.size = parse_size(size);
    request.time = time;
    request.exposure = defaults.exposure;
    request.auto_exposure = defaults.auto_exposure;
    request.ambient = defaults.ambient;
    request.seed = seed;
    request.model = parse_model(model);
    request.frames = frames;
    request.warmup = warmup;
    return request;
}

/// Runs a study on the engine. Ctrl+C ends it by KeyboardInterrupt.
template <typename Request, typename Study>
auto run_study(SharedEngine& shared, Request& request, const Study& study) {
    SignalWatch watch;
    request.watcher = watch.watcher();
    try {
        auto result = run_on_engine(shared, study);
        watch.rethrow();
        return result;
    } catch (const Error&) {
        watch.rethrow();
        throw;
    }
}

std::unique_ptr<measure::Comparison>
compare(SharedEngine& shared, const scene::Scene& scene, const std::vector<std::string>& techniques,
        const std::pair<std::int64_t, std::int64_t>& size,
        const std::optional<scene::Camera>& camera, double time, std::optional<double> exposure,
        std::optional<double> ambient, std::uint64_t seed, const std::string& model, int frames,
        int warmup, const std::string& reference, double reference_seconds, int views) {
    study::CompareRequest request;
    request.base = make_request(scene, techniques, size, camera, time, exposure, ambient, seed,
                                model, frames, warmup);
    request.reference = reference;
    request.reference_seconds = reference_seconds;
    if (views > 0) request.studies.push_back({"views", views});
    return run_study(shared, request, [&](session::Engine& engine) {
        return std::make_unique<measure::Comparison>(study::compare(engine, request));
    });
}

/// Returns the plan ("" if none keeps the limits), why there is none, and plan.json.
std::tuple<std::string, std::string, std::string>
choose(SharedEngine& shared, const scene::Scene& scene, const std::vector<std::string>& techniques,
       const std::pair<std::int64_t, std::int64_t>& size,
       const std::optional<scene::Camera>& camera, double time, std::optional<double> exposure,
       std::optional<double> ambient, std::uint64_t seed, const std::string& model, int frames,
       int warmup, const std::string& reference, double reference_seconds,
       std::optional<double> max_flip, std::optional<double> max_rmse, std::optional<double> max_ms,
       double share, double confidence, int training_views, int cameras_per_instant,
       int proof_views, std::uint64_t proof_seed, const std::string& costs) {
    study::ChooseRequest request;
    request.base = make_request(scene, techniques, size, camera, time, exposure, ambient, seed,
                                model, frames, warmup);
    request.reference = reference;
    request.reference_seconds = reference_seconds;
    if (max_rmse) request.quantity = study::ErrorQuantity::rmse;
    request.max_error = max_rmse ? max_rmse : max_flip;
    request.max_ms = max_ms;
    request.share = share;
    request.confidence = confidence;
    request.training_views = training_views;
    request.cameras_per_instant = cameras_per_instant;
    request.proof_views = proof_views;
    request.proof_seed = proof_seed;
    request.costs = costs;
    const study::ChosenPlan chosen = run_study(
        shared, request, [&](session::Engine& engine) { return study::choose(engine, request); });
    return {chosen.plan, chosen.failure, chosen.json};
}

} // namespace

void bind_comparisons(nb::module_& module) {
    using Comparison = measure::Comparison;
    nb::class_<Comparison>(module, "Comparison", "The results of a comparison.")
        .def("rows", &list_rows, "Returns a dictionary for each row.")
        .def("views", &list_views, "Returns a dictionary for each row and drawn view.")
        .def_prop_ro("warnings", [](const Comparison& c) { return c.warnings; })
        .def_prop_ro("stopped", &find_stop,
                     "The failure that ended the comparison early, else None.")
        .def_prop_ro(
            "exposure", [](const Comparison& c) { return c.exposure; }, "Stops.")
        .def_prop_ro("reference", [](const Comparison& c) { return c.reference_label; })
        .def("to_json", &report::to_json, "Returns report.json.")
        .def("write", &report::write, nb::arg("folder"),
             "Writes report.html, report.json, rows.csv and the pictures into a folder.",
             nb::call_guard<nb::gil_scoped_release>());
    module.def("compare", &compare, nb::arg("engine"), nb::arg("scene"), nb::arg("techniques"),
               nb::arg("size"), nb::arg("camera").none(), nb::arg("time"),
               nb::arg("exposure").none(), nb::arg("ambient").none(), nb::arg("seed"),
               nb::arg("model"), nb::arg("frames"), nb::arg("warmup"), nb::arg("reference"),
               nb::arg("reference_seconds"), nb::arg("views"),
               "Compares techniques. Use catoptric.compare() or catoptric.views() instead.");
    module.def("choose", &choose, nb::arg("engine"), nb::arg("scene"), nb::arg("techniques"),
               nb::arg("size"), nb::arg("camera").none(), nb::arg("time"),
               nb::arg("exposure").none(), nb::arg("ambient").none(), nb::arg("seed"),
               nb::arg("model"), nb::arg("frames"), nb::arg("warmup"), nb::arg("reference"),
               nb::arg("reference_seconds"), nb::arg("max_flip").none(), nb::arg("max_rmse").none(),
               nb::arg("max_ms").none(), nb::arg("share"), nb::arg("confidence"),
               nb::arg("training_views"), nb::arg("cameras_per_instant"), nb::arg("proof_views"),
               nb::arg("proof_seed"), nb::arg("costs"),
               "Chooses a plan. Use catoptric.choose() instead.");
    module.def("create_folder", &report::create_folder, nb::arg("folder"),
               "Makes a folder with its parents. Existing folders are accepted.");
}

} // namespace catoptric::python
