// Soft shadows of lamps from one shadow map (percentage-closer soft shadows: Fernando 2005). A lamp is replaced by points
// of a box (LampExtent), the same points in each pixel. A first loop reads the shadow map around the way from the receiver
// to the lamp, and finds how far along that way the surfaces are that hide points of the lamp, on average. A second loop
// looks up the shadow map at this place on the way to each point of the lamp. The penumbra's width follows: it is the
// lamp's size, times the distance from blocker to receiver, divided by the distance from lamp to blocker.
// Only lib/shadow.glsl includes this file.
#ifndef CATOPTRIC_SOFT_SHADOW_GLSL
#define CATOPTRIC_SOFT_SHADOW_GLSL

// 1: lamps cast soft shadows.
layout(constant_id = SOFT_SHADOWS_CONSTANT) const uint soft_shadows = 0u;

layout(set = 0, binding = SHADOW_DEPTHS_BINDING) uniform sampler2DArray shadow_depths;
layout(set = 0, binding = LAMP_EXTENTS_BINDING, scalar) uniform LampExtents { LampExtent lamp_extents[kMaxLights]; };

// Look-ups that search for blockers, and look-ups over the penumbra. All are at the same points of the lamp in each pixel, so
// a picture has no noise.
const uint kBlockerSearchTaps = 16u, kPenumbraTaps = 32u;
// The blocker search reads more places near the receiver than near the lamp: place k of n, counted from 0 and shuffled, is
// at the power of (k + 1/2) / n of the whole way.
const float kBlockerSearchPower = 2.0;
// A blocker counts only if it is seen at least this high above the receiver's plane, as a tangent. Facets of a curved
// receiver are lower, and light that is as low fades (kFacetFadeSine).
const float kMinBlockerSlope = 0.10510423526567647;
// Least |cosine| between a flat lamp's normal and the way to the receiver at which distances are measured along the
// normal.
const float kMinFlatLampCosine = 1.0 / 64.0;

// A point that may lie in the shadow of a lamp, in the axes of the lamp's shadow map. The lamp is at the origin.
struct SoftShadowReceiver {
    vec3 position;
    vec3 normal;       // unit normal of the receiver's plane, facing the lamp
    vec3 place;        // the direction to the receiver, as a point on the unit cube around the lamp
    float depth_scale; // stored depth of the receiver's plane at a point on the unit cube, divided by dot(-normal, point)
    float least_bias;  // bias of a look-up at the receiver, for a plane that faces the lamp; divided by depth_scale
    float texel;       // edge of a texel on the unit cube
};

// Returns point `i` of `count` of the lamp, relative to its centre: a lattice of irrational steps.
vec3 lamp_point_offset(LampExtent extent, uint i, uint count) {
    vec3 share = fract(vec3(float(i) + 0.5) * vec3(1.0 / float(count), 0.7548776662466927, 0.4142135623730950)) * 2.0 - 1.0;
    return extent.first * share.x + extent.second * share.y + extent.third * share.z;
}

// Finds where the shadow map holds the direction `v` from the lamp, and the depth behind which surfaces hide nothing from
// the receiver. Returns false where the light has no shadow map.
bool locate_soft_shadow_lookup(SoftShadowReceiver receiver, vec3 v, out vec3 place_layer, out float depth, out vec3 on_cube) {
    int face = cube_face(v);
    vec3 c = cube_coordinates(face, v);
    on_cube = v / c.z;
    place_layer = vec3(c.xy / c.z * 0.5 + 0.5, float(face));
    float cosine = cube_coordinates(face, receiver.normal).z;
    // The four taps of a look-up lie within one texel of the place. The plane's depth is linear across the face.
    float bias = receiver.least_bias + kShadowBiasTexels * receiver.texel * sqrt(max(0.0, 1.0 - cosine * cosine)) +
                 kMinBlockerSlope * distance(on_cube, receiver.place);
    depth = receiver.depth_scale * max(0.0, bias - dot(receiver.normal, on_cube));
    return uint(face) < shadow_face_count();
}

// Finds how far along the way from the receiver to the lamp the blockers are on average, as a share of the way, 0 to 1.
// Returns false if it finds no blocker. `along`: the axis along which ways are measured.
bool find_mean_blocker(uint light, LampExtent extent, SoftShadowReceiver receiver, vec3 along, out float mean) {
    float way = dot(receiver.position, along), near = read_light(light).near;
    float radius_square = dot(extent.first, extent.first) + dot(extent.second, extent.second) + dot(extent.third, extent.third);
    float longest = max(0.0, 1.0 - near / length(receiver.position)); // no blocker is nearer to the lamp than `near`
    float sum = 0.0, count = 0.0;
    for (uint i = 0u; i < kBlockerSearchTaps; ++i) {
        float share = longest * pow(fract((float(i) + 0.5) * 0.5698402909980532), kBlockerSearchPower);
        vec3 place_layer, on_cube;
        float depth;
        if (!locate_soft_shadow_lookup(receiver, mix(receiver.position, lamp_point_offset(extent, i, kBlockerSearchTaps), share),
                                       place_layer, depth, on_cube)) continue;
        place_layer.z += float(light * shadow_face_count());
        count_work_once(kWorkShadowLookups);
        float stored = textureLod(shadow_depths, place_layer, 0.0).r;
        if (!(stored > depth)) continue;
        // The blocker hides the point of the lamp that lies behind the blocker, if the lamp reaches so far.
        vec3 blocker = on_cube * (near / stored);
        float blocked = 1.0 - dot(blocker, along) / way;
        vec3 aside = blocker - receiver.position * (1.0 - blocked);
        if (!(blocked > 0.0 && dot(aside, aside) <= radius_square * blocked * blocked)) continue;
        sum += blocked;
        count += 1.0;
    }
    mean = sum / max(count, 1.0);
    return count > 0.0;
}

// Returns the share of a lamp's points that the receiver sees, 0 to 1, and sets light_tint to the mean tint of their light.
// `facet` is the unit normal of the receiver's plane, on either side. `error` is the largest error of the position along
// this normal, scene units. `hard`: the visible share of the lamp's centre, with its light_tint.
float sample_soft_shadow_map(uint light, vec3 position, vec3 facet, float error, float hard) {
    LampExtent extent = lamp_extents[light];
    SoftShadowReceiver receiver;
    receiver.position = world_to_light_axes(light, position - read_light(light).position);
    receiver.normal = world_to_light_axes(light, facet);
    float height = -dot(receiver.normal, receiver.position);
    if (height < 0.0) receiver.normal = -receiver.normal;
    height = abs(height);
    receiver.place = receiver.position / cube_coordinates(cube_face(receiver.position), receiver.position).z;
    receiver.texel = 2.0 / float(textureSize(shadow_map, 0).x);
    receiver.depth_scale = read_light(light).near / max(height - error, 0.5 * height);
    receiver.least_bias = 2.0 * kShadowDepthError * dot(abs(receiver.normal), vec3(1));
    vec3 centre = normalize(receiver.position);
    vec3 along = abs(dot(extent.flat_normal, centre)) > kMinFlatLampCosine ? extent.flat_normal : centre;
    float blocked;
    if (!(height > 0.0) || !find_mean_blocker(light, extent, receiver, along, blocked)) return hard;
    float visible = 0.0;
    vec3 tint = vec3(0);
    for (uint i = 0u; i < kPenumbraTaps; ++i) {
        vec3 place_layer, on_cube;
        float depth, seen = 1.0;
        if (locate_soft_shadow_lookup(receiver, mix(receiver.position, lamp_point_offset(extent, i, kPenumbraTaps), blocked),
                                      place_layer, depth, on_cube)) {
            count_work_once(kWorkShadowLookups);
            if (tints_shadows != 0u) light_tint = vec3(1);
            seen = compare_with_shadow_map(place_layer.xy, place_layer.z + float(light * shadow_face_count()), depth);
        }
        visible += seen;
        if (tints_shadows != 0u) tint += seen * light_tint;
    }
    if (tints_shadows != 0u) light_tint = visible > 0.0 ? tint / visible : vec3(1);
    return visible / float(kPenumbraTaps);
}

#endif
