// Traces rays through the BVH of engine/bvh/bvh.hpp in compute shaders.
// The including shader defines these macros before the include:
// BVH_NODES_BINDING and BVH_TRIANGLES_BINDING: the bindings in set 0. The specialisation constant bvh_in_storage reads
// nodes and triangles from storage buffers instead of texel buffers.
// TRACE_LOCAL_SIZE: the number of invocations of a work group, if it is not 64.
// TRACE_PRIVATE_STACK: puts the stack into a private array, for shader stages without shared memory.
// TRACE_SEES(object): returns false for objects that rays pass through.
// TRACE_BALLS: whether the BVH may hold spheres in place of triangles.
// TRACE_IS_THERE(stored triangle, object, barycentric, is shadow ray): returns false where rays of this kind pass a
// kBvhAlphaMasked triangle.
// TRACE_TINTS_SHADOWS: with tints_shadows, shadow rays call pass_triangle_of_glass or pass_sphere_of_glass where they meet
// kBvhTintsShadow triangles and spheres, and go on.
// Four choices make the walk fast on a processor: uniform texel buffers, the stack in shared memory, divergent lanes,
// and loops that test their condition at the end. The software driver jumps only at a loop's end, so it runs the body
// of a loop that tests first once more than needed. NAIVE selects storage buffers and a private stack, the obvious
// implementation, for a benchmark.
#ifndef CATOPTRIC_TRACE_GLSL
#define CATOPTRIC_TRACE_GLSL

#include "lib/constants.glsl"
#include "lib/math.glsl"
#include "lib/plain.glsl"
#include "lib/texels.glsl"
#include "lib/work.glsl"

#ifndef TRACE_LOCAL_SIZE
#define TRACE_LOCAL_SIZE 64
#endif
#ifndef TRACE_SEES
#define TRACE_SEES(object) true
#endif
#ifndef TRACE_BALLS
#define TRACE_BALLS false
#endif
#ifdef NAIVE
#define TRACE_PRIVATE_STACK
#endif
// Whether this lane stands for its subgroup. TRACE_COUNTS_LANES says that the shader may use subgroup operations.
#ifdef TRACE_COUNTS_LANES
#define IS_ELECTED subgroupElect()
#else
#define IS_ELECTED true
#endif

#ifdef NAIVE
const uint bvh_in_storage = 1u;
#else
layout(constant_id = BVH_IN_STORAGE_CONSTANT) const uint bvh_in_storage = 0u;
#endif
TEXEL_LIST(BVH_NODES_BINDING, bvh_nodes, vec4, samplerBuffer, bvh_in_storage != 0u)
TEXEL_LIST(BVH_TRIANGLES_BINDING, bvh_triangles, vec4, samplerBuffer, bvh_in_storage != 0u)
#ifdef TRACE_PRIVATE_STACK
#define STACK(i) stack[i]
#else
shared uint trace_stack[kBvhMaxStack * TRACE_LOCAL_SIZE];
#define STACK(i) trace_stack[(i) * TRACE_LOCAL_SIZE + gl_LocalInvocationIndex]
#endif

// The number of node visits and triangle tests of all rays of this invocation.
uint trace_steps = 0u;
// The node visits and the triangle tests, counted separately, and the number of times that this invocation stood for
// its subgroup in a node visit or a triangle test. The sum of the latter over all lanes is the number of visits and
// tests that subgroups executed, so nodes / node_lanes is the mean number of live lanes. These numbers are counted only
// if count_work is 1.
uint nodes_visited = 0u, triangles_tested = 0u, node_lanes = 0u, triangle_lanes = 0u;
// Whether some walk of this invocation stopped before its end, so that its answer is wrong. A walk stops at
// kMaxTraceSteps, or because the driver stops its loops. The software driver silently ends all loops of an invocation
// after 65,535 iterations, counted over the eight lanes that run together.
// The driver then ends the caller's loops, too, even if a lane's own walk was complete. A caller that loops over rays
// must therefore check that its own loop ran to its end.
bool trace_exhausted = false;
const uint kMaxTraceSteps = 60000u;

struct TraceHit {
    float t;
    vec3 barycentric; // weights of the corners a, b, c
    uint triangle;    // original number of the triangle
    uint object;
    uint place;  // stored index of the triangle, for read_triangle_corners; or kHitOnExactSphere
    uint inside; // record of the instance in whose object space the hit lies; 0: the hit is in scene units
};
const uint kHitOnExactSphere = 0xffffffffu; // TraceHit::place of a hit on the exact sphere of an instance

// 1: some objects are instances in object space (engine/bvh/tlas.hpp).
layout(constant_id = OWN_SPACES_CONSTANT) const uint object_spaces = 0u;
// The rounding error of the next ray's origin: the exact origin is origin + trace_low. Each walk resets it to 0.
vec3 trace_low = vec3(0);

ObjectPlacement read_placement(uint record) {
    uint i = 4u * record;
    return ObjectPlacement(bvh_nodes_at(i).xyz, bvh_nodes_at(i + 1u).xyz, bvh_nodes_at(i + 2u).xyz, bvh_nodes_at(i + 4u).xyz,
                 bvh_nodes_at(i + 5u).xyz, bvh_nodes_at(i + 6u).xyz, bvh_nodes_at(i + 3u).xyz, bvh_nodes_at(i + 7u).xyz);
}
// Returns the number that is added to the triangle numbers of an instance, given the instance's record.
uint triangle_number_offset(uint record) { return floatBitsToUint(bvh_nodes_at(4u * record + 2u).w) & kBvhIdMask; }
float object_space_sphere_radius(uint record) { return bvh_nodes_at(4u * record + 9u).w; }

// The state of a walk in one tree: the ray in the tree's coordinates, and the object, flags and number shift that
// replace those of an instance's triangles.
struct TreeWalkState {
    Ray ray;
    BoxTestRay boxes;
    TriangleTestRayShear shear;
    uint record; // record of the instance; 0: the walk is in the scene's own tree
    uint object, flags, shift;
};

// Returns the corners of a stored triangle, in scene units or in the object space of an instance.
void read_triangle_corners(uint place, out vec3 a, out vec3 b, out vec3 c) {
    a = bvh_triangles_at(3u * place).xyz;
    b = bvh_triangles_at(3u * place + 1u).xyz;
    c = bvh_triangles_at(3u * place + 2u).xyz;
}

#ifdef TRACE_TINTS_SHADOWS
// Takes note of the glass that a shadow ray passes. `record`: record of the instance, whose object space holds ray and glass.
// `corner`: number of the triangle in the list of corners. `facet`: normal of the triangle, of any length.
void pass_triangle_of_glass(uint record, Ray ray, uint object, uint corner, vec3 weights, vec3 facet, float t);
void pass_sphere_of_glass(Ray ray, uint object, vec3 centre, float radius, float t_max);

// Returns whether a triangle owns the points on its side from `a` to `b`. Of two triangles that share a side, in opposite
// directions, one does, and at most one of all those around a corner. Others would count a surface twice there. No triangle
// owns a corner that lies furthest of its neighbours along an axis: a ray exactly through it misses one surface.
bool owns_side(vec3 a, vec3 b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}
bool owns_point(vec3 a, vec3 b, vec3 c, vec3 weights) {
    return (weights.x != 0.0 || owns_side(b, c)) && (weights.y != 0.0 || owns_side(c, a)) && (weights.z != 0.0 || owns_side(a, b));
}
#endif

bool intersects_sphere(vec3 centre, float radius, Ray ray, float t_max, out float t) {
    return is_precision_rule_kept(kStableSphereRule) ? intersect_sphere_robustly(centre, radius, ray, t_max, t)
        : plain_sphere_test(centre, radius, ray, t_max, t);
}

// Intersects the ray with a stored triangle or sphere, and updates the best hit. If two hits have equal t, the lower
// original triangle number wins.
void intersect_stored_triangle(uint place, TreeWalkState walked, uint skipped_flags, inout TraceHit best, inout bool found) {
    Ray ray = walked.ray;
    vec4 a = bvh_triangles_at(3u * place);
    vec4 b = bvh_triangles_at(3u * place + 1u);
    vec4 c = bvh_triangles_at(3u * place + 2u);
    float t;
    vec3 weights;
    bool hit = is_precision_rule_kept(kWatertightRule) ? intersect_triangle_watertight(a.xyz, b.xyz, c.xyz, ray.origin, walked.shear, t, weights)
                                  : plain_triangle_test(a.xyz, b.xyz, c.xyz, ray, t, weights);
    uint triangle = floatBitsToUint(b.w) & kBvhIdMask;
    uint object = floatBitsToUint(a.w) & kBvhIdMask;
    uint flags = floatBitsToUint(c.w);
    if (TRACE_BALLS && (flags & kBvhSpherePrimitive) != 0u) {
        hit = intersects_sphere(a.xyz, b.x, ray, kLargestFloat, t);
        weights = vec3(1, 0, 0);
    }
    if (object_spaces != 0u && walked.record != 0u) {
        triangle += walked.shift;
        object = walked.object;
        flags = walked.flags;
    }
    uint skips = flags & skipped_flags;
    bool seen = (skips == 0u || (skips == kBvhOneSided && !hits_back_face(a.xyz, b.xyz, c.xyz, ray.direction))) &&
                triangle + 1u != ray.leaves && TRACE_SEES(object);
    bool nearer = t < best.t || (found && t == best.t && triangle < best.triangle);
#ifdef TRACE_TINTS_SHADOWS
    if (tints_shadows != 0u && (flags & kBvhTintsShadow) != 0u && (skipped_flags & kBvhCastsNoShadow) != 0u) {
        if (TRACE_BALLS && (flags & kBvhSpherePrimitive) != 0u) {
            if (seen) pass_sphere_of_glass(ray, object, a.xyz, b.x, best.t);
        } else if (hit && seen && nearer && owns_point(a.xyz, b.xyz, c.xyz, weights)) {
            pass_triangle_of_glass(walked.record, ray, object, triangle - walked.shift, normalise_barycentric(weights),
                                   cross(b.xyz - a.xyz, c.xyz - a.xyz), t);
        }
        return;
    }
#endif
#ifdef TRACE_IS_THERE
    if (masks != 0u && hit && seen && nearer && (flags & kBvhAlphaMasked) != 0u)
        seen = TRACE_IS_THERE(triangle - walked.shift, object, normalise_barycentric(weights), (skipped_flags & kBvhCastsNoShadow) != 0u);
#endif
    if (hit && seen && nearer) {
        best = TraceHit(t, weights, triangle, object, place, walked.record);
        found = true;
    }
}

bool intersect_traced_box(vec3 lo, vec3 hi, BoxTestRay ray, float t_max, out float t_near) {
    return is_precision_rule_kept(kBoxPaddingRule) ? intersect_box_slabs(lo, hi, ray, t_max, t_near)
        : plain_slab_test(lo, hi, ray, t_max, t_near);
}

// Intersects the ray with the two child boxes of a node. `first` is the word of the nearer child that the ray meets,
// `second` that of the other child. A word is kBvhEmptyChild if the ray misses the child.
void intersect_child_boxes(uint node, BoxTestRay boxes, float t_max, out uint first, out uint second) {
    vec4 lo_0 = bvh_nodes_at(4u * node);
    vec4 hi_0 = bvh_nodes_at(4u * node + 1u);
    vec4 lo_1 = bvh_nodes_at(4u * node + 2u);
    vec4 hi_1 = bvh_nodes_at(4u * node + 3u);
    float near_0, near_1;
    bool meets_0 = intersect_traced_box(lo_0.xyz, hi_0.xyz, boxes, t_max, near_0);
    bool meets_1 = intersect_traced_box(lo_1.xyz, hi_1.xyz, boxes, t_max, near_1);
    uint child_0 = meets_0 ? floatBitsToUint(lo_0.w) : kBvhEmptyChild;
    uint child_1 = meets_1 ? floatBitsToUint(hi_0.w) : kBvhEmptyChild;
    bool swap = meets_1 && (!meets_0 || near_1 < near_0);
    first = swap ? child_1 : child_0;
    second = swap ? child_0 : child_1;
}

// Returns the state of a walk in the scene's own tree.
TreeWalkState begin_walk_in_scene(Ray ray) {
    vec3 lo = bvh_nodes_at(0u).xyz, hi = bvh_nodes_at(1u).xyz;
    float times = object_spaces != 0u ? bvh_nodes_at(2u).x : 1.0;
    BoxTestRay boxes = is_precision_rule_kept(kBoxPaddingRule) ? make_box_ray(ray, lo, hi, times) : make_plain_box_ray(ray);
    return TreeWalkState(ray, boxes, make_ray_shear(ray.direction), 0u, 0u, 0u, 0u);
}

// Returns the state of a walk in an instance's tree, and the tree's root. `low` is the rounding error of the ray's
// origin.
TreeWalkState begin_walk_in_instance(uint record, Ray ray, vec3 low, out uint root) {
    uint i = 4u * record;
    root = floatBitsToUint(bvh_nodes_at(i).w);
    Ray own = transform_ray_to_object_space(read_placement(record), ray, low);
    BoxTestRay boxes = is_precision_rule_kept(kBoxPaddingRule) ? make_box_ray(own, bvh_nodes_at(i + 8u).xyz, bvh_nodes_at(i + 9u).xyz,
        1.0) : make_plain_box_ray(own);
    return TreeWalkState(own, boxes, make_ray_shear(own.direction), record, floatBitsToUint(bvh_nodes_at(i + 1u).w) & kBvhIdMask,
                  floatBitsToUint(bvh_nodes_at(i + 3u).w) & kBvhIdMask, triangle_number_offset(record));
}

// Intersects the ray with the exact sphere of an instance. The sphere's centre is the origin of the object space.
void intersect_instance_sphere(TreeWalkState walked, uint skipped_flags, inout TraceHit best, inout bool found) {
    float t;
    float radius = object_space_sphere_radius(walked.record);
#ifdef TRACE_TINTS_SHADOWS
    if (tints_shadows != 0u && (walked.flags & kBvhTintsShadow) != 0u && (skipped_flags & kBvhCastsNoShadow) != 0u) {
        bool is_met = (walked.flags & skipped_flags & ~(kBvhStandsForSphere | kBvhOneSided)) == 0u && radius > 0.0;
        if (is_met) pass_sphere_of_glass(walked.ray, walked.object, vec3(0), radius, best.t);
        return;
    }
#endif
    if ((walked.flags & skipped_flags & ~(kBvhStandsForSphere | kBvhOneSided)) == 0u && TRACE_SEES(walked.object) &&
        radius > 0.0 &&
        intersect_sphere_robustly(vec3(0), radius, walked.ray, best.t, t)) {
        best = TraceHit(t, vec3(0), 0u, walked.object, kHitOnExactSphere, walked.record);
        found = true;
    }
}

// Walks the trees to the closest hit with 0 < t < t_max, or with `any` to the first hit that is found. Ignores
// triangles with a flag of `skipped_flags`. Returns whether the ray has a hit.
bool find_hit_in_trees(Ray ray, float t_max, uint skipped_flags, bool any, out TraceHit best) {
    best = TraceHit(t_max, vec3(0), 0u, 0u, 0u, 0u);
    vec3 low = trace_low;
    trace_low = vec3(0);
    bool empty = (floatBitsToUint(bvh_nodes_at(0u).w) & kBvhIdMask) == 0u;
    if (empty || !is_valid_ray(ray) || !(t_max > 0.0)) return false;
#ifdef TRACE_PRIVATE_STACK
    uint stack[kBvhMaxStack];
#endif
    TreeWalkState walked = begin_walk_in_scene(ray);
    bool found = false;
    uint waiting = 0u;
    // Triangles without a shadow may have a tree of their own, which shadow rays need not walk.
    vec4 start = bvh_nodes_at(3u);
    uint child = floatBitsToUint(start.x);
    if ((skipped_flags & kBvhCastsNoShadow) == 0u && floatBitsToUint(start.y) != kBvhEmptyChild) {
        STACK(0u) = floatBitsToUint(start.y);
        waiting = 1u;
    }
    do {
        // Descends to a leaf. If the ray meets neither child of a node, the next node comes from the stack.
        do {
            if (is_bvh_word_inner_node(child)) {
                uint second;
                intersect_child_boxes(bvh_word_index(child), walked.boxes, best.t, child, second);
                ++trace_steps;
                if (count_work != 0u) {
                    ++nodes_visited;
                    if (IS_ELECTED) ++node_lanes;
                }
                if (second != kBvhEmptyChild) {
                    STACK(waiting) = second;
                    ++waiting;
                }
                if (child == kBvhEmptyChild && waiting > 0u) {
                    --waiting;
                    child = STACK(waiting);
                }
            }
        } while (is_bvh_word_inner_node(child) && trace_steps < kMaxTraceSteps);
        uint first = bvh_word_index(child);
        uint count = bvh_word_triangle_count(child);
        uint i = 0u;
        bool enters = false;
        if (object_spaces != 0u && count >= kBvhInstanceMarker) {
            if (child == kBvhReturnFromInstance) {
                walked = begin_walk_in_scene(ray);
            } else {
                uint root;
                walked = begin_walk_in_instance(first, ray, low, root);
                enters = (walked.flags & skipped_flags & kBvhStandsForSphere) == 0u;
                if (!enters) {
                    intersect_instance_sphere(walked, skipped_flags, best, found);
                    walked = begin_walk_in_scene(ray);
                } else {
                    STACK(waiting) = kBvhReturnFromInstance;
                    ++waiting;
                    child = root;
                }
            }
            ++trace_steps;
            if (count_work != 0u) {
                ++nodes_visited;
                if (IS_ELECTED) ++node_lanes;
            }
            count = 0u;
        }
        do {
            if (i < count) {
                intersect_stored_triangle(first + i, walked, skipped_flags, best, found);
                ++trace_steps;
                if (count_work != 0u) {
                    ++triangles_tested;
                    if (IS_ELECTED) ++triangle_lanes;
                }
                ++i;
            }
        } while (i < count);
        // If the descent or the leaf's loop has work left, the walk ran out of steps or the driver stopped its loops.
        if (!enters && (is_bvh_word_inner_node(child) || i < count)) break;
        if (enters) continue;
        child = kBvhEmptyChild;
        if (waiting > 0u && !(any && found)) {
            --waiting;
            child = STACK(waiting);
        }
    } while (child != kBvhEmptyChild && trace_steps < kMaxTraceSteps);
    trace_exhausted = trace_exhausted || child != kBvhEmptyChild;
    if (found) best.barycentric = normalise_barycentric(best.barycentric);
    return found;
}

// Finds the closest triangle or sphere that the ray meets at 0 < t < t_max. Ignores those with a flag of `skipped`.
bool find_closest_hit(Ray ray, float t_max, uint skipped, out TraceHit hit) {
    return find_hit_in_trees(ray, t_max, skipped, false, hit);
}

// Returns whether the ray meets a triangle or sphere without a flag of `skipped` at 0 < t < t_max.
bool has_any_hit(Ray ray, float t_max, uint skipped) {
    TraceHit hit;
    return find_hit_in_trees(ray, t_max, skipped, true, hit);
}

#endif
