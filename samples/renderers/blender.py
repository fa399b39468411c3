"""Draws the views of a folder of pose.py that show one of its scenes, by Blender:

blender --background --factory-startup --python-exit-code 1 --python blender.py -- FOLDER SCENE.glb OUT [OPTION...]

Writes OUT/view-000.exr, OUT/view-001.exr and so on, with linear light in 32-bit floats. EEVEE needs OpenGL and therefore
an X server, such as that of xvfb-run. Tested with Blender 3.4.1.
"""

import argparse
import json
import math
import pathlib
import shutil
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

# The glTF importer of Debian 12's Blender uses a name that Debian 12's NumPy lacks.
if "bool" not in vars(numpy):
    numpy.bool = bool


def read_options():
    parser = argparse.ArgumentParser(prog="blender.py")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("scene", help="name of a file in the folder")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--engine", choices=("cycles", "eevee"), default="cycles")
    parser.add_argument("--samples", type=int, default=64, help="samples per pixel")
    parser.add_argument("--light", choices=("direct", "full"), default="direct",
                        help="full: with light from one diffuse surface to another (Cycles)")
    parser.add_argument("--pixel", choices=("centre", "area"), default="centre",
                        help="what a pixel shows: the point at its centre, or the mean over its area (a box filter)")
    parser.add_argument("--face", type=int, default=256, help="edge of the captures of EEVEE, a power of two")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def turn_to_z_up(vector):
    """Returns a vector of glTF, where y points up, in Blender's axes, where z does."""
    return Vector((vector[0], -vector[2], vector[1]))


def load(file):
    """Replaces everything by the scene of a .glb file, in a black world."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Blender's importer knows intensities in candela, and its lights have watts of radiation. COMPAT takes a candela for
    # a watt per steradian, as catoptric does.
    bpy.ops.import_scene.gltf(filepath=str(file), convert_lighting_mode="COMPAT")
    for light in bpy.data.lights: # lights of glTF are points and have parallel rays
        light.shadow_soft_size = 0
        if light.type == "SUN":
            light.angle = 0
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    return scene


def bounds():
    """Returns the centre of the scene and half its diagonal."""
    points = [item.matrix_world @ Vector(corner) for item in bpy.data.objects if item.type == "MESH"
              for corner in item.bound_box]
    low, high = (Vector(tuple(pick(point[axis] for point in points) for axis in range(3))) for pick in (min, max))
    return (low + high) / 2, (high - low).length / 2


def place_camera(scene, view, radius):
    facts = view["camera"]
    data = bpy.data.cameras.new(view["name"])
    item = bpy.data.objects.new(view["name"], data)
    scene.collection.objects.link(item)
    eye, target, up = (turn_to_z_up(facts[key]) for key in ("eye", "target", "up"))
    back = (eye - target).normalized()
    right = up.cross(back).normalized()
    item.matrix_world = Matrix.Translation(eye) @ Matrix((right, back.cross(right), back)).transposed().to_4x4()
    data.sensor_fit = "VERTICAL"
    if facts["orthographic_height"]:
        data.type, data.ortho_scale = "ORTHO", facts["orthographic_height"]
    else:
        data.sensor_height = 24
        data.lens = 12 / math.tan(math.radians(facts["vertical_fov_degrees"]) / 2)
    data.clip_start, data.clip_end = 1e-3 * radius, 10 * radius + (eye - target).length
    scene.camera = item


def principled(material):
    """Returns the shader node of an imported material, or None."""
    nodes = material.node_tree.nodes if material.use_nodes else []
    return next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)


def emits(material):
    """Returns whether a material emits light."""
    node = principled(material)
    return node is not None and node.inputs["Emission Strength"].default_value > 0 and (
        node.inputs["Emission"].is_linked or max(node.inputs["Emission"].default_value[:3]) > 0)


def hide_backs_of_lamps():
    """Lets lamps with one side emit to this side only, as glTF says. Blender's emission has two sides."""
    for material in bpy.data.materials:
        if not material.use_backface_culling or not emits(material):
            continue
        nodes, links, strength = material.node_tree.nodes, material.node_tree.links, principled(material).inputs["Emission Strength"]
        geometry, front = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeMath")
        front.operation, front.inputs[0].default_value = "MULTIPLY_ADD", -strength.default_value
        front.inputs[2].default_value = strength.default_value
        links.new(geometry.outputs["Backfacing"], front.inputs[1])
        links.new(front.outputs[0], strength)


def use_lambertian_surfaces():
    """Makes Lambertian surfaces of those that reflect nothing. The diffuse part of Blender's Principled BSDF is Disney's."""
    for material in bpy.data.materials:
        node = principled(material)
        if node is None or any(node.inputs[name].is_linked or node.inputs[name].default_value > 0
                               for name in ("Specular", "Metallic", "Transmission", "Clearcoat")):
            continue
        if node.inputs["Alpha"].is_linked or node.inputs["Alpha"].default_value < 1 or emits(material):
            continue
        nodes, links = material.node_tree.nodes, material.node_tree.links
        diffuse = nodes.new("ShaderNodeBsdfDiffuse")
        for name, other in (("Base Color", "Color"), ("Normal", "Normal")):
            if node.inputs[name].is_linked:
                links.new(node.inputs[name].links[0].from_socket, diffuse.inputs[other])
            elif name == "Base Color":
                diffuse.inputs[other].default_value = node.inputs[name].default_value
        links.new(diffuse.outputs[0], next(x for x in nodes if x.type == "OUTPUT_MATERIAL").inputs["Surface"])


def set_up_cycles(scene, options):
    cycles, direct = scene.cycles, options.light == "direct"
    scene.render.engine = "CYCLES"
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = options.samples, False, False
    # A box always has the width of a pixel.
    cycles.pixel_filter_type, cycles.filter_width = ("GAUSSIAN", .01) if options.pixel == "centre" else ("BOX", 1)
    cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = 16
    cycles.diffuse_bounces = 0 if direct else 16
    # Nothing that trades bias for less noise.
    cycles.sample_clamp_indirect = cycles.sample_clamp_direct = cycles.blur_glossy = cycles.light_sampling_threshold = 0
    hide_backs_of_lamps()
    use_lambertian_surfaces()


def add_lamps(scene, lamps):
    """Adds a light for each lamp, because the emission of meshes lights nothing in EEVEE."""
    for index, lamp in enumerate(lamps):
        one_sided = lamp["direction"] is not None
        data = bpy.data.lights.new(f"lamp {index}", "AREA" if one_sided else "POINT")
        strength = max(lamp["emission"])
        data.color = [value / strength for value in lamp["emission"]]
        # For the radiance L and the area A: Blender's area lights of W watts have L = W / (4 A), and its points have
        # W / (4 pi) watts per steradian, which are L A / 4 for a closed lamp.
        data.energy = (4 if one_sided else math.pi) * strength * lamp["area"]
        data.specular_factor = 0 # mirrors show the mesh
        if one_sided:
            data.shape, data.size = "SQUARE", math.sqrt(lamp["area"])
        else:
            data.shadow_soft_size = math.sqrt(lamp["area"] / (4 * math.pi))
        item = bpy.data.objects.new(data.name, data)
        scene.collection.objects.link(item)
        item.location = turn_to_z_up(lamp["position"])
        if one_sided:
            item.rotation_mode = "QUATERNION"
            item.rotation_quaternion = turn_to_z_up(lamp["direction"]).to_track_quat("-Z", "Y")


def is_mirror(material):
    node = principled(material)
    if node is None:
        return False
    return node.inputs["Metallic"].default_value >= .5 and node.inputs["Roughness"].default_value <= .6


def add_reflection_probes(scene, radius):
    """Adds a capture in the middle of each smooth metal object, which looks through the object's own back faces."""
    for material in bpy.data.materials:
        material.use_backface_culling = material.use_backface_culling or is_mirror(material)
    for item in [item for item in scene.objects if item.type == "MESH"]:
        if not any(slot.material and is_mirror(slot.material) for slot in item.material_slots):
            continue
        corners = [item.matrix_world @ Vector(corner) for corner in item.bound_box]
        centre = sum(corners, Vector()) / 8
        data = bpy.data.lightprobes.new(f"capture of {item.name}", "CUBE")
        data.influence_distance = 1.05 * max((corner - centre).length for corner in corners)
        data.falloff, data.clip_start, data.clip_end = 0, 1e-3 * radius, 10 * radius
        probe = bpy.data.objects.new(data.name, data)
        scene.collection.objects.link(probe)
        probe.location = centre


def set_up_eevee(scene, options, lamps, radius):
    eevee = scene.eevee
    scene.render.engine = "BLENDER_EEVEE"
    eevee.taa_render_samples = options.samples
    scene.render.filter_size = 0 if options.pixel == "centre" else 1
    eevee.use_soft_shadows, eevee.shadow_cube_size, eevee.shadow_cascade_size = True, "2048", "2048"
    eevee.use_shadow_high_bitdepth, eevee.light_threshold = True, 0
    eevee.use_ssr, eevee.use_ssr_halfres, eevee.ssr_firefly_fac, eevee.gi_glossy_clamp = True, False, 0, 0
    eevee.gi_cubemap_resolution, eevee.gi_diffuse_bounces = str(options.face), 1
    for material in bpy.data.materials:
        if emits(material):
            material.shadow_method = "NONE" # the light stands in its middle
    add_lamps(scene, lamps)
    for light in bpy.data.lights:
        light.shadow_buffer_clip_start = 1e-3 * radius
    add_reflection_probes(scene, radius)
    bpy.context.view_layer.update()
    bpy.ops.scene.light_cache_bake(subset="CUBEMAPS")


def set_up_picture(scene, width, height):
    render, image = scene.render, scene.render.image_settings
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.use_compositing = render.use_sequencer = False
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
    scene.view_settings.view_transform = "Raw" # EXR files hold linear light with any of them


def main():
    options = read_options()
    posed = json.loads((options.folder / "posed.json").read_text())
    options.out.mkdir(parents=True, exist_ok=True)
    shutil.copy(options.folder / "views.json", options.out) # 'compare --row' checks that its views are these
    views = [view for view in posed["views"] if view["scene"] == options.scene]
    scene = load(options.folder / options.scene)
    radius = bounds()[1]
    set_up_picture(scene, posed["width"], posed["height"])
    if options.engine == "cycles":
        set_up_cycles(scene, options)
    else:
        set_up_eevee(scene, options, views[0]["lamps"], radius)
    for view in views:
        place_camera(scene, view, radius)
        scene.render.filepath = str((options.out / (view["name"] + ".exr")).resolve())
        bpy.ops.render.render(write_still=True)


main()
