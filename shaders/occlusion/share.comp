// Computes the share of the environment that the surfaces of the camera's view leave visible at each of them, by horizon
// angles in slices around the direction to the viewer (GTAO: Jimenez et al., "Practical Realtime Strategies for Accurate
// Indirect Occlusion", 2016). Stores the visible and the whole cosine-weighted solid angle of the pixel's slices, so that
// the mean over neighbouring pixels (occlusion/mean.comp) weights slices by what they contribute.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "occlusion/surfaces.glsl"

layout(set = 0, binding = 21, rgba16f) writeonly uniform image2D solid_angles;
layout(push_constant, scalar) uniform Push { float radius; }; // farther surfaces do not count, scene units

// Slices and steps of one pixel. The pixels of a block of 4x4 turn their slices and move their steps by different amounts.
const uint kSlices = 2u, kSteps = 6u;
// Part of the radius within which surfaces count fully.
const float kFullRadius = 0.5;
// A slice whose plane is this close to orthogonal to the normal (sine of the angle) has no share in the sum that a picture
// could show, and the angle of its normal is lost in rounding.
const float kMinNormalPart = 1e-4;
// Distances from the eye are interpolated with an error of this share (lib/surface.glsl, fragment_position_error).
const float kDistanceError = 1.0 / 16384.0;

// Returns the integral of the cosine to the normal times |sin| from the direction to the viewer (angle 0) to `angle`.
// `normal_angle`: angle between the normal and the viewer, with that cosine and sine.
float cosine_integral(float angle, float normal_angle, float cosine, float sine) {
    float integral = 0.25 * (cosine - cos(2.0 * angle - normal_angle) + 2.0 * angle * sine);
    return angle < 0.0 ? -integral : integral;
}

// Returns the angle from the normal to the horizon that `height` means (find_horizon).
float horizon_angle(float height) { return height <= 1.0 ? acos(height) : -acos(2.0 - height); }

// A slice: the plane of the direction to the viewer and the unit vector `along`, which is orthogonal to it.
struct Slice {
    vec2 on_screen;    // step of one pixel along the slice
    vec3 tangent;      // unit vector in the slice, orthogonal to the normal's projection
    float normal_part; // length of the normal's projection to the slice
    float pixels;      // pixels of the radius
};

// Returns the height of the horizon on the side `side` (1 or -1) of the slice: the cosine of its angle from the projected
// normal, 0 to 1; 2 minus that cosine beyond the normal. The height follows from the angle between sample and tangent plane,
// because that angle is 0 on a plane also for samples beside the slice, at the middle of their pixels.
float find_horizon(ivec2 pixel, SeenSurface surface, Slice slice, float side, float start) {
    float height = 0.0, error = kDistanceError * length(surface.position);
    uint i = 0u;
    do {
        float part = (float(i) + start) / float(kSteps);
        float pixels = max(part * part * slice.pixels, float(i) + 1.0);
        ivec2 at = ivec2(floor(vec2(pixel) + 0.5 + side * pixels * slice.on_screen));
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, picture_size))) break;
        SeenSurface other = read_seen_surface(at);
        vec3 way = other.position - surface.position;
        float distance = length(way), above = dot(way, surface.normal) - error;
        if (other.exists && above > 0.0 && distance < radius) {
            float cosine = min(above / (distance * slice.normal_part), 1.0);
            float own = side * dot(way, slice.tangent) > 0.0 ? cosine : 2.0 - cosine;
            height = max(height, own * clamp((radius - distance) / ((1.0 - kFullRadius) * radius), 0.0, 1.0));
        }
    } while (++i < kSteps);
    return height;
}

void main() {
    prepare_camera_view();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= picture_size.x || pixel.y >= picture_size.y) return;
    SeenSurface surface = read_seen_surface(pixel);
    vec2 sum = vec2(0);
    if (surface.exists) {
        vec3 to_viewer = orthographic != 0u ? -camera_view.forward : -normalize(surface.position);
        vec3 across, up;
        tangent_frame(to_viewer, across, up);
        // The order of a 4x4 Bayer matrix: neighbours differ much.
        ivec2 cell = pixel & 3, fine = cell & 1, coarse = cell >> 1;
        int order = 4 * ((fine.x ^ fine.y) * 2 + fine.y) + (coarse.x ^ coarse.y) * 2 + coarse.y;
        float turn = (float(order) + 0.5) / 16.0, start = (float(order * 5 & 15) + 0.5) / 16.0;
        float along = dot(camera_view.forward, surface.position);
        uint i = 0u;
        do {
            float angle = kPi * (float(i) + turn) / float(kSlices);
            vec3 direction = cos(angle) * across + sin(angle) * up;
            // The movement on the screen, in pixels, of a point that moves along `direction`.
            vec2 moved = vec2(dot(camera_view.right, direction), dot(camera_view.down, direction));
            if (orthographic == 0u)
                moved = (moved - vec2(dot(camera_view.right, surface.position), dot(camera_view.down, surface.position)) *
                                     (dot(camera_view.forward, direction) / along)) / along;
            moved *= 0.5 * vec2(picture_size);
            float pixels_per_unit = length(moved);
            vec3 aside = cross(direction, to_viewer);
            vec3 projected = surface.normal - aside * dot(surface.normal, aside);
            Slice slice;
            slice.normal_part = length(projected);
            slice.pixels = pixels_per_unit * radius;
            if (!(slice.normal_part > kMinNormalPart && pixels_per_unit > 0.0)) continue;
            float cosine = dot(projected, to_viewer) / slice.normal_part, sine = dot(projected, direction) / slice.normal_part;
            float normal_angle = atan(sine, cosine);
            slice.on_screen = moved / pixels_per_unit;
            slice.tangent = direction * cosine - to_viewer * sine;
            float left = normal_angle - horizon_angle(find_horizon(pixel, surface, slice, -1.0, start));
            float right = normal_angle + horizon_angle(find_horizon(pixel, surface, slice, 1.0, start));
            float whole = cosine_integral(normal_angle + 0.5 * kPi, normal_angle, cosine, sine) -
                          cosine_integral(normal_angle - 0.5 * kPi, normal_angle, cosine, sine);
            float visible = cosine_integral(max(left, right), normal_angle, cosine, sine) - cosine_integral(left, normal_angle, cosine, sine);
            sum += slice.normal_part * vec2(visible, whole);
        } while (++i < kSlices);
    }
    imageStore(solid_angles, pixel, vec4(sum, 0, 0));
}
