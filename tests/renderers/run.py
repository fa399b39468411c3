#!/usr/bin/python3
"""Draws a small scene by other renderers, by samples/renderers/report.sh, and checks that cameras, instants and lights agree.

run.py CATOPTRIC SAMPLES FOLDER, by ./dev test --label renderers, which installs the renderers. SAMPLES: samples/renderers.
Exit code 77: a renderer is missing.
"""

import importlib.util
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import scene

SIZE = (80, 56)
VIEWS = 7 # the scene's own camera and six drawn ones
FAST = ["--techniques", "secant:face=32", "--frames", "6", "--warmup", "1", "--max-ms", "1000", "--exposure", "0", "--quiet"]
# Most rmse over pixels without mirrors. Cycles had .0028, EEVEE .002 and three.js, whose shadows come from maps, .02.
MOST = {"cycles": 0.006, "eevee": 0.006, "three": 0.03}
PROGRAMS = {"blender": "blender", "xvfb-run": "xvfb", "chromium": "chromium", "chromedriver": "chromium-driver",
            "npm": "npm", "oiiotool": "openimageio-tools"}
MODULES = {"numpy": "python3-numpy", "selenium": "python3-selenium"}


def expect(holds, what):
    if not holds:
        raise AssertionError(what)


def run(*words, folder):
    ended = subprocess.run([str(word) for word in words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    expect(ended.returncode == 0, f"{' '.join(map(str, words))}: wanted exit code 0, found {ended.returncode}: {ended.stdout}")
    return ended.stdout


def make_wrong_pictures(folder, name):
    """Writes the pictures of a row again: turned left to right, and moved by two pixels. Returns the rows."""
    rows = {}
    width, height = SIZE
    for kind, change in (("mirrored", ["--flop"]), ("moved right", [2, 0]), ("moved down", [0, 2])):
        to = folder / f"{name}-{kind.replace(' ', '-')}"
        to.mkdir()
        for file in sorted((folder / name).glob("view-*.exr")):
            words = ["oiiotool", file, "--flop"]
            if kind != "mirrored":
                x, y = change
                words = ["oiiotool", file, "--origin", f"+{x}+{y}", "--crop", f"{width}x{height}+0+0"]
            run(*words, "-d", "float", "-o", to / file.name, folder=folder)
        rows[f"{name} {kind}"] = to
    return rows


def errors_beside_mirrors(row):
    """Returns the rmse over pixels without mirrors, of each view; None where there are no such pixels."""
    found = [row["error_non_mirror"]["rmse"]]
    return found + (row["views"]["error_non_mirror"]["rmse"]["values"] if row.get("views") else [])


def test_cameras(program, folder, file, names, views):
    """A picture that is turned, or two pixels off, has at least three times the error of the renderer's own."""
    rows = {}
    for name in names:
        rows.update({name: folder / name, **make_wrong_pictures(folder, name)})
    words = [program, "compare", file, "--size", f"{SIZE[0]}x{SIZE[1]}", "--ambient", "0", "-o", folder / "wrong", *FAST]
    if views > 1:
        words += ["--views", views - 1]
    for name, place in rows.items():
        words += ["--row", f"{name}={place}"]
    run(*words, folder=folder)
    found = {row["label"]: row for row in json.loads((folder / "wrong/report.json").read_text())["rows"]}
    for name in names:
        right = errors_beside_mirrors(found[name])
        expect(len(right) == views, f"{name}: wanted errors of {views} views, found {right}")
        worst = max(error for error in right if error is not None)
        expect(worst < MOST[name], f"{name}: wanted an rmse under {MOST[name]} beside the mirrors, found {right}")
        judged = 0
        for kind in ("mirrored", "moved right", "moved down"):
            wrong = errors_beside_mirrors(found[f"{name} {kind}"])
            for view, (own, other) in enumerate(zip(right, wrong)):
                if own is None or other < 0.02: # views of a mirror alone, and of a single surface, tell nothing
                    continue
                judged += 1
                expect(own < other / 3, f"{name}, view {view}: wanted a third of the rmse of the picture {kind} ({other}), found {own}")
        expect(judged >= 2 * views, f"{name}: wanted at least {2 * views} pictures that tell a wrong camera, found {judged}")
        print(f"renderers: {name}: rmse beside the mirrors {right}, judged by {judged} wrong pictures")


def test_report(folder, names):
    """The report has a row for each renderer, with errors in each view."""
    report = json.loads((folder / "report/report.json").read_text())
    labels = [row["label"] for row in report["rows"]]
    expect(labels == ["secant:face=32", *names], f"wanted rows of secant and {names}, found {labels}")
    for row in report["rows"][1:]:
        expect(row["error"]["flip"] is not None, f"{row['label']} has no error on mirrors")
    expect((folder / "report/report.html").is_file(), "found no report.html")


def test_refusals(samples, program, folder):
    """Wrong words end before anything is drawn, and say what was wanted."""
    for words, text in ((["a.glb", "out", "--rows", "povray"], "found 'povray'"), (["a.glb", "out", "--light", "all"], "found 'all'"),
                        (["a.glb", "out", "--views", "6"], "unknown option '--views'"),
                        (["a.glb", "out", "--light", "full", "--pixel", "area"], "wanted --pixel centre")):
        ended = subprocess.run([samples / "report.sh", *words, "--catoptric", program], cwd=folder, stderr=subprocess.PIPE, text=True)
        expect(ended.returncode == 2 and text in ended.stderr, f"{words}: wanted exit code 2 and \"{text}\", found "
               f"{ended.returncode} and {ended.stderr}")
        expect(not (folder / "out").exists(), f"{words}: wrote a folder")


def test_document(samples, program, folder):
    """Runs each command of docs/renderers.md, with one small view."""
    text = (samples / "../../docs/renderers.md").read_text()
    commands = re.findall(r"^samples/renderers/report\.sh (\S+) out (.*)$", text, re.M)
    expect(len(commands) >= 3, f"docs/renderers.md: wanted at least 3 commands, found {commands}")
    (folder / "samples").symlink_to(samples.parent)
    for index, (file, options) in enumerate(command for command in commands if "mitsuba" not in command[1]): # mitsuba_test.py
        before, _, after = options.partition("-- ")
        # Of an option that is given twice, the last value counts.
        words = [*shlex.split(before), "--count", "1", "--size", "48x32", "--samples", "2", "--catoptric", program, "--",
                 *shlex.split(after), "--reference-seconds", "5", "--frames", "6", "--warmup", "1", "--quiet"]
        run("samples/renderers/report.sh", file, f"document-{index}", *words, folder=folder)
        expect((folder / f"document-{index}/report/report.html").is_file(), f"{options}: found no report")


def main():
    program, samples, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    missing = [package for name, package in PROGRAMS.items() if shutil.which(name) is None]
    missing += [package for name, package in MODULES.items() if importlib.util.find_spec(name) is None]
    if missing:
        print(f"renderers: skipped: wanted {', '.join(missing)}, found none; ./dev test --label renderers installs them")
        sys.exit(77)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    test_refusals(samples, program, folder)
    # The light of spots and lamps has another shape in Blender, and is left out here.
    scene.write_scene(folder / "scene.glb", ["point", "directional"])
    for out, names, views in (("all", ["cycles", "three"], VIEWS), ("one", ["eevee"], 1)):
        run(samples / "report.sh", "scene.glb", out, "--rows", ",".join(names), "--count", max(views - 1, 1), "--size",
            f"{SIZE[0]}x{SIZE[1]}", "--samples", "4", "--catoptric", program, "--", *FAST, folder=folder)
        test_report(folder / out, names)
        test_cameras(program, folder / out, folder / "scene.glb", names, views)
    os.environ["CATOPTRIC_NODE_MODULES"] = str(folder / "all/npm/node_modules") # three.js is installed once
    test_document(samples, program, folder)
    print("renderers: passed")


if __name__ == "__main__":
    main()
