// Shadow map lookups. The shadow map of a point light is a cube of depth faces, with face +Z along the light's normal.
// If every light is one-sided, face -Z is left out, because the light does not shine there.
#ifndef CATOPTRIC_SHADOW_GLSL
#define CATOPTRIC_SHADOW_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"
#include "lib/glass_shadow.glsl"
#include "lib/lights.glsl"

// 1: the pass has shadow maps. 0: nothing reads them, and surfaces drawn by raster are lit without shadows.
layout(constant_id = HAS_SHADOW_MAP_CONSTANT) const uint has_shadow_map = 0u;

// The optical depth of the glass between each light and the surfaces in its shadow map, in the same layers.
layout(set = 0, binding = GLASS_DEPTHS_BINDING) uniform sampler2DArray glass_depths;

// Returns the share of the four texels around `place`, 0 to 1 across the layer, whose surfaces are not nearer to the light
// than `depth`, and sets light_tint to the mean tint of their light.
float compare_with_shadow_map(vec2 place, float layer, float depth) {
    float visible = texture(shadow_map, vec4(place, layer, depth));
    if (tints_shadows == 0u || visible == 0.0) return visible;
    vec2 size = vec2(textureSize(shadow_map, 0).xy), at = place * size - 0.5, low = floor(at), share = at - low;
    // Texels in the order of a gather: lower left, lower right, upper right, upper left, where v points down.
    vec4 weights = textureGather(shadow_map, vec3(place, layer), depth) *
        vec4((1.0 - share.x) * share.y, share.x * share.y, share.x * (1.0 - share.y), (1.0 - share.x) * (1.0 - share.y));
    float sum = dot(weights, vec4(1));
    if (!(sum > 0.0)) return visible;
    vec3 passed = vec3(0);
    bool is_tinted = false; // a tint of exactly 1 needs no shadow ray (find_light_share_by_shadow_map)
    for (int i = 0; i < 4; ++i) {
        vec2 texel = clamp(low + vec2(i == 1 || i == 2, i < 2), vec2(0), size - 1.0);
        vec3 glass_depth = texelFetch(glass_depths, ivec3(texel, layer), 0).rgb;
        is_tinted = is_tinted || glass_depth != vec3(0);
        passed += weights[i] * share_behind_glass(glass_depth);
    }
    light_tint = is_tinted ? passed / sum : vec3(1);
    return visible;
}

// How far the looked-up point is lifted off its surface, in texels times sin(theta), where the surface is tilted by
// theta against the shadow face. The four taps lie within one texel of the point along each axis, so a lift of sqrt(2)
// keeps a plane from shadowing itself. The rest up to 1.5 is for texels whose rays are not parallel.
const float kShadowBiasTexels = 1.5;
// The error of interpolated depth, relative to the largest depth that the receiver's plane has in the shadow face.
// 2^-20 is 16 roundings.
const float kShadowDepthError = 1.0 / 1048576.0;

vec3 world_to_light_axes(uint light, vec3 v) {
    return vec3(dot(read_light(light).right, v), -dot(read_light(light).down, v), dot(read_light(light).forward, v));
}

// The direction in which the looked-up point is lifted off its surface. Along the normal, shadows shift sideways by up to
// kShadowBiasTexels. Towards the light, shadows keep their place, but begin late where a surface touches what shades
// it. The height above the surface is the same, so that a plane does not shadow itself.
const uint kBiasAlongNormal = 0u, kBiasTowardsLight = 1u;
// Least cosine to the light, which limits how far a point moves towards the light.
const float kMinLightCosine = 1.0 / 64.0;

vec3 shadow_bias_offset(uint lift, vec3 normal, vec3 to_light, float height) {
    return lift == kBiasAlongNormal ? normal * height
        : to_light * (height / max(dot(normal, to_light), kMinLightCosine));
}

// Returns the share of a directional light that reaches the point, 0 to 1. The shadow map of such a light has two
// windows around one axis. The first window covers the scene's core in more detail, the second covers all shadow
// casters.
float sample_parallel_shadow_map(uint light, vec3 position, vec3 normal, float error, uint lift) {
    float edge = float(textureSize(shadow_map, 0).x);
    for (uint window = 0u; window < 2u; ++window) {
        View view = views[1u + 6u * frame.value.mirror_count + shadow_face_count() * light + window];
        float texel = 2.0 / (edge * min(length(view.right), length(view.down)));
        float cosine = dot(normal, view.forward), sine = sqrt(max(0.0, 1.0 - cosine * cosine));
        vec3 v = position - view.eye + shadow_bias_offset(lift, normal, -view.forward,
            kShadowBiasTexels * texel * sine + error);
        vec2 place = vec2(dot(view.right, v), dot(view.down, v));
        if (max(abs(place.x), abs(place.y)) > 1.0 - 2.0 / edge) continue;
        // The slack in depth grows with the depth range of the receiver's plane in the window, since depth is
        // interpolated.
        float slack = kShadowDepthError * (1.0 + view.near * edge * texel * sine / max(abs(cosine), kShadowDepthError));
        float depth = 1.0 - view.near * dot(view.forward, v) + slack;
        count_work_once(kWorkShadowLookups);
        return compare_with_shadow_map(place * 0.5 + 0.5, float(light * shadow_face_count() + window), depth);
    }
    return 1.0;
}

// Returns the share of the light that reaches the point, 0 to 1 (2x2 percentage-closer filtering). `normal` faces the
// light. `error` is the largest error of the position along `normal`, scene units.
float sample_shadow_map(uint light, vec3 position, vec3 normal, float error, uint lift) {
    if (is_directional_light(light)) return sample_parallel_shadow_map(light, position, normal, error, lift);
    vec3 v = world_to_light_axes(light, position - read_light(light).position);
    vec3 n = world_to_light_axes(light, normal);
    int face = cube_face(v);
    if (uint(face) >= shadow_face_count()) return 0.0;
    vec3 n_face = cube_coordinates(face, n);
    float texel = 2.0 * cube_coordinates(face, v).z / float(textureSize(shadow_map, 0).x);
    v += shadow_bias_offset(lift, n, -normalize(v), kShadowBiasTexels * texel * sqrt(max(0.0,
        1.0 - n_face.z * n_face.z)) + error);
    vec3 place = cube_coordinates(face, v);
    // Depth is near / z, which is linear over the receiver's plane dot(n, p) = -height. The largest depth of the plane
    // in the face is therefore at most near * (|n.x| + |n.y| + |n.z|) / height.
    float height = abs(dot(n, v));
    float slack = kShadowDepthError * (1.0 + place.z * dot(abs(n), vec3(1)) / height);
    float layer = float(light * shadow_face_count() + uint(face));
    count_work_once(kWorkShadowLookups);
    return compare_with_shadow_map(place.xy / place.z * 0.5 + 0.5, layer, read_light(light).near / place.z * (1.0 + slack));
}
float sample_shadow_map(uint light, vec3 position, vec3 normal, float error) {
    return sample_shadow_map(light, position, normal, error, kBiasAlongNormal);
}

#include "lib/soft_shadow.glsl"

// Returns the share of the light that reaches the point, 0 to 1: with soft_shadows, the share of a lamp that it sees. `facet`
// is a unit normal of the point's facet, on either side.
float sample_hard_or_soft_shadow_map(uint light, vec3 position, vec3 normal, vec3 facet, float error) {
    float visible = sample_shadow_map(light, position, normal, error);
    if (soft_shadows != 0u && is_light_a_lamp(light)) visible = sample_soft_shadow_map(light, position, facet, error, visible);
    return visible;
}

// Finds the share of the light that reaches the point. Returns false at the edge of a shadow, where the four taps differ
// and a shadow ray must tell, and behind glass.
bool find_light_share_by_shadow_map(uint light, vec3 position, vec3 normal, float error, out float visible) {
    visible = sample_shadow_map(light, position, normal, error, kBiasTowardsLight);
    return visible == 0.0 || (visible == 1.0 && (tints_shadows == 0u || light_tint == vec3(1)));
}

#endif
