#pragma once

#include "core/format.hpp"
#include "core/knob.hpp"
#include "core/technique_traits.hpp"
#include "reflect/shared_knobs.hpp"
#include "reflect/tracer.hpp"
#include "render/capture_cache.hpp"
#include "scene/flat_mirror.hpp"
#include "shared.h"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The table of techniques. A technique is one row of data and functions. Its .cpp file registers
/// the row, and no other file lists it.
namespace catoptric::reflect {

/// Images and buffers that a technique adds to the graph, with notes for the user.
struct TechniqueOutputs {
    graph::ImageHandle hdr;     ///< linear radiance, rgba32f
    graph::ImageHandle display; ///< the displayed picture, rgba8_unorm
    /// Whether the alpha of `hdr` says which surface the ray met (shared::kBitsPerMirrorHit).
    bool has_hits = false;
    std::vector<graph::BufferHandle> counters; ///< shared::Counters of each tracing pass
    /// Image with the direction in which each mirror pixel looked into a capture
    /// (shaders/lib/mirror.glsl), rgba32f; only if the inputs ask for this image.
    std::optional<graph::ImageHandle> lookup;
    /// Image with the number of the tracer that traces each pixel which the search leaves open
    /// (render::CameraOutputs). Only set with `lookup`, and only if tracers of listed pixels
    /// complete the picture.
    std::optional<graph::ImageHandle> tracer_marks;
    /// Whether rays draw all mirrors of the picture, so that `lookup` says nothing.
    bool traces_all_mirrors = false;
    std::shared_ptr<const render::MirrorCaptures>
        captures;                   ///< captures that the view reads; may be null
    std::vector<std::string> notes; ///< differences from the request, one sentence each
    /// Captures for the next frame, if captures are kept.
    std::shared_ptr<render::CaptureCache> kept;
    bool draws_everything = false; ///< every frame draws all captures, also with the model
                                   ///< `required`
};

/// Mirror inputs: captures and lighting for the mirrors that share a technique and its settings.
struct ShadingInputs {
    /// Captures of all mirrors; null if no technique asks for captures.
    std::shared_ptr<const render::MirrorCaptures> captures;
    render::ShadingLights lighting;     ///< lights and shadows as the settings ask for
    std::vector<std::uint32_t> mirrors; ///< the mirrors that share the technique, from 0
    bool completes_view = false;        ///< see Technique::completes_view
};

/// Shaders and resources with which the view draws mirrors.
struct MirrorShading {
    render::MirrorShader mirror;
    std::optional<TracerSettings>
        tracer; ///< traces the pixels that the mirror's shader leaves to rays
};

/// How a technique with mirrored views draws flat mirrors (reflect/mirrored.cpp).
struct MirroredViewOptions {
    int bounces = 0; ///< number of flat mirrors one behind the other that a mirrored view shows
    /// How rough mirrors show their view: Lookup::none, mips or prefilter.
    RoughKnobs::Lookup rough = RoughKnobs::Lookup::none;
    /// How the blur depends on the distance of what the view shows: Law::none or cone.
    RoughKnobs::Law law = RoughKnobs::Law::none;
    std::uint32_t taps = 1; ///< look-ups of a pixel with Lookup::prefilter
};

struct Technique {
    std::string_view name;
    std::string_view summary; ///< one sentence for `list` and the report
    int order = 0;            ///< position in lists and tables
    TechniqueTraits traits = {};
    std::span<const Knob> knobs;
    /// Rows that `compare` uses by default: "name[:knob=value,...]" each.
    std::span<const std::string_view> compared = {};
    /// Returns the scene passes R per frame as the seed report counts them. A cube counts once.
    /// Tests compare R with the planned frame.
    int (*scene_passes)(int mirrors, int lights, const KnobSettings& settings) = nullptr;
    /// Returns the options of the technique's captures, if they are shared
    /// (TechniqueTraits::captures). Mirrors in them are drawn by the shader `in_captures`.
    render::CaptureOptions (*capture)(const render::FrameInputs& inputs,
                                      const KnobSettings& settings) = nullptr;
    const char* in_captures = nullptr; ///< path of a fragment shader
    bool reads_whole_cubes = false;    ///< captures need all six faces
    /// Path of a fragment shader that needs only the captures. If set, `look` is null
    /// (reflect/captures.hpp, make_search_shader).
    const char* search = nullptr;
    /// Returns how the technique draws its mirrors, and declares the passes that this needs.
    MirrorShading (*look)(graph::Graph& graph, const render::FrameInputs& inputs,
                          const KnobSettings& settings, const ShadingInputs& around) = nullptr;
    /// Returns how flat mirrors show mirrored views, if the technique draws some
    /// (reflect/mirrored.cpp).
    MirroredViewOptions (*mirrored_views)(const KnobSettings& settings) = nullptr;
    /// Returns why the technique cannot draw the mirror, as words after "it is"; empty: it can.
    /// `tolerance`: scene::flat_tolerance.
    std::string (*unfit)(const scene::FlatFaces& flats, double tolerance,
                         const KnobSettings& settings) =
        [](const scene::FlatFaces&, double, const KnobSettings&) { return std::string(); };
    /// Knob whose choice is the technique that draws the mirrors that are unfit; null: `unfit` is.
    const Knob* rest = nullptr;
    /// Returns why the technique cannot draw with these settings together, as words after
    /// "technique '...': "; empty: it can.
    std::string (*conflict)(const KnobSettings& settings) = [](const KnobSettings&) {
        return std::string();
    };
    /// Returns whether the tracer of `look` completes a rasterised view in which all mirrors have
    /// this technique. The tracer then also draws surfaces that reflect without being mirrors, and
    /// pixels whose shadow the shadow map leaves open. `picture` is not used.
    bool (*completes_view)(const KnobSettings& settings) = [](const KnobSettings&) {
        return false;
    };
    /// Declares the whole picture without a rasterised view, if all mirrors have this technique
    /// (TechniqueTraits::draws_whole_picture).
    TechniqueOutputs (*picture)(graph::Graph& graph, const render::FrameInputs& inputs,
                                const KnobSettings& settings,
                                const render::ShadingLights& lighting) = nullptr;
};

/// Adds a technique to the table when the program starts, as an object of namespace scope. Throws
/// `internal` if its functions do not fit its traits.
struct RegisteredTechnique {
    explicit RegisteredTechnique(const Technique& technique);
};

/// Returns all techniques, sorted by `order`.
std::vector<const Technique*> techniques();
/// Throws `Failure::usage` with the nearest name.
const Technique& find_technique(std::string_view name);

/// A technique with a value for each knob.
struct TechniqueChoice {
    const Technique* technique = nullptr;
    KnobSettings settings{{}};
    std::string label;       ///< the technique as the user wrote it
    SharedKnobs shared = {}; ///< read from `settings`
    std::shared_ptr<const TechniqueChoice>
        rest; ///< draws the mirrors that are unfit; null: none are

    /// Reads `shared` and `rest` again, after a change of `settings`.
    void update_shared();
    /// Returns the label as a file name: "naive-bounces3".
    std::string file_name() const;
    /// Returns whether technique and knob values are the same. The spelling of the labels does not
    /// matter.
    bool is_same(const TechniqueChoice& other) const {
        return technique == other.technique && settings == other.settings;
    }
};

/// Reads "name[:knob=value,...]". Throws `Failure::usage` with the faulty part and the nearest
/// name.
TechniqueChoice parse_choice(std::string_view text);

} // namespace catoptric::reflect
