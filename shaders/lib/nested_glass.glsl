// Solid bodies of glass that share space, in rays (Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced Images",
// 2002). A ray keeps the list of the bodies it is in. It is in the glass of the one with the highest rank
// (engine/scene/nested_glass.hpp). A surface that leaves this body the same is passed as if it were not there; any other
// bends light between the two glasses, or between glass and air. Other bodies of glass lie in air.
#ifndef CATOPTRIC_NESTED_GLASS_GLSL
#define CATOPTRIC_NESTED_GLASS_GLSL

layout(constant_id = HAS_NESTED_GLASS_CONSTANT) const uint has_nested_glass = 0u;

// The ranked bodies that a ray is in: a byte for each of up to four, 1 + the index of its MaterialParameters, with the
// lowest in the lowest byte; then zeros. Ranked bodies come first in the list of MaterialParameters, by falling rank.
uint path_bodies = 0u;

bool is_ranked_glass(uint detail) {
    return has_nested_glass != 0u && (read_material_parameters(detail).flags & kMaterialRankedFlag) != 0u;
}

uint without_body(uint bodies, uint detail) {
    uint rest = 0u, place = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        uint body = (bodies >> 8u * i) & 255u;
        if (body == 0u || body == detail + 1u) continue;
        rest |= body << place;
        place += 8u;
    }
    return rest;
}

// Of five bodies, the one with the lowest rank is forgotten.
uint with_body(uint bodies, uint detail) {
    uint others = without_body(bodies, detail), place = 0u;
    while (place < 24u && ((others >> place) & 255u) != 0u && ((others >> place) & 255u) < detail + 1u) place += 8u;
    uint higher = (1u << place) - 1u;
    return (others & higher) | ((detail + 1u) << place) | (place == 24u ? 0u : (others & ~higher) << 8u);
}

bool is_in_ranked_glass(uint bodies) { return bodies != 0u; }
MaterialParameters read_glass_around(uint bodies) { return read_material_parameters((bodies & 255u) - 1u); }
bool are_in_same_glass(uint bodies, uint others) { return (bodies & 255u) == (others & 255u); }

// The bodies before and behind a surface of ranked glass. A ray that leaves a body which it never entered started in it.
struct BodiesAtSurface {
    uint before;
    uint behind;
};
BodiesAtSurface find_bodies_at_surface(uint detail, vec3 direction, vec3 outwards) {
    if (!is_inside_glass(detail, direction, outwards)) return BodiesAtSurface(path_bodies, with_body(path_bodies, detail));
    uint before = with_body(path_bodies, detail);
    return BodiesAtSurface(before, without_body(before, detail));
}

// Returns the share of light that passes a way through the glass that the ray is in.
vec3 share_through_bodies(uint bodies, float way) {
    return is_in_ranked_glass(bodies) ? exp(-read_glass_around(bodies).absorption * way) : vec3(1);
}

#endif
