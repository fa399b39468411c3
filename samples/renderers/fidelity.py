#!/usr/bin/env python3
"""Draws a scenario of Khronos' glTF-Render-Fidelity-Generator by Catoptric.

fidelity.py [OPTION...] SCENARIO

The generator starts this program for each scenario, and appends the text SCENARIO:
{"scenario": {"model", "lighting", "dimensions", "target", "orbit", "verticalFoV", "renderSkybox"}, "outputFile"}.
OPTION: options of `catoptric render`; without them --technique raytrace:depth=8,rays=64. The variable CATOPTRIC names the
program (catoptric). oiiotool of OpenImageIO maps the colours.

As by the generator's other programs, the picture has twice the scenario's width and height, the tone curve ACES, a gamma
of 2.2, and a transparent background if `renderSkybox` is false.
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

DEFAULT_OPTIONS = ["--technique", "raytrace:depth=8,rays=64"]
# three.js shows the middle column of an environment towards +x, and Catoptric towards -z.
ENVIRONMENT_DEGREES = 90
LEAST_PHI = 1e-4 # radians; a camera that looks along +y would have no direction up
# The fit of the ACES tone curve by Stephen Hill, as three.js uses it. The factor 1 / .6 is its exposure.
ACES_EXPOSURE = 1 / 0.6
ACES_INPUT = ((.59719, .35458, .04823), (.07600, .90834, .01566), (.02840, .13383, .83777))
ACES_OUTPUT = ((1.60475, -.53108, -.07367), (-.10208, 1.10813, -.00605), (-.00327, -.07276, 1.07602))


class ScenarioError(Exception):
    pass


def member(values, *names):
    """Returns a member of nested JSON objects. Raises ScenarioError with its full name if it is missing."""
    for count, name in enumerate(names, 1):
        if not isinstance(values, dict) or name not in values:
            raise ScenarioError(f"{'.'.join(names[:count])}: wanted a value, found none")
        values = values[name]
    return values


def number(values, *names):
    value = member(values, *names)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ScenarioError(f"{'.'.join(names)}: wanted a number, found {json.dumps(value)}")
    return value


def text_member(values, *names):
    value = member(values, *names)
    if not isinstance(value, str):
        raise ScenarioError(f"{'.'.join(names)}: wanted text, found {json.dumps(value)}")
    return value


def find_file(text, output):
    """Returns a file of the scenario. Its name is relative to the output's folder, or to the current folder."""
    for folder in (output.parent, pathlib.Path(".")):
        if (folder / text).is_file():
            return folder / text
    raise ScenarioError(f"{text}: wanted a file below {output.parent.resolve()} or {pathlib.Path.cwd()}, found none")


def camera_option(config):
    """Returns the camera as an option of `catoptric render`: theta turns around +y from +z, phi is the angle from +y."""
    target = [number(config, "scenario", "target", axis) for axis in "xyz"]
    theta, phi = (math.radians(number(config, "scenario", "orbit", name)) for name in ("theta", "phi"))
    phi = min(max(phi, LEAST_PHI), math.pi - LEAST_PHI)
    radius = number(config, "scenario", "orbit", "radius")
    direction = (math.sin(phi) * math.sin(theta), math.cos(phi), math.sin(phi) * math.cos(theta))
    eye = [at + radius * along for at, along in zip(target, direction)]
    field = number(config, "scenario", "verticalFoV")
    return f"{','.join(f'{value:.9g}' for value in eye)}:{','.join(f'{value:.9g}' for value in target)}:{field:.9g}"


def matrix(rows):
    """Returns a matrix as oiiotool reads it, which multiplies row vectors."""
    return ",".join(str(value) for column in zip(*rows) for value in column)


def tone_map_words():
    """Returns the words of oiiotool that turn linear light into display values: (v (v + a) - b) / (v (c v + d) + e)."""
    return ["--mulc", str(ACES_EXPOSURE), "--ccmatrix", matrix(ACES_INPUT), "--label", "v",
            "v", "v", "--addc", ".0245786", "--mul", "--subc", ".000090537",
            "v", "--mulc", ".983729", "--addc", ".4329510", "v", "--mul", "--addc", ".238081",
            "--div", "--ccmatrix", matrix(ACES_OUTPUT), "--clamp:min=0:max=0.9999", "--powc", str(1 / 2.2)]


def run(words):
    ended = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if ended.returncode != 0:
        raise ScenarioError(f"{words[0]}: exit code {ended.returncode}: {ended.stderr.strip()}")


def draw(config, options):
    output = pathlib.Path(text_member(config, "outputFile"))
    size = [2 * int(number(config, "scenario", "dimensions", side)) for side in ("width", "height")]
    model, lighting = (find_file(text_member(config, "scenario", name), output) for name in ("model", "lighting"))
    with tempfile.TemporaryDirectory() as folder:
        linear, mapped = pathlib.Path(folder) / "linear.exr", pathlib.Path(folder) / "mapped.png"
        run([os.environ.get("CATOPTRIC", "catoptric"), "render", model, "--environment", lighting,
             "--environment-rotate", ENVIRONMENT_DEGREES, "--camera", camera_option(config), "--size", f"{size[0]}x{size[1]}",
             "--exposure", "0", "--aov", "object", "--quiet", "-o", linear, *options])
        words = ["oiiotool", linear, "--ch", "R,G,B", *tone_map_words()]
        if not member(config, "scenario", "renderSkybox"):
            # Objects have numbers from 1, and the background has 0.
            words += [linear, "--ch", "A=object.V", "--clamp:min=0:max=1", "--chappend"]
        # The values are display values already, so that no colour space may change them.
        run([*words, "-d", "uint8", "--attrib", "oiio:ColorSpace", "sRGB", "-o", mapped])
        output.parent.mkdir(parents=True, exist_ok=True)
        part = output.with_name(output.name + ".part")
        part.write_bytes(mapped.read_bytes())
        part.replace(output)


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip(), file=sys.stderr if len(sys.argv) < 2 else sys.stdout)
        return 2 if len(sys.argv) < 2 else 0
    try:
        config = json.loads(sys.argv[-1])
        draw(config, sys.argv[1:-1] or DEFAULT_OPTIONS)
    except json.JSONDecodeError as error:
        print(f"fidelity.py: the last argument: wanted JSON, found {sys.argv[-1][:60]!r}: {error}", file=sys.stderr)
        return 2
    except (ScenarioError, OSError) as error:
        print(f"fidelity.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
