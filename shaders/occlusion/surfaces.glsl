// The surfaces of the camera's view as occlusion/surface.frag draws them.
#ifndef CATOPTRIC_OCCLUSION_SURFACES_GLSL
#define CATOPTRIC_OCCLUSION_SURFACES_GLSL

#include "lib/bindings.glsl"
#include "lib/eye.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 20) uniform sampler2D surfaces;

struct SeenSurface {
    vec3 position; // vector from the eye to the surface, scene units
    vec3 normal;
    bool exists; // false: the pixel shows no surface
};

View camera_view = views[0];
// The steps of one pixel across and down, at a distance of 1 along the view's axis. With an orthographic view, at any
// distance.
vec3 pixel_across, pixel_down;
ivec2 picture_size;

void prepare_camera_view() {
    picture_size = textureSize(surfaces, 0);
    pixel_across = camera_view.right * (2.0 / (dot(camera_view.right, camera_view.right) * float(picture_size.x)));
    pixel_down = camera_view.down * (2.0 / (dot(camera_view.down, camera_view.down) * float(picture_size.y)));
}

SeenSurface read_seen_surface(ivec2 pixel) {
    count_work_once(kWorkTextureLookups);
    vec4 texel = texelFetch(surfaces, pixel, 0);
    vec2 place = vec2(pixel) + 0.5 - 0.5 * vec2(picture_size);
    vec3 aside = place.x * pixel_across + place.y * pixel_down;
    return SeenSurface(texel.w * camera_view.forward + (orthographic != 0u ? 1.0 : texel.w) * aside, texel.xyz, texel.w > 0.0);
}

#endif
