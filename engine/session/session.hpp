#pragma once

#include "../core/export.hpp"
#include "../core/frame_facts.hpp"
#include "../core/math.hpp"
#include "../measure/picture.hpp"
#include "../scene/build.hpp"
#include "engine.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Frames of a scene on a device.
namespace catoptric::session {

/// How passes are timed. isolated: passes do not overlap, and their times add up. pipelined: passes
/// may overlap, and only the time of the whole frame is valid.
enum class PassTimingMode { isolated, pipelined };

/// The work that a frame renders. everything: the capture of each mirror, six faces, every frame.
/// required: only what the picture needs. Both give the same picture unless documented otherwise.
enum class RenderedWork { everything, required };

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
    PassTimingMode timing = PassTimingMode::isolated;
    RenderedWork model = RenderedWork::everything;
    /// Most mirrors whose captures a frame draws again, per technique; 0: all. Needs
    /// RenderedWork::required. The others are drawn in one of the next ceil(captured mirrors /
    /// most_captures) frames; mirrors that come into view are drawn in addition. A frame with
    /// `keeps_history` draws all. Each frame waits for the one before.
    std::uint32_t most_captures = 0;
    /// Limit like `most_captures`, in milliseconds of device time; 0: none. The first frame draws
    /// all captures. Later frames draw as many as fit by the session's measurements, at least one.
    double budget_ms = 0;
    bool with_lookup = false; ///< fill TechniqueResult::lookup, which costs time
    /// A frame that keeps the history unchanged: the next frame has the history that this one had.
    bool keeps_history = false;
};

struct PassTime {
    std::string name;
    double begin_ms = 0, end_ms = 0; ///< from the frame's first timestamp
    double ms() const { return end_ms - begin_ms; }
};

/// Times of one frame. On a device of type "cpu", GPU times are times of the driver's threads.
struct FrameTimes {
    /// Passes in order of execution. In a long run only the last 1000 frames have them.
    std::vector<PassTime> passes;
    double passes_ms = 0; ///< sum over all passes
    double gpu_ms = 0;    ///< first to last timestamp
    double record_ms = 0; ///< filling the command buffer
    /// From submit until the device has finished the frame, without recording and read-back.
    double wall_ms = 0;
    /// Time that the host waited for a place among the frames in flight, and for the end of this
    /// frame. It is part of no other figure.
    double wait_ms = 0;
    double cpu_ms = 0; ///< processor time of the whole process for the frame; 0: not measured
    HostTimes host;
    /// Returns the time of host and device work, which do not overlap. Waiting is not included.
    double frame_ms() const { return host.sum() + gpu_ms; }
};

/// Outcome of a frame that limits its captures (most_captures, budget_ms, or the knob `every`).
struct CaptureBudget {
    std::uint32_t mirrors = 0; ///< number of captured mirrors
    std::uint32_t most = 0;    ///< mirrors that a frame draws again at most, 1 to `mirrors`
    std::uint32_t drawn = 0;   ///< mirrors drawn, including those that came into view
    std::uint32_t waiting = 0; ///< mirrors whose captures had to wait for a later frame
    std::uint32_t longest = 0; ///< number of frames for which the oldest capture has waited
    std::uint32_t every = 1;   ///< largest value of the knob `every`

    /// Returns the frames within which each waiting capture is drawn if `most` does not change.
    CATOPTRIC_API std::uint32_t frames_per_cycle() const;
};

/// Results of one technique or plan in a frame.
struct TechniqueResult {
    std::string label;              ///< technique or plan as it was asked for
    std::string prefix;             ///< of its passes' names; empty if the frame has only one part
    std::vector<PlanEntry> plan;    ///< technique of each mirror
    std::vector<std::string> notes; ///< deviations from what was asked for, a sentence each
    RenderedWork model = RenderedWork::everything;
    std::vector<CulledWork> left_out;            ///< work that the model left out
    std::optional<CaptureBudget> capture_budget; ///< only if captures are kept under a limit
    int scene_passes = 0;
    int scene_draws = 0;            ///< scene passes times their layers
    bool remembers = false;         ///< the picture depends on the frame before
    std::uint64_t memory_bytes = 0; ///< size of the whole frame's images
    measure::Picture hdr;           ///< linear radiance
    measure::Picture display;       ///< displayed picture, in multiples of 1/255
    /// Captured texels brighter than 65504, the largest half. Only `with_lookup`, with halves.
    std::optional<std::size_t> saturated;
    /// Where each mirror pixel looked into a capture (shaders/lib/mirror.glsl). Only `with_lookup`.
    std::vector<vec4> lookup;
    std::vector<std::uint32_t> hits; ///< ray tracing only: first mirror | second mirror << 16
    std::optional<RayCounts> rays;   ///< ray tracing only
    /// Share of mirror pixels that were ray traced, if a search leaves some to ray tracing.
    std::optional<double> traced_fraction;
    std::optional<AutoFace> auto_face; ///< only if the part chooses the cube edge (face=auto)
};

/// A submitted frame. Its results can be read until another frame takes its place: the session's
/// next frame, or a later one if several are in flight. Look-ups can be read until the next frame.
/// Reading later throws `internal`. Functions that wait throw `device_lost` and `exhausted`.
class Frame {
public:
    /// Returns the frame's times. The first call waits for the device.
    CATOPTRIC_API const FrameTimes& times() const;
    /// Returns the number of techniques.
    CATOPTRIC_API std::size_t size() const;
    /// Returns the outcome of the capture limit, if there is one and the technique keeps captures.
    CATOPTRIC_API const std::optional<CaptureBudget>& capture_budget(std::size_t part = 0) const;
    /// Returns how many mirrors, over all techniques, have captures that wait to be drawn again.
    CATOPTRIC_API std::uint32_t waiting() const;
    /// Returns linear radiance, the cheapest result to read.
    CATOPTRIC_API measure::Picture hdr(std::size_t part = 0) const;
    /// Returns all results of one technique.
    CATOPTRIC_API TechniqueResult read(std::size_t part = 0) const;
    CATOPTRIC_API std::vector<TechniqueResult> read_all() const;

private:
    friend struct Access; // internal
    friend class Session;
    struct Impl;
    explicit Frame(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<Impl> impl_;
};

/// A scene on a device. Uploaded data, compiled pipelines and history stay from frame to frame.
/// Only one thread may use a session at a time. A device error ends the session and its engine. The
/// engine must outlive the session and its frames.
class Session {
public:
    /// `scene`: at rest. `in_flight`: number of frames, 1 to 3, that may be under way before the
    /// oldest is waited for. Throws `exhausted` if the scene exceeds the device's limits, and as
    /// scene::check_scene does. A session without objects shows the environment.
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
    /// Edits the scene; the next frame shows the edit. History stays unless the edit removes an
    /// object or changes the scene's units on the device (render::make_scene_units), because the
    /// scene becomes much larger or smaller, or an outermost object or small mirrors move. Throws
    /// as scene::apply_edit does.
    CATOPTRIC_API void change(const scene::Edit& edit);
    /// Makes a cut: the next frame begins without history.
    CATOPTRIC_API void forget();

private:
    friend struct Access; // internal
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

} // namespace catoptric::session
