"""Writes a scene with lights of each kind of glTF, a lamp, a moving box and a mirror, for the test of other renderers."""

import json
import math
import struct

LIGHTS = {
    "point": {"type": "point", "intensity": 12, "color": [1, 0.8, 0.6]},
    "spot": {"type": "spot", "intensity": 30, "color": [0.6, 1, 0.7],
             "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.55}},
    "directional": {"type": "directional", "intensity": 1.2, "color": [0.7, 0.8, 1]},
}
# Places, and rotations about x by the angle: a light shines along its -z.
PLACES = {"point": ([-1.5, 3, 2], 0), "spot": ([1, 4, 1], -math.pi / 2), "directional": ([0, 5, 0], -1.1)}
BOXES = [([-2, 0.5, -0.5], [0.5, 0.5, 0.5], [0.8, 0.1, 0.1]), ([-0.7, 0.3, 1.2], [0.3, 0.3, 0.3], [0.9, 0.9, 0.2]),
         ([2.1, 0.8, -1.4], [0.4, 0.8, 0.4], [0.1, 0.5, 0.8]), ([1.6, 0.2, 1.3], [0.6, 0.2, 0.2], [0.2, 0.7, 0.2]),
         ([0, 1.5, -3], [3, 1.5, 0.05], [0.6, 0.6, 0.65]), ([0, -0.05, 0], [3, 0.05, 3], [0.7, 0.65, 0.6])]


def box_mesh():
    """Returns positions, normals and indices of a cube of edge 2, each face with its own vertices."""
    positions, normals, indices = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            normal = [sign * (i == axis) for i in range(3)]
            first = len(positions)
            for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                point = [0, 0, 0]
                point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = sign, u, v
                positions.append(point)
                normals.append(normal)
            order = (0, 1, 2, 0, 2, 3) if sign > 0 else (0, 2, 1, 0, 3, 2)
            indices += [first + i for i in order]
    return positions, normals, indices


def write_scene(file, lights):
    """Writes a .glb file with these kinds of lights of LIGHTS, or "lamp", a mesh that emits."""
    positions, normals, indices = box_mesh()
    data, views, accessors = b"", [], []

    def add(numbers, form, component, kind, **more):
        nonlocal data
        flat = [x for row in numbers for x in row] if isinstance(numbers[0], list) else numbers
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": struct.calcsize(form) * len(flat)})
        data += struct.pack(f"<{len(flat)}{form}", *flat)
        data += bytes(-len(data) % 4)
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(numbers), "type": kind, **more})
        return len(accessors) - 1

    attributes = {"POSITION": add(positions, "f", 5126, "VEC3", min=[-1] * 3, max=[1] * 3),
                  "NORMAL": add(normals, "f", 5126, "VEC3")}
    order = add(indices, "H", 5123, "SCALAR")
    matt = {"KHR_materials_specular": {"specularFactor": 0, "specularColorFactor": [0, 0, 0]}}
    materials, meshes, nodes = [], [], []

    def add_box(place, size, **material):
        materials.append(material)
        meshes.append({"primitives": [{"attributes": attributes, "indices": order, "material": len(materials) - 1}]})
        nodes.append({"name": f"box {len(nodes)}", "mesh": len(meshes) - 1, "translation": place, "scale": size})
        return len(nodes) - 1

    moving = [add_box(place, size, extensions=matt, pbrMetallicRoughness={"baseColorFactor": [*colour, 1], "metallicFactor": 0})
              for place, size, colour in BOXES][1]
    add_box([0.5, 0.9, -0.8], [0.5, 0.6, 0.1], pbrMetallicRoughness={"baseColorFactor": [0.9, 0.9, 0.9, 1], "roughnessFactor": 0})
    if "lamp" in lights:
        add_box([0, 3, 0], [0.4, 0.05, 0.4], emissiveFactor=[1, 0.9, 0.7],
                extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 8}, **matt},
                pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0})
    kinds = [kind for kind in LIGHTS if kind in lights]
    for index, kind in enumerate(kinds):
        place, angle = PLACES[kind]
        nodes.append({"name": kind, "translation": place, "rotation": [math.sin(angle / 2), 0, 0, math.cos(angle / 2)],
                      "extensions": {"KHR_lights_punctual": {"light": index}}})
    angle = -0.3
    nodes.append({"name": "camera", "camera": 0, "translation": [0.4, 2.6, 6], "rotation": [math.sin(angle / 2), 0, 0, math.cos(angle / 2)]})
    # Tangents that carry the box off the line between its keys, by half a unit.
    keys = add([0.0, 2.0], "f", 5126, "SCALAR", min=[0], max=[2])
    steps = [[0, 0, 0], [-0.7, 0.3, 1.2], [0, 2, 0], [0, -2, 0], [0.3, 0.3, 1.2], [0, 0, 0]]
    animation = {"channels": [{"sampler": 0, "target": {"node": moving, "path": "translation"}}],
                 "samplers": [{"input": keys, "output": add(steps, "f", 5126, "VEC3"), "interpolation": "CUBICSPLINE"}]}
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
                "meshes": meshes, "materials": materials, "accessors": accessors, "bufferViews": views,
                "buffers": [{"byteLength": len(data)}], "animations": [animation],
                "cameras": [{"type": "perspective", "perspective": {"yfov": 0.75, "znear": 0.01}}],
                "extensionsUsed": ["KHR_materials_specular", "KHR_materials_emissive_strength"]}
    if kinds:
        document["extensionsUsed"].append("KHR_lights_punctual")
        document["extensions"] = {"KHR_lights_punctual": {"lights": [LIGHTS[kind] for kind in kinds]}}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text
                     + struct.pack("<I4s", len(data), b"BIN\0") + data)
