#pragma once

#include "require/frustum.hpp"
#include "require/world.hpp"

#include <vector>

/// Finds which mirrors the camera and other mirrors can see.
namespace catoptric::require {

/// Largest number of pairs of objects that are tested for visibility per frame. With more pairs,
/// the rules assume the safe answer without a test.
inline constexpr std::size_t kMaxVisibilityPairs = 1 << 14;

/// Reason why the camera does not see a mirror.
struct UnseenReason {
    enum class Cause { outside, hidden_from_camera, hidden, empty };
    Cause why = Cause::outside;
    std::size_t wall = 0; ///< index of the wall object that hides the mirror
};

/// Returns why the camera does not see a mirror. The result is none if its bounds are in the
/// picture and no wall stands in front of them.
std::optional<UnseenReason> find_unseen_reason(const VisibilityScene& world,
                                               const PictureFrustum& picture, std::size_t mirror);

/// Returns whether a mirror's mesh has few enough triangles to be tested one by one in each frame.
bool has_few_triangles(const scene::Mesh& mesh);
/// Returns false if no triangle of the mirror is in the picture, though its bounds may be. Returns
/// true for a mesh that is not tested. An exact sphere is tested as a ball.
bool may_picture_show(const PictureFrustum& picture, const VisibilityScene& world,
                      std::size_t mirror, const scene::Scene& now);

/// Finds which mirrors can see each other. The results for objects that did not move are kept from
/// one instant to the next.
class MirrorVisibility {
public:
    /// Takes over an instant, after VisibilityScene::update. O(1) if no mirror has moved;
    /// O(mirrors * walls) for each mirror that has. With more than kMaxVisibilityPairs pairs, moved
    /// mirrors are assumed to see all mirrors and to be seen by all.
    void update(const VisibilityScene& world);

    /// Returns whether a ray from some point of mirror `viewer` may reach `target`.
    bool may_reach(const VisibilityScene& world, std::size_t viewer, std::size_t target);
    /// Returns whether the capture of `viewer`, made at the centre of its bounds, may show
    /// `target`.
    bool may_show(const VisibilityScene& world, std::size_t viewer, std::size_t target);
    /// Returns whether any answer about `viewer` may differ from the previous instant.
    bool has_changed(std::size_t viewer) const { return changed_[viewer]; }

private:
    enum : std::uint8_t { kReachesFlag = 1, kShowsFlag = 2 };
    /// One bit per wall: whether a box lies wholly in front of the wall, or wholly behind it.
    struct WallSides {
        std::uint32_t front = 0, back = 0;
    };
    struct FacingSides {
        WallSides box, centre;
    };
    WallSides wall_sides(const VisibilityScene& world, const Bounds<double>& box) const;
    FacingSides facing_sides(const VisibilityScene& world, std::size_t mirror) const;
    void update_row(const VisibilityScene& world, std::size_t viewer);
    std::uint8_t classify_visibility(const VisibilityScene& world, std::size_t viewer,
                                     std::size_t target) const;

    std::uint64_t layout_ = 0;
    std::size_t count_ = 0;
    std::vector<FacingSides> places_;
    std::uint32_t two_sided_ = 0;                 ///< bits of walls that hide from both sides
    std::vector<std::vector<std::uint8_t>> rows_; ///< answers by viewer; empty: not computed yet
    std::vector<bool> changed_;
};

} // namespace catoptric::require
