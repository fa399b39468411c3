#pragma once

#include "core/work.hpp"
#include "require/model.hpp"
#include "session/engine.hpp"
#include "session/first_surface.hpp"
#include "session/session.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace catoptric::render {
struct CapturedCubes;
} // namespace catoptric::render
namespace catoptric::graph {
struct ExternalSemaphores;
} // namespace catoptric::graph
namespace catoptric::gpu {
struct ExternalDevice;
} // namespace catoptric::gpu
namespace catoptric::require {
struct DeviceUnitCosts;
struct WorkModel;
} // namespace catoptric::require

// Functions of engines, sessions and frames for the programs and tests of this tree. The headers
// that are installed do not declare them.
namespace catoptric::session {

class WindowScreen;
struct WindowPictures;
struct FrameGraph;

/// Options of an engine that only programs and tests of this repository can set.
struct EngineHooks {
    /// Whether the six faces of a capture are rendered at once if the device can. False: the faces
    /// are always rendered one by one.
    bool layered = true;
    /// Replacements of shader builds by other builds, for benchmarks: "raytrace.comp" ->
    /// "raytrace.comp#naive".
    std::map<std::string, std::string> shader_variants = {};
    /// For a window (session/screen.hpp): instance extensions that the window system needs, and a
    /// function that makes the window's surface. The function receives the Vulkan instance and
    /// returns the handle of a surface, which the engine owns from then on. The chosen device can
    /// show pictures on this surface.
    std::vector<std::string> instance_extensions = {};
    std::function<std::uint64_t(void* instance)> make_surface = {};
    const gpu::ExternalDevice* given = nullptr; ///< device of an embedding program; null: none
    /// Folder for specialised shaders if EngineOptions::cache is empty, for tests; empty: none.
    std::filesystem::path shader_cache = {};
};

/// Options of a frame that only programs and tests of this repository can set.
struct FrameHooks {
    /// Causes of error to remove from mirrors: a sum of shared::kAblate... (shaders/shared.h).
    std::uint32_t ablated = 0;
    bool with_captures = false; ///< make captures readable (Access::read_captures)
    bool counts_work = false; ///< count the work (Access::pass_work), which makes the frame slower
    bool ignores_turns = false; ///< draw captures as with every=1
};

/// Pipelines that an engine has compiled so far. A software driver compiles more of a pipeline in
/// the first frame that uses it.
struct CompiledPipelines {
    std::size_t pipelines = 0;
    double ms = 0; ///< host time from the shader's words to the driver's pipeline
};

/// State of the pipeline cache on disk. none: there is no cache. made: the cache is new, or its
/// file was damaged. used: the driver received the cached data.
enum class PipelineCacheState { none, made, used };

/// Output format of a frame's compiled plan.
enum class PlanFormat { text, dot, json };

struct SessionCounters {
    std::uint64_t frames = 0;
    std::uint64_t updates = 0; ///< writes of scene data to the device
    std::uint64_t plans = 0;   ///< differently shaped frames that were planned
    // `uploads` and the two counters of hierarchies count from the last time that the whole scene
    // was written to the device. A change of the scene units writes the whole scene again.
    std::uint64_t uploads = 0; ///< buffer writes
    std::uint64_t hierarchies_built = 0, hierarchies_refitted = 0;
    std::uint64_t memory_bytes = 0; ///< device memory for images and buffers of frames
};

/// Host time for work that a scene needs once, in milliseconds.
struct SetupTimes {
    double upload_ms = 0;    ///< laying the scene out and writing it to the device
    double hierarchy_ms = 0; ///< building BVHs; 0: no pass has traced rays
};

/// A suspended sequence of frames, with the history that they left for the next frame. Only the
/// session that suspended the sequence can resume it. The engine must outlive it.
class FrameSequence {
public:
    FrameSequence(FrameSequence&&) noexcept;
    FrameSequence& operator=(FrameSequence&&) noexcept;
    ~FrameSequence();

private:
    friend struct Access;
    struct Impl;
    explicit FrameSequence(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

struct Access {
    using EngineImpl = Engine::Impl;
    using SessionImpl = Session::Impl;
    using FrameImpl = Frame::Impl;

    static Engine make_engine(const EngineOptions& options, const EngineHooks& hooks);
    static CompiledPipelines compiled_pipelines(const Engine& engine);
    static PipelineCacheState pipeline_cache_state(const Engine& engine);
    /// Returns the folder in which the engine keeps files between runs; empty if it keeps none.
    static std::filesystem::path cache_folder(const Engine& engine);
    static EngineImpl& impl(const Engine& engine) { return *engine.impl_; }
    /// Returns the unit costs by which `auto` compares plans on the engine's device.
    static const require::DeviceUnitCosts& unit_costs(const Engine& engine);

    /// Returns whether a technique's picture depends on the previous frame.
    static bool remembers(const Frame& frame, std::size_t part = 0);
    /// Returns the model of the frame: which work was rendered, and which was left out.
    static const require::WorkModel& rendered_model(const Frame& frame);
    /// Returns colours and distances around every mirror, of a technique that captures both. Throws
    /// `internal` without `with_captures`.
    static render::CapturedCubes read_captures(const Frame& frame, std::size_t part = 0);
    /// Returns the work of the frame's passes, in order of execution. Empty without `counts_work`.
    static std::vector<PassWork> pass_work(const Frame& frame);
    /// Returns the linear pictures and all data that the next frame can read of this one, as bytes.
    /// If two successive frames of a still scene have equal states, the picture changes no more.
    /// Empty if nothing is remembered.
    static std::vector<std::byte> read_state(const Frame& frame);

    /// Traces what the pixels of a frame with this specification show first, in a frame of its own.
    /// Later frames continue as without this frame, but earlier ones can no longer be read. Throws
    /// `exhausted`.
    static FirstSurfaces trace_first_surfaces(Session& session, const FrameSpec& spec);
    /// Returns how the frame made its reflections. Throws `internal` for a frame that was submitted
    /// without `with_lookup`, or before another one.
    static ReflectionTiers read_tiers(const Frame& frame, std::size_t part = 0);

    /// Submits a frame as Session::frame does, with hooks. `finish` adds passes that belong to no
    /// technique before the frame is submitted.
    static Frame
    render_frame(Session& session, const FrameSpec& spec, const FrameHooks& hooks,
                 const std::function<graph::ExternalSemaphores(FrameGraph&)>& finish = {});
    /// Submits a frame and shows it in a window. The screen must belong to the session's engine,
    /// and WindowScreen::fit must have returned true. If the window has no image for the
    /// frame, the frame is still rendered.
    static Frame show(Session& session, const FrameSpec& spec, WindowScreen& screen,
                      const WindowPictures& showing);
    /// Makes a cut and returns the suspended frame sequence with its history.
    /// `resume` can continue the sequence. Waits for frames in flight.
    static FrameSequence suspend(Session& session);
    /// Continues a suspended sequence: the next frame follows the last frame of the sequence.
    /// Discards the present history. If the scene's units have changed (see Session::change), the
    /// next frame begins without history.
    static void resume(Session& session, FrameSequence sequence);
    /// Returns the plan, written out, of a frame that follows another frame. With
    /// RenderedWork::required, the scene is still and its captures no longer change.
    static std::string format_plan(Session& session, const FrameSpec& spec, PlanFormat format);
    /// Renders a frame that clears the cubes of every mirror, 256 texels an edge, and draws
    /// nothing. The time of this frame is the least that any capture costs. The history of the
    /// session stays.
    static FrameTimes measure_clear_time(Session& session);
    static SessionCounters session_counters(const Session& session);
    /// Returns the setup times of the scene as it is resident now.
    static SetupTimes setup_times(const Session& session);
};

/// Returns "everything" or "required".
std::string work_name(RenderedWork work);

} // namespace catoptric::session
