#pragma once

#include "reflect/technique.hpp"

#include <map>
#include <span>
#include <vector>

/// Filtered levels of captures, in which rough mirrors are looked up.
namespace catoptric::reflect {

/// Filtered levels of all captures of a frame, for each way of filtering that its mirrors use.
class RoughLevels {
public:
    /// Declares the images of the filtered levels. `knobs`: settings of each mirror, from 0.
    /// Declares nothing if no mirror is rough, or if `captures` is null.
    RoughLevels(graph::Graph& graph, const render::FrameInputs& inputs,
                std::shared_ptr<const render::MirrorCaptures> captures,
                const std::vector<SharedKnobs>& knobs);

    /// Changes the shader `look` of these mirrors, so that rough surfaces are looked up in captures
    /// by the knobs `rough`, `law` and `rays`. `before`: the look-ups read the captures of the
    /// previous frame, for passes that are declared before add_passes. Does nothing if all these
    /// mirrors are smooth, or if the shader has no captures.
    void add_lookup(graph::Graph& graph, std::span<const std::uint32_t> mirrors,
                    const SharedKnobs& knobs, render::MirrorShader& look,
                    bool before = false) const;

    /// Declares the passes that compute the filtered levels of captures that changed since the
    /// previous frame: at most two passes for each way of filtering. Call it after the captures'
    /// passes.
    void add_passes(graph::Graph& graph) const;

private:
    /// A way of filtering, and RoughKnobs::taps if that filters by the lobe.
    struct LevelFilter {
        RoughKnobs::Lookup rough = RoughKnobs::Lookup::none;
        std::uint32_t taps = 0;
        auto operator<=>(const LevelFilter&) const = default;
    };
    struct FilteredCaptures {
        std::vector<graph::ImageHandle> levels; ///< one image for each array of captures
        std::vector<bool> is_read; ///< for each mirror: whether a rough surface may look into the
                                   ///< mirror's capture
    };
    static LevelFilter filter_of(const SharedKnobs& knobs);
    void add_filter_passes(graph::Graph& graph, const LevelFilter& filter,
                           const FilteredCaptures& filtered) const;

    const render::FrameInputs& inputs_;
    std::shared_ptr<const render::MirrorCaptures> captures_;
    std::map<LevelFilter, FilteredCaptures> filtered_;
};

} // namespace catoptric::reflect
