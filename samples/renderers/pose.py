#!/usr/bin/python3
"""pose.py CATOPTRIC SCENE FOLDER [OPTION...]: writes what other renderers draw for the views in FOLDER/views.json.

FOLDER/views.json is a file of 'catoptric views'. SCENE is a .glb or .gltf file. OPTION: options of 'catoptric info',
which lists the lamps. For each instant of the views this writes FOLDER/scene-N.glb, which holds the scene without
animations, as it stands at that instant. FOLDER/posed.json lists the views, each with its .glb file and its lamps.
Renderers read animations differently (Blender leaves out the tangents of cubic splines), but all read such files alike.
"""

import base64
import json
import math
import mimetypes
import pathlib
import struct
import subprocess
import sys
import urllib.parse

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
TYPES = {5120: ("b", 127), 5121: ("B", 255), 5122: ("h", 32767), 5123: ("H", 65535), 5126: ("f", 0)}


class SceneError(Exception):
    pass


def read_uri(uri, folder):
    """Returns the bytes of a data: URI, or of a file beside the scene."""
    if uri.startswith("data:"):
        return base64.b64decode(uri.split(",", 1)[1])
    return (folder / urllib.parse.unquote(uri)).read_bytes()


class Gltf:
    """A glTF document, with all its bytes in one buffer."""

    def __init__(self, file):
        data, binary = file.read_bytes(), b""
        if data[:4] == b"glTF":
            size = struct.unpack_from("<I", data, 12)[0]
            text = data[20:20 + size]
            if len(data) > 28 + size:
                length = struct.unpack_from("<I", data, 20 + size)[0]
                binary = data[28 + size:28 + size + length]
        elif data.lstrip()[:1] == b"{":
            text = data
        else:
            raise SceneError("wanted a .glb or .gltf file, found another format")
        self.document = json.loads(text)
        self.data = bytearray()
        starts = []
        for buffer in self.document.get("buffers", []):
            starts.append(self.append(read_uri(buffer["uri"], file.parent) if "uri" in buffer else binary))
        for view in self.document.get("bufferViews", []):
            for part in (view, *view.get("extensions", {}).values()):
                if "buffer" in part:
                    part["byteOffset"] = part.get("byteOffset", 0) + starts[part["buffer"]]
                    part["buffer"] = 0
        for image in self.document.get("images", []):
            if "uri" in image:
                self.embed_image(image, file.parent)

    def append(self, data):
        """Adds bytes to the buffer. Returns where they begin."""
        self.data += bytes(-len(self.data) % 8)
        start = len(self.data)
        self.data += data
        return start

    def embed_image(self, image, folder):
        uri = image.pop("uri")
        data = read_uri(uri, folder)
        kind = uri[5:].split(";")[0] if uri.startswith("data:") else mimetypes.guess_type(uri)[0]
        image.setdefault("mimeType", kind or "image/png")
        views = self.document.setdefault("bufferViews", [])
        views.append({"buffer": 0, "byteOffset": self.append(data), "byteLength": len(data)})
        image["bufferView"] = len(views) - 1

    def read(self, index):
        """Returns the elements of an accessor, each as a list of numbers."""
        accessor = self.document["accessors"][index]
        view = self.document["bufferViews"][accessor["bufferView"]] if "bufferView" in accessor else None
        if view is None or "sparse" in accessor or "EXT_meshopt_compression" in view.get("extensions", {}):
            raise SceneError(f"accessors[{index}]: wanted keys of an animation in plain buffers, "
                             "found sparse or compressed ones")
        letter, unit = TYPES[accessor["componentType"]]
        form = "<" + letter * COMPONENTS[accessor["type"]]
        stride = view.get("byteStride", struct.calcsize(form))
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        rows = [struct.unpack_from(form, self.data, begin + i * stride) for i in range(accessor["count"])]
        if unit and accessor.get("normalized"):
            rows = [[max(value / unit, -1) for value in row] for row in rows]
        return [list(row) for row in rows]

    def write(self, file):
        document = dict(self.document)
        if self.data:
            document["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(document).encode()
        chunks = [(text + b" " * (-len(text) % 4), b"JSON")]
        if self.data:
            chunks.append((bytes(self.data) + bytes(-len(self.data) % 4), b"BIN\0"))
        with file.open("wb") as out:
            out.write(struct.pack("<4sII", b"glTF", 2, 12 + sum(8 + len(data) for data, _ in chunks)))
            for data, kind in chunks:
                out.write(struct.pack("<I4s", len(data), kind) + data)


def normalise(quaternion):
    length = math.sqrt(sum(value * value for value in quaternion))
    return [value / length for value in quaternion]


def slerp(a, b, share):
    """Returns the rotation between two quaternions, by the shorter way."""
    a, b = normalise(a), normalise(b)
    cosine = sum(x * y for x, y in zip(a, b))
    if cosine < 0:
        b, cosine = [-value for value in b], -cosine
    if cosine > 0.99999:
        return normalise([x + share * (y - x) for x, y in zip(a, b)])
    angle = math.acos(cosine)
    left, right = math.sin((1 - share) * angle), math.sin(share * angle)
    return [(left * x + right * y) / math.sin(angle) for x, y in zip(a, b)]


def value_at(times, values, interpolation, is_rotation, time):
    """Returns the value of a track (glTF 2.0, appendix C)."""
    cubic = interpolation == "CUBICSPLINE"
    pick = (lambda i: values[3 * i + 1]) if cubic else (lambda i: values[i])
    if time <= times[0]:
        return pick(0)
    if time >= times[-1]:
        return pick(len(times) - 1)
    k = max(i for i, key in enumerate(times) if key <= time)
    if interpolation == "STEP":
        return pick(k)
    length = times[k + 1] - times[k]
    t = (time - times[k]) / length
    if not cubic:
        if is_rotation:
            return slerp(pick(k), pick(k + 1), t)
        return [x + t * (y - x) for x, y in zip(pick(k), pick(k + 1))]
    weights = (2 * t**3 - 3 * t**2 + 1, length * (t**3 - 2 * t**2 + t), 3 * t**2 - 2 * t**3, length * (t**3 - t**2))
    terms = zip(pick(k), values[3 * k + 2], pick(k + 1), values[3 * k + 3])
    value = [sum(weight * part for weight, part in zip(weights, parts)) for parts in terms]
    return normalise(value) if is_rotation else value


class Motion:
    """The first animation of a document, as catoptric plays it."""

    def __init__(self, gltf):
        animation = gltf.document["animations"][0]
        self.repeats = animation.get("extras", {}).get("catoptric", {}).get("repeats", False)
        self.tracks = []
        for channel in animation["channels"]:
            target, sampler = channel["target"], animation["samplers"][channel["sampler"]]
            if "node" in target and target["path"] in ("translation", "rotation", "scale"):
                self.tracks.append((target["node"], target["path"], [row[0] for row in gltf.read(sampler["input"])],
                                    gltf.read(sampler["output"]), sampler.get("interpolation", "LINEAR")))
        self.end = max((track[2][-1] for track in self.tracks), default=0)

    def move(self, nodes, time):
        if self.repeats and self.end > 0:
            time = math.fmod(time, self.end)
        for node, path, times, values, interpolation in self.tracks:
            nodes[node][path] = value_at(times, values, interpolation, path == "rotation", time)


def main():
    program, scene, folder, options = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[4:]
    views = json.loads((folder / "views.json").read_text())
    gltf = Gltf(scene)
    motion = Motion(gltf) if gltf.document.get("animations") else None
    gltf.document.pop("animations", None)
    instants, listed = {}, []
    for view in views["views"]:
        time = view["time"] if motion else 0
        if time not in instants:
            name = f"scene-{len(instants):03}.glb"
            if motion:
                motion.move(gltf.document["nodes"], time)
            gltf.write(folder / name)
            info = json.loads(subprocess.run([program, "info", scene, "--json", "--time", str(time), *options], check=True,
                                             stdout=subprocess.PIPE).stdout)
            if info["environment"] is not None:
                print(f"pose.py: {scene} has an environment, which the pictures of Blender and three.js lack", file=sys.stderr)
            instants[time] = name, [light for light in info["lights"] if light["kind"] == "mesh"]
        name, lamps = instants[time]
        listed.append({"name": view["name"], "camera": view["camera"], "scene": name, "lamps": lamps})
    posed = {"width": views["width"], "height": views["height"], "views": listed}
    (folder / "posed.json").write_text(json.dumps(posed, indent=1) + "\n")


if __name__ == "__main__":
    try:
        main()
    except (SceneError, OSError, KeyError, IndexError, ValueError, struct.error) as error:
        sys.exit(f"pose.py: {' '.join(sys.argv[2:3])}: {type(error).__name__}: {error}")
    except subprocess.CalledProcessError as error:
        sys.exit(error.returncode)
