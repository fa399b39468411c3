#pragma once

#include "reflect/technique.hpp"

#include <map>
#include <span>
#include <vector>

/// Reflections of rough surfaces that are looked up in captures.
namespace catoptric::reflect {

/// Filtered levels of all captures of a frame, for each way of filtering that its mirrors use.
class RoughLevels {
public:
    /// Declares the images of the levels. `knobs`: of each mirror, from 0. Declares nothing if no
    /// mirror is rough, or `captures` is null.
    RoughLevels(graph::Graph& graph, const render::FrameInputs& inputs,
                std::shared_ptr<const render::MirrorCaptures> captures,
                const std::vector<KnobsSharedByTechniques>& knobs);

    /// Makes the shader `look` of these mirrors look rough surfaces up in the captures, as the
    /// knobs `rough`, `law` and `rays` say. `before`: in the captures of the frame before, for
    /// passes that are declared before add_passes. Does nothing if all these mirrors are smooth, or
    /// the shader has no captures.
    void add_rough_lookup_mirrors(graph::Graph& graph, std::span<const std::uint32_t> mirrors,
                                  const KnobsSharedByTechniques& knobs, render::MirrorShader& look,
                                  bool before = false) const;

    /// Declares the passes that compute the levels of captures that differ from the frame before:
    /// at most two for each way of filtering. Call it after the captures' passes.
    void add_passes(graph::Graph& graph) const;

private:
    /// A way of filtering: KnobsSharedByTechniques::rough, and KnobsSharedByTechniques::taps if
    /// that filters by the lobe.
    struct LevelFilterKind {
        KnobsSharedByTechniques::RoughMirrorLookup rough =
            KnobsSharedByTechniques::RoughMirrorLookup::none;
        std::uint32_t taps = 0;
        auto operator<=>(const LevelFilterKind&) const = default;
    };
    struct FilteredCaptures {
        std::vector<graph::ImageHandle> levels; ///< one image for each array of captures
        std::vector<bool> is_read; ///< by mirror: whether a rough surface may look into its capture
    };
    static LevelFilterKind level_filter_from_knobs(const KnobsSharedByTechniques& knobs);
    void add_passes_of_level_filter(graph::Graph& graph, const LevelFilterKind& filter,
                                    const FilteredCaptures& filtered) const;

    const render::FrameInputs& level_frame_inputs_;
    std::shared_ptr<const render::MirrorCaptures> captures_;
    std::map<LevelFilterKind, FilteredCaptures> filtered_;
};

} // namespace catoptric::reflect
