#!/usr/bin/python3
"""Tests samples/renderers/fidelity.py: camera, environment, tone curve, background and refusals.

fidelity_test.py CATOPTRIC ADAPTER FOLDER. Needs oiiotool.
"""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

SIDE = 12 # of the scenario; pictures have twice as many pixels
# Colours of the environment's columns in the directions that three.js gives them, from the middle on: +x, +z, -x, -z.
COLOURS = {"+x": (.6, 0, 0), "+z": (0, .6, 0), "-x": (0, 0, .6), "-z": (.6, .6, .6)}


def expect(holds, what):
    if not holds:
        raise AssertionError(what)


def write_model(folder):
    """Writes a black triangle in the plane z = 0, in the lower left half of a square around the origin."""
    (folder / "model.obj").write_text("mtllib model.mtl\nv -1 -1 0\nv 1 -1 0\nv -1 1 0\nusemtl black\nf 1 2 3\n")
    (folder / "model.mtl").write_text("newmtl black\nKd 0 0 0\n")


def write_environment(folder):
    """Writes an environment of four columns. Its first column begins at -x, as the middle is +x."""
    width, height = 64, 32
    fills = []
    for name, first in (("-x", 0), ("-z", 8), ("+x", 24), ("+z", 40), ("-x", 56)):
        colour = ",".join(str(value) for value in COLOURS[name])
        last = {0: 7, 8: 23, 24: 39, 40: 55, 56: 63}[first]
        fills += [f"--box:color={colour}:fill=1", f"{first},0,{last},{height - 1}"]
    subprocess.run(["oiiotool", "--create", f"{width}x{height}", "3", *fills, "-d", "float", "-o", folder / "sky.hdr"],
                   check=True)


def aces(colour):
    """Returns the display value, 0 to 255, of linear light by the tone curve of three.js, from its formula."""
    r, g, b = (value / .6 for value in colour)
    light = (.59719 * r + .35458 * g + .04823 * b, .07600 * r + .90834 * g + .01566 * b, .02840 * r + .13383 * g + .83777 * b)
    r, g, b = ((v * (v + .0245786) - .000090537) / (v * (.983729 * v + .4329510) + .238081) for v in light)
    mapped = (1.60475 * r - .53108 * g - .07367 * b, -.10208 * r + 1.10813 * g - .00605 * b,
              -.00327 * r - .07276 * g + 1.07602 * b)
    return [255 * min(max(v, 0), .9999) ** (1 / 2.2) for v in mapped]


def make_scenario(theta, phi, skybox, radius=2):
    return {"scenario": {"model": "model.obj", "lighting": "sky.hdr", "dimensions": {"width": SIDE, "height": SIDE},
                         "target": {"x": 0, "y": 0, "z": 0}, "orbit": {"theta": theta, "phi": phi, "radius": radius},
                         "verticalFoV": 2 * math.degrees(math.atan(.5)), "renderSkybox": skybox, "name": "test"},
            "outputFile": "out.png"}


def draw(adapter, folder, config):
    return subprocess.run([adapter, "--technique", "raytrace", config if isinstance(config, str) else json.dumps(config)],
                          cwd=folder, capture_output=True, text=True)


def pixel(file, x, y):
    """Returns the values of a pixel, 0 to 255."""
    text = subprocess.run(["oiiotool", file, "--cut", f"1x1+{x}+{y}", "--printstats"], check=True, capture_output=True,
                          text=True).stdout
    return [255 * float(value) for value in re.search(r"Stats Avg: ([\d. ]+)", text).group(1).split()]


def test_pictures(adapter, folder):
    last = 2 * SIDE - 2
    # The camera stands at +z and looks along -z. Its picture is 2 wide and high at the triangle.
    ended = draw(adapter, folder, make_scenario(0, 90, False))
    expect(ended.returncode == 0, ended.stderr)
    sizes = subprocess.run(["oiiotool", "--info", folder / "out.png"], check=True, capture_output=True, text=True).stdout
    expect(re.search(rf"\b{2 * SIDE} x +{2 * SIDE}, 4 channel, uint8", sizes), f"wanted 24x24, 4 channels, found {sizes}")
    expect(pixel(folder / "out.png", 2, last)[3] == 255, "lower left: wanted the triangle")
    expect(pixel(folder / "out.png", last, 2)[3] == 0, "upper right: wanted a transparent background")
    # Cameras on the four sides see the environment of the opposite side. The triangle covers no corner that is asked for:
    # it is a line from the sides, and its lower right half from behind.
    for theta, seen in ((0, "-z"), (180, "+z"), (90, "-x"), (270, "+x")):
        ended = draw(adapter, folder, make_scenario(theta, 90, True))
        expect(ended.returncode == 0, ended.stderr)
        found, wanted = pixel(folder / "out.png", 2 if theta == 180 else last, 2), aces(COLOURS[seen])
        expect(len(found) == 3 and max(abs(a - b) for a, b in zip(found, wanted)) <= 1,
               f"theta {theta}: wanted the environment of {seen}, {wanted}, found {found}")
    # From above, the triangle is a line without area.
    ended = draw(adapter, folder, make_scenario(0, 0, False))
    expect(ended.returncode == 0, ended.stderr)
    expect(pixel(folder / "out.png", 2, last)[3] == 0, "phi 0: wanted no triangle")


def test_refusals(adapter, folder):
    before = (folder / "out.png").read_bytes()

    def refuse(change, code, part):
        config = make_scenario(0, 90, False)
        config = change(config) or config
        ended = draw(adapter, folder, config)
        expect(ended.returncode == code and part in ended.stderr and "Traceback" not in ended.stderr,
               f"wanted exit code {code} and {part!r}, found {ended.returncode} and {ended.stderr!r}")
        expect((folder / "out.png").read_bytes() == before, f"{part}: the last picture was changed")

    refuse(lambda config: "{", 2, "wanted JSON, found '{'")
    refuse(lambda config: config["scenario"].pop("orbit") and None, 1, "scenario.orbit: wanted a value, found none")
    refuse(lambda config: config["scenario"]["target"].update(y="up"), 1, "scenario.target.y: wanted a number, found \"up\"")
    refuse(lambda config: config["scenario"].update(model=5), 1, "scenario.model: wanted text, found 5")
    refuse(lambda config: config.update(outputFile=None), 1, "outputFile: wanted text, found null")
    refuse(lambda config: config["scenario"].update(model="none.glb"), 1, "none.glb: wanted a file below")
    (folder / "bad.obj").write_text("f 1 2 9\n")
    refuse(lambda config: config["scenario"].update(model="bad.obj"), 1, "exit code 65")
    refuse(lambda config: config["scenario"]["dimensions"].update(width=0), 1, "--size")


def main():
    catoptric, adapter, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    os.environ["CATOPTRIC"] = str(catoptric)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    write_model(folder)
    write_environment(folder)
    test_pictures(adapter, folder)
    test_refusals(adapter, folder)


if __name__ == "__main__":
    main()
