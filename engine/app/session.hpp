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

class Screen;      // app/screen.hpp
struct Showing;    // likewise
struct FrameGraph; // internal

/// isolated: passes do not overlap and their times add up. pipelined: believe the span only.
enum class Timing { isolated, pipelined };

/// What is rendered of what could be. everything: each mirror, six faces, every frame. required:
/// what the picture needs (require/model.hpp), with the same picture where nothing else is said.
enum class Modelling { everything, required };
/// "everything", "required"
CATOPTRIC_API std::string name_of(Modelling modelling);

/// What one frame shows and how it is made.
struct FrameSpec {
    /// "name[:knob=value,...]", a plan "PATTERN=name[:knob=value,...] ..." (reflect/plan.hpp), or
    /// "plan:FILE" with one in it (app/plan_file.hpp) each. Several are rendered in one frame: one
    /// command buffer, one submit, one timeline; their pictures equal those of separate frames.
    std::vector<std::string> techniques;
    scene::Camera camera;
    uvec2 size{512, 512};
    double time = 0; ///< seconds into the scene's motion
    double ambient = 0.05;
    double exposure = 0;    ///< stops
    std::uint64_t seed = 1; ///< of sample patterns that are not a regular grid
    Timing timing = Timing::isolated;
    Modelling model = Modelling::everything;
    /// With Modelling::required, of each technique: mirrors whose captures a frame draws again at
    /// most; 0: all. The others show what they showed, and each is drawn in one of the next
    /// ceil(captured mirrors / most_captures) frames. What comes into view is drawn beside them. A
    /// frame `keeps_history` draws all. A frame waits for the one before.
    std::uint32_t most_captures = 0;
    /// The same by milliseconds of the device that captures may take; 0: no limit. The first frame
    /// draws all, later ones as many as fit by what the session measured, at least one: pictures
    /// depend on how fast the device is.
    double budget_ms = 0;
    /// Causes of error that mirrors are drawn without: a sum of shared::kMend...
    /// (shaders/shared.h).
    std::uint32_t ablated = 0;
    bool with_lookup = false;   ///< also say where mirrors looked (Part::lookup); costs time
    bool with_captures = false; ///< captures can be read back (Frame::captures)
    bool keeps_history =
        false; ///< beside the sequence: the next frame has the history that this one had
};

struct PassTime {
    std::string name;
    double begin_ms = 0, end_ms = 0; ///< from the frame's first stamp
    double ms() const { return end_ms - begin_ms; }
};

/// What the processor did for a frame before the device could begin, milliseconds each.
struct HostTimes {
    double update = 0;    ///< what moved: buffers written, views and lights found
    double hierarchy = 0; ///< trees for tracing, built or refitted
    double compile = 0;   ///< passes declared, and planned where their shape is new
    double record = 0;    ///< filling the command buffer
    double sum() const { return update + hierarchy + compile + record; }
};

/// One frame on the clock. On a cpu device "gpu" time is time of the driver's threads.
struct FrameTimes {
    /// In order of execution. Of a run of many frames only the last kDetailedFrames have them.
    std::vector<PassTime> passes;
    double passes_ms = 0; ///< sum over all passes
    double gpu_ms = 0;    ///< first to last stamp
    double record_ms = 0; ///< filling the command buffer
    double wall_ms = 0;   ///< submit until done, without recording and read-back
    /// The host stood still for the device: for a place among the frames in flight, and until this
    /// one had ended. No work, and added to nothing.
    double wait_ms = 0;
    /// Of all the process's threads, while the frame was made and waited for; 0 where nobody
    /// measured it (Frames does).
    double cpu_ms = 0;
    HostTimes host;
    /// Host and device work, which do not overlap; waiting is no work.
    double frame_ms() const { return host.sum() + gpu_ms; }
};

struct RayCounts {
    std::uint64_t primary = 0, mirror = 0, shadow = 0; ///< in one frame
    std::uint32_t longest_walk = 0; ///< hierarchy steps of the busiest invocation
};

/// The cube edge that face=auto stands for.
struct AutoFace {
    std::uint32_t edge = 0; ///< used for every mirror's capture, texels
    std::vector<double>
        needs; ///< texels along an edge, entry n-1 of mirror n; 0: it is not in view
};

/// What one technique, or plan, made in a frame.
struct Part {
    std::string label;              ///< as it was asked for
    std::string prefix;             ///< of its passes' names; empty when it was alone
    std::vector<PlanEntry> plan;    ///< of each mirror
    std::vector<std::string> notes; ///< what was done otherwise than asked for, a sentence each
    Modelling model = Modelling::everything;
    std::vector<require::CulledWork> left_out; ///< by the model, of its picture
    std::optional<CaptureBudget> slices;       ///< where captures are kept, and only some drawn
    int scene_passes = 0;
    int scene_draws = 0;            ///< scene passes times the layers that each renders
    bool remembers = false;         ///< it shows what the frame before left
    std::uint64_t memory_bytes = 0; ///< of the whole frame's images
    measure::Picture hdr;           ///< linear radiance
    measure::Picture display;       ///< what the screen shows: multiples of 1/255
    /// With `with_lookup`, techniques whose captures hold halves: their texels that are brighter
    /// than 65504 and cut off there.
    std::optional<std::size_t> saturated;
    std::vector<vec4>
        lookup; ///< with `with_lookup`, techniques that search: see shaders/lib/mirror.glsl
    std::vector<std::uint32_t> hits; ///< ray tracing only: first mirror | second mirror << 16
    std::optional<RayCounts> rays;   ///< ray tracing only
    std::optional<double>
        traced_fraction; ///< of its mirror pixels, where a search leaves some to tracing
    std::optional<AutoFace> auto_face; ///< where it was left to choose the cube edge (face=auto)
};

/// A frame that a session has submitted. What it made can be read until its place is taken: by the
/// session's next frame, or with several in flight by one after; captures, look-ups and state until
/// the next in any case. Later that throws `internal`. Throws `device_lost` and `exhausted` where
/// it waits.
class Frame {
public:
    /// Waits for the device; stay with this value from then on.
    CATOPTRIC_API const FrameTimes& times() const;
    /// Techniques in it.
    CATOPTRIC_API std::size_t size() const;
    /// Whether a technique shows what the frame before left.
    CATOPTRIC_API bool remembers(std::size_t part = 0) const;
    /// What was rendered, and what was left out.
    CATOPTRIC_API const require::Model& model() const;
    /// Where the technique keeps captures, and FrameSpec limits how many are drawn.
    CATOPTRIC_API const std::optional<CaptureBudget>& slices(std::size_t part = 0) const;
    /// Mirrors, of all techniques, whose captures are put off: the picture is not what it would be
    /// without a limit.
    CATOPTRIC_API std::uint32_t waiting() const;
    /// Linear radiance; the cheapest thing to read.
    CATOPTRIC_API measure::Picture hdr(std::size_t part = 0) const;
    /// Everything that one technique made.
    CATOPTRIC_API Part read(std::size_t part = 0) const;
    CATOPTRIC_API std::vector<Part> read_all() const;
    /// Colours and distances around every mirror, of a technique that keeps both; with
    /// `with_captures`, else `internal`. Not for programs outside.
    render::Captured captures(std::size_t part = 0) const;
    /// All that the next frame can see of this one, and the linear pictures, as bytes: a still
    /// scene whose frames agree in it changes no more. Empty where nothing is remembered.
    CATOPTRIC_API std::vector<std::byte> state() const;

private:
    friend class Session;
    struct Impl;
    explicit Frame(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<Impl> impl_;
};

/// How the compiled plan of a frame is written.
enum class PlanFormat { text, dot, json };

/// What a session has done so far.
struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t updates = 0; ///< times that something of the scene was written to the device
    std::uint64_t plans = 0;   ///< shapes of frames that were planned
    // Of the scene as it is resident now; a change of the scene's units makes it anew.
    std::uint64_t uploads = 0; ///< writes of buffers
    std::uint64_t hierarchies_built = 0, hierarchies_refitted = 0;
    std::uint64_t memory_bytes = 0; ///< of the device, for images and buffers of frames
};

/// Frames that followed one another in a session, set aside: what they have left for the next one.
/// Only the session that gave it takes it back; the engine must outlive it.
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

/// What a scene needed once, milliseconds of the host each.
struct Setup {
    double upload_ms = 0;    ///< laid out for the device and written to it
    double hierarchy_ms = 0; ///< trees for tracing, built; 0: no pass has traced
};

/// A scene on a device, for as many frames as one likes: what is uploaded, compiled or remembered
/// stays from frame to frame. One thread at a time. A device error ends it, and its engine, which
/// must outlive it and its frames.
class Session {
public:
    /// The scene at rest. `in_flight`: frames, 1 to 3, that may be under way before the oldest is
    /// waited for. Throws `exhausted` where the scene is beyond what the device allows.
    CATOPTRIC_API Session(Engine& engine, scene::Scene scene, std::uint32_t in_flight = 1);
    CATOPTRIC_API ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    CATOPTRIC_API const scene::Scene& scene() const;
    /// Submits a frame. Waits where all places in flight are taken, and for the frame before where
    /// the scene is written to. Other techniques than those of the frame before, or another model,
    /// begin without history. Throws `usage` for a specification that means nothing.
    CATOPTRIC_API Frame frame(const FrameSpec& spec);
    /// The same, shown in a window: of the screen's engine, which must `fit`. A frame that the
    /// window has no image for is rendered all the same. Not for programs outside, which have a
    /// window of their own (embed/embed.hpp).
    Frame show(const FrameSpec& spec, Screen& screen, const Showing& showing);
    /// Edits the scene; seen from the next frame on. History stays unless the edit changes the
    /// scene's units on the device (render::space_of): it is much larger or smaller now, or what
    /// its origin goes by stands elsewhere (an outermost object, small mirrors). Throws `usage` for
    /// an object or material that is not there.
    CATOPTRIC_API void change(const scene::Edit& edit);
    /// A cut: the next frame begins without history.
    CATOPTRIC_API void forget();
    /// A cut, after which `resume` can go on from here. Waits for what is in flight.
    CATOPTRIC_API Sequence suspend();
    /// The next frame follows the last one of a sequence that was set aside; the one so far is
    /// forgotten. Where the scene's units changed in between (see change) it begins without
    /// history.
    CATOPTRIC_API void resume(Sequence sequence);
    /// The plan of a frame that has a frame before it, written out; with Modelling::required, of a
    /// still scene whose captures change no more.
    CATOPTRIC_API std::string plan(const FrameSpec& spec, PlanFormat format);
    /// A frame that clears the cubes of every mirror, 256 texels an edge, and draws nothing: what
    /// any capture costs before it shows something. History stays.
    CATOPTRIC_API FrameTimes clear_cubes();
    CATOPTRIC_API Counts counts() const;
    /// Of the scene as it is resident now.
    CATOPTRIC_API Setup setup() const;

private:
    friend class Frame;
    friend struct Embedding;
    /// `finish`: adds to the frame what is not a technique's, before it is submitted.
    Frame submit(const FrameSpec& spec,
                 const std::function<graph::ExternalSync(FrameGraph&)>& finish);
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

} // namespace catoptric::app
