#pragma once

#include "../core/error.hpp"
#include "../core/plan_entry.hpp"
#include "causes.hpp"
#include "difference.hpp"
#include "lag.hpp"
#include "light_edges.hpp"
#include "lookup.hpp"
#include "picture.hpp"
#include "statistics.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What `compare` found, as plain data: filled by the application, judged here, written by report/.
namespace catoptric::measure {

struct DeviceFacts {
    std::string name, driver, api, type;
    int threads = 0;     ///< of a cpu device
    std::string profile; ///< file name of its profile; empty: none holds
    std::vector<std::pair<std::string, std::string>> variants; ///< of its shaders, by name
    int held_threads =
        0;         ///< of a cpu device's, how many stayed on a processor while rows were measured
    int lanes = 0; ///< 32-bit lanes of a shader that run together; 0: not counted
};

/// Where the picture was taken from, world units.
struct CameraFacts {
    std::string name; ///< empty: none
    dvec3 eye{0}, target{0}, up{0};
    double vertical_fov_degrees = 0;
    double orthographic_height = 0; ///< of the picture, world units; 0: in perspective
};

/// What the scene says that is not shown so, or what was added to it.
struct UnsupportedFeatureFacts {
    std::string id;
    std::uint64_t count = 0;
    std::string first;                 ///< where
    std::optional<double> pixel_share; ///< of the picture, 0..1; none: pixels cannot tell it
};

/// A light as the shading formula sees it.
struct LightFacts {
    std::string kind; ///< "mesh", "point", "spot" or "directional"
    std::string name; ///< of a light without a surface
    dvec3 position{0};
    dvec3 direction{
        0}; ///< where a spot or a directional light shines to, a mesh faces; 0: all round
    dvec3 emission{0}; ///< radiance of a mesh; candela, or lux of a directional light
    double area = 0;   ///< of a mesh
};

struct EnvironmentFacts {
    std::string name;
    double scale = 1, rotation_degrees = 0;
};

struct SceneFacts {
    std::string name;
    std::size_t triangles = 0;
    std::size_t mirrors = 0;
    std::string hash;
    bool is_seed = false; ///< the scene of the seed report, beside whose figures its own may stand
    CameraFacts camera;
    std::vector<LightFacts> lights = {};
    std::optional<EnvironmentFacts> environment = {};
    std::vector<UnsupportedFeatureFacts> unsupported = {};
};

/// What the rows needed once, milliseconds of the host each; no row's times hold it.
struct SetupFacts {
    std::optional<double> load_ms; ///< the scene read or made, where the caller told
    double upload_ms = 0;          ///< laid out for the device and written to it
    double hierarchy_ms = 0;       ///< trees for tracing, built; 0: no row traced
    double compile_ms = 0; ///< pipelines, up to what a driver leaves for the first frame with one
    std::size_t pipelines = 0;
    std::string pipeline_cache = "none"; ///< on disk: "none", "made" (empty before) or "used"
};

struct PassFacts {
    std::string name;
    Summary gpu_ms;
};

struct Rays {
    std::uint64_t primary = 0, mirror = 0, shadow = 0;
};

/// What face=auto stood for.
struct AutoFace {
    std::uint32_t edge = 0;    ///< of every mirror's cube, texels
    std::vector<double> needs; ///< entry n-1: what mirror n alone needs; 0: not in view
};

/// Medians over frames, milliseconds each.
struct HostParts {
    double update = 0;    ///< what moved: buffers written, views and lights found
    double hierarchy = 0; ///< trees for tracing, built or refitted
    double compile = 0;   ///< passes declared, and planned where their shape is new
    double record = 0;    ///< filling the command buffer
};

/// How far a picture is from the truth, over one set of pixels after the other.
struct Errors {
    Difference error;                  ///< over the pixels whose first hit is a mirror
    Difference error_first_order;      ///< ... whose reflected ray meets no second mirror
    Difference error_mirror_in_mirror; ///< ... whose reflected ray does
    Difference error_non_mirror;       ///< everything else
    Difference error_all;
    Difference error_dielectrics; ///< over the pixels whose first hit reflects, but is no mirror
    std::vector<Difference> error_per_mirror; ///< by MirrorId::index
};

/// From where and when a picture shows a scene.
struct View {
    CameraFacts camera;
    double time = 0;        ///< seconds into the scene's motion
    std::uint64_t seed = 0; ///< that the camera was drawn from
};

/// The view at which a row is furthest from the reference.
struct WorstView {
    std::size_t view = 0; ///< among Comparison::views
    Picture display;      ///< the row's picture there, to its right the reference's
};

/// What a row did not render, since its picture does not need it.
struct CulledWork {
    std::string what, why, saves;
    double error = 0; ///< the most that a displayed pixel can differ for it, of 1
};

/// One technique with its settings: what it cost and what it got wrong.
struct Row : Errors {
    std::string technique;            ///< "naive"; "plan" where several draw the mirrors
    std::string label;                ///< as it was asked for: "naive:bounces=1"
    std::vector<Setting> settings;    ///< all knobs
    std::vector<PlanEntry> plan;      ///< of each mirror
    std::string model = "everything"; ///< or "required"
    std::vector<CulledWork> left_out;
    int scene_passes =
        0; ///< counted in the executed plan; a cube counts once, as in the seed report
    int scene_draws = 0; ///< the same with every cube face counted
    Summary gpu_ms, cpu_record_ms, wall_ms;
    Summary cpu_ms; ///< processor time of the process a frame; of cpu devices
    /// Share of the time in which its threads waited for a processor that others had; NaN: not
    /// told.
    double waited = NAN;
    bool noisy = false; ///< its threads waited for a processor: its times are not to be trusted
    Summary wait_ms;    ///< the host stood still for the device: part of nothing else
    Summary host_ms;    ///< the processor's work before the device could begin; waiting is none
    Summary frame_ms;   ///< host_ms and the device's time, frame by frame: they do not overlap
    HostParts host_parts;
    bool moves = false; ///< the scene moved, so that every frame had work for the host
    /// What the row is ranked by: a moving scene's rows pay for it on the host too.
    const Summary& time_ms() const { return moves ? frame_ms : gpu_ms; }
    std::vector<PassFacts> passes; ///< in order of execution
    /// Sum of all the frame's passes over wall_ms, frame by frame: near 1 where stamps tell the
    /// truth.
    Summary closure;
    std::uint64_t memory_bytes = 0;              ///< of the frame's images
    std::optional<Rays> rays;                    ///< of ray tracing, one frame
    std::optional<std::size_t> saturated_texels; ///< of captures that hold halves: cut off at 65504
    std::optional<LookupError> lookup;           ///< first-order pixels: where mirrors looked
    std::optional<LightEdges> light_edges;       ///< of rows that look into captures
    std::optional<Causes> causes;                ///< of rows that look into captures
    std::optional<double> traced_fraction;
    std::optional<AutoFace> auto_face;
    /// Of Comparison::views, in their order; empty: none were drawn; fewer: of a run cut short.
    std::vector<Errors> views;
    std::optional<WorstView> worst; ///< of these, by FLIP over the mirrors
    Mean mean, mean_clamped;
    int pictured = 0; ///< frame, from 1, that pictures and errors are of; later ones show the same
    Picture hdr;      ///< linear
    Picture display;  ///< the same as shown
    std::vector<float> flip_map; ///< against the reference, row-major
    std::string image;           ///< file name without folder and ending: "naive-bounces1"
    bool is_reference = false;   ///< same technique and settings as the reference
    bool mirrors_black = false;  ///< it draws nothing in them: see measure::is_candidate
};

struct Comparison {
    std::string version, commit;
    std::string date; ///< when the run began: UTC, ISO 8601, "2026-11-24T03:05:10Z"
    std::vector<std::string> command;
    bool complete = true;         ///< false: the rows so far, of a run that goes on or was stopped
    std::size_t asked = 0;        ///< rows that it is to have
    std::optional<Error> stopped; ///< what ended it early
    DeviceFacts device;
    SceneFacts scene;
    SetupFacts setup; ///< so far
    int width = 0, height = 0;
    int frames = 0, warmup = 0;
    int rounds = 0;                          ///< that the frames were measured in
    double load_start = NAN, load_end = NAN; ///< of the machine, runnable threads; NaN: not known
    double time = 0, ambient = 0.05, exposure = 0;
    std::string timing = "isolated";
    std::string model = "everything"; ///< or "required", or "both" of each row
    bool together = false;            ///< all rows were one frame, one command buffer
    std::string reference_technique;
    std::string reference_label;
    std::vector<Setting> reference_settings;
    Summary reference_gpu_ms;
    Picture reference_display;
    /// Clearing the cubes of all mirrors once and drawing nothing, at the default face size.
    std::optional<Summary> clear_ms;
    std::vector<View> views; ///< drawn, over which errors are known beside the one of the pictures
    std::vector<Row> rows;
    /// Rows on the front of gpu_ms.median against error.flip: measure::front_of.
    std::vector<std::size_t> pareto;
    std::optional<Lag> lag; ///< of the rows that remember, when it was asked for
    std::vector<std::string> warnings;
    std::string images; ///< folder of its pictures below images/, "1-room/"; empty: that itself
};

} // namespace catoptric::measure
