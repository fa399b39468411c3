#!/usr/bin/env python3
"""Measures how the error of look-ups in captures depends on roughness, distance law and technique.

rough.py PROGRAM [--views N] [--size WxH] [-o FOLDER] renders drawn views of the scene `roughness` and prints tables
in Markdown. An error is the root of the mean squared error over the views and over the pixels of the balls and slabs
of one roughness, clamped to [0,1], against two halves of a traced reference (docs/noise.md). Rows are compared in
pairs over the same views, with 95 % intervals of the ratio by bootstrap over views.
"""
import argparse
import json
import os
import random
import re
import subprocess
import sys

LAWS = ["none", "frostbite", "square", "cone", "exact"]
KNOBS = "face=128"
ROWS = ([f"pyramid:{KNOBS},law={law}" for law in LAWS] + [f"parallax:{KNOBS},law={law}" for law in LAWS] +
        [f"pyramid:{KNOBS},rough=none", f"pyramid:{KNOBS},rough=mips", f"pyramid:{KNOBS},rough=rays", f"reuse:{KNOBS}"])


def view_errors(arguments, view):
    """Returns, by row and roughness: sum of squared errors and number of pixels in a drawn view."""
    folder = os.path.join(arguments.out, "compare")
    run = subprocess.run([arguments.program, "compare", "roughness", "-o", folder, "--size", arguments.size, "--camera",
                          "seeded", "--seed", str(view), "--frames", "1", "--warmup", "5", "--model", "required",
                          "--reference-seconds", "4", "--quiet", "--json", "--techniques", *ROWS],
                         capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"rough: view {view}: {run.stderr}")
    info = subprocess.run([arguments.program, "info", "roughness", "--json"], capture_output=True, text=True, check=True)
    names = [mirror["name"] for mirror in json.loads(info.stdout)["mirrors"]]
    found = {}
    for row in json.loads(run.stdout)["rows"]:
        of_row = found.setdefault(row["label"], {})
        for error in row["error_per_mirror"]:
            roughness = re.search(r"[\d.]+$", names[error["mirror"] - 1])
            if not roughness or error["rmse"] is None:
                continue
            # A negative estimate of the squared error has a negative root.
            total, count = of_row.get(roughness[0], (0, 0))
            of_row[roughness[0]] = (total + error["pixels"] * error["rmse"] * abs(error["rmse"]), count + error["pixels"])
    return found


def rms(views, row, roughness):
    """Returns the root of the mean squared error over views, at least 0."""
    pairs = [view[row][roughness] for view in views if roughness in view.get(row, {})]
    pixels = sum(count for _, count in pairs)
    return max(0, sum(total for total, _ in pairs) / pixels) ** .5 if pixels else float("nan")


def ratio_interval(views, a, b, roughness):
    """Returns the ratio of the errors of row `a` and row `b`, and its 95 % interval."""
    draw = random.Random(1)
    ratios = sorted(rms(drawn, a, roughness) / max(rms(drawn, b, roughness), 1e-9)
                    for drawn in ([draw.choice(views) for _ in views] for _ in range(1000)))
    return rms(views, a, roughness) / max(rms(views, b, roughness), 1e-9), ratios[25], ratios[974]


def short(number):
    return f"{number:.4f}".lstrip("0") if number < 1 else f"{number:.2f}"


def print_table(head, rows):
    print("| " + " | ".join(head) + " |\n|---" + "|--:" * (len(head) - 1) + "|")
    for cells in rows:
        print("| " + " | ".join(cells) + " |")
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--views", type=int, default=30)
    parser.add_argument("--size", default="128x128")
    parser.add_argument("-o", dest="out", default="out/rough")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    kept = os.path.join(arguments.out, "views.json")
    views = json.load(open(kept)) if os.path.exists(kept) else []
    for view in range(len(views) + 1, arguments.views + 1):
        views.append(view_errors(arguments, view))
        with open(kept, "w") as file:
            json.dump(views, file)
        print(f"view {view} of {arguments.views}", file=sys.stderr)
    roughnesses = sorted({r for view in views for row in view.values() for r in row}, key=float)
    print_table(["row"] + roughnesses,
                [[f"`{row}`"] + [short(rms(views, row, r)) for r in roughnesses] for row in ROWS])
    laws = []
    for technique in ("pyramid", "parallax"):
        for law in LAWS[1:]:
            cells = [f"`{technique}`, `{law}`"]
            for r in roughnesses:
                ratio, low, high = ratio_interval(views, f"{technique}:{KNOBS},law={law}",
                                                  f"{technique}:{KNOBS},law=none", r)
                cells.append(f"{short(ratio)} [{short(low)} - {short(high)}]")
            laws.append(cells)
    print_table(["error / error of `law=none`"] + roughnesses, laws)


if __name__ == "__main__":
    main()
