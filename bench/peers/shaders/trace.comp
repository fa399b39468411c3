// Simple Whitted ray tracing of one picture: triangles as in Moeller and Trumbore, single precision, no counters.
// SKIP_LINKS walks nodes of one texel, with 16 bits for each plane of a box, in the order of the walk. A missed box is
// skipped by the link to the node behind its subtree. Without SKIP_LINKS, nodes have two boxes, the nearer child is
// visited first, and the other child waits on a stack.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform samplerBuffer nodes;
// Three texels for each triangle: corner (w: object), two edges.
layout(set = 0, binding = 1) uniform samplerBuffer triangles;
layout(set = 0, binding = 2) uniform samplerBuffer normals;   // three normals for each triangle
// Three texels for each surface: albedo (w: mirror), emission, reflectance.
layout(set = 0, binding = 3) uniform samplerBuffer surfaces;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D picture;
layout(push_constant) uniform Push {
    vec4 eye;     // eye of the camera; w: ambient light
    vec4 forward; // view direction; w: most bounces
    vec4 right;
    vec4 down;
    vec4 light;   // position of the light; w: share of the way to the light at which shadow rays end
    vec4 light_normal;
    vec4 intensity;
    vec4 grid;    // grid of the skip links' boxes: lowest corner; w: steps per scene unit
};

const float kLift = 1.0 / 1048576.0; // distance from the surface at which reflected and shadow rays start, scene units
const float kFarthest = 3.4e38;

struct TraceHit {
    float t, u, v;
    int triangle;
};

// Intersects the ray with triangle i, and replaces the hit if the new hit is nearer.
void intersect_stored_triangle(int i, vec3 from, vec3 along, inout TraceHit hit) {
    vec3 a = texelFetch(triangles, 3 * i).xyz;
    vec3 e = texelFetch(triangles, 3 * i + 1).xyz;
    vec3 f = texelFetch(triangles, 3 * i + 2).xyz;
    vec3 p = cross(along, f);
    float inverse = 1.0 / dot(e, p);
    vec3 s = from - a;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, e);
    float v = dot(along, q) * inverse;
    float t = dot(f, q) * inverse;
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < hit.t) hit = TraceHit(t, u, v, i);
}

#ifdef SKIP_LINKS

void walk_tree(vec3 from, vec3 along, bool any, inout TraceHit hit) {
    // The ray is transformed to steps of the grid of box planes. The ray's points keep their t.
    vec3 inverse = 1.0 / (along * grid.w);
    vec3 start = -(from - grid.xyz) * grid.w * inverse;
    int node = 0, end = int(texelFetch(nodes, 0).w);
    node = 1;
    do {
        int first = 0, count = 0;
        do {
            uvec4 n = floatBitsToUint(texelFetch(nodes, node));
            vec3 a = vec3(n.xyz & 0xffffu) * inverse + start;
            vec3 b = vec3(n.xyz >> 16) * inverse + start;
            vec3 lo = min(a, b), hi = max(a, b);
            bool met = max(max(lo.x, lo.y), max(lo.z, 0.0)) <= min(min(hi.x, hi.y), min(hi.z, hit.t));
            bool leaf = (n.w & 0x80000000u) != 0u;
            node = met || leaf ? node + 1 : int(n.w);
            if (met && leaf) {
                first = int(n.w & 0x07ffffffu);
                count = int(n.w >> 27 & 15u);
            }
        } while (count == 0 && node < end);
        int last = first + count;
        do {
            if (first < last) intersect_stored_triangle(first, from, along, hit);
            ++first;
        } while (first < last);
    } while (node < end && !(any && hit.triangle >= 0));
}

#else

shared uint waiting[32 * 64];

void walk_tree(vec3 from, vec3 along, bool any, inout TraceHit hit) {
    vec3 inverse = 1.0 / along;
    vec3 start = -from * inverse;
    uint depth = 0u, child = 1u;
    bool done = false;
    do {
        do { // descends to a leaf
            if (child >> 27 == 0u) {
                int i = 4 * int(child);
                vec4 lo_0 = texelFetch(nodes, i), hi_0 = texelFetch(nodes, i + 1);
                vec4 lo_1 = texelFetch(nodes, i + 2), hi_1 = texelFetch(nodes, i + 3);
                vec3 a = lo_0.xyz * inverse + start, b = hi_0.xyz * inverse + start;
                vec3 c = lo_1.xyz * inverse + start, d = hi_1.xyz * inverse + start;
                vec3 in_0 = min(a, b), out_0 = max(a, b), in_1 = min(c, d), out_1 = max(c, d);
                float near_0 = max(max(in_0.x, in_0.y), max(in_0.z, 0.0));
                float near_1 = max(max(in_1.x, in_1.y), max(in_1.z, 0.0));
                bool met_0 = near_0 <= min(min(out_0.x, out_0.y), min(out_0.z, hit.t));
                bool met_1 = near_1 <= min(min(out_1.x, out_1.y), min(out_1.z, hit.t));
                uint child_0 = floatBitsToUint(lo_0.w), child_1 = floatBitsToUint(hi_0.w);
                bool swaps = met_1 && (!met_0 || near_1 < near_0);
                child = swaps ? child_1 : child_0;
                if (met_0 && met_1) waiting[depth++ * 64 + gl_LocalInvocationIndex] = swaps ? child_0 : child_1;
                if (!met_0 && !met_1) {
                    done = depth == 0u;
                    child = done ? 0xffffffffu : waiting[--depth * 64 + gl_LocalInvocationIndex];
                }
            }
        } while (child >> 27 == 0u);
        int first = int(child & 0x07ffffffu);
        int last = done ? 0 : first + int(child >> 27);
        do {
            if (first < last) intersect_stored_triangle(first, from, along, hit);
            ++first;
        } while (first < last);
        done = done || depth == 0u || (any && hit.triangle >= 0);
        if (!done) child = waiting[--depth * 64 + gl_LocalInvocationIndex];
    } while (!done);
}

#endif

// Returns the origin of a ray that leaves a surface on the side to which its direction points.
vec3 offset_reflected_ray_origin(vec3 point, vec3 facet, vec3 along) { return point + (dot(along, facet) < 0.0 ? -kLift : kLift) * facet; }

vec3 trace_radiance_of_ray(vec3 from, vec3 along) {
    vec3 weight = vec3(1), sum = vec3(0);
    int bounce = 0;
    bool goes_on;
    do {
        goes_on = false;
        TraceHit hit = TraceHit(kFarthest, 0.0, 0.0, -1);
        walk_tree(from, along, false, hit);
        if (hit.triangle < 0) continue;
        int i = 3 * hit.triangle;
        vec4 corner = texelFetch(triangles, i);
        vec3 facet = normalize(cross(texelFetch(triangles, i + 1).xyz, texelFetch(triangles, i + 2).xyz));
        vec3 n = normalize((1.0 - hit.u - hit.v) * texelFetch(normals, i).xyz + hit.u * texelFetch(normals, i + 1).xyz +
                           hit.v * texelFetch(normals, i + 2).xyz);
        vec3 point = from + hit.t * along;
        int object = 3 * int(corner.w);
        vec4 albedo = texelFetch(surfaces, object);
        if (albedo.w == 0.0) {
            sum += weight * (texelFetch(surfaces, object + 1).rgb + eye.w * albedo.rgb);
            vec3 to_light = light.xyz - point;
            float distance = length(to_light);
            to_light /= distance;
            float cosines = max(-dot(to_light, light_normal.xyz), 0.0) * max(dot(to_light, n), 0.0);
            if (cosines > 0.0 && albedo.rgb != vec3(0)) {
                vec3 origin = offset_reflected_ray_origin(point, facet, to_light);
                TraceHit blocked = TraceHit(light.w, 0.0, 0.0, -1);
                walk_tree(origin, light.xyz - origin, true, blocked);
                if (blocked.triangle < 0)
                    sum += weight * albedo.rgb * intensity.rgb * (cosines / (distance * distance * 3.14159265));
            }
        } else {
            weight *= texelFetch(surfaces, object + 2).rgb;
            if (dot(along, facet) > 0.0) facet = -facet;
            along -= 2.0 * dot(along, n) * n;
            float height = dot(along, facet);
            if (height < 0.0) along = normalize(along - 2.0 * height * facet);
            from = offset_reflected_ray_origin(point, facet, along);
            goes_on = bounce < int(forward.w);
            ++bounce;
        }
    } while (goes_on);
    return sum;
}

void main() {
    // Scatters the work groups over the picture. A software driver gives each thread a contiguous run of work groups,
    // and neighbouring work groups cost about the same.
    uint count = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    uint group = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 2531u & (count - 1u);
    uvec2 pixel = uvec2(group % gl_NumWorkGroups.x, group / gl_NumWorkGroups.x) * 8u + gl_LocalInvocationID.xy;
    vec2 place = (vec2(pixel) + 0.5) / vec2(imageSize(picture)) * 2.0 - 1.0;
    vec3 sum = trace_radiance_of_ray(eye.xyz, normalize(forward.xyz + place.x * right.xyz + place.y * down.xyz));
    imageStore(picture, ivec2(pixel), vec4(sum, 1));
}
