#pragma once

#include "require/frustum.hpp"
#include "require/world.hpp"

#include <vector>

/// Who sees which mirror.
namespace catoptric::require {

/// Pairs of things that are looked at one by one in a frame; beyond that rules take the careful
/// answer for granted, which costs nothing.
inline constexpr std::size_t kMostPairs = 1 << 14;

/// Why the camera does not see a mirror.
struct Unseen {
    enum class Why { outside, hidden_from_camera, hidden, empty };
    Why why = Why::outside;
    std::size_t wall = 0; ///< object that hides it
};

/// Returns why the camera does not see a mirror: none if its bounds are in the picture and no wall
/// stands in front of them.
std::optional<Unseen> hidden_from_camera(const World& world, const Picture& picture,
                                         std::size_t mirror);

/// Whether a mirror's mesh has few enough triangles to be tested one by one in each frame.
bool is_tested(const scene::Mesh& mesh);
/// Returns false when no triangle of the mirror is in the picture, though its bounds may be. True
/// for a mesh that is not tested. An exact sphere is tested as a ball.
bool is_surface_in(const Picture& picture, const World& world, std::size_t mirror,
                   const scene::Scene& now);

/// Which mirrors can see which others, kept from one instant to the next.
class Sight {
public:
    /// After World::follow. O(1) where no mirror has moved; O(mirrors * walls) for one that has. Of
    /// more than kMostPairs pairs those that moved are taken to see all and to be seen by all.
    void follow(const World& world);

    /// From some place of mirror `viewer`, a ray may reach `target`.
    bool reaches(const World& world, std::size_t viewer, std::size_t target);
    /// The capture of `viewer`, made at the centre of its bounds, may show `target`.
    bool shows(const World& world, std::size_t viewer, std::size_t target);
    /// Some answer about `viewer` may be another than at the instant before.
    bool has_changed(std::size_t viewer) const { return changed_[viewer]; }

private:
    enum : std::uint8_t { kReaches = 1, kShows = 2 };
    /// A bit for each wall before, or behind, which something lies wholly.
    struct Sides {
        std::uint32_t front = 0, back = 0;
    };
    struct Place {
        Sides box, centre;
    };
    Sides sides_of(const World& world, const Bounds<double>& box) const;
    Place place_of(const World& world, std::size_t mirror) const;
    void look(const World& world, std::size_t viewer);
    std::uint8_t look_at(const World& world, std::size_t viewer, std::size_t target) const;

    std::uint64_t layout_ = 0;
    std::size_t count_ = 0;
    std::vector<Place> places_;
    std::uint32_t two_sided_ = 0;                 ///< walls
    std::vector<std::vector<std::uint8_t>> rows_; ///< of a viewer; empty: not asked yet
    std::vector<bool> changed_;
};

} // namespace catoptric::require
