// Hierarchical search: the reflected ray, seen from the capture's centre, is an arc; on each face of the
// cube a straight line. It is followed through the cells of a pyramid that bounds the captured distance
// from both sides. A cell in which the ray stays in front of everything, or behind everything, is passed in
// one step; any other is opened, down to texels, where the distance itself decides.
//
// What is guaranteed, for the captured distance as a bilinear lookup shows it (a surface that is a function
// of the direction), barring rounding:
// - A HIT is a point where the ray goes from before that surface to behind it, no silhouette is there, and
//   up to it the ray was in sight of the centre. So it is the first such point: no cell is passed in which
//   the ray could change sides, because a cell's bounds include the ring of one texel around it that
//   bilinear lookups mix in, across the edges of faces too. Two changes inside one texel cancel unseen.
// - A MISS is a ray that stays in sight of the centre and leaves where nothing was captured.
// - Everything else is UNKNOWN: the ray went behind a silhouette, began behind something, or took more than
//   kMaxVisits cells. If it came back into sight, the direction is that of a later crossing. Otherwise what
//   was last seen beside the silhouette is taken to go on behind it: a surface is looked up there, and
//   where nothing was, the ray leaves along its own direction and sees nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CONTINUE
#include "lib/probe.glsl"
#include "reflect/pyramid.glsl"
#include "reflect/silhouette.glsl"

layout(set = 0, binding = 20) uniform WHOLE_FACES(bounds);

// A driver that stops an invocation's loops does it after 65,535 turns.
const int kMaxVisits = 4096;
const int kRefinements = 3;
const int kBelowTop = 3; // where it begins; measured, one level more or less costs little
// Distances and bounds are each off by a few roundings.
const float kOutwards = 1.0 + 1.0 / 1048576.0;
// Below this bend, a texel of the largest cube on its face, the arc is one direction.
const float kOneDirection = 1.0 / 16384.0;
const float kNever = 2.0; // after the arc's end

// Points offset + t direction of the ray, by s = t / (size + t) in [0, 1]: their directions are those of
// from + s * bend, so every plane through the centre is met where a linear function of s is zero.
struct Arc {
    vec3 from;   // unit
    vec3 bend;   // unit direction of the ray - from
    float size;  // distance of the ray's start from the centre
    float turn;  // where the ray is nearest to the centre
    float least; // and how near
};

// The arc on one face, in the coordinates of cube_coordinates.
struct Line {
    int face;
    vec3 from;
    vec3 bend;
    ivec2 ahead; // -1, 0, 1: where the line goes
};

vec3 direction_at(Arc arc, float s) { return arc.from + s * arc.bend; }

// At the end it is infinite: to be asked for before.
float distance_at(Arc arc, float s) { return arc.size * length(direction_at(arc, s)) / (1.0 - s); }

// Positive behind what was captured, `captured` away; distance behind it times 1 - s, which is about linear.
float depth_at(Arc arc, float s, float captured) {
    return is_miss(captured) ? -kLargest : arc.size * length(direction_at(arc, s)) - captured * (1.0 - s);
}

Line line_on(int face, Arc arc) {
    vec3 from = cube_coordinates(face, arc.from), bend = cube_coordinates(face, arc.bend);
    return Line(face, from, bend, ivec2(sign(bend.xy * from.z - from.xy * bend.z)));
}

// The texel that holds the line's point.
ivec2 texel_at(Line line, float s, int face) {
    vec3 at = line.from + s * line.bend;
    return ivec2(clamp(floor((at.xy / at.z * 0.5 + 0.5) * float(face)), vec2(0), vec2(face - 1)));
}

// Where on the arc the line passes x (or y) = border ahead of it; kNever if it ends before that.
float passes(float from, float bend, float from_z, float bend_z, int ahead, float border, float s) {
    float before = from - border * from_z, towards = bend - border * bend_z;
    if (ahead == 0 || !(towards * float(ahead) > 0.0)) return kNever;
    return max(s, -before / towards);
}

// Where the line leaves a cell, by x and by y.
vec2 leaves(Line line, ivec2 first, ivec2 end, int face, float s) {
    vec2 border = vec2(line.ahead.x > 0 ? end.x : first.x, line.ahead.y > 0 ? end.y : first.y) / float(face) * 2.0 - 1.0;
    return vec2(passes(line.from.x, line.bend.x, line.from.z, line.bend.z, line.ahead.x, border.x, s),
                passes(line.from.y, line.bend.y, line.from.z, line.bend.z, line.ahead.y, border.y, s));
}

struct Walk {
    Line line;
    ivec2 texel; // where it is
    int level;   // of the cell that is looked at next, 0 for the texel itself
    float s;
};

ivec2 cell_first(Walk walk) { return walk.texel >> walk.level << walk.level; }
ivec2 cell_end(Walk walk, int face) { return min(cell_first(walk) + (1 << walk.level), ivec2(face)); }

// On to the texel behind the border that the line passes first, on the next face where the face ends; one
// level up where that is in another cell of the level above.
void advance(inout Walk walk, Arc arc, vec2 leave, int face) {
    int axis = leave.x <= leave.y ? 0 : 1, other = 1 - axis;
    ivec2 first = cell_first(walk), end = cell_end(walk, face);
    walk.s = min(leave[axis], 1.0);
    int ahead = walk.line.ahead[axis];
    int next = ahead > 0 ? end[axis] : first[axis] - 1;
    int top = top_level(face);
    if (next < 0 || next >= face) {
        vec3 edge = vec3(0);
        edge[axis] = float(ahead);
        walk.line = line_on(cube_face(cube_direction(walk.line.face, edge)), arc);
        walk.texel = texel_at(walk.line, walk.s, face);
        walk.level = min(walk.level + 1, top);
        return;
    }
    int beside = clamp(texel_at(walk.line, walk.s, face)[other], first[other], end[other] - 1);
    if (next >> (walk.level + 1) != first[axis] >> (walk.level + 1)) walk.level = min(walk.level + 1, top);
    walk.texel[axis] = next;
    walk.texel[other] = beside;
}

uint packed_bounds(uint mirror, ivec3 place) {
#define PACKED(i) texelFetch(WHOLE_FACES_OF(bounds, i), place, 0).r
    RETURN_OF_ARRAY(mirror, PACKED)
}

// Least and largest captured distance in the cell; infinite as in the pyramid.
vec2 cell_bounds(Walk walk, uint mirror, int face) {
    ivec2 cell = walk.texel >> walk.level;
    uint both = packed_bounds(mirror, ivec3(level_column(face, walk.level) + cell.x, cell.y,
                                            int(first_face_of(mirror)) + walk.line.face));
    return unpackHalf2x16(both) * stored_unit_of(mirror);
}

// Whether the ray cannot change sides in the cell, which it leaves at s = end.
bool is_passed(Arc arc, vec2 bound, float s, float end) {
    if (isinf(bound.x)) return true;
    float enters = distance_at(arc, s);
    float farthest = end < 1.0 ? max(enters, distance_at(arc, end)) : kLargest;
    float nearest = s < arc.turn && arc.turn < end ? arc.least : min(enters, farthest);
    return farthest * kOutwards < bound.x || nearest > bound.y * kOutwards;
}

// The crossing between two points of the arc, before and behind the surface, by false position.
Lookup refined(uint mirror, Arc arc, float before, float behind, float depth_before, float depth_behind, uint state) {
    float residual = 0.0;
    vec3 direction;
    for (int i = 0; i < kRefinements; ++i) {
        float s = mix(before, behind, depth_before / (depth_before - depth_behind));
        direction = normalize(direction_at(arc, s));
        float captured = captured_distance(mirror, direction);
        float depth = depth_at(arc, s, captured);
        residual = abs(depth) / (arc.size * length(direction_at(arc, s)));
        if (depth < 0.0) {
            before = s, depth_before = depth;
            depth_behind *= 0.5; // Illinois: neither end stays for ever
        } else {
            behind = s, depth_behind = depth;
            depth_before *= 0.5;
        }
    }
    return Lookup(direction, state, min(residual, 1.0), 0.0);
}

Arc arc_of(vec3 offset, vec3 direction) {
    Arc arc;
    arc.size = length(offset);
    arc.from = arc.size > 0.0 ? offset / arc.size : direction;
    arc.bend = direction - arc.from;
    float t = max(-dot(offset, direction), 0.0);
    arc.turn = arc.size > 0.0 ? t / (arc.size + t) : 0.0;
    arc.least = length(offset + direction * t);
    return arc;
}

// Past cells in which nothing can happen, up to a texel or to the arc's end.
void pass_cells(inout Walk walk, inout int visits, Arc arc, uint mirror, int face) {
    bool goes_on = walk.level > 0; // it is before the arc's end
    do { // loops ask at their end: see lib/trace.glsl
        if (goes_on) {
            ++visits;
            vec2 leave = leaves(walk.line, cell_first(walk), cell_end(walk, face), face, walk.s);
            float end = min(min(leave.x, leave.y), 1.0);
            if (is_passed(arc, cell_bounds(walk, mirror, face), walk.s, end))
                advance(walk, arc, leave, face);
            else
                --walk.level;
        }
        goes_on = walk.level > 0 && walk.s < 1.0 && visits < kMaxVisits;
    } while (goes_on);
}

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    Arc arc = arc_of(offset, direction);
    // Straight away from the centre, or through it.
    if (!(length(arc.bend) > kOneDirection && length(direction + arc.from) > kOneDirection))
        return Lookup(direction, is_miss(captured_distance(mirror, direction)) ? kMiss : kHit, 0.0, 0.0);
    int face = distance_edge(mirror);
    Line line = line_on(cube_face(arc.from), arc);
    Walk walk = Walk(line, texel_at(line, 0.0, face), max(top_level(face) - kBelowTop, 1), 0.0);
    bool in_sight = depth_at(arc, 0.0, captured_distance(mirror, arc.from)) < 0.0;
    uint state = in_sight ? kHit : kUnknown;
    float last_in_sight = in_sight ? 0.0 : 1.0;
    bool nothing_beside = false; // the last silhouette
    int visits = 0;
    do {
        pass_cells(walk, visits, arc, mirror, face);
        if (walk.s >= 1.0) break;
        ++visits;
        vec2 leave = leaves(walk.line, walk.texel, walk.texel + 1, face, walk.s);
        float end = min(min(leave.x, leave.y), 1.0);
        float captured_end = captured_distance(mirror, direction_at(arc, end));
        float depth_end = depth_at(arc, end, captured_end);
        if (in_sight && depth_end >= 0.0) {
            float captured = captured_distance(mirror, direction_at(arc, walk.s));
            float depth = min(depth_at(arc, walk.s, captured), 0.0);
            uint between = what_is_between(mirror, normalize(direction_at(arc, walk.s)), normalize(direction_at(arc, end)),
                                           inverse(captured), inverse(captured_end));
            if (between != kSilhouette)
                return refined(mirror, arc, walk.s, end, depth, depth_end, between == kEnds ? kUnknown : state);
            state = kUnknown;
            nothing_beside = is_miss(captured);
            last_in_sight = max(walk.s - 2.0 / (float(face) * length(arc.bend)), 0.0); // a texel before its ramp
        }
        in_sight = depth_end < 0.0;
        advance(walk, arc, leave, face);
    } while (walk.s < 1.0 && visits < kMaxVisits);
    if (walk.s < 1.0) return Lookup(normalize(direction_at(arc, walk.s)), kUnknown, 0.0, 0.0);
    if (in_sight) return Lookup(direction, state == kHit ? kMiss : kUnknown, 0.0, 0.0);
    if (nothing_beside) return Lookup(direction, kUnknown, 0.0, kLeaves);
    return Lookup(normalize(direction_at(arc, last_in_sight)), kUnknown, 0.0, 0.0);
}
#include "lib/mirror.glsl"
