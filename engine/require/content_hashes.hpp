#pragma once

#include "require/model.hpp"
#include "require/pieces.hpp"
#include "require/shadows.hpp"

#include <vector>

/// Of what captures and shadow maps show.
namespace catoptric::require {

/// Smaller than this part of how far it may be from the scene's origin, a thing may have a space of
/// its own on the device (render::kSmallPart), whose coming and going other things' shaders notice.
inline constexpr double kSmall = 0x1p-12;
/// Shadows on things, times captures, that are looked at one by one in a frame.
inline constexpr std::size_t kMostLandings = 1 << 17;

/// A face's stamp stands for: the epoch (all that has never moved, materials, environment, lights);
/// the mirror itself, for the capture's centre; and each mover, mirrors among them, whose box and
/// ball may meet the face or one of whose shadows may fall on something there. A shadow on a mover
/// is told by that mover where the caster stands still. Equal stamps, equal bytes, but for what
/// other mirrors show, as long as views do: near planes and a directional light's windows depend on
/// the nearest and the outermost things, which those who have the views know.
///
/// A capture whose mirror moved since the instant before gets one stamp of everything on all of its
/// faces, and so do all where more than kMostPairs of things would have to be looked at.
class ContentHashes {
public:
    /// After World::follow. O(movers * (lights * objects + walls)).
    void follow(const World& world, std::uint32_t shadow_edge);
    /// Of a mirror's six faces.
    struct Faces6 {
        std::uint64_t made_at = 0; ///< value of `changes_`
        std::array<std::uint64_t, 6> content_hashes{}, settings{};
        std::shared_ptr<const Pieces> pieces;
    };
    /// See MirrorNeeds. O(movers + landings), nothing where nothing has changed since it was asked
    /// last.
    const Faces6& of_faces(const World& world, std::size_t mirror);
    /// Movers that cast shadows.
    std::vector<Caster> casters(const World& world) const;

private:
    void add_up(const World& world, Faces6& faces, std::size_t mirror) const;

    std::vector<Faces6> mirrors_;
    std::vector<Landing> landings_;
    std::uint64_t changes_ = 1; ///< counts instants at which something changed
    std::uint64_t all_ = 0;     ///< of everything
    std::uint64_t epoch_ = 0, layout_ = 0;
    std::uint32_t shadow_edge_ = 0;
    bool is_much_ = false;
};

} // namespace catoptric::require
