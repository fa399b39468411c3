#pragma once

#include "require/model.hpp"
#include "require/pieces.hpp"
#include "require/shadows.hpp"

#include <vector>

namespace catoptric::require {

/// An object smaller than this part of its distance from the scene's origin loses half of a float's
/// digits, and may be stored in object space on the device (render::is_small_for_distance). Shaders
/// contain the code for object space only if some object needs it. The first such object therefore
/// changes the shaders of all objects.
inline constexpr double kSmallObjectRatio = 0x1p-12;
/// Largest number of tests per frame of whether a capture shows the place where a mover's shadow
/// falls.
inline constexpr std::size_t kMaxShadowReceiverTests = 1 << 17;

/// Content hashes of the faces of captures. The hash of a face stands for:
/// - the static content hash: all objects that never moved, materials, environment and lights;
/// - the mirror itself, because it places the capture's centre;
/// - each mover, including mirrors, whose box and ball may meet the face;
/// - each mover whose shadow may fall on an object in the face. If only the receiver moves, the
///   receiver's own hash covers the change.
///
/// Equal hashes stand for equal bytes, except for the contents of other mirrors, while the views
/// stay the same. The hashes do not cover views: near planes and the windows of a directional light
/// depend on the nearest and outermost objects. The owner of the views must compare these.
///
/// A capture whose mirror moved since the previous instant gets one hash of everything on all its
/// faces. All captures do if more than kMaxVisibilityPairs pairs of objects would have to be
/// tested.
class ContentHashes {
public:
    /// Takes over an instant, after VisibilityScene::update. O(movers * (lights * objects
    /// + walls)).
    void update(const VisibilityScene& world, std::uint32_t shadow_edge, bool has_soft_shadows);
    /// Content hashes of the six faces of a mirror's capture.
    struct FaceHashes {
        std::uint64_t made_at = 0; ///< value of `changes_` for which the hashes were computed
        std::array<std::uint64_t, 6> content_hashes{}, still_hashes{};
        std::shared_ptr<const MovingParts> pieces;
    };
    /// Takes O(movers + receivers of shadows), or O(1) if nothing has changed since the last call.
    const FaceHashes& face_hashes(const VisibilityScene& world, std::size_t mirror);
    std::vector<ShadowCaster> shadow_casters(const VisibilityScene& world) const;

private:
    void combine_hashes(const VisibilityScene& world, FaceHashes& faces, std::size_t mirror) const;

    std::vector<FaceHashes> mirrors_;
    std::vector<ShadowReceiver> receivers_;
    std::uint64_t changes_ = 1; ///< counts instants at which something changed
    std::uint64_t all_ = 0;     ///< content hash of the whole scene
    std::uint64_t static_hash_ = 0, layout_ = 0;
    std::uint32_t shadow_edge_ = 0;
    bool has_soft_shadows_ = false;
    bool is_much_ = false;
};

} // namespace catoptric::require
