#!/usr/bin/env python3
"""Applies the worked diffs of CONTRIBUTING.md to a copy of the sources, builds the copy, and checks what each promises.

run.py SOURCE WORK
WORK/source holds the copy, and is built again only where it changed. Called by CTest (label guides).
"""
import json
import os
import re
import shutil
import struct
import subprocess
import sys

HEAD = re.compile(r"^--- (\S+)( \(new\))?$")


class GuideError(Exception):
    """A diff that does not fit, or a promise that does not hold."""


def check(holds, *said):
    if not holds:
        raise GuideError("".join(str(part) for part in said))


def diffs_of(page):
    """Returns the changes of a page's blocks of diff: (path, whether the file is new, lines) each."""
    changes = []
    for block in re.findall(r"^```diff\n(.*?)^```$", page, re.M | re.S):
        for line in block.splitlines():
            head = HEAD.match(line)
            if head:
                changes.append((head[1], bool(head[2]), []))
            else:
                check(changes, "guides: a diff begins without a path: ", line)
                changes[-1][2].append(line)
    return changes


def apply_change(text, lines, path):
    """Returns the text after a change. Lines with + are new, lines with - go, others must stand there; runs of these
    lines must occur once."""
    before = "".join(line[1:] + "\n" for line in lines if not line.startswith("+"))
    after = "".join(line[1:] + "\n" for line in lines if not line.startswith("-"))
    check(text.count(before) == 1, f"guides: {path}: wanted these lines once, found them {text.count(before)} times:\n",
          before)
    return text.replace(before, after)


def write_if_changed(path, data):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    if not os.path.exists(path) or open(path, "rb").read() != data:
        with open(path, "wb") as file:
            file.write(data)


def make_copy(source, copy):
    """Copies the files that git tracks, and those that it does not ignore, with the diffs applied."""
    names = subprocess.run(["git", "-C", source, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                           capture_output=True, check=True).stdout.decode().split("\0")
    files = {}
    for name in filter(None, names):
        path = os.path.join(source, name)
        if os.path.isfile(path):
            files[name] = open(path, "rb").read()
    changes = diffs_of(files["CONTRIBUTING.md"].decode())
    for path, is_new, lines in changes:
        check(is_new != (path in files), f"guides: {path}: wanted a file that ", "does not exist" if is_new else "exists")
        text = "" if is_new else files[path].decode()
        files[path] = ("".join(line[1:] + "\n" for line in lines) if is_new else
                       apply_change(text, lines, path)).encode()
    for name, data in files.items():
        write_if_changed(os.path.join(copy, name), data)
        mode = os.stat(os.path.join(source, name)).st_mode if os.path.exists(os.path.join(source, name)) else 0o644
        os.chmod(os.path.join(copy, name), mode)
    for folder, _, found in os.walk(copy):
        for name in found:
            path = os.path.relpath(os.path.join(folder, name), copy)
            if not path.startswith("build/") and path not in files:
                os.remove(os.path.join(copy, path))
    return changes


def build(copy):
    environment = {**os.environ, "CCACHE_BASEDIR": copy, "CCACHE_NOHASHDIR": "1"}
    for command in (["cmake", "--preset", "ci", "-DCATOPTRIC_TESTS=OFF"], ["cmake", "--build", "build/ci", "--target",
                                                                          "catoptric_cli"]):
        run = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True)
        check(run.returncode == 0, "guides: ", " ".join(command), " failed:\n", run.stdout[-6000:], run.stderr[-3000:])
    return os.path.join(copy, "build/ci/catoptric")


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)

    def __call__(self, *arguments):
        run = subprocess.run([self.path, *arguments], cwd=self.folder, capture_output=True, text=True)
        check(run.returncode == 0, "guides: catoptric ", " ".join(arguments), ": exit code ", run.returncode, "\n", run.stderr)
        return run.stdout

    def picture(self, scene, technique, name, *more):
        self("render", scene, "--technique", technique, "--size", "48x48", "--ambient", "0", "-o", name + ".exr", "--quiet",
             *more)
        return name + ".exr"

    def rmse(self, a, b):
        return json.loads(self("diff", a, b, "--json"))["rmse"]


def check_technique(catoptric):
    """share=1 equals `parallax`; share=0 equals `reuse` in the first frame, whose captures show mirrors black."""
    small = "face=32,shadow_map=64"
    for share, other, frames in (("1", "parallax", "3"), ("0", "reuse", "1")):
        def draw(technique, name):
            return catoptric.picture("cornell-mirrors", f"{technique}{small}", name, "--frames", frames, "--warmup", "0")
        picture = draw(other + ":", other)
        error = catoptric.rmse(draw(f"halfway:share={share},continue=0,lookup=bilinear,", "halfway"), picture)
        check(error < 1e-6, f"guides: halfway:share={share} differs from {other} by {error}")
        error = catoptric.rmse(draw("halfway:share=0.5,continue=0,lookup=bilinear,", "half"), picture)
        check(error > 1e-3, f"guides: halfway:share=0.5 differs from {other} by {error} only")


def rows_of(catoptric, *more):
    catoptric("compare", "cornell-mirrors", "-o", "compared", "--size", "32x32", "--frames", "1", "--warmup", "1",
              "--techniques", "reuse:face=16", "raytrace:depth=1", "--quiet", *more)
    return json.load(open(os.path.join(catoptric.folder, "compared/report.json"), encoding="utf-8"))["rows"]


def check_metric(catoptric):
    for row in rows_of(catoptric):
        check(row.get("brightest", 0) > 1, "guides: wanted a lamp's radiance in 'brightest', found ", row.get("brightest"))
    check("brightest" in catoptric("list", "metrics"), "guides: `list metrics` lacks 'brightest'")


def check_study(catoptric):
    for row in rows_of(catoptric, "--mirror-share"):
        pixels = row["mirror_pixels"]
        check(len(pixels) == 4 and abs(sum(pixels) / 1024 - row["mirror_share"]) < 1e-9 and row["mirror_share"] > .02,
              "guides: mirror_share ", row["mirror_share"], " and mirror_pixels ", pixels)
    check("mirror_share" not in rows_of(catoptric)[0], "guides: mirror_share without its option")


def write_floor(catoptric, name, light, material=None):
    """Writes a white floor of 4 by 4 under a light 2 above it, seen from above, and returns its path."""
    corners = [(-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2)]
    data = b"".join(struct.pack("<3f", *corner) for corner in corners) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    with open(os.path.join(catoptric.folder, name + ".bin"), "wb") as file:
        file.write(data)
    down = [-0.7071067811865476, 0, 0, 0.7071067811865476]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 4, 0], "rotation": down},
                  {"translation": [0, 2, 0], "rotation": down, "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": .8, "znear": .01}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [material or {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-2, 0, -2],
                       "max": [2, 0, 2]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"uri": name + ".bin", "byteLength": 60}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [light]}}}
    with open(os.path.join(catoptric.folder, name + ".gltf"), "w", encoding="utf-8") as file:
        json.dump(document, file)
    return name + ".gltf"


SPOT = {"type": "spot", "intensity": 20, "spot": {"innerConeAngle": .1, "outerConeAngle": .7}}
ROWS = ("parallax", "raytrace:depth=1", "raytrace:depth=1,rays=16,indirect=paths")


def check_light_kind(catoptric):
    """The new kind lights the same by the rasteriser, by rays and by paths, and other than a spot."""
    linear = write_floor(catoptric, "linear", {**SPOT, "extras": {"catoptric": {"light": "linear_spot"}}})
    usual = write_floor(catoptric, "usual", SPOT)
    check("linear_spot" in catoptric("info", linear), "guides: `info` does not name linear_spot")
    pictures = [catoptric.picture(linear, row, f"linear{i}") for i, row in enumerate(ROWS)]
    for row, picture in zip(ROWS[1:], pictures[1:]):
        error = catoptric.rmse(pictures[0], picture)
        check(error < 2e-3, f"guides: linear_spot by {ROWS[0]} and by {row} differs by {error}")
    error = catoptric.rmse(pictures[1], catoptric.picture(usual, ROWS[1], "usual"))
    check(error > 1e-2, f"guides: linear_spot differs from a spot by {error} only")


def check_material(catoptric):
    """The rasteriser and the ray tracer lose the same share of the diffuse light."""
    half = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1},
            "extensions": {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": .5}}}
    white, lost = write_floor(catoptric, "white", SPOT), write_floor(catoptric, "lost", SPOT, half)
    check("diffuse_transmission" in catoptric("info", lost, "--json"), "guides: `info` does not name diffuse_transmission")
    pictures = [catoptric.picture(lost, row, f"lost{i}") for i, row in enumerate(ROWS[:2])]
    error = catoptric.rmse(*pictures)
    check(error < 2e-3, f"guides: diffuse_transmission by {ROWS[0]} and by {ROWS[1]} differs by {error}")
    error = catoptric.rmse(pictures[1], catoptric.picture(white, ROWS[1], "white"))
    check(error > 1e-2, f"guides: diffuse_transmission changes the picture by {error} only")


def main(source, work):
    copy = os.path.join(os.path.abspath(work), "source")
    try:
        changes = make_copy(os.path.abspath(source), copy)
        catoptric = Program(build(copy), os.path.join(os.path.abspath(work), "pictures"))
        for guide in (check_technique, check_metric, check_study, check_light_kind, check_material):
            guide(catoptric)
    except GuideError as error:
        sys.exit(str(error))
    print(f"guides: {len(changes)} files changed by diffs, 5 guides hold")


if __name__ == "__main__":
    main(*sys.argv[1:])
