// Paths that share their camera ray. All paths of a camera ray are equal up to the first surface where something is drawn at
// random. One dispatch traces this shared part, adds its light to the picture, and stores for each pixel where it ends.
// Later dispatches trace one path from each stored start. Where glass or blended surfaces split rays, the shared part is
// a tree. If more than one of its branches ends at such a surface, the pixel's paths start at the camera ray's hit, and
// the rest of the tree is traced with each path.
// A shader that defines SHARES_CAMERA_RAYS declares the list `starts`. Other shaders trace whole paths.
#ifndef CATOPTRIC_PATH_START_GLSL
#define CATOPTRIC_PATH_START_GLSL

uint met_before = 0u; // mirrors that the shared part of the path has met, as trace_radiance returns them

#ifdef SHARES_CAMERA_RAYS

const bool resumes_path = resumes_paths != 0u; // whether the dispatch traces paths from stored starts
const bool finds_path_start = !resumes_path;   // whether it traces the shared part
uint start_place = 0u;        // index of the pixel's start
uint start_count = 0u;        // branches of the shared part that end where something is drawn at random
TraceHit camera_hit;
bool has_camera_hit = false;

void keep_camera_hit(TraceHit hit) {
    if ((has_glass == 0u && has_blending == 0u) || has_camera_hit) return;
    camera_hit = hit;
    has_camera_hit = true;
}

// The start that is stored at the end. The software driver executes a store lane by lane, also where no lane stores, so the
// loop over surfaces must not hold one.
PathStart path_start;

PathStart make_path_start(TraceHit hit, Ray ray, vec3 low, vec3 weight, uint bounce, bool is_shaded) {
    return PathStart(hit.barycentric, hit.t, hit.triangle, hit.object, hit.place, hit.inside, ray.origin, ray.direction,
                     low, weight, bounce, uint(is_shaded), path_pixel, path_bodies);
}

// Ends a branch of the shared part at the surface that the ray has met. `low`: rounding error of the ray's origin.
void keep_path_start(TraceHit hit, Ray ray, vec3 low, vec3 weight, uint bounce, bool is_shaded) {
    ++start_count;
    if (start_count == 1u) path_start = make_path_start(hit, ray, low, weight, bounce, is_shaded);
    else pending_count = 0u; // the shared part is traced again with each path
}

void store_no_path_start() { starts[start_place].bounce = kNoPathStart; }
bool has_path_start() { return finds_path_start && start_count > 0u; }

// Stores where the pixel's paths start, after the shared part of the camera ray's paths was traced with these results.
void store_end_of_shared_part(Ray camera_ray, inout vec3 radiance, inout uint met) {
    if (start_count == 0u) {
        store_no_path_start();
        return;
    }
    if ((has_glass != 0u || has_blending != 0u) && start_count > 1u) {
        path_start = make_path_start(camera_hit, camera_ray, object_spaces != 0u ? camera_view.eye_low : vec3(0), vec3(1), 0u, false);
        path_start.bodies = 0u;
        radiance = vec3(0);
        met = 0u;
    }
    starts[start_place] = path_start;
}

// Reads the pixel's start, at the surface that the ray has met.
void resume_path(out Ray ray, out TraceHit hit, out vec3 weight, out uint bounce, out bool is_shaded) {
    PathStart start = starts[start_place];
    hit = TraceHit(start.t, start.barycentric, start.triangle, start.object, start.place, start.inside);
    ray = Ray(start.origin, start.direction, 0u);
    trace_low = start.origin_low;
    weight = start.weight;
    bounce = start.bounce;
    is_shaded = start.is_shaded != 0u;
    path_bodies = start.bodies;
}

#else

const bool finds_path_start = false, resumes_path = false;
void store_no_path_start() {}
bool has_path_start() { return false; }
void store_end_of_shared_part(Ray camera_ray, inout vec3 radiance, inout uint met) {}
void keep_camera_hit(TraceHit hit) {}
void keep_path_start(TraceHit hit, Ray ray, vec3 low, vec3 weight, uint bounce, bool is_shaded) {}
void resume_path(inout Ray ray, inout TraceHit hit, inout vec3 weight, inout uint bounce, inout bool is_shaded) {}

#endif

// Returns whether the shading of the surface that was evaluated last draws random numbers. `is_coated`: it has a clear coat.
bool is_shading_random(Surface surface, bool is_coated) {
    if (has_clear_coats != 0u && traces_lobes != 0u && is_coated) return true;
    return environment_shadows != 0u && surface.albedo != vec3(0) && !(has_glass != 0u && is_glass(surface.detail));
}

#endif
