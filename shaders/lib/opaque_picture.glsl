// The camera's view as it is before glass is drawn. Glass with refract=screen shows it at the point where the refracted ray
// leaves the body, as three.js and the glTF Sample Viewer do.
#ifndef CATOPTRIC_OPAQUE_PICTURE_GLSL
#define CATOPTRIC_OPAQUE_PICTURE_GLSL

#include "lib/refraction.glsl"

layout(set = 0, binding = OPAQUE_PICTURE_BINDING) uniform sampler2D opaque_picture;
layout(set = 0, binding = OPAQUE_LEVELS_BINDING) uniform texture2D opaque_levels; // from level 1 on, box-filtered

// Returns the colour of the picture at a place in pixels, as the bilinear mean of four pixels.
vec3 opaque_picture_colour(vec2 place) {
    // A ray that passes the glass without bending ends in the middle of its own pixel, and its look-up must mix in no other pixel. Rasterisers move vertices to the
    // nearest 1/256 of a pixel, which puts the end up to 1/512 beside the middle. Rounding to 1/64 takes that away.
    const float kWeightSteps = 64.0;
    ivec2 last = textureSize(opaque_picture, 0) - 1;
    vec2 low = floor(place - 0.5), share = round((place - 0.5 - low) * kWeightSteps) / kWeightSteps;
    vec3 sum = vec3(0);
    count_colour_lookups(1u);
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        float weight = (step.x == 1 ? share.x : 1.0 - share.x) * (step.y == 1 ? share.y : 1.0 - share.y);
        if (weight > 0.0) sum += weight * texelFetch(opaque_picture, clamp(ivec2(low) + step, ivec2(0), last), 0).rgb;
    }
    return sum;
}

#ifndef ABLATE
// Returns the level of the picture that rough glass shows: that of three.js, which has no derivation. It is the mean of the
// whole picture where the roughness is 1 and the index of refraction at least 1.5.
float opaque_picture_level(uint detail) {
    float bending = clamp(2.0 * read_material_parameters(detail).ior - 2.0, 0.0, 1.0);
    return log2(float(textureSize(opaque_picture, 0).x)) * specular_lobe.roughness * bending;
}
#endif

// Finds the light that the picture shows at the end of the ray's way through the body. Returns false if the end is outside the
// picture or behind the eye.
bool find_light_in_opaque_picture(uint detail, vec3 end, out vec3 light) {
    View view = views[draw.first_view];
    light = vec3(0);
    if (orthographic == 0u && !(dot(view.forward, end - view.eye) > 0.0)) return false;
    vec2 place = find_place_of_point(view, end);
    if (!(all(greaterThanEqual(place, vec2(0))) && all(lessThanEqual(place, vec2(1))))) return false;
#ifndef ABLATE
    if (has_lobes != 0u && has_levels) {
        float level = opaque_picture_level(detail);
        if (level > 0.0) {
            count_colour_lookups(1u);
            light = textureLod(sampler2D(opaque_levels, mipmapped_texels), place, max(level, 1.0) - 1.0).rgb;
            if (level < 1.0) light = mix(opaque_picture_colour(place * vec2(textureSize(opaque_picture, 0))), light, level);
            return true;
        }
    }
#endif
    light = opaque_picture_colour(place * vec2(textureSize(opaque_picture, 0)));
    return true;
}

#endif
