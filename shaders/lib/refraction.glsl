// Light that passes a glass body, for mirrors that look it up in their capture (knob `refract`). The capture leaves the body
// out, so it shows what is behind. A ray bends where it enters the body and once more where it leaves. Light that is
// reflected inside the body is left out.
#ifndef CATOPTRIC_REFRACTION_GLSL
#define CATOPTRIC_REFRACTION_GLSL

#include "lib/drawn.glsl"
#include "lib/eye.glsl"
#include "lib/material.glsl"

layout(constant_id = REFRACT_CONSTANT) const uint refract_model = kRefractNone;
// A model of refraction for camera views only: light leaves the body at the back face that an image of the view shows
// (Wyman, "An Approximate Image-Space Approach for Interactive Refraction", 2005). Where the image shows no back face,
// the shader uses the model kRefractAuto.
const uint kRefractBackface = 6u;
// A model of refraction for camera views only: the body is that of kRefractAuto, and light is looked up in the picture of
// the same view without glass, at the point where the ray leaves the body (lib/opaque_picture.glsl). Where the picture does
// not show that point, the shader uses the model kRefractAuto.
const uint kRefractScreen = 7u;
// Back faces of glass bodies, drawn by glass_back.frag.
layout(set = 0, binding = GLASS_BACKS_BINDING) uniform sampler2D glass_backs;

// Returns whether light passes the surface that was evaluated last.
bool is_refracting(uint detail) {
    return refract_model != kRefractNone && is_glass(detail);
}

// A ray of light behind a glass surface.
struct RefractedRay {
    vec3 origin;    // point where the ray leaves the glass body, scene units
    vec3 direction; // unit direction in which the ray leaves the glass body
    vec3 weight;    // share of the ray's light that reaches the viewer
    float reflected; // share of the light that the drawn surface reflects instead
    float roughness; // roughness of a mirror that spreads light as much as the glass does; 0: the glass is smooth
    vec3 inside;     // unit direction in which the ray runs through the body, if it enters one
    float way;       // length of its way there; 0: it enters no body
    vec3 entering;   // share of light from inside the body that reaches the viewer, if nothing were absorbed
};

// Returns the roughness of a mirror that spreads light as much as the rough glass that was evaluated last. A facet tilted by
// a small angle turns reflected light by twice this angle, light through one surface by (ior - 1) times it, and light through
// both surfaces of a body, whose tilts are independent, by the root of two as much. Facets of a sheet bend like a mirror's.
float passing_roughness(bool is_solid, float ior) {
    const float kRootOfHalf = 0.70710678;
    return has_lobes == 0u ? 0.0 : is_solid ? specular_lobe.roughness * sqrt(min((ior - 1.0) * kRootOfHalf, 1.0)) : specular_lobe.roughness;
}

// Returns the length of the way along `direction` from `at` to where the ray leaves the box. Also sets the normal of
// the box there, which points inwards.
float find_way_out_of_box(vec3 at, vec3 direction, vec3 lowest, vec3 highest, out vec3 normal) {
    float way = kLargestFloat;
    normal = -direction;
    for (int axis = 0; axis < 3; ++axis) {
        float end = direction[axis] > 0.0 ? highest[axis] : lowest[axis], t = (end - at[axis]) / direction[axis];
        if (direction[axis] == 0.0 || !(t < way)) continue;
        way = max(t, 0.0);
        normal = vec3(0);
        normal[axis] = direction[axis] > 0.0 ? -1.0 : 1.0;
    }
    return way;
}

// A point of a back face, and its normal, which points outwards.
struct BackFace {
    vec3 position;
    vec3 normal;
};

// Reads the back face of the drawn body in a pixel. Returns false if the pixel shows none.
bool read_back_face(View view, ivec2 pixel, out BackFace back) {
    ivec2 size = textureSize(glass_backs, 0);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) return false;
    vec4 texel = texelFetch(glass_backs, pixel, 0);
    if (texel.w != float(drawn_mirror_number())) return false;
    vec2 place = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec3 across = place.x * view.right / dot(view.right, view.right) + place.y * view.down / dot(view.down, view.down);
    float along = abs(texel.z), z = sqrt(max(1.0 - dot(texel.xy, texel.xy), 0.0));
    back.position = view.eye + along * view.forward + (orthographic != 0u ? 1.0 : along) * across;
    back.normal = vec3(texel.xy, texel.z < 0.0 ? -z : z);
    return true;
}

// Returns where the view shows a point, from 0 to 1 across and down the picture.
vec2 find_place_of_point(View view, vec3 point) {
    vec3 v = point - view.eye;
    float along = orthographic != 0u ? 1.0 : dot(view.forward, v);
    return vec2(dot(view.right, v), dot(view.down, v)) / along * 0.5 + 0.5;
}
vec2 find_pixel_of_point(View view, vec3 point) {
    return find_place_of_point(view, point) * vec2(textureSize(glass_backs, 0));
}

// Returns the mean normal of the back faces around a place, in pixels. Those that belong to another side of the body than
// `normal` do not count.
vec3 interpolate_back_normal(View view, vec2 place, vec3 normal) {
    const float kSameSideCosine = 0.9;
    vec2 low = floor(place - 0.5), share = place - 0.5 - low;
    vec3 sum = vec3(0);
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        BackFace back;
        if (!read_back_face(view, ivec2(low) + step, back) || dot(back.normal, normal) < kSameSideCosine) continue;
        sum += back.normal * (step.x == 1 ? share.x : 1.0 - share.x) * (step.y == 1 ? share.y : 1.0 - share.y);
    }
    return dot(sum, sum) > 0.0 ? normalize(sum) : normal;
}

// Finds the way along `inside` from `at`, on the drawn body, to where the ray leaves it through a back face, and the normal
// there, which points inwards. Meets the tangent planes of the back faces that it passes by turns (Newton's method), and turns
// half-way back from where the view shows no back face. Returns false if the pixel itself shows none, or the ray does not
// leave through a face in view.
bool find_way_to_back_face(vec3 at, vec3 inside, out float way, out vec3 normal) {
    const int kSteps = 12;
    // kTolerance: share of the way. 1e-3 is less than a pixel in bodies up to 1,000 pixels deep, and the image of back faces
    // has no finer data. kMinCosine: cosine between the ray and the back face's normal. At 1e-2 (89.4 degrees), an error of
    // the face's place is 100 times as large along the ray. The picture hardly depends on either number: ten times more or
    // less changes at most 8 of 196,608 pixels of the scene `glass`.
    const float kTolerance = 1e-3, kMinCosine = 1e-2;
    View view = views[draw.first_view];
    way = 0.0;
    normal = -inside;
    BackFace back;
    if (!read_back_face(view, ivec2(gl_FragCoord.xy), back)) return false;
    float seen_way = 0.0, next = dot(back.position - at, back.normal) / max(dot(inside, back.normal), kMinCosine);
    bool is_met = false;
    for (int i = 0; i < kSteps && !is_met; ++i) {
        if (!(next > 0.0 && next <= kLargestFloat)) return false;
        BackFace met;
        if (!read_back_face(view, ivec2(floor(find_pixel_of_point(view, at + next * inside))), met)) {
            next = 0.5 * (seen_way + next);
            continue;
        }
        back = met;
        seen_way = next;
        next = dot(back.position - at, back.normal) / max(dot(inside, back.normal), kMinCosine);
        is_met = abs(next - seen_way) <= kTolerance * next;
    }
    if (!(seen_way > 0.0) || !(dot(inside, back.normal) > kMinCosine)) return false;
    way = is_met ? next : seen_way;
    normal = -interpolate_back_normal(view, find_pixel_of_point(view, at + way * inside), back.normal);
    return dot(inside, normal) < 0.0;
}

// Returns the ray behind a glass body, for a ray that meets the glass at the point `at` with the unit direction `seen`.
// `n`: the unit normal of the surface, which points out of a solid body. `from_viewer`: the distance to the viewer, who
// may be inside the body.
RefractedRay refract_through_body(uint detail, vec3 at, vec3 seen, vec3 n, float from_viewer, Probe body) {
    MaterialParameters glass = read_material_parameters(detail);
    bool is_auto = refract_model == kRefractAuto || refract_model == kRefractTraced || refract_model >= kRefractBackface;
    bool is_thin = is_auto ? body.kind == kMirrorThinGlass : refract_model == kRefractThin;
    bool is_box = is_auto ? body.kind == kMirrorGlassBox : refract_model == kRefractBox;
    bool is_solid = (glass.flags & kMaterialSolidFlag) != 0u, is_inside = is_inside_glass(detail, seen, n);
    vec3 normal = dot(seen, n) > 0.0 ? -n : n;
    float ratio = is_inside ? 1.0 / glass.ior : glass.ior, cosine = min(-dot(seen, normal), 1.0), cosine_behind;
    float reflected = fresnel_dielectric(cosine, ratio, cosine_behind);
    if ((glass.flags & kMaterialOpenSheetFlag) != 0u) reflected = sheet_reflectance(reflected);
    RefractedRay ray = RefractedRay(at, seen, (1.0 - reflected) * glass_tint, reflected, passing_roughness(is_solid, glass.ior),
        seen, 0.0, vec3(0));
    ray.entering = ray.weight;
    if (body.holds != 0u && !is_inside) {
        vec3 side;
        ray.way = find_way_out_of_box(at, seen, body.lowest, body.highest, side);
    }
    if (is_inside) ray.weight *= exp(-glass.absorption * from_viewer);
    if (!is_solid || reflected == 1.0) return ray;
    float way;
    vec3 far_normal;
    bool has_back_face = refract_model == kRefractBackface && !is_inside &&
        find_way_to_back_face(at, refract_direction(seen, normal, cosine, ratio, cosine_behind), way, far_normal);
    if (refract_model == kRefractBackface) is_thin = is_thin && !has_back_face;
    if (is_thin && !is_inside) {
        ray.weight *= ray.weight;
        return ray;
    }
    if (!is_thin) ray.direction = refract_direction(seen, normal, cosine, ratio, cosine_behind);
    if (is_inside) return ray;
    vec3 inside = ray.direction, size = body.highest - body.lowest;
    ray.inside = inside;
    if (refract_model == kRefractBackface && has_back_face) {
        // The way through the body and the normal at its end are already known.
    } else if (is_box) {
        way = find_way_out_of_box(at, inside, body.lowest, body.highest, far_normal);
    } else {
        float along = dot(normal, inside);
        way = -along * min(size.x, min(size.y, size.z));
        far_normal = normalize(along * inside - 0.5 * normal);
    }
    ray.way = way;
    ray.origin += way * inside;
    ray.weight *= exp(-glass.absorption * way);
    float far_cosine = min(-dot(inside, far_normal), 1.0);
    reflected = fresnel_dielectric(far_cosine, 1.0 / glass.ior, cosine_behind);
    if (reflected == 1.0) return ray; // totally reflected light would go on inside; it is shown as if it left unbent
    ray.weight *= (1.0 - reflected) * glass_tint;
    ray.direction = refract_direction(inside, far_normal, far_cosine, 1.0 / glass.ior, cosine_behind);
    return ray;
}

#endif
