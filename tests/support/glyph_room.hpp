#pragma once

#include "support/scenes.hpp"

#include <algorithm>
#include <limits>

/// A room whose walls cannot be confused: six colours, and on each wall a letter F in a colour of its
/// own, so that a face that is swapped, turned or mirrored shows the wrong thing.
namespace test {

struct GlyphRoom {
    dvec3 lo{-3, -2, -4}, hi{5, 6, 3};
    dvec3 ball{0.7, 0.9, -0.6};
    dvec3 centre; ///< of the capture: of the bounds of the ball's mesh, which is no sphere

    GlyphRoom() {
        const scene::Scene made = scene();
        centre = scene::bounds(made, made.objects.back()).centre();
    }

    static vec3 wall_colour(int face) { return vec3(0.125f * static_cast<float>(face + 1), 0.25f, 0.0f); }
    static vec3 glyph_colour(int face) { return vec3(0.0f, 0.125f * static_cast<float>(face + 1), 1.0f); }

    /// Strokes of the F in shares of the wall's two axes, (first + 1) % 3 and (first + 2) % 3 of the
    /// face's own: an upright and two arms of different length, off the middle.
    struct Stroke {
        double u0, u1, v0, v1;
    };
    static constexpr std::array<Stroke, 3> kStrokes{{{.30, .40, .20, .80}, {.40, .70, .70, .80}, {.40, .55, .45, .55}}};

    /// What a ray from the mirror's centre along `direction` meets.
    struct Seen {
        int face;
        bool glyph;
        double distance; ///< world units
        double margin;   ///< angle-like distance to the next edge of wall or stroke, shares of the wall
    };
    Seen look(dvec3 direction) const {
        Seen seen{0, false, std::numeric_limits<double>::infinity(), 1};
        for (int face = 0; face < 6; ++face) {
            const int axis = face / 2;
            const double t = ((face % 2 ? lo : hi)[axis] - centre[axis]) / direction[axis];
            if (t > 0 && t < seen.distance) seen.face = face, seen.distance = t;
        }
        const dvec3 place = (centre + seen.distance * direction - lo) / (hi - lo);
        seen.distance *= glm::length(direction);
        const double u = place[(seen.face / 2 + 1) % 3], v = place[(seen.face / 2 + 2) % 3];
        seen.margin = std::min({u, 1 - u, v, 1 - v});
        for (const Stroke& s : kStrokes) {
            const double inside = std::min({u - s.u0, s.u1 - u, v - s.v0, s.v1 - v});
            seen.glyph = seen.glyph || inside > 0;
            seen.margin = std::min(seen.margin, std::abs(inside));
        }
        return seen;
    }

    /// The point of a wall at shares u, v of its two axes.
    dvec3 place(int face, double u, double v) const {
        const int axis = face / 2;
        dvec3 point;
        point[axis] = (face % 2 ? lo : hi)[axis];
        point[(axis + 1) % 3] = glm::mix(lo[(axis + 1) % 3], hi[(axis + 1) % 3], u);
        point[(axis + 2) % 3] = glm::mix(lo[(axis + 2) % 3], hi[(axis + 2) % 3], v);
        return point;
    }

    vec3 colour(const Seen& seen) const { return seen.glyph ? glyph_colour(seen.face) : wall_colour(seen.face); }

    /// Walls, letters (cut out of the walls, so that no two things lie in one place) and the mirror.
    scene::Scene scene() const {
        scene::Scene scene{.name = "glyphs"};
        for (int face = 0; face < 6; ++face) {
            const std::size_t wall = add_material(scene, {.name = "wall", .emission = wall_colour(face)});
            const std::size_t glyph = add_material(scene, {.name = "glyph", .emission = glyph_colour(face)});
            add_wall(scene, face, wall, glyph);
        }
        const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
        add_ball(scene, "ball", mirror, ball, 0.5);
        scene.cameras.push_back({.eye = ball + dvec3(0, 0, -2), .target = ball});
        return scene;
    }

private:
    /// A grid of the strokes' edges: the cells that a stroke covers in one mesh, the others in another.
    void add_wall(scene::Scene& scene, int face, std::size_t wall, std::size_t glyph) const {
        const std::array<double, 6> us{0, .30, .40, .55, .70, 1};
        const std::array<double, 7> vs{0, .20, .45, .55, .70, .80, 1};
        scene::Mesh meshes[2]{{.name = "wall"}, {.name = "glyph"}};
        for (std::size_t i = 0; i + 1 < us.size(); ++i)
            for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
                const double um = (us[i] + us[i + 1]) / 2, vm = (vs[j] + vs[j + 1]) / 2;
                const bool inked = std::ranges::any_of(kStrokes, [&](const Stroke& s) {
                    return um > s.u0 && um < s.u1 && vm > s.v0 && vm < s.v1;
                });
                add_cell(meshes[inked], face, {us[i], us[i + 1], vs[j], vs[j + 1]});
            }
        add_mesh(scene, std::move(meshes[0]), wall);
        add_mesh(scene, std::move(meshes[1]), glyph);
    }

    void add_cell(scene::Mesh& mesh, int face, const Stroke& cell) const {
        const scene::Mesh quad = scene::quad("", place(face, cell.u0, cell.v0), place(face, cell.u1, cell.v0),
                                             place(face, cell.u1, cell.v1), place(face, cell.u0, cell.v1));
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), quad.positions.begin(), quad.positions.end());
        mesh.normals.insert(mesh.normals.end(), quad.normals.begin(), quad.normals.end());
        for (const uvec3& triangle : quad.triangles) mesh.triangles.push_back(triangle + first);
    }
};

} // namespace test
