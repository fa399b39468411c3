#pragma once

#include "core/knob.hpp"
#include "reflect/tracer.hpp"
#include "render/capture_cache.hpp"
#include "scene/flat_mirror.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The table of techniques. A technique is one row: data and two functions, in one .cpp that
/// registers itself; nothing else lists it.
namespace catoptric::reflect {

/// What a technique leaves in the graph.
struct Outputs {
    graph::Image hdr;                    ///< linear radiance, rgba32f
    bool has_hits = false;               ///< its alpha says what was met (shared::kMetBits)
    std::vector<graph::Buffer> counters; ///< shared::Counters of each tracing
    std::optional<graph::Image> lookup; ///< rgba32f: where mirrors looked, if the inputs ask for it
    std::shared_ptr<const render::Captures> captures; ///< that the view looks into; may be none
    std::vector<std::string> notes; ///< what was done otherwise than asked for, a sentence each
    std::shared_ptr<render::CaptureCache> kept; ///< for the next frame, where captures are kept
};

/// What the mirrors that share a technique and its settings may look into.
struct MirrorInputs {
    std::shared_ptr<const render::Captures> captures; ///< of all mirrors; none was asked for: null
    render::Lighting lighting;                        ///< as the settings ask for it
    std::vector<std::uint32_t> mirrors;               ///< those that share it, from 0
};

/// How mirrors are drawn in the view.
struct MirrorShading {
    render::MirrorShader mirror;
    std::optional<Tracer> tracer; ///< for pixels that the mirror's shader leaves to it
};

struct Technique {
    std::string_view name;
    std::string_view summary; ///< one sentence for `list` and the report
    int order = 0;            ///< place in lists and tables
    std::span<const Knob> knobs;
    /// Its rows where compare is not told which: "name[:knob=value,...]" each.
    std::span<const std::string_view> compared = {};
    /// Scene renders a frame as the report counts its R; a cube counts once.
    int (*scene_passes)(int mirrors, int lights, const Settings& settings) = nullptr;
    /// What its mirrors' captures hold, one a frame and mirror. In them mirrors look into last
    /// frame's captures with `in_captures`. Null: it looks into none of these.
    render::CaptureOptions (*capture)(const render::FrameInputs& inputs,
                                      const Settings& settings) = nullptr;
    const char* in_captures = nullptr; ///< path of a fragment shader
    bool reads_whole_cubes = false;    ///< whatever directions its mirrors ask for
    /// Path of a fragment shader that looks into the captures and needs nothing else: `look` is
    /// null then (reflect/captures.hpp, shading_of_search).
    const char* search = nullptr;
    /// How its mirrors are drawn; declares what passes that takes.
    MirrorShading (*look)(graph::Graph& graph, const render::FrameInputs& inputs,
                          const Settings& settings, const MirrorInputs& around) = nullptr;
    /// Its mirrors show what a view of their own sees (reflect/mirrored.hpp): mirrors one behind
    /// the other in it.
    int (*mirrored_bounces)(const Settings& settings) = nullptr;
    /// Why it cannot draw the mirror, after "it is"; empty: it can. Null: it draws any. What it
    /// cannot is drawn by the row that the knob `rest` names. `tolerance`: scene::flat_tolerance.
    std::string (*unfit)(const scene::FlatFaces& flats, double tolerance) = nullptr;
    /// The whole picture where all mirrors are its own, without a view that is drawn. Null: drawn.
    Outputs (*picture)(graph::Graph& graph, const render::FrameInputs& inputs,
                       const Settings& settings, const render::Lighting& lighting) = nullptr;
};

/// A namespace-scope Registered puts its technique into the table while the program starts.
struct Registered {
    explicit Registered(const Technique& technique);
};

/// Every technique by `order`.
std::vector<const Technique*> techniques();
/// Throws `Failure::usage` with the nearest name.
const Technique& find_technique(std::string_view name);

/// A technique with a value for each knob.
struct Choice {
    const Technique* technique = nullptr;
    Settings settings{{}};
    std::string label; ///< as it was asked for: "naive:bounces=3"

    /// The label fit for a file name: "naive-bounces3".
    std::string file_name() const;
    /// Same technique, same value of each knob, whatever was spelled out.
    bool same_as(const Choice& other) const {
        return technique == other.technique && settings == other.settings;
    }
};

/// Reads "name[:knob=value,...]". Throws `Failure::usage` naming what is wrong and the nearest
/// name.
Choice parse_choice(std::string_view text);

} // namespace catoptric::reflect
