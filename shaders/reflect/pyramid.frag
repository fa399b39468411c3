// Technique `pyramid`: hierarchical search. Seen from the capture's centre, the reflected ray is an arc, which is
// a straight line on each face of the cube map. The search follows this line through the cells of a pyramid that bounds
// the captured distance from both sides. A cell is passed in one step if the ray stays in front of all its surfaces, or
// behind all. Any other cell is opened, down to single texels, whose distances decide.
//
// The search guarantees the following, apart from rounding errors. The bilinearly interpolated captured distance is
// taken as the surface, a function of the direction.
// - A hit is a point at which the ray goes from the surface's front to its back, away from any silhouette. Up to this
//   point, the ray is in sight of the centre. A hit is the first such point, because no cell is passed in which the ray
//   could change sides. A cell's bounds include a ring of one texel around the cell, which bilinear lookups read, also
//   across the edges of faces. Two changes inside one texel cancel and are not found.
// - A miss is a ray that stays in sight of the centre and leaves where no surface was captured.
// - All other rays are unknown: they went behind a silhouette, started behind a surface, or took more than
//   kMaxCellVisits
//   cells. If the ray came back into sight, the lookup's direction is that of the next crossing. Otherwise, the surface
//   last seen beside the silhouette is assumed to continue behind the silhouette, and is looked up. If no surface was
//   captured beside the silhouette, the ray leaves along its own direction and sees the environment.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#define CONTINUE
#include "lib/probe.glsl"
#include "reflect/pyramid.glsl"
#include "reflect/silhouette.glsl"

layout(set = 0, binding = 20) uniform UINT_FACES(bounds);

// The most cells that a search visits. The software driver stops an invocation's loops after 65,535 iterations.
const int kMaxCellVisits = 4096;
const int kCrossingRefinements = 3;
// The level at which the search starts, counted from the pyramid's top. Measurements show that one level more or less
// costs little.
const int kStartLevelBelowTop = 3;
// The factor that widens comparisons of distances with bounds, since both have errors of a few roundings.
const float kOutwardRounding = 1.0 + 1.0 / 1048576.0;
// The length of RayArc::bend, one texel of the largest cube map, below which an arc counts as a single direction.
const float kMinArcAngle = 1.0 / 16384.0;
const float kAfterArcEnd = 2.0; // a parameter s after the arc's end

// The directions of a ray's points from the capture's centre. The point offset + t * direction has the parameter
// s = t / (size + t) in [0, 1]. Its direction is from + s * bend. Therefore the ray meets a plane through the centre
// where a linear function of s is zero.
struct RayArc {
    vec3 from;   // unit direction of the ray's start
    vec3 bend;   // unit direction of the ray, minus `from`
    float size;  // distance of the ray's start from the centre
    float turn;  // parameter s of the ray's point nearest to the centre
    float least; // distance of that point from the centre
};

// The part of an arc on one cube face, in the coordinates of cube_coordinates.
struct ArcOnCubeFace {
    int face;
    vec3 from;
    vec3 bend;
    ivec2 ahead; // signs of the line's direction in x and y: -1, 0 or 1
};

vec3 arc_direction_at(RayArc arc, float s) { return arc.from + s * arc.bend; }

// Returns the ray's distance from the centre at s < 1. At s = 1 the distance is infinite.
float arc_distance_at(RayArc arc, float s) { return arc.size * length(arc_direction_at(arc, s)) / (1.0 - s); }

// Returns the ray's distance minus the captured distance, times 1 - s, which is about linear in s. The result is
// positive if the ray is behind the captured surface.
float ray_depth_behind_surface(RayArc arc, float s, float captured) {
    return is_miss(captured) ? -kLargestFloat : arc.size * length(arc_direction_at(arc, s)) - captured * (1.0 - s);
}

ArcOnCubeFace project_arc_on_face(int face, RayArc arc) {
    vec3 from = cube_coordinates(face, arc.from), bend = cube_coordinates(face, arc.bend);
    return ArcOnCubeFace(face, from, bend, ivec2(sign(bend.xy * from.z - from.xy * bend.z)));
}

// Returns the texel that contains the line's point at s.
ivec2 texel_of_arc_point(ArcOnCubeFace line, float s, int face) {
    vec3 at = line.from + s * line.bend;
    return ivec2(clamp(floor((at.xy / at.z * 0.5 + 0.5) * float(face)), vec2(0), vec2(face - 1)));
}

// Returns the parameter s at which the line passes the border x = border, or y = border, ahead. Returns kAfterArcEnd if
// the line does not reach the border.
float arc_parameter_at_cell_border(float from, float bend, float from_z, float bend_z, int ahead, float border, float s) {
    float before = from - border * from_z, towards = bend - border * bend_z;
    if (ahead == 0 || !(towards * float(ahead) > 0.0)) return kAfterArcEnd;
    return max(s, -before / towards);
}

// Returns the parameters s at which the line leaves a cell through its x border and through its y border.
vec2 arc_parameters_leaving_cell(ArcOnCubeFace line, ivec2 first, ivec2 end, int face, float s) {
    vec2 border = vec2(line.ahead.x > 0 ? end.x : first.x, line.ahead.y > 0 ? end.y : first.y) / float(face) * 2.0 - 1.0;
    return vec2(arc_parameter_at_cell_border(line.from.x, line.bend.x, line.from.z, line.bend.z, line.ahead.x, border.x, s),
                arc_parameter_at_cell_border(line.from.y, line.bend.y, line.from.z, line.bend.z, line.ahead.y, border.y, s));
}

struct PyramidCellWalk {
    ArcOnCubeFace line;
    ivec2 texel; // current texel of the walk
    int level;   // level of the cell that is tested next; 0: the texel itself
    float s;     // current parameter on the arc
};

ivec2 low_corner_of_cell(PyramidCellWalk walk) { return walk.texel >> walk.level << walk.level; }
ivec2 high_corner_of_cell(PyramidCellWalk walk, int face) { return min(low_corner_of_cell(walk) + (1 << walk.level), ivec2(face)); }

// Advances the walk to the texel behind the cell border that the line passes first. At the end of a face, the walk
// moves to the next face. The level rises by one if the new texel is in another cell of the level above.
void advance_walk_to_next_cell(inout PyramidCellWalk walk, RayArc arc, vec2 leave, int face) {
    int axis = leave.x <= leave.y ? 0 : 1, other = 1 - axis;
    ivec2 first = low_corner_of_cell(walk), end = high_corner_of_cell(walk, face);
    walk.s = min(leave[axis], 1.0);
    int ahead = walk.line.ahead[axis];
    int next = ahead > 0 ? end[axis] : first[axis] - 1;
    int top = top_pyramid_level(face);
    if (next < 0 || next >= face) {
        vec3 edge = vec3(0);
        edge[axis] = float(ahead);
        walk.line = project_arc_on_face(cube_face(cube_direction(walk.line.face, edge)), arc);
        walk.texel = texel_of_arc_point(walk.line, walk.s, face);
        walk.level = min(walk.level + 1, top);
        return;
    }
    int beside = clamp(texel_of_arc_point(walk.line, walk.s, face)[other], first[other], end[other] - 1);
    if (next >> (walk.level + 1) != first[axis] >> (walk.level + 1)) walk.level = min(walk.level + 1, top);
    walk.texel[axis] = next;
    walk.texel[other] = beside;
}

uint read_packed_bounds(uint mirror, ivec3 place) {
#define PACKED(i) texelFetch(UINT_FACES_OF(bounds, i), place, 0).r
    count_distance_lookup();
    RETURN_OF_ARRAY(mirror, PACKED)
}

// Returns the least and the largest captured distance in the walk's cell, scene units. Infinities mean the same as in
// pack_distance_bounds.
vec2 read_cell_bounds(PyramidCellWalk walk, uint mirror, int face) {
    ivec2 cell = walk.texel >> walk.level;
    uint both = read_packed_bounds(mirror, ivec3(first_column_of_level(face, walk.level) + cell.x, cell.y,
                                            int(first_face_layer_of_mirror(mirror)) + walk.line.face));
    return unpackHalf2x16(both) * stored_distance_unit(mirror);
}

// Returns whether the ray stays on one side of all surfaces in a cell, which it leaves at s = end.
bool does_ray_stay_on_one_side(RayArc arc, vec2 bound, float s, float end) {
    if (isinf(bound.x)) return true;
    float enters = arc_distance_at(arc, s);
    float farthest = end < 1.0 ? max(enters, arc_distance_at(arc, end)) : kLargestFloat;
    float nearest = s < arc.turn && arc.turn < end ? arc.least : min(enters, farthest);
    return farthest * kOutwardRounding < bound.x || nearest > bound.y * kOutwardRounding;
}

// Finds the crossing of ray and surface between two points of the arc, in front of and behind the surface, by false
// position.
Lookup refine_crossing_by_false_position(uint mirror, RayArc arc, float before, float behind, float depth_before, float depth_behind, uint state) {
    float residual = 0.0;
    vec3 direction;
    for (int i = 0; i < kCrossingRefinements; ++i) {
        count_search_step();
        float s = mix(before, behind, depth_before / (depth_before - depth_behind));
        direction = normalize(arc_direction_at(arc, s));
        float captured = captured_distance(mirror, direction);
        float depth = ray_depth_behind_surface(arc, s, captured);
        residual = abs(depth) / (arc.size * length(arc_direction_at(arc, s)));
        if (depth < 0.0) {
            before = s, depth_before = depth;
            depth_behind *= 0.5; // Illinois variant of false position: halving makes both ends move
        } else {
            behind = s, depth_behind = depth;
            depth_before *= 0.5;
        }
    }
    return Lookup(direction, state, min(residual, 1.0), 0.0);
}

RayArc make_pyramid_arc(vec3 offset, vec3 direction) {
    RayArc arc;
    arc.size = length(offset);
    arc.from = arc.size > 0.0 ? offset / arc.size : direction;
    arc.bend = direction - arc.from;
    float t = max(-dot(offset, direction), 0.0);
    arc.turn = arc.size > 0.0 ? t / (arc.size + t) : 0.0;
    arc.least = length(offset + direction * t);
    return arc;
}

// Advances the walk past cells in which the ray cannot change sides, up to a texel to test or to the arc's end.
void skip_cells_without_crossing(inout PyramidCellWalk walk, inout int visits, RayArc arc, uint mirror, int face) {
    bool goes_on = walk.level > 0; // callers ensure that the walk is before the arc's end
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        if (goes_on) {
            ++visits;
            count_search_step();
            vec2 leave = arc_parameters_leaving_cell(walk.line, low_corner_of_cell(walk), high_corner_of_cell(walk, face), face,
                walk.s);
            float end = min(min(leave.x, leave.y), 1.0);
            if (does_ray_stay_on_one_side(arc, read_cell_bounds(walk, mirror, face), walk.s, end))
                advance_walk_to_next_cell(walk, arc, leave, face);
            else
                --walk.level;
        }
        goes_on = walk.level > 0 && walk.s < 1.0 && visits < kMaxCellVisits;
    } while (goes_on);
}

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    RayArc arc = make_pyramid_arc(offset, direction);
    // The ray's line passes through the centre, so that the ray's own direction is the only direction to look up.
    if (!(length(arc.bend) > kMinArcAngle && length(direction + arc.from) > kMinArcAngle))
        return Lookup(direction, is_miss(captured_distance(mirror, direction)) ? kMiss : kHit, 0.0, 0.0);
    int face = distance_edge(mirror);
    ArcOnCubeFace line = project_arc_on_face(cube_face(arc.from), arc);
    PyramidCellWalk walk = PyramidCellWalk(line, texel_of_arc_point(line, 0.0, face), max(top_pyramid_level(face) - kStartLevelBelowTop, 1), 0.0);
    bool in_sight = ray_depth_behind_surface(arc, 0.0, captured_distance(mirror, arc.from)) < 0.0;
    uint state = in_sight ? kHit : kUnknown;
    float last_in_sight = in_sight ? 0.0 : 1.0;
    bool nothing_beside = false; // whether no surface was captured beside the last silhouette
    int visits = 0;
    do {
        skip_cells_without_crossing(walk, visits, arc, mirror, face);
        if (walk.s >= 1.0) break;
        ++visits;
        count_search_step();
        vec2 leave = arc_parameters_leaving_cell(walk.line, walk.texel, walk.texel + 1, face, walk.s);
        float end = min(min(leave.x, leave.y), 1.0);
        float captured_end = captured_distance(mirror, arc_direction_at(arc, end));
        float depth_end = ray_depth_behind_surface(arc, end, captured_end);
        if (in_sight && depth_end >= 0.0) {
            float captured = captured_distance(mirror, arc_direction_at(arc, walk.s));
            float depth = min(ray_depth_behind_surface(arc, walk.s, captured), 0.0);
            uint between = classify_surface_between(mirror, normalize(arc_direction_at(arc, walk.s)), normalize(arc_direction_at(arc, end)),
                                           reciprocal_or_zero(captured), reciprocal_or_zero(captured_end));
            if (between != kSurfaceSilhouette)
                return refine_crossing_by_false_position(mirror, arc, walk.s, end, depth, depth_end, between == kSurfaceEnds
                    ? kUnknown : state);
            state = kUnknown;
            nothing_beside = is_miss(captured);
            // One texel before the steep texel of the silhouette.
            last_in_sight = max(walk.s - 2.0 / (float(face) * length(arc.bend)), 0.0);
        }
        in_sight = depth_end < 0.0;
        advance_walk_to_next_cell(walk, arc, leave, face);
    } while (walk.s < 1.0 && visits < kMaxCellVisits);
    if (walk.s < 1.0) return Lookup(normalize(arc_direction_at(arc, walk.s)), kUnknown, 0.0, 0.0);
    if (in_sight) return Lookup(direction, state == kHit ? kMiss : kUnknown, 0.0, 0.0);
    if (nothing_beside) return Lookup(direction, kUnknown, 0.0, kLeaves);
    return Lookup(normalize(arc_direction_at(arc, last_in_sight)), kUnknown, 0.0, 0.0);
}
#include "lib/mirror.glsl"
