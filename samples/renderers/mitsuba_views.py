"""Draws the views of a folder of pose.py that show one of its scenes, by the path tracer Mitsuba:

python3 -B mitsuba_views.py FOLDER SCENE.glb OUT [--environment SKY.exr] [OPTION...]

Writes OUT/view-000.exr, OUT/view-001.exr and so on, with linear light in 32-bit floats. The environment and surfaces that
emit are the only light. Without an environment the integrator is Mitsuba's own ("path"), which draws points on lamps.
Tested with Mitsuba 3.9.1 (pip install mitsuba==3.9.1 numpy) and libLLVM 19 (Debian's package libllvm19, or the variable
DRJIT_LIBLLVM_PATH).
"""

import argparse
import json
import math
import pathlib
import shutil

import drjit as dr
import mitsuba as mi
import numpy as np

import mitsuba_gltf
import pose

LANES = 2**21 # paths that are traced together


def read_options():
    parser = argparse.ArgumentParser(prog="mitsuba_views.py")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("scene", help="name of a file in the folder")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--environment", type=pathlib.Path, help="equirectangular picture, +y up, -z in the middle (none)")
    parser.add_argument("--samples", type=int, default=256, help="paths per pixel")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--light", choices=("direct", "full"), default="direct",
                        help="direct: diffuse surfaces get the whole environment, and only lobes are traced, as the technique "
                             "raytrace does; full: path tracing")
    parser.add_argument("--depth", type=int, default=16, help="reflections of a path; longer paths end black")
    parser.add_argument("--diffuse", choices=("rest", "khronos"), default="rest",
                        help="rest: what the lobe's albedo leaves, as catoptric; khronos: what the facet's Fresnel reflectance leaves")
    parser.add_argument("--shadowing", choices=("correlated", "separable"), default="correlated",
                        help="Smith's shadowing: separable is that of glTF's appendix B")
    parser.add_argument("--pixel", choices=("centre", "area"), default="centre",
                        help="what a pixel shows: the point at its centre, or the mean over its area")
    parser.add_argument("--integrator", choices=("own", "path"),
                        help="path: Mitsuba's integrator of this name, which counts back faces as surfaces (own; path without an "
                             "environment)")
    parser.add_argument("--bsdf", choices=("gltf", "plain"), default="gltf",
                        help="plain: Mitsuba's own BSDFs for Lambertian surfaces and sharp mirrors, which are faster, and black behind")
    options = parser.parse_args()
    options.integrator = options.integrator or ("own" if options.environment else "path")
    if not options.environment and (options.integrator, options.light) != ("path", "full"):
        parser.error("wanted --light full and no --integrator own without --environment, because the integrator of this file draws no "
                     "points on lamps")
    return options


def camera_rays(camera, width, height, lane, jitter):
    """Returns the rays through pixels; `jitter` is the place in the pixel, (.5, .5) in its middle."""
    eye, target, up = (mi.ScalarVector3f(camera[key]) for key in ("eye", "target", "up"))
    ahead = dr.normalize(target - eye)
    right = dr.normalize(dr.cross(ahead, up))
    above = dr.cross(right, ahead)
    x = (2 * (mi.Float(lane % width) + jitter.x) - width) / height
    y = 1 - 2 * (mi.Float(lane // width) + jitter.y) / height
    if camera["orthographic_height"]:
        half = camera["orthographic_height"] / 2
        return mi.Ray3f(mi.Point3f(eye) + mi.Vector3f(right) * x * half + mi.Vector3f(above) * y * half, mi.Vector3f(ahead))
    half = math.tan(math.radians(camera["vertical_fov_degrees"]) / 2)
    return mi.Ray3f(mi.Point3f(eye), dr.normalize(mi.Vector3f(ahead) + half * (x * mi.Vector3f(right) + y * mi.Vector3f(above))))


BOTH = mi.BSDFContext()
DIFFUSE, LOBE = (mi.BSDFContext(mi.TransportMode.Radiance, 0x1ffff, component) for component in (0, 1))


@dr.syntax
def unblocked_share(scene, first, needed):
    """Returns the share of the environment's light that arrives along rays."""
    ray, share, passed, active = mi.Ray3f(first), mi.Color3f(1), mi.UInt32(0), mi.Bool(needed)
    while active:
        si = scene.ray_intersect(ray, active)
        active &= si.is_valid()
        share[active] *= si.bsdf(ray).eval_null_transmission(si, active)
        passed += 1
        active &= (dr.max(share) > 0) & (passed < 64)
        ray = si.spawn_ray(ray.d)
    return share


def sample_sky(scene, si, context, sampler, active):
    """Returns what a point reflects of a direction that is drawn from the environment, weighted by the balance heuristic
    beside directions that the BSDF draws, and the direction."""
    at, light = scene.environment().sample_direction(si, sampler.next_2d(), active)
    value, pdf = si.bsdf().eval_pdf(context, si, si.to_local(at.d), active)
    return dr.select(active & (at.pdf > 0), value * light * (at.pdf / (at.pdf + pdf)), 0), at.d


def sky_along(scene, direction, density):
    """Returns the environment's radiance in a direction that the BSDF drew with this density, weighted by the balance
    heuristic. 0: the direction was not drawn."""
    sky, at = dr.zeros(mi.SurfaceInteraction3f), dr.zeros(mi.DirectionSample3f)
    sky.wi, at.d = -direction, direction
    other = scene.environment().pdf_direction(sky, at)
    return scene.environment().eval(sky) * dr.select(density > 0, density / (density + other), 1)


@dr.syntax
def trace(scene, sampler, first, depth, direct):
    """Returns the radiance that arrives along rays. `direct`: diffuse surfaces get the whole environment."""
    ray, radiance, weight, density = mi.Ray3f(first), mi.Color3f(0), mi.Color3f(1), mi.Float(0)
    bounces, passed, active = mi.UInt32(0), mi.UInt32(0), mi.Bool(True)
    context = LOBE if direct else BOTH
    while active:
        si = scene.ray_intersect(ray, active)
        radiance[active & ~si.is_valid()] += weight * sky_along(scene, ray.d, density)
        active &= si.is_valid()
        bsdf = si.bsdf(ray)
        drawn, reflected = bsdf.sample(context, si, sampler.next_1d(), sampler.next_2d(), active)
        is_null = mi.has_flag(drawn.sampled_type, mi.BSDFFlags.Null)
        is_surface = active & ~is_null
        radiance[is_surface] += weight * si.emitter(scene).eval(si)
        is_delta = mi.has_flag(drawn.sampled_type, mi.BSDFFlags.DeltaReflection)
        if dr.hint(direct, mode="scalar"):
            is_diffuse = is_surface & ~is_delta
            part, towards = sample_sky(scene, si, DIFFUSE, sampler, is_diffuse)
            around, share = bsdf.sample(DIFFUSE, si, mi.Float(0), sampler.next_2d(), is_diffuse)
            part += share * sky_along(scene, si.to_world(around.wo), around.pdf)
            radiance[is_diffuse] += weight * part
        active &= is_null | (bounces < depth)
        is_surface &= active
        part, towards = sample_sky(scene, si, context, sampler, is_surface)
        is_lit = is_surface & (dr.max(part) > 0)
        radiance[is_lit] += weight * part * unblocked_share(scene, si.spawn_ray(towards), is_lit)
        density[is_surface] = dr.select(is_delta, 0, drawn.pdf)
        bounces[is_surface] += 1
        weight *= reflected
        passed += 1
        active &= (dr.max(weight) > 0) & (passed < 64)
        ray = si.spawn_ray(si.to_world(drawn.wo))
    return radiance


def draw(scene, options, camera, width, height):
    """Returns the picture of a view."""
    pixels, total, done, round_number = width * height, 0, 0, 0
    while done < options.samples:
        count = min(options.samples - done, max(1, LANES // pixels))
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(1000 * options.seed + round_number, pixels * count)
        lane = dr.arange(mi.UInt32, pixels * count) // count
        jitter = sampler.next_2d() if options.pixel == "area" else mi.Point2f(.5)
        ray = camera_rays(camera, width, height, lane, jitter)
        if options.integrator == "path":
            integrator = mi.load_dict({"type": "path", "max_depth": options.depth + 1, "rr_depth": 5})
            light = integrator.sample(scene, sampler, mi.RayDifferential3f(ray))[0]
        else:
            light = trace(scene, sampler, ray, options.depth, options.light == "direct")
        sums = [np.array(dr.block_sum(channel, count), dtype=np.float64) for channel in light]
        total = total + np.stack(sums, -1)
        done, round_number = done + count, round_number + 1
    return (total / options.samples).reshape(height, width, 3).astype(np.float32)


def main():
    options = read_options()
    posed = json.loads((options.folder / "posed.json").read_text())
    options.out.mkdir(parents=True, exist_ok=True)
    shutil.copy(options.folder / "views.json", options.out) # 'compare --row' checks that its views are these
    parts = mitsuba_gltf.Loader(pose.Gltf(options.folder / options.scene)).all_parts()
    shading = mitsuba_gltf.Shading(options.diffuse, options.shadowing, options.light == "full", options.bsdf == "plain")
    scene = mitsuba_gltf.make_scene(parts, options.environment, shading)
    for view in posed["views"]:
        if view["scene"] == options.scene:
            picture = draw(scene, options, view["camera"], posed["width"], posed["height"])
            mi.Bitmap(picture).write(str(options.out / (view["name"] + ".exr")))


if __name__ == "__main__":
    main()
