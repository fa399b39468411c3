#!/usr/bin/python3
"""torus_room.py FILE.gltf: writes a closed room with a mirror torus, a scene for comparisons of path tracers.

The room is 4 wide (x), 3 high (y) and 4 deep (z) around the y axis, with its floor at y = 0. Its left wall is red, its
right wall green, and all other walls are white. A lamp of 1.6 x 1.6 hangs .01 below the ceiling and shines downwards. In the
middle a torus with the radii .7 and .28 reflects all light. All walls face inwards. The camera 'inside' stands before
the front wall. The same program always writes the same bytes.
"""

import base64
import json
import math
import pathlib
import struct
import sys

AROUND, ACROSS = 96, 48 # steps around the torus's axis and around its tube
LARGE, SMALL = .7, .28  # radii of the torus
CENTRE = (0, 1.2, -.2)
TILT = math.radians(55) # angle between the torus's axis and the y axis, towards the camera
LO, HI = (-2, 0, -2), (2, 3, 2)
LAMP_HALF, LAMP_GAP, LAMP_RADIANCE = .8, .01, 3
MATT = {"KHR_materials_specular": {"specularFactor": 0, "specularColorFactor": [0, 0, 0]}}
COLOURS = {"white": [.75, .75, .75], "red": [.65, .08, .06], "green": [.12, .5, .1]}


def make_wall(axis, is_high):
    """Returns positions, normals and triangles of a wall of the room, which faces inwards."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    positions = []
    for along_u, along_v in ((LO, LO), (HI, LO), (HI, HI), (LO, HI)):
        point = [0, 0, 0]
        point[axis], point[u], point[v] = (HI if is_high else LO)[axis], along_u[u], along_v[v]
        positions.append(point)
    normal = [0, 0, 0]
    normal[axis] = -1 if is_high else 1
    return positions, [normal] * 4, [0, 2, 1, 0, 3, 2] if is_high else [0, 1, 2, 0, 2, 3]


def make_lamp():
    height, half = HI[1] - LAMP_GAP, LAMP_HALF
    corners = [[-half, height, -half], [half, height, -half], [half, height, half], [-half, height, half]]
    return corners, [[0, -1, 0]] * 4, [0, 1, 2, 0, 2, 3]


def make_torus():
    """Returns positions, exact normals and triangles of the torus, in the axes of the room."""
    positions, normals, triangles = [], [], []
    cosine, sine = math.cos(TILT), math.sin(TILT)
    for i in range(AROUND + 1):
        a = 2 * math.pi * (i % AROUND) / AROUND
        for j in range(ACROSS + 1):
            b = 2 * math.pi * (j % ACROSS) / ACROSS
            normal = math.cos(a) * math.cos(b), math.sin(b), -math.sin(a) * math.cos(b)
            point = [LARGE * x + SMALL * n for x, n in zip((math.cos(a), 0, -math.sin(a)), normal)]
            turned = [(x, y * cosine - z * sine, y * sine + z * cosine) for x, y, z in (point, normal)]
            positions.append([x + c for x, c in zip(turned[0], CENTRE)])
            normals.append(list(turned[1]))
    row = ACROSS + 1
    for i in range(AROUND):
        for j in range(ACROSS):
            a, b, c, d = i * row + j, (i + 1) * row + j, (i + 1) * row + j + 1, i * row + j + 1
            triangles += [a, b, c, a, c, d]
    return positions, normals, triangles


def make_document():
    data = bytearray()
    views, accessors, materials, meshes, nodes = [], [], [], [], []

    def add(numbers, form, component, **more):
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": struct.calcsize(form) * len(numbers)})
        data.extend(struct.pack(f"<{len(numbers)}{form}", *numbers))
        accessors.append({"bufferView": len(views) - 1, "componentType": component, **more})
        return len(accessors) - 1

    def add_material(name, **more):
        materials.append({"name": name, **more})
        return len(materials) - 1

    def add_object(name, mesh, material):
        positions, normals, triangles = mesh
        bounds = {bound: [struct.unpack("<f", struct.pack("<f", function(p[axis] for p in positions)))[0] for axis in range(3)]
                  for bound, function in (("min", min), ("max", max))}
        attributes = {"POSITION": add(sum(positions, []), "f", 5126, count=len(positions), type="VEC3", **bounds),
                      "NORMAL": add(sum(normals, []), "f", 5126, count=len(normals), type="VEC3")}
        indices = add(triangles, "I", 5125, count=len(triangles), type="SCALAR")
        meshes.append({"name": name, "primitives": [{"attributes": attributes, "indices": indices, "material": material}]})
        nodes.append({"name": name, "mesh": len(meshes) - 1})

    paint = {name: add_material(name, extensions=MATT, pbrMetallicRoughness={
        "baseColorFactor": colour + [1], "metallicFactor": 0, "roughnessFactor": 1}) for name, colour in COLOURS.items()}
    walls = [("left wall", "red", 0, False), ("right wall", "green", 0, True), ("floor", "white", 1, False),
             ("ceiling", "white", 1, True), ("back wall", "white", 2, False), ("front wall", "white", 2, True)]
    for name, colour, axis, is_high in walls:
        add_object(name, make_wall(axis, is_high), paint[colour])
    add_object("lamp", make_lamp(), add_material(
        "lamp", emissiveFactor=[1, 1, 1], pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
        extensions=MATT | {"KHR_materials_emissive_strength": {"emissiveStrength": LAMP_RADIANCE}}))
    add_object("torus", make_torus(), add_material("mirror", pbrMetallicRoughness={"metallicFactor": 1, "roughnessFactor": 0}))
    eye_z = 1.9
    nodes.append({"name": "inside", "camera": 0, "translation": [0, 1.4, eye_z]})
    return {"asset": {"version": "2.0", "generator": "torus_room.py"}, "scene": 0,
            "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes, "materials": materials,
            "cameras": [{"name": "inside", "type": "perspective", "perspective": {"yfov": math.radians(70), "znear": .01}}],
            "extensionsUsed": ["KHR_materials_specular", "KHR_materials_emissive_strength"],
            "accessors": accessors, "bufferViews": views,
            "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," +
                         base64.b64encode(bytes(data)).decode()}]}


def main():
    if len(sys.argv) != 2 or not sys.argv[1].endswith(".gltf"):
        sys.exit("torus_room.py: wanted one FILE.gltf, found: " + " ".join(sys.argv[1:]))
    pathlib.Path(sys.argv[1]).write_text(json.dumps(make_document()) + "\n")


if __name__ == "__main__":
    main()
