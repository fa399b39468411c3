#pragma once

#include "scene/scene.hpp"

#include <array>

namespace catoptric::stress {

/// Room whose walls cannot be confused. It has six colours, and on each wall a letter F in its own
/// colour. A face that is swapped, turned or mirrored therefore shows a wrong colour.
struct LetterRoom {
    dvec3 lo{-3, -2, -4}, hi{5, 6, 3};
    dvec3 ball{0.7, 0.9, -0.6};
    /// Centre of the capture: that of the bounds of the ball's mesh, which is no exact sphere.
    dvec3 centre;

    LetterRoom();

    static vec3 wall_colour(int face) {
        return vec3(0.125f * static_cast<float>(face + 1), 0.25f, 0.0f);
    }
    static vec3 letter_colour(int face) {
        return vec3(0.0f, 0.125f * static_cast<float>(face + 1), 1.0f);
    }

    /// Stroke of the F, in shares of the wall's two axes. These are (first + 1) % 3 and (first + 2)
    /// % 3, where `first` is the face's own axis. The F has an upright and two arms of different
    /// length and lies off the centre.
    struct Stroke {
        double u0, u1, v0, v1;
    };
    static constexpr std::array<Stroke, 3> kStrokes{
        {{.30, .40, .20, .80}, {.40, .70, .70, .80}, {.40, .55, .45, .55}}};

    /// The wall point that a ray from the mirror's centre meets.
    struct WallPoint {
        int face;
        bool glyph;
        double distance; ///< world units
        /// Distance to the next edge of a wall or stroke as an angle would measure it, in shares of
        /// the wall.
        double margin;
    };
    WallPoint seen_point(dvec3 direction) const;

    /// Returns the point of a wall at shares u, v of its two axes.
    dvec3 wall_point(int face, double u, double v) const;

    static vec3 point_colour(const WallPoint& seen) {
        return seen.glyph ? letter_colour(seen.face) : wall_colour(seen.face);
    }

    /// Returns the scene of walls, letters and the mirror. The letters are cut out of the walls, so
    /// that no two surfaces coincide.
    scene::Scene make_scene() const;
};

} // namespace catoptric::stress
