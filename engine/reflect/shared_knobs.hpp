#pragma once

#include "core/format.hpp"
#include "core/knob.hpp"
#include "render/passes.hpp"
#include "shared.h"

#include <cstdint>
#include <optional>

/// The values of the knobs that several techniques have, in groups. A technique that lacks a group
/// has the group's defaults.
namespace catoptric::reflect {

struct ShadowKnobs {
    enum class Method { none, map, ray };
    Method method = Method::none;
    std::uint32_t edge = 1; ///< of a shadow map's face, texels
    bool is_soft = false;   ///< soft=pcss
};

/// How captures are stored.
struct CaptureKnobs {
    /// Edge of a face in texels; none: `auto`, or the technique has no such knob.
    std::optional<std::uint32_t> face;
    bool chooses_face = false;           ///< face=auto
    std::uint32_t every = 1;             ///< frames from one drawing to the next
    bool stores_floats = false;          ///< colour=float
    std::optional<TexelFormat> distance; ///< none: the technique has no such knob
    double range = 0;                    ///< largest distance for `distance=unorm8`, in world units
};

struct SearchKnobs {
    std::uint32_t continues = 0;     ///< further mirrors through which a ray is followed
    bool by_object = false;          ///< lookup=object
    bool asks_all = false;           ///< captures=all
    bool leaves_out_spheres = false; ///< mirrors=left_out
    /// Returns whether a search may read captures of other mirrors.
    bool reads_others() const { return continues > 0 || asks_all; }
};

/// How rough surfaces are looked up.
struct RoughKnobs {
    /// Numbered as in shaders/lib/rough.glsl. Shaders look up `fast` as `prefilter`.
    enum class Lookup : std::uint32_t { none, mips, prefilter, rays, fast };
    /// Distance law; numbered as kLaw... in shaders/lib/math/rough.glsl.
    enum class Law : std::uint32_t { none, frostbite, square, cone, exact };
    Lookup lookup = Lookup::none;
    Law law = Law::none;
    std::uint32_t taps = 0; ///< samples of each texel for prefilter, and for wide lobes of fast
    std::uint32_t rays = 1; ///< directions of each rough pixel
    /// Returns whether rough surfaces are looked up in filtered levels of captures.
    bool uses_levels() const { return lookup == Lookup::mips || filters_by_lobe(); }
    /// Returns whether the filtered levels are filtered by the GGX lobe, and not by boxes.
    bool filters_by_lobe() const { return lookup == Lookup::prefilter || lookup == Lookup::fast; }
};

/// What lights diffuse surfaces apart from lamps.
struct LightKnobs {
    /// Light between surfaces. Numbered as the choices of `indirect`.
    enum class Indirect : std::uint32_t { ambient, captures };
    /// What hides light of the environment, ambient light and light of light probes. Numbered as
    /// the choices of `ao`.
    enum class Occlusion : std::uint32_t { none, screen, captures };
    Indirect indirect = Indirect::ambient;
    Occlusion occlusion = Occlusion::none;
    std::uint32_t most_probes = 0; ///< of the grid, if there is one
    /// Returns whether light probes hold the light between surfaces.
    bool has_probe_light() const { return indirect == Indirect::captures; }
    bool uses_probes() const { return has_probe_light() || occlusion == Occlusion::captures; }
};

/// How mirrors of other techniques show a mirror.
struct OtherMirrorKnobs {
    /// Edge of the capture by which they show it, texels (`capture`); none: `capture=none`, or the
    /// technique has no such knob.
    std::optional<std::uint32_t> face;
    bool is_black = false; ///< capture=none
};

struct SharedKnobs {
    ShadowKnobs shadow = {};
    CaptureKnobs capture = {};
    SearchKnobs search = {};
    RoughKnobs rough = {};
    LightKnobs light = {};
    OtherMirrorKnobs others = {};
    std::uint32_t refract = shared::kRefractAuto; ///< how light passes glass
};

SharedKnobs read_knobs(const KnobSettings& settings);

} // namespace catoptric::reflect
