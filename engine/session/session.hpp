#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"
#include "../core/plan_entry.hpp"
#include "../measure/picture.hpp"
#include "../require/model.hpp"
#include "../scene/edit.hpp"
#include "../scene/scene.hpp"
#include "capture_budget.hpp"
#include "engine.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::render {
struct Captured;
} // namespace catoptric::render
namespace catoptric::graph {
struct ExternalSync;
} // namespace catoptric::graph

namespace catoptric::app {

class Screen;      // session/screen.hpp
struct Showing;    // session/screen.hpp
struct FrameGraph; // internal

/// How passes are timed. isolated: passes do not overlap, and their times add up. pipelined: passes
/// may overlap, and only the time of the whole frame is valid.
enum class Timing { isolated, pipelined };

/// The work that a frame renders. everything: the capture of each mirror, six faces, every frame.
/// required: only what the picture needs (require/model.hpp). Both give the same picture unless
/// documented otherwise.
enum class Modelling { everything, required };
/// Returns "everything" or "required".
CATOPTRIC_API std::string name_of(Modelling modelling);

/// What one frame shows and how it is rendered.
struct FrameSpec {
    /// Techniques or plans. Each text is "name[:knob=value,...]", a plan
    /// "PATTERN=name[:knob=value,...] ..." (reflect/plan.hpp), or "plan:FILE" with a plan in the
    /// file (session/plan_file.hpp). Several techniques are rendered in one frame: one command
    /// buffer, one submit, one timeline. Their pictures equal those of separate frames.
    std::vector<std::string> techniques;
    scene::Camera camera;
    uvec2 size{512, 512};
    double time = 0; ///< seconds into the scene's motion
    double ambient = 0.05;
    double exposure = 0;    ///< stops
    std::uint64_t seed = 1; ///< seed of sample patterns that are not a regular grid
    Timing timing = Timing::isolated;
    Modelling model = Modelling::everything;
    /// Largest number of mirrors whose captures a frame draws again, per technique; 0: all. Needs
    /// Modelling::required. The other captures keep their contents. Each of them is drawn in one of
    /// the next ceil(captured mirrors / most_captures) frames. Mirrors that come into view are
    /// drawn in addition. A frame with `keeps_history` draws all captures. Each frame waits for the
    /// one before.
    std::uint32_t most_captures = 0;
    /// Limit like `most_captures`, in milliseconds of device time for captures; 0: no limit. The
    /// first frame draws all captures. Later frames draw as many as fit by the session's
    /// measurements, at least one. Therefore pictures depend on the speed of the device.
    double budget_ms = 0;
    /// Causes of error to remove from mirrors: a sum of shared::kAblate... (shaders/shared.h).
    std::uint32_t ablated = 0;
    bool with_lookup = false;   ///< also record where mirrors looked (Part::lookup); costs time
    bool with_captures = false; ///< make captures readable (Frame::captures)
    /// A frame that keeps the history unchanged: the next frame has the history that this one had.
    bool keeps_history = false;
};

struct PassTime {
    std::string name;
    double begin_ms = 0, end_ms = 0; ///< from the frame's first timestamp
    double ms() const { return end_ms - begin_ms; }
};

/// Host work for a frame before the device can begin, in milliseconds.
struct HostTimes {
    double update = 0;    ///< scene updates: buffers written, views and lights computed
    double hierarchy = 0; ///< BVHs built or refitted
    double compile = 0;   ///< passes declared, and planned if the graph's shape is new
    double record = 0;    ///< filling the command buffer
    double sum() const { return update + hierarchy + compile + record; }
};

/// Times of one frame. On a device of type "cpu", GPU times are times of the driver's threads.
struct FrameTimes {
    /// Passes in order of execution. In a run of many frames only the last kDetailedFrames have
    /// them.
    std::vector<PassTime> passes;
    double passes_ms = 0; ///< sum over all passes
    double gpu_ms = 0;    ///< first to last timestamp
    double record_ms = 0; ///< filling the command buffer
    /// Time in milliseconds from submit until the device has finished the frame, without recording
    /// and read-back.
    double wall_ms = 0;
    /// Time that the host waited for the device: for a place among the frames in flight, and for
    /// the end of this frame. Waiting is no work and is part of no other figure.
    double wait_ms = 0;
    /// Processor time of all threads of the process while the frame was made and waited for. 0 if
    /// it was not measured (Frames measures it).
    double cpu_ms = 0;
    HostTimes host;
    /// Returns the time of host and device work, which do not overlap. Waiting is not included.
    double frame_ms() const { return host.sum() + gpu_ms; }
};

struct RayCounts {
    std::uint64_t primary = 0, mirror = 0, shadow = 0; ///< rays in one frame
    std::uint32_t longest_walk = 0;                    ///< BVH steps of the busiest invocation
};

/// The cube edge that the engine chose for the knob value face=auto.
struct AutoFace {
    std::uint32_t edge = 0; ///< edge of every mirror's capture, texels
    /// Texels along an edge that mirror n needs, entry n-1; 0: mirror n is not in view.
    std::vector<double> needs;
};

/// Results of one technique or plan in a frame.
struct Part {
    std::string label; ///< technique or plan as it was asked for
    /// Prefix of the names of this part's passes; empty if the frame has only one part.
    std::string prefix;
    std::vector<PlanEntry> plan;    ///< technique of each mirror
    std::vector<std::string> notes; ///< deviations from what was asked for, a sentence each
    Modelling model = Modelling::everything;
    std::vector<require::CulledWork> left_out; ///< work that the model left out
    std::optional<CaptureBudget> slices;       ///< only if captures are kept under a limit
    int scene_passes = 0;
    int scene_draws = 0;            ///< scene passes times their layers
    bool remembers = false;         ///< the picture depends on the frame before
    std::uint64_t memory_bytes = 0; ///< size of the whole frame's images
    measure::Picture hdr;           ///< linear radiance
    measure::Picture display;       ///< displayed picture, in multiples of 1/255
    /// Number of captured texels that are brighter than 65504, the largest half, and cut off there.
    /// Only with `with_lookup`, for techniques whose captures hold halves.
    std::optional<std::size_t> saturated;
    /// Direction in which each mirror pixel looked into a capture (shaders/lib/mirror.glsl). Only
    /// with `with_lookup`, for techniques that search.
    std::vector<vec4> lookup;
    std::vector<std::uint32_t> hits; ///< ray tracing only: first mirror | second mirror << 16
    std::optional<RayCounts> rays;   ///< ray tracing only
    /// Share of mirror pixels that were ray traced, if a search leaves some to ray tracing.
    std::optional<double> traced_fraction;
    std::optional<AutoFace> auto_face; ///< only if the part chooses the cube edge (face=auto)
};

/// A frame that a session has submitted. Its results can be read until another frame takes its
/// place: the session's next frame, or a later one if several are in flight. Captures, look-ups and
/// state can always be read until the next frame. Reading later throws `internal`. Functions that
/// wait throw `device_lost` and `exhausted`.
class Frame {
public:
    /// Returns the frame's times. The first call waits for the device; the times stay with this
    /// object.
    CATOPTRIC_API const FrameTimes& times() const;
    /// Returns the number of techniques.
    CATOPTRIC_API std::size_t size() const;
    /// Returns whether a technique's picture depends on the frame before.
    CATOPTRIC_API bool remembers(std::size_t part = 0) const;
    /// Returns what was rendered, and what was left out.
    CATOPTRIC_API const require::Model& model() const;
    /// Returns the outcome of the capture limit, if the technique keeps captures and FrameSpec sets
    /// a limit.
    CATOPTRIC_API const std::optional<CaptureBudget>& slices(std::size_t part = 0) const;
    /// Returns how many mirrors, over all techniques, have captures that still wait to be drawn
    /// again. If some captures wait, the picture can differ from the picture without a limit.
    CATOPTRIC_API std::uint32_t waiting() const;
    /// Returns linear radiance, the cheapest result to read.
    CATOPTRIC_API measure::Picture hdr(std::size_t part = 0) const;
    /// Returns all results of one technique.
    CATOPTRIC_API Part read(std::size_t part = 0) const;
    CATOPTRIC_API std::vector<Part> read_all() const;
    /// Returns colours and distances around every mirror, of a technique that captures both. Throws
    /// `internal` without `with_captures`. Not for programs outside the library.
    render::Captured captures(std::size_t part = 0) const;
    /// Returns the linear pictures and all data that the next frame can read of this one, as bytes.
    /// If two successive frames of a still scene have equal states, the picture changes no more.
    /// Empty if nothing is remembered.
    CATOPTRIC_API std::vector<std::byte> state() const;

private:
    friend class Session;
    struct Impl;
    explicit Frame(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<Impl> impl_;
};

/// Output format of a frame's compiled plan.
enum class PlanFormat { text, dot, json };

/// Counters of a session's work so far.
struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t updates = 0; ///< writes of scene data to the device
    std::uint64_t plans = 0;   ///< differently shaped frames that were planned
    // `uploads` and the two counters of hierarchies count from the last time that the whole scene
    // was written to the device. A change of the scene units writes the whole scene again.
    std::uint64_t uploads = 0; ///< buffer writes
    std::uint64_t hierarchies_built = 0, hierarchies_refitted = 0;
    std::uint64_t memory_bytes = 0; ///< device memory for images and buffers of frames
};

/// A suspended sequence of frames: the history that they left for the next frame. Only the session
/// that suspended the sequence can resume it. The engine must outlive it.
class Sequence {
public:
    CATOPTRIC_API Sequence(Sequence&&) noexcept;
    CATOPTRIC_API Sequence& operator=(Sequence&&) noexcept;
    CATOPTRIC_API ~Sequence();

private:
    friend class Session;
    struct Impl;
    explicit Sequence(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Host time for work that a scene needs once, in milliseconds.
struct Setup {
    double upload_ms = 0;    ///< laying the scene out and writing it to the device
    double hierarchy_ms = 0; ///< building BVHs; 0: no pass has traced rays
};

/// A scene on a device. Uploaded data, compiled pipelines and history stay from frame to frame.
/// Only one thread may use a session at a time. A device error ends the session and its engine. The
/// engine must outlive the session and its frames.
class Session {
public:
    /// `scene`: at rest. `in_flight`: number of frames, 1 to 3, that may be under way before the
    /// oldest is waited for. Throws `exhausted` if the scene exceeds the device's limits.
    CATOPTRIC_API Session(Engine& engine, scene::Scene scene, std::uint32_t in_flight = 1);
    CATOPTRIC_API ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    CATOPTRIC_API const scene::Scene& scene() const;
    /// Submits a frame. Waits if all places in flight are taken. Writing scene data also waits for
    /// the frames that read the same copy of the data. A frame with other techniques or another
    /// model than the frame before begins without history. Throws `usage` for an invalid
    /// specification.
    CATOPTRIC_API Frame frame(const FrameSpec& spec);
    /// Submits a frame and shows it in a window. The screen must belong to the session's engine,
    /// and Screen::fit must have returned true. If the window has no image for the
    /// frame, the frame is still rendered. Not for programs outside the library, which have their
    /// own window (embed/embed.hpp).
    Frame show(const FrameSpec& spec, Screen& screen, const Showing& showing);
    /// Edits the scene; the next frame shows the edit. History stays unless the edit changes the
    /// scene's units on the device (render::space_of). The units change if the scene becomes much
    /// larger or smaller, or if objects that determine its origin move (an outermost object, small
    /// mirrors). Throws `usage` for an object or material that does not exist.
    CATOPTRIC_API void change(const scene::Edit& edit);
    /// Makes a cut: the next frame begins without history.
    CATOPTRIC_API void forget();
    /// Makes a cut and returns the history of the frame sequence, which `resume` can continue.
    /// Waits for frames in flight.
    CATOPTRIC_API Sequence suspend();
    /// Continues a suspended sequence: the next frame follows its last one. Discards the present
    /// history. If the scene's units changed in between (see change), the next frame begins without
    /// history.
    CATOPTRIC_API void resume(Sequence sequence);
    /// Returns the plan, written out, of a frame that follows another frame. With
    /// Modelling::required, the scene is still and its captures no longer change.
    CATOPTRIC_API std::string plan(const FrameSpec& spec, PlanFormat format);
    /// Renders a frame that clears the cubes of every mirror, 256 texels an edge, and draws
    /// nothing. The time of this frame is the least that any capture costs. The history of the
    /// session stays.
    CATOPTRIC_API FrameTimes clear_cubes();
    CATOPTRIC_API Counts counts() const;
    /// Returns the setup times of the scene as it is resident now.
    CATOPTRIC_API Setup setup() const;

private:
    friend class Frame;
    friend struct Embedding;
    /// Submits a frame. `finish`: adds passes that belong to no technique before the frame is
    /// submitted.
    Frame submit(const FrameSpec& spec,
                 const std::function<graph::ExternalSync(FrameGraph&)>& finish);
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

} // namespace catoptric::app
