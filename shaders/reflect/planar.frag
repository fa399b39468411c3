// Technique `planar`: draws a flat mirror. The reflection is the same pixel of the mirrored view, whose eye is as far
// behind the mirror's plane as the camera is in front. A rough mirror shows the view blurred. The shader can add the
// mirror's diffuse and emitted light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/lit.glsl"
#include "lib/rough.glsl"

layout(set = 0, binding = 20) uniform sampler2D mirrored;
// For rough mirrors: the same picture, which is then of 16-bit floats; its box-filtered levels, from 1; and distances from
// the mirrored eye, infinity where no surface is.
layout(set = 0, binding = 21) uniform texture2D mirrored_colours;
layout(set = 0, binding = 22) uniform texture2D mirrored_levels;
layout(set = 0, binding = 23) uniform sampler2D mirrored_distances;
layout(constant_id = OWN_CONSTANTS) const uint taps = 1u; // look-ups of a pixel, for kRoughPrefilter
// 1: the mirror is drawn into a view that stores distances. The distance stored is that of the surface which the mirror
// shows.
layout(constant_id = OWN_CONSTANTS + 1) const uint passes_distances = 0u;

// Width of a box-filtered level's texel that is as wide as the lobe, in widths alpha of the lobe (box_level_of_alpha).
const float kBoxWidthsPerAlpha = 2.57 / 1.5;
// Area of a sample's box in areas for which the sample stands. Larger boxes blur the view more than the lobe does.
const float kOverlap = 0.5;
// Levels between the boxes of colours that a sample reads and those of the distances with which its ray is searched. The
// search is wrong where a box holds near and far surfaces, and the boxes must hide the edges between few samples.
const float kSharperDistances = 2.0;

// Returns the place moved into the drawn part of the view, at least half a pixel from its edge.
vec2 clamp_to_drawn_part(vec2 place) {
    vec2 half_pixel = 0.5 / vec2(textureSize(mirrored, 0));
    return clamp(place, draw.shown.xy + half_pixel, draw.shown.zw - half_pixel);
}

// Returns a texel of the box-filtered levels at a level from 1: colour, and the mean of 1 / distance.
vec4 view_level_texel(vec2 place, float level) {
    return textureLod(sampler2D(mirrored_levels, mipmapped_texels), clamp_to_drawn_part(place), level - 1.0);
}

// Returns the colour of the view at a place, from 0 to 1 across and down the picture, and at a level of its boxes. Outside the
// drawn part of the view, this is the colour at the nearest place inside.
vec3 view_colour_at_level(vec2 place, float level) {
    vec3 colour = vec3(0);
    if (level < 1.0) {
        count_colour_lookups(1u);
        colour = textureLod(sampler2D(mirrored_colours, mipmapped_texels), clamp_to_drawn_part(place), 0.0).rgb;
    }
    if (!(level > 0.0)) return colour;
    count_colour_lookups(1u);
    vec3 blurred = view_level_texel(place, max(level, 1.0)).rgb;
    return level < 1.0 ? mix(colour, blurred, level) : blurred;
}

// A lobe's ray behind the mirror starts at the mirror's surface, at `from_eye`, and runs along the unit vector `direction`. A
// point of the ray is given by w = s / (s + d), where s is its distance from the mirror's surface, and d the distance of the
// mirror's surface from the eye. Infinity has w = 1. The point's place in the picture is nearly linear in w.

// Returns where the view shows the ray's point, from 0 to 1 across and down the picture. z is the number of pixels there in
// the solid angle 1, as seen from the mirror's surface; 0 if the view cannot show the point.
vec3 find_place_on_ray(vec3 direction, float w) {
    View view = views[draw.first_view];
    vec2 size = vec2(textureSize(mirrored, 0));
    float behind = w * length(from_eye); // this, `v` and `along` are lengths times 1 - w, because infinity has no length
    vec3 v = from_eye * (1.0 - w) + direction * behind;
    float along = orthographic != 0u ? 1.0 - w : dot(view.forward, v);
    if (!(along > 0.0)) return vec3(0);
    float pixels = length(view.right) * length(view.down) * size.x * size.y / 4.0; // of the unit square before the eye
    pixels *= behind * behind / (along * along);
    if (orthographic == 0u) pixels *= length(v) / along;
    return vec3(vec2(dot(view.right, v), dot(view.down, v)) / along * 0.5 + 0.5, pixels);
}

// Returns the level whose boxes are as large as a sample that stands for this solid angle.
float level_of_solid_angle(float solid_angle, vec3 place) { return 0.5 * log2(max(kOverlap * solid_angle * place.z, 1.0)); }

// Returns w of the ray's point that is as far from the eye as what the view shows at a place and at a level of its boxes.
float find_shown_distance_on_ray(vec3 direction, vec2 place, float level) {
    const float kMinDistance = 1e-4; // as in rough/box.comp
    float inverse = 0.0;
    count_distance_lookup();
    if (level < 1.0) {
        ivec2 pixel = ivec2(clamp_to_drawn_part(place) * vec2(textureSize(mirrored, 0)));
        inverse = 1.0 / max(texelFetch(mirrored_distances, pixel, 0).r, kMinDistance);
    }
    if (level > 0.0) {
        float blurred = view_level_texel(place, max(level, 1.0)).a;
        inverse = level < 1.0 ? mix(inverse, blurred, level) : blurred;
    }
    if (!(inverse > 0.0)) return 1.0;
    float shown = 1.0 / inverse, b = dot(from_eye, direction);
    float s = max(sqrt(max(b * b - dot(from_eye, from_eye) + shown * shown, 0.0)) - b, 0.0);
    return s / (s + length(from_eye));
}

// Returns w where a lobe's ray meets what the view shows. The search starts at `w`, and each step goes to where a straight line
// through two known points meets the surface. `solid_angle`: for which the ray stands.
float find_end_of_lobe_ray(vec3 direction, float solid_angle, float w) {
    const int kSteps = 2;
    // At `near` the ray is in front of the surface by `near_gap`. At `far` it is behind the surface if `far_gap` < 0.
    float near = 0.0, near_gap = w, far = 1.0, far_gap = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        vec3 place = find_place_on_ray(direction, w);
        if (!(place.z > 0.0)) break;
        float level = max(level_of_solid_angle(solid_angle, place) - kSharperDistances, 0.0);
        float gap = find_shown_distance_on_ray(direction, place.xy, level) - w;
        if (gap < 0.0) far = w, far_gap = gap;
        else near = w, near_gap = gap;
        w = far_gap < 0.0 ? mix(near, far, near_gap / (near_gap - far_gap)) : min(w + gap, 1.0);
    }
    return w;
}

// Returns the light that arrives in a lobe of that roughness around the mirrored direction, as the view shows it. `n`: unit
// normal of the mirror. With kRoughPrefilter, each sample of the lobe reads the level whose boxes are as large as the part of
// the lobe for which the sample stands: filtered importance sampling (Krivanek and Colbert, "Real-time Shading with Filtered
// Importance Sampling", 2008).
vec3 blurred_view_colour(vec3 n, float roughness) {
    vec3 seen = normalize(direction_from_viewer());
    if (dot(n, seen) > 0.0) n = -n;
    vec2 here = gl_FragCoord.xy / vec2(textureSize(mirrored, 0));
    float alpha = roughness_to_alpha(roughness), w = 1.0;
    float box = kBoxWidthsPerAlpha * alpha;
    if (distance_law != kLawNone) {
        w = find_shown_distance_on_ray(seen, here, 0.0);
        // The mean distance over the lobe has no edges where the view has some.
        w = find_shown_distance_on_ray(seen, here, log2(max(box * sqrt(find_place_on_ray(seen, w).z), 1.0)));
    }
    if (rough == kRoughMips) return view_colour_at_level(here, log2(max(box * sqrt(find_place_on_ray(seen, w).z), 1.0)));
    vec3 tangent, bitangent;
    tangent_frame(n, tangent, bitangent);
    vec3 to_eye = to_viewer_in_tangent_space(n, tangent, bitangent, -seen), sum = vec3(0);
    float weights = 0.0;
    uint i = 0u;
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        float u, v;
        hammersley_point(i++, taps, u, v);
        vec3 drawn = sample_lobe(alpha, to_eye, u, v);
        float weight = lobe_sample_weight(alpha, vec3(1), vec3(1), to_eye, drawn).x;
        if (!(weight > 0.0)) continue;
        // Behind the mirror, the lobe is mirrored in the mirror's plane.
        vec3 direction = drawn.x * tangent + drawn.y * bitangent - drawn.z * n;
        float solid_angle = 1.0 / (float(taps) * lobe_pdf(alpha, to_eye, drawn)), end = w;
        if (distance_law != kLawNone) end = find_end_of_lobe_ray(direction, solid_angle, w);
        vec3 place = find_place_on_ray(direction, end);
        if (!(place.z > 0.0)) continue;
        sum += weight * view_colour_at_level(place.xy, level_of_solid_angle(solid_angle, place));
        weights += weight;
    } while (i < taps);
    return weights > 0.0 ? sum / weights : view_colour_at_level(here, 0.0);
}

vec3 sharp_view_colour() {
    count_work_once(kWorkColourLookups);
    return texelFetch(mirrored, ivec2(gl_FragCoord.xy), 0).rgb;
}

// Returns what a surface with the normal `n` reflects of the view, where some mirror is rough.
vec3 reflected_view_colour(Surface surface, vec3 n) {
    if (surface.reflectance == vec3(0)) return vec3(0);
    float cosine = -dot(n, normalize(direction_from_viewer()));
    vec3 shown = vec3(0), sharp = surface.reflectance;
    bool is_rough = has_rough_lobe();
    if (has_clear_coats != 0u && clear_coat.strength > 0.0) {
        is_rough = is_rough && clear_coat.is_base_shown;
        if (clear_coat.is_shown && clear_coat.roughness > kMaxSharpRoughness) {
            sharp -= clear_coat.reflected;
            shown += rough_clear_coat_albedo(cosine) * blurred_view_colour(n, clear_coat.roughness);
        }
        if (is_rough) sharp = vec3(clear_coat.is_shown && clear_coat.roughness <= kMaxSharpRoughness ? clear_coat.reflected : 0.0);
    } else if (is_rough) {
        sharp = vec3(0);
    }
    if (is_rough) shown += specular_lobe_albedo(cosine) * blurred_view_colour(n, specular_lobe.roughness);
    return sharp == vec3(0) ? shown : shown + sharp * sharp_view_colour();
}

void main() {
    vec3 facet = cross(dFdx(from_eye), dFdy(from_eye));
    discard_cut_out_fragments();
    vec3 n = normalize(normal);
    Surface surface = find_surface_at_fragment(n, facet);
    vec3 shown = rough == kRoughNone ? surface.reflectance * sharp_view_colour() : reflected_view_colour(surface, n);
    if (lights_mirrors != 0u) shown += shade_drawn_fragment(surface, n, facet);
    write_fragment_outputs(shown);
    if (passes_distances != 0u) {
        count_distance_lookup();
        out_distance = max(out_distance, texelFetch(mirrored_distances, ivec2(gl_FragCoord.xy), 0).r);
    }
}
