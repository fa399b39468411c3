#pragma once

#include "core/format.hpp"
#include "core/math.hpp"
#include "core/setting.hpp"
#include "measure/picture.hpp"
#include "scene/load.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::render {
struct Captured;
} // namespace catoptric::render

/// The engine as a program or a library uses it. No Vulkan name is needed to include this.
namespace catoptric::app {

/// isolated: passes do not overlap and their times add up. pipelined: believe the span only.
enum class Timing { isolated, pipelined };

struct EngineOptions {
    std::string device;    ///< index or part of a name; empty = discrete, else integrated, else cpu
    bool validate = false; ///< the validation layer watches; any message makes the run fail
    bool layered = true;   ///< false: render captures face by face even where the device can do six
    /// Shader builds to use in place of others, for benchmarks: "raytrace.comp" ->
    /// "raytrace.comp#naive".
    std::map<std::string, std::string> shader_variants = {};
};

struct Part;
/// Reads back what the techniques made in the frame that has just been rendered.
using ReadParts = std::function<std::vector<Part>()>;

/// What to render and for how long.
struct Request {
    scene::Scene scene; ///< at rest
    /// "name[:knob=value,...]" each. Several are rendered in one frame: one command buffer, one
    /// submit, one timeline; their pictures equal those of separate runs.
    std::vector<std::string> techniques;
    scene::Camera camera;
    uvec2 size{512, 512};
    int frames = 20; ///< measured
    int warmup = 8;  ///< before them; frames count from 1 at cold history, these included
    /// End with the first frame that cannot change any more: at once where nothing is remembered,
    /// else when a frame's linear pictures and all captures equal those of the frame before, byte
    /// for byte.
    bool until_settled = false;
    double time = 0;      ///< seconds into the scene's motion
    bool animate = false; ///< frame k at time + (k-1)/60 s; otherwise all at `time`
    /// Seconds into the scene's motion of frame k, in place of `time` and `animate`; may be empty.
    std::function<double(int)> clock;
    /// The scene of frame k, in place of `scene` at an instant of its motion, where light or
    /// materials change in mid-run; units stay those of `scene`, and what the frame before left is
    /// kept. May be empty.
    std::function<scene::Scene(int)> changed;
    double ambient = 0.05;
    double exposure = 0;    ///< stops
    std::uint64_t seed = 1; ///< of sample patterns that are not a regular grid
    Timing timing = Timing::isolated;
    /// Renderings of the last frame beside the row's own, each with causes of error taken away:
    /// sums of shared::kMend... (shaders/shared.h). Filled into Part::mended.
    std::vector<std::uint32_t> mended;
    bool with_lookup = false; ///< also say where mirrors looked (Part::lookup); costs time
    /// Called after each frame with its number and the total; may be empty.
    std::function<void(int, int)> progress;
    /// Called after each frame with its number; false makes it the last one. No measured time holds
    /// what this or reading back takes. May be empty.
    std::function<bool(int, const ReadParts&)> watch;
};

/// Seconds into the scene's motion at the last frame.
double last_time(const Request& request);

struct PassTime {
    std::string name;
    double begin_ms = 0, end_ms = 0; ///< from the frame's first stamp
    double ms() const { return end_ms - begin_ms; }
};

/// One measured frame. On a cpu device "gpu" time is time of the driver's threads.
struct Frame {
    std::vector<PassTime> passes;
    double gpu_ms = 0;    ///< first to last stamp
    double record_ms = 0; ///< filling the command buffer
    double wall_ms = 0;   ///< submit until done, without recording and read-back
};

struct RayCounts {
    std::uint64_t primary = 0, mirror = 0, shadow = 0; ///< in one frame
    std::uint32_t longest_walk = 0; ///< hierarchy steps of the busiest invocation
};

/// The cube edge that face=auto stands for in one run.
struct AutoFace {
    std::uint32_t edge = 0; ///< used for every mirror's capture, texels
    std::vector<double>
        needs; ///< texels along an edge, entry n-1 of mirror n; 0: it is not in view
};

/// What one technique made in the last frame.
struct Part {
    std::string label;  ///< as it was asked for
    std::string prefix; ///< of its passes' names; empty when it was alone
    int scene_passes = 0;
    int scene_draws = 0;            ///< scene passes times the layers that each renders
    bool remembers = false;         ///< a pass of it reads what the frame before left
    std::uint64_t memory_bytes = 0; ///< of the whole frame's images
    measure::Picture hdr;           ///< linear radiance
    measure::Picture display;       ///< what the screen shows: multiples of 1/255
    /// With `with_lookup`, techniques whose captures hold halves: their texels that are brighter
    /// than 65504 and cut off there.
    std::optional<std::size_t> saturated;
    std::vector<vec4>
        lookup; ///< with `with_lookup`, techniques that search: see shaders/lib/mirror.glsl
    std::vector<measure::Picture> mended; ///< one for each Request::mended, linear radiance
    std::vector<std::uint32_t> hits;      ///< ray tracing only: first mirror | second mirror << 16
    std::optional<RayCounts> rays;        ///< ray tracing only
    std::optional<double>
        traced_fraction; ///< of its mirror pixels, where a search leaves some to tracing
    std::optional<AutoFace> auto_face; ///< where it was left to choose the cube edge (face=auto)
};

struct Result {
    std::vector<Part> parts; ///< one per technique, of the last frame
    /// The measured ones; fewer than asked for where `watch` or `until_settled` ended the run.
    std::vector<Frame> frames;
    bool settled = false; ///< with `until_settled`: any further frame would show the same
};

/// How the compiled plan of a request's frame is written.
enum class PlanFormat { text, dot, json };

struct Knob {
    std::string name, help;
    double low = 0, high = 1;
    std::string value;                ///< default
    std::vector<std::string> choices; ///< empty for a number
    std::string special;              ///< a word allowed in place of the number; empty: none
};
struct TechniqueInfo {
    std::string name, summary;
    std::vector<Knob> knobs;
};
/// Every technique in the table's order.
std::vector<TechniqueInfo> techniques();

/// Checks "name[:knob=value,...]"; throws `Failure::usage` with the nearest name.
struct TechniqueChoice {
    std::string technique, label, file_name;
    std::vector<Setting> settings; ///< all knobs
};
TechniqueChoice parse_technique(const std::string& text);

struct DeviceInfo {
    std::string name, driver, api, type;
    int threads = 0;
    std::string missing; ///< what the engine needs and it lacks; empty = usable
};
std::vector<DeviceInfo> devices();

/// Set to a signal's number to end the frame loop after the current frame:
/// run() then throws `Failure::hangup` (1), `interrupted` (2) or `terminated` (15).
extern std::atomic<int> stop_signal;

std::string version(); ///< "0.1.0"
std::string commit();  ///< abbreviated, "unknown" outside a checkout

/// Whether an Engine of this process had to give up its device (Engine::usable). Its driver's
/// threads may still be at work, and to take the program down under them can crash: such a program
/// ends with std::_Exit.
bool any_abandoned();

/// A device with what has been compiled for it. One thread at a time.
class Engine {
public:
    explicit Engine(const EngineOptions& options);
    ~Engine();

    /// False once the device was lost or could not be waited for, which threw `device_lost` or
    /// `exhausted`. Then all that needs the device throws the same again, and what the driver may
    /// still use is never freed. Another Engine can be made.
    bool usable() const;

    /// The only frame loop. Throws `usage`, `exhausted`, `device_lost`, and for a stop signal
    /// `hangup`, `interrupted` or `terminated`.
    Result run(const Request& request);
    /// The plan of the request's second frame (when history exists), written out.
    std::string plan(const Request& request, PlanFormat format);
    /// Median and samples are up to the caller: milliseconds of `frames` frames that clear the
    /// cubes of the scene's mirrors once and draw nothing.
    std::vector<double> clear_ms(const Request& request);

    /// Cubes of `face` texels around every mirror: no shadows, no ambient light, other mirrors
    /// black. For tests and properties; render/captured.hpp says what it holds.
    render::Captured capture(const scene::Scene& scene, std::uint32_t face, Format distance);

    const DeviceInfo& device() const;
    /// Throws `internal` with the first message of the validation layer, when there is any.
    void check_validation() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace catoptric::app
