#include "stress/glyph_room.hpp"

#include "scene/build.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace catoptric::stress {

namespace {

void add_wall_cell(scene::Mesh& mesh, const LetterRoom& room, int face,
                   const LetterRoom::Stroke& cell) {
    const scene::Mesh quad = scene::quad(
        "", room.wall_point(face, cell.u0, cell.v0), room.wall_point(face, cell.u1, cell.v0),
        room.wall_point(face, cell.u1, cell.v1), room.wall_point(face, cell.u0, cell.v1));
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), quad.positions.begin(), quad.positions.end());
    mesh.normals.insert(mesh.normals.end(), quad.normals.begin(), quad.normals.end());
    for (const uvec3& triangle : quad.triangles) mesh.triangles.push_back(triangle + first);
}

/// Adds a wall as a grid along the edges of the strokes. Cells inside a stroke form one mesh, the
/// others another.
void add_letter_wall(scene::Scene& scene, const LetterRoom& room, int face) {
    const std::array<double, 6> us{0, .30, .40, .55, .70, 1};
    const std::array<double, 7> vs{0, .20, .45, .55, .70, .80, 1};
    scene::Mesh meshes[2]{{.name = "wall"}, {.name = "glyph"}};
    for (std::size_t i = 0; i + 1 < us.size(); ++i)
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
            const double um = (us[i] + us[i + 1]) / 2, vm = (vs[j] + vs[j + 1]) / 2;
            const bool inked = std::ranges::any_of(
                LetterRoom::kStrokes, [&](const LetterRoom::Stroke& s) {
                    return um > s.u0 && um < s.u1 && vm > s.v0 && vm < s.v1;
                });
            add_wall_cell(meshes[inked], room, face, {us[i], us[i + 1], vs[j], vs[j + 1]});
        }
    const auto glowing = [&](const char* name, const vec3& colour) {
        return add_material(scene, {.name = name, .emission = colour, .two_sided = true});
    };
    add_mesh(scene, std::move(meshes[0]), glowing("wall", LetterRoom::wall_colour(face)));
    add_mesh(scene, std::move(meshes[1]), glowing("glyph", LetterRoom::letter_colour(face)));
}

} // namespace

LetterRoom::LetterRoom() {
    const scene::Scene made = make_scene();
    centre = scene::bounds(made, made.objects.back()).centre();
}

LetterRoom::WallPoint LetterRoom::seen_point(dvec3 direction) const {
    WallPoint seen{0, false, std::numeric_limits<double>::infinity(), 1};
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

dvec3 LetterRoom::wall_point(int face, double u, double v) const {
    const int axis = face / 2;
    dvec3 point;
    point[axis] = (face % 2 ? lo : hi)[axis];
    point[(axis + 1) % 3] = glm::mix(lo[(axis + 1) % 3], hi[(axis + 1) % 3], u);
    point[(axis + 2) % 3] = glm::mix(lo[(axis + 2) % 3], hi[(axis + 2) % 3], v);
    return point;
}

scene::Scene LetterRoom::make_scene() const {
    scene::Scene scene{.name = "glyphs"};
    for (int face = 0; face < 6; ++face) add_letter_wall(scene, *this, face);
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    add_ball(scene, "ball", mirror, ball, 0.5);
    scene.cameras.push_back({.eye = ball + dvec3(0, 0, -2), .target = ball});
    return scene;
}

} // namespace catoptric::stress
