#!/usr/bin/python3
"""Draws a scene of rough metals and dielectrics by Mitsuba and by catoptric, and checks that the pictures agree.

mitsuba_test.py CATOPTRIC SAMPLES FOLDER, by ./dev test --label renderers. SAMPLES: samples/renderers. The variable
CATOPTRIC_MITSUBA_PYTHON names a Python that has Mitsuba (that of ./dev test). Exit code 77: it has none.
"""

import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys

import scene

SIZE = (48, 32)
VIEW = ["--size", f"{SIZE[0]}x{SIZE[1]}", "--environment", "sky.hdr"]
# Place, half the edges, and the factors of base colour, metal and roughness. A negative edge mirrors the box.
BOXES = [([0, -0.1, 0], [3, 0.1, 3], [0.7, 0.65, 0.6], 0, 0.5), ([-1.6, 0.6, 0], [0.6, 0.6, 0.6], [1, 0.7, 0.3], 1, 0.3),
         ([0, 0.5, 0.8], [-0.5, 0.5, 0.5], [0.8, 0.1, 0.1], 0, 0.2), ([1.5, 0.8, -0.3], [0.5, 0.8, 0.5], [0.9, 0.9, 0.9], 1, 0.7),
         ([0.3, 1, -1.5], [0.8, 1, 0.3], [0.1, 0.3, 0.8], 0.5, 0.4)]
MOST_LAMP_RMSE = 0.015 # .007 was measured with 1,024 paths, and .048 with one reflection less
MOST_RMSE = 0.0028 # .0018 and .0017 were measured, and .0039 and .0047 with the formulas of appendix B


def expect(holds, what):
    if not holds:
        raise AssertionError(what)


def run(*words, folder):
    ended = subprocess.run([str(word) for word in words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    expect(ended.returncode == 0, f"{' '.join(map(str, words))}: wanted exit code 0, found {ended.returncode}: {ended.stderr}")
    return ended.stdout


def write_sky(file):
    """Writes a Radiance picture of a smooth sky that is brightest to the left, above and in front."""
    width, height, data = 256, 128, b""
    for row in range(height):
        for column in range(width):
            angle, height_angle = ((column + 0.5) / width - 0.5) * 2 * math.pi, (row + 0.5) / height * math.pi
            x, y, z = math.sin(height_angle) * math.sin(angle), math.cos(height_angle), -math.sin(height_angle) * math.cos(angle)
            light = 0.1 + max(0, (-0.6 * x + 0.6 * y - 0.5 * z)) ** 4
            exponent = math.frexp(light)[1]
            mantissa = int(light / 2**exponent * 256)
            data += bytes([mantissa, int(mantissa * 0.9), int(mantissa * 0.8), exponent + 128])
    file.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + data)


def write_boxes(file):
    positions, normals, indices = scene.box_mesh()
    flat = [x for row in positions + normals for x in row]
    data = struct.pack(f"<{len(flat)}f", *flat) + struct.pack(f"<{len(indices)}H", *indices)
    size = 12 * len(positions)
    views = [{"buffer": 0, "byteOffset": begin, "byteLength": length}
             for begin, length in ((0, size), (size, size), (2 * size, 2 * len(indices)))]
    accessors = [{"bufferView": i, "componentType": 5126, "count": len(positions), "type": "VEC3", "min": [-1] * 3, "max": [1] * 3}
                 for i in (0, 1)]
    accessors.append({"bufferView": 2, "componentType": 5123, "count": len(indices), "type": "SCALAR"})
    materials = [{"doubleSided": i % 2 == 0,
                  "pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": metal, "roughnessFactor": rough}}
                 for i, (_, _, colour, metal, rough) in enumerate(BOXES)]
    nodes = [{"mesh": i, "translation": place, "scale": edges} for i, (place, edges, *_) in enumerate(BOXES)]
    nodes.append({"camera": 0, "translation": [0.4, 2.4, 5], "rotation": [math.sin(-0.19), 0, 0, math.cos(-0.19)]})
    meshes = [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": i}]} for i in range(len(BOXES))]
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes,
                "materials": materials, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}],
                "cameras": [{"type": "perspective", "perspective": {"yfov": 0.75, "znear": 0.01}}]}
    text = json.dumps(document).encode()
    text, data = text + b" " * (-len(text) % 4), data + bytes(-len(data) % 4)
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text
                     + struct.pack("<I4s", len(data), b"BIN\0") + data)


def test_light(program, python, samples, folder, light, depth, technique):
    """Mitsuba and the technique agree, and agree less with the diffuse part and shadowing of glTF's appendix B."""
    own, errors = f"{light}.exr", {}
    run(program, "render", "boxes.glb", *VIEW, "--technique", technique, "--frames", 1, "--warmup", 0, "-o", own, folder=folder)
    for name, options in (("right", []), ("khronos", ["--diffuse", "khronos", "--shadowing", "separable"])):
        out = f"{light}-{name}"
        run(python, "-B", samples / "mitsuba_views.py", "views", "scene-000.glb", out, "--environment", "sky.hdr", "--light", light,
            "--depth", depth, "--samples", 2048, *options, folder=folder)
        errors[name] = json.loads(run(program, "diff", own, f"{out}/view-000.exr", "--json", folder=folder))["rmse"]
    print(f"mitsuba: {technique}: rmse {errors}")
    expect(errors["right"] < MOST_RMSE, f"{technique}: wanted an rmse under {MOST_RMSE}, found {errors['right']}")
    expect(errors["right"] < errors["khronos"], f"{technique}: wanted less rmse than with the formulas of appendix B, found {errors}")


def test_lamp(program, python, samples, folder):
    """Mitsuba and traced paths agree in a closed room that a lamp lights, also by way of a mirror. With one reflection less they
    do not."""
    run(python, "-B", samples / "torus_room.py", "torus.gltf", folder=folder)
    view = ["--size", "32x32", "--exposure", 0]
    run(program, "views", "torus.gltf", "--count", 1, *view, "-o", "torus", folder=folder)
    run(python, "-B", samples / "pose.py", program, "torus.gltf", "torus", folder=folder)
    errors = {}
    for depth in (4, 3):
        run(program, "render", "torus.gltf", *view, "--technique", f"raytrace:indirect=paths,depth={depth},rays=1024", "--ambient", 0,
            "--frames", 1, "--warmup", 0, "-o", "lamp.exr", folder=folder)
        if not errors:
            run(python, "-B", samples / "mitsuba_views.py", "torus", "scene-000.glb", "lamp", "--light", "full", "--depth", depth,
                "--samples", 1024, "--bsdf", "plain", folder=folder)
        errors[depth] = json.loads(run(program, "diff", "lamp.exr", "lamp/view-000.exr", "--json", folder=folder))["rmse"]
    print(f"mitsuba: lamp: rmse by depth {errors}")
    expect(errors[4] < MOST_LAMP_RMSE < errors[3], f"wanted an rmse under {MOST_LAMP_RMSE} for depth 4 alone, found {errors}")


def test_report(program, samples, folder):
    """report.sh makes a row of Mitsuba's pictures, and refuses it without an environment or the light of lamps."""
    ended = subprocess.run([samples / "report.sh", "boxes.glb", "out", "--rows", "mitsuba"], cwd=folder, stderr=subprocess.PIPE, text=True)
    expect(ended.returncode == 2 and "wanted --environment FILE or --light full" in ended.stderr, f"wanted exit code 2, found {ended}")
    run(samples / "report.sh", "boxes.glb", "out", "--rows", "mitsuba", "--environment", "sky.hdr", "--count", 1, "--size", "48x32",
        "--samples", 16, "--catoptric", program, "--", "--techniques", "raytrace:rays=4", "--frames", 6, "--warmup", 1,
        "--reference-seconds", 5, folder=folder)
    rows = {row["label"]: row for row in json.loads((folder / "out/report/report.json").read_text())["rows"]}
    expect(list(rows) == ["raytrace:rays=4", "mitsuba"], f"wanted rows of raytrace and mitsuba, found {list(rows)}")


def main():
    program, samples, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    built = samples.parents[1] / "build/mitsuba/bin/python"
    python = os.environ.setdefault("CATOPTRIC_MITSUBA_PYTHON", str(built) if built.exists() else "/usr/bin/python3")
    probe = "import mitsuba; mitsuba.set_variant('llvm_ad_rgb'); print(mitsuba.Float(1) + 1)"
    if subprocess.run([python, "-c", probe], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0:
        print(f"mitsuba: skipped: wanted Mitsuba with LLVM in {python}, found none; docs/renderers.md says how to install it")
        sys.exit(77)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    write_sky(folder / "sky.hdr")
    write_boxes(folder / "boxes.glb")
    run(program, "views", "boxes.glb", "--count", 1, *VIEW, "-o", "views", folder=folder)
    run(python, "-B", samples / "pose.py", program, "boxes.glb", "views", "--environment", "sky.hdr", folder=folder)
    test_light(program, python, samples, folder, "full", 1, "raytrace:indirect=paths,depth=1,rays=1024")
    test_light(program, python, samples, folder, "direct", 8, "raytrace:depth=8,rays=1024")
    test_lamp(program, python, samples, folder)
    test_report(program, samples, folder)
    print("mitsuba: passed")


if __name__ == "__main__":
    main()
