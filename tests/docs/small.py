#!/usr/bin/env python3
"""Stands in for catoptric in the commands of the documentation. Runs the program $CATOPTRIC_PROGRAM with a small
picture, small captures, few frames, views and techniques, and with names that the folder of the test has in place of examples."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

# Names in commands that a reader replaces by names of their own scene.
NAMES = {"SCENE": "scene.glb", "A": "0.1", "NAME": "ball1", "table top=0.9,roughness=0.3": "ball1=0.9,roughness=0.3"}
SIZES = {"--size": "32x32", "--frames": "6", "--warmup": "2", "--views": "6", "--count": "6", "--reference-seconds": "1",
         "--cameras-per-instant": "1"}
# Options that the command need not give, by verb.
ADDED = {"compare": ["--size", "--frames", "--warmup", "--reference-seconds"], "render": ["--size"], "graph": ["--size"],
         "bench": ["--size", "--frames", "--warmup"], "choose": ["--size", "--frames", "--warmup"], "views": ["--size"]}
# An exit code of 1 is an answer with these options: a limit is exceeded, or something is slower.
LIMITS = {"--max-ms", "--max-flip", "--max-rmse", "--max-error", "--baseline", "--compare", "--against", "--certify"}


def shrink_captures(word):
    """Returns the name of a technique with small captures and few light probes, and other words as they are."""
    word = re.sub(r"\bface=(\d+)", lambda match: f"face={max(1, int(match.group(1)) // 8)}", word)
    has_captures = re.fullmatch(r"(naive|reuse|parallax|proxy|secant|march|pyramid|layered|hybrid)(:.*)?", word)
    if has_captures and "face=" not in word:
        word += (",face=32" if ":" in word else ":face=32")
    return word if "probes=" in word else word.replace("indirect=captures", "indirect=captures,probes=27")


def main():
    words = [shrink_captures(NAMES.get(word, word)) for word in sys.argv[1:]]
    if words[0] == "list":
        words = sys.argv[1:]
    for at, word in enumerate(words[:-1]):
        words[at + 1] = SIZES.get(word, words[at + 1])
    added = ADDED.get(words[0], []) if "--compare" not in words else []
    if words[0] == "choose":
        words += ["--share", "0.5", "--confidence", "0.5", "--training-views", "6", "--proof-views", "6"]
    for option in added:
        if option not in words:
            words += [option, SIZES[option]]
    if words[0] in ("compare", "choose", "bench") and not {"--techniques", "--certify", "--compare"} & set(words):
        words += ["--techniques", "reuse:face=32", "secant:face=32", "raytrace"]
    done = subprocess.run([os.environ["CATOPTRIC_PROGRAM"], *words], check=False)
    if words[0] == "views" and done.returncode == 0: # the pictures that a reader's renderer draws of the views
        folder = pathlib.Path(words[words.index("-o") + 1])
        for view in json.loads((folder / "views.json").read_text())["views"]:
            shutil.copy("mine.exr", folder / f"{view['name']}.exr")
    sys.exit(0 if done.returncode == 1 and LIMITS & set(words) else done.returncode)


if __name__ == "__main__":
    main()
