"""Writes .glb scenes that differ in one number: a bright box with a lattice of balls, some of which are mirrors."""
import array
import json
import math
import struct

FACES = [((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((-1, 0, 0), (0, 0, 1), (0, 1, 0)), ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
         ((0, -1, 0), (1, 0, 0), (0, 0, 1)), ((0, 0, 1), (1, 0, 0), (0, 1, 0)), ((0, 0, -1), (0, 1, 0), (1, 0, 0))]


def cube_of_squares(edge, warp):
    """Returns positions, normals and indices of a cube whose faces have edge^2 squares, 12 edge^2 triangles in all. The
    function `warp` maps each corner, with the face's outward normal, to a position and a normal."""
    positions, normals, indices = array.array("f"), array.array("f"), array.array("I")
    for out, right, up in FACES:
        first = len(positions) // 3
        for j in range(edge + 1):
            for i in range(edge + 1):
                u, v = 2 * i / edge - 1, 2 * j / edge - 1
                position, normal = warp([out[k] + u * right[k] + v * up[k] for k in range(3)], out)
                positions.extend(position)
                normals.extend(normal)
        for j in range(edge):
            for i in range(edge):
                a = first + j * (edge + 1) + i
                b, c, d = a + 1, a + edge + 1, a + edge + 2
                indices.extend((a, b, d, a, d, c))
    return positions, normals, indices


def ball(edge):
    """Returns a ball of radius 1. The squares of a face have equal angles, so that all triangles have similar sizes."""
    def warp(corner, _):
        bent = [math.tan(math.pi / 4 * c) for c in corner]
        length = math.sqrt(sum(c * c for c in bent))
        unit = [c / length for c in bent]
        return unit, unit
    return cube_of_squares(edge, warp)


def room():
    """Returns a cube from -1 to 1 whose triangles face inwards."""
    positions, normals, indices = cube_of_squares(1, lambda corner, out: (corner, [-c for c in out]))
    for i in range(0, len(indices), 3):
        indices[i + 1], indices[i + 2] = indices[i + 2], indices[i + 1]
    return positions, normals, indices


class Glb:
    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "accessors": [], "bufferViews": [], "materials": []}
        self.bytes = bytearray()

    def accessor(self, values, width, target):
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "target": target,
                                         "byteLength": len(values) * values.itemsize})
        self.bytes += values.tobytes()
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "count": len(values) // width,
                    "componentType": 5126 if width == 3 else 5125, "type": "VEC3" if width == 3 else "SCALAR"}
        if width == 3:
            accessor["min"] = [min(values[k::3]) for k in range(3)]
            accessor["max"] = [max(values[k::3]) for k in range(3)]
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def shape(self, arrays):
        positions, normals, indices = arrays
        return {"attributes": {"POSITION": self.accessor(positions, 3, 34962),
                               "NORMAL": self.accessor(normals, 3, 34962)},
                "indices": self.accessor(indices, 1, 34963)}

    def mesh(self, shape, material):
        self.json["meshes"].append({"primitives": [dict(shape, material=material)]})
        return len(self.json["meshes"]) - 1

    def material(self, name, colour, is_mirror=False):
        self.json["materials"].append({"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [*colour, 1], "metallicFactor": float(is_mirror),
            "roughnessFactor": 0.0 if is_mirror else 1.0}})
        return len(self.json["materials"]) - 1

    def node(self, **node):
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.bytes)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(self.bytes)))
            file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
            file.write(struct.pack("<II", len(self.bytes), 0x004E4942) + self.bytes)


def write(path, lattice, mirrors, lights, edge):
    """Writes a scene with lattice^3 balls of 12 edge^2 triangles each. `mirrors` of the balls, spread over the lattice,
    are mirrors. `lights` point lights are on a circle below the ceiling. Returns the number of triangles."""
    glb = Glb()
    glb.node(name="room", mesh=glb.mesh(glb.shape(room()), glb.material("wall", (.7, .7, .7))), scale=[4, 4, 4])
    shape = ball(edge)
    diffuse, mirror = glb.material("paint", (.7, .4, .3)), glb.material("mirror", (.9, .9, .9), True)
    count = lattice ** 3
    chosen = {(k * count + count // 2) // mirrors for k in range(mirrors)}
    for n in range(count):
        cell = (n % lattice, n // lattice % lattice, n // lattice ** 2)
        place = [5 * ((c + .5) / lattice - .5) + .3 * math.sin(7 * n + k) / lattice for k, c in enumerate(cell)]
        glb.node(name=f"ball {n}", mesh=glb.mesh(glb.shape(shape), mirror if n in chosen else diffuse),
                 translation=place, scale=[1.6 / lattice] * 3)
    glb.json["extensionsUsed"] = ["KHR_lights_punctual"]
    glb.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 40 / lights}]}}
    for n in range(lights):
        angle = 2 * math.pi * n / lights
        glb.node(name=f"light {n}", translation=[2.5 * math.cos(angle), 3.6, 2.5 * math.sin(angle)],
                 extensions={"KHR_lights_punctual": {"light": 0}})
    glb.write(path)
    return 12 + 12 * edge ** 2 * count


CAMERA = "0.3,0.4,3.8:0,0,0:60"
