#pragma once

#include "scene/scene.hpp"

#include <array>

namespace catoptric::stress {

/// A room whose walls cannot be confused: six colours, and on each wall a letter F in a colour of
/// its own, so that a face that is swapped, turned or mirrored shows the wrong thing.
struct GlyphRoom {
    dvec3 lo{-3, -2, -4}, hi{5, 6, 3};
    dvec3 ball{0.7, 0.9, -0.6};
    dvec3 centre; ///< of the capture: of the bounds of the ball's mesh, which is no sphere

    GlyphRoom();

    static vec3 wall_colour(int face) {
        return vec3(0.125f * static_cast<float>(face + 1), 0.25f, 0.0f);
    }
    static vec3 glyph_colour(int face) {
        return vec3(0.0f, 0.125f * static_cast<float>(face + 1), 1.0f);
    }

    /// Strokes of the F in shares of the wall's two axes, (first + 1) % 3 and (first + 2) % 3 of
    /// the face's own: an upright and two arms of different length, off the middle.
    struct Stroke {
        double u0, u1, v0, v1;
    };
    static constexpr std::array<Stroke, 3> kStrokes{
        {{.30, .40, .20, .80}, {.40, .70, .70, .80}, {.40, .55, .45, .55}}};

    /// What a ray from the mirror's centre along `direction` meets.
    struct Seen {
        int face;
        bool glyph;
        double distance; ///< world units
        double
            margin; ///< angle-like distance to the next edge of wall or stroke, shares of the wall
    };
    Seen look(dvec3 direction) const;

    /// The point of a wall at shares u, v of its two axes.
    dvec3 place(int face, double u, double v) const;

    static vec3 colour(const Seen& seen) {
        return seen.glyph ? glyph_colour(seen.face) : wall_colour(seen.face);
    }

    /// Walls, letters (cut out of the walls, so that no two things lie in one place) and the
    /// mirror.
    scene::Scene scene() const;
};

} // namespace catoptric::stress
