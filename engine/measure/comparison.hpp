#pragma once

#include "../core/frame_facts.hpp"
#include "../error.hpp"
#include "picture.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Results of `compare` as plain data: measured by study/, judged here, written by report/.
namespace catoptric::measure {

using catoptric::AutoFace;
using catoptric::CulledWork;
struct DeviceCosts;
struct Causes; // internal: report.json has their data
struct LagResults;
struct LightEdgeErrors;
struct LookupSummary;
struct PathDistance;
struct ReferenceNoise;
struct SceneContents;
struct SetupFacts;
struct Studied;
struct WorstView;

/// Closed interval from `low` to `high`. Both are NaN if the interval is not known.
struct Interval {
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();

    bool is_known() const { return !std::isnan(low) && !std::isnan(high); }
};

/// Median and spread of a list of measurements, in the unit of the measurements.
struct SampleSummary {
    double median = 0; ///< median of the rounds' medians if there are rounds
    double p05 = 0;    ///< 5th percentile
    double p95 = 0;    ///< 95th percentile
    double mad = 0;    ///< median of the absolute deviations from the median, not scaled
    std::size_t n = 0;
    std::vector<double> samples; ///< the measurements as given, in order
    std::vector<double> rounds;  ///< median of each round; empty if measured without rounds
    Interval ci95;               ///< interval of the median, from the rounds
};

struct DeviceFacts {
    std::string name, driver, api, type;
    int threads = 0;     ///< number of threads of a cpu device
    std::string profile; ///< file name of the device's profile; empty if no profile applies
    std::vector<std::pair<std::string, std::string>> variants; ///< of shaders: name and choice
    std::string calibration = {}, balance = {}; ///< file name and text; empty if uncalibrated
    int held_threads = 0; ///< threads that were each held on one processor during measurements
    int lanes = 0;        ///< number of 32-bit shader lanes that run together; 0 if not counted
};

/// Camera of a picture, in world units.
struct CameraFacts {
    std::string name; ///< empty if the camera has no name
    dvec3 eye{0}, target{0}, up{0};
    double vertical_fov_degrees = 0;
    double orthographic_height = 0; ///< height of the picture, world units; 0: perspective
};

struct SceneFacts {
    std::string name;
    std::size_t triangles = 0;
    std::size_t mirrors = 0;
    std::string hash;
    bool is_seed = false; ///< whether measured times can be compared with the seed report's
    CameraFacts camera;
    std::shared_ptr<const SceneContents> contents = {}; ///< lights, environment, gaps
};

struct PassFacts {
    std::string name;
    SampleSummary gpu_ms;
};

/// Errors of a picture against the reference, each over another set of pixels.
struct Errors {
    Difference error; ///< over pixels whose first hit is a mirror
    /// Error over the pixels that show a mirror and whose reflected ray meets no second mirror.
    Difference error_first_order;
    /// Error over the pixels that show a mirror and whose reflected ray meets a second mirror.
    Difference error_mirror_in_mirror;
    Difference error_non_mirror; ///< over pixels whose first hit is no mirror
    Difference error_all;
    Difference error_dielectrics; ///< over pixels whose first hit is a smooth dielectric
    Difference error_rough;       ///< over pixels that show a rough surface which is no mirror
    std::vector<Difference> error_per_mirror; ///< one entry a mirror, by MirrorId::index
};

/// Camera and time of a picture.
struct View {
    CameraFacts camera;
    double time = 0;        ///< seconds into the scene's motion
    std::uint64_t seed = 0; ///< seed from which the camera was drawn
};

/// Results of one technique with its settings, or of one plan: cost and error.
struct Row : Errors {
    /// "naive", for example; "plan" if several techniques draw the mirrors.
    std::string technique;
    const TechniqueTraits* traits = nullptr; ///< internal; null: several techniques
    std::string label;                       ///< text of the request, such as "naive:bounces=1"
    std::vector<Setting> settings;           ///< values of all knobs
    std::vector<PlanEntry> plan;             ///< technique of each mirror
    std::string model = "everything";        ///< or "required"
    std::vector<CulledWork> left_out;
    /// Scene passes in the executed plan. A cube counts once, as in the seed report.
    int scene_passes = 0;
    int scene_draws = 0; ///< the same, but each face of a cube counts
    SampleSummary gpu_ms, cpu_record_ms, wall_ms;
    SampleSummary cpu_ms; ///< processor time of the process per frame; cpu devices only
    /// Share of time in which the row's threads waited for a processor that other programs used,
    /// 0..1. NaN if unknown.
    double waited = NAN;
    bool noisy = false;    ///< whether the threads waited too long for the times to be trusted
    SampleSummary wait_ms; ///< time that the host waited for the device; no other time includes it
    SampleSummary host_ms; ///< host work before the device can begin, without waiting
    /// host_ms plus device time, frame by frame, because the two do not overlap.
    SampleSummary frame_ms;
    HostTimes host_parts; ///< each a median over frames
    bool moves = false;   ///< whether the scene moved, so that the host had work in each frame
    /// Whether the row is judged by cpu_ms: on a processor, unless several rows share a frame.
    bool on_processor = false;
    /// Returns frame_ms if the scene moves, because the host works in each frame, else gpu_ms.
    const SampleSummary& elapsed_ms() const { return moves ? frame_ms : gpu_ms; }
    const SampleSummary& time_ms() const { return on_processor ? cpu_ms : elapsed_ms(); }
    /// Returns the name of time_ms(), the time by which the row is judged.
    const char* time_metric() const {
        return on_processor ? "cpu_ms" : moves ? "frame_ms" : "gpu_ms";
    }
    std::vector<PassFacts> passes; ///< passes in order of execution
    /// Sum of a frame's pass times divided by wall_ms, frame by frame; near 1 if they are right.
    SampleSummary closure;
    std::uint64_t memory_bytes = 0; ///< memory of the frame's images
    std::optional<RayCounts> rays;  ///< rays of one frame; empty if the row traces none
    std::optional<std::size_t> saturated_texels; ///< of half-float captures, clipped at 65504
    /// Of directions, over first-order pixels. Null unless the row looks into captures.
    std::shared_ptr<LookupSummary> lookup;
    std::shared_ptr<LightEdgeErrors> light_edges; ///< null unless the row looks into captures
    std::shared_ptr<Causes> causes;               ///< see CompareRequest::studies; may be null
    std::optional<double> traced_fraction;
    std::optional<AutoFace> auto_face;
    /// Errors in each of Comparison::views, in the same order. Empty if no views were drawn. A run
    /// that was cut short has fewer entries.
    std::vector<Errors> views;
    std::shared_ptr<WorstView> worst; ///< see measure/views.hpp; null if no view was judged
    std::shared_ptr<Studied> studied; ///< other results of studies; may be null
    Mean mean, mean_clamped;
    int pictured = 0; ///< frame, from 1, whose picture and errors are given; later ones are equal
    Picture hdr;      ///< the row's picture, linear RGB
    Picture display;  ///< the same picture as displayed
    std::vector<float> flip_map; ///< FLIP of each pixel against the reference, row-major
    std::string image; ///< file name of the pictures without folder and ending: "naive-bounces1"
    bool is_reference = false;  ///< whether technique and settings are those of the reference
    bool mirrors_black = false; ///< see measure::is_rankable
};

struct Comparison {
    std::string version, commit;
    std::string date; ///< start of the run in UTC, ISO 8601: "2026-11-24T03:05:10Z"
    std::vector<std::string> command;
    /// False if the run goes on or was stopped: `rows` are the rows so far.
    bool complete = true;
    std::size_t asked = 0;        ///< number of rows that were asked for
    std::optional<Error> stopped; ///< the error that ended the run early
    DeviceFacts device;
    SceneFacts scene;
    std::shared_ptr<SetupFacts> setup; ///< set-up work until now; null before the first row
    int width = 0, height = 0;
    int frames = 0, warmup = 0;
    int rounds = 0;                          ///< number of rounds in which the frames were measured
    double load_start = NAN, load_end = NAN; ///< runnable threads of the machine; NaN: unknown
    double time = 0, ambient = 0.05, exposure = 0;
    std::string timing = "isolated";
    std::string model = "everything"; ///< "everything", "required", or "both" for each row
    bool together = false;            ///< whether one frame and one command buffer held all rows
    std::string reference_technique, reference_label;
    std::vector<Setting> reference_settings;
    SampleSummary reference_gpu_ms;
    Picture reference_hdr, reference_display;
    /// First mirror of each pixel in the low 16 bits, 0 for none (measure/masks.hpp).
    std::vector<std::uint32_t> mirror_hits;
    double reference_area_flip = NAN;      ///< FLIP of 1 sample a pixel from many, over mirrors
    std::shared_ptr<ReferenceNoise> noise; ///< see measure/halves.hpp; null: no noise
    std::shared_ptr<PathDistance> path_distance; ///< of the reference; null: not asked for
    /// Time to clear the cubes of all mirrors once without drawing, at the default face size, ms.
    std::optional<SampleSummary> clear_ms;
    /// Drawn views in which errors were measured, in addition to the comparison's own camera.
    std::vector<View> views;
    std::vector<Row> rows;
    /// Indices of the rows on the front of time against FLIP over the mirrors, from
    /// measure::find_pareto_front.
    std::vector<std::size_t> pareto;
    double max_ms = NAN, max_flip = NAN, max_rmse = NAN; ///< budgets (budget.hpp); NaN: none
    std::shared_ptr<LagResults> lag;  ///< see CompareRequest::studies; may be null
    std::vector<std::string> studies; ///< names of the studies that were asked for
    std::shared_ptr<std::vector<DeviceCosts>> own_costs; ///< devices of the map, first; may be null
    std::vector<std::string> warnings;
    /// Folder of the pictures below images/, such as "1-room/"; empty for images/ itself.
    std::string images;
};

} // namespace catoptric::measure
