#!/usr/bin/env python3
"""Measures how the error of look-ups in captures depends on roughness, distance law and technique.

rough.py PROGRAM [--views N] [--size WxH] [-o FOLDER] [--into FILE] renders drawn views of the scene `roughness` and
prints tables in Markdown, or writes them between `<!-- laws -->` and `<!-- /laws -->` of a file. Results of views in
FOLDER/views.json are kept. An error is the rmse over the pixels of the balls and slabs of one roughness in one view,
clamped to [0,1], against two halves of a traced reference (docs/noise.md). Views that show fewer than 200 such pixels
are left out. The first table has medians over views, and in its heading the number of views. The second has the
geometric mean over views of the ratio to `law=none`, with its 95 % interval by bootstrap over views.
"""
import argparse
import json
import math
import os
import random
import re
import statistics
import subprocess
import sys

LAWS = ["none", "frostbite", "square", "cone", "exact"]
KNOBS = "face=128"
MIN_PIXELS = 200
ROWS = ([f"pyramid:{KNOBS},law={law}" for law in LAWS] + [f"parallax:{KNOBS},law={law}" for law in LAWS] +
        [f"pyramid:{KNOBS},rough=none", f"pyramid:{KNOBS},rough=mips", f"reuse:{KNOBS}"])


def view_errors(arguments, view):
    """Returns, by row and roughness: sum of squared errors and number of pixels in a drawn view."""
    folder = os.path.join(arguments.out, "compare")
    run = subprocess.run([arguments.program, "compare", "roughness", "-o", folder, "--size", arguments.size, "--camera",
                          "seeded", "--seed", str(view), "--frames", "1", "--warmup", "5", "--model", "required",
                          "--reference-seconds", "6", "--quiet", "--json", "--techniques", *ROWS],
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


def rmse_of_view(view, row, roughness):
    """Returns the rmse over the pixels of a roughness, or nothing if they are too few or the noise hides the error."""
    total, count = view.get(row, {}).get(roughness, (0, 0))
    return (total / count) ** .5 if count >= MIN_PIXELS and total > 0 else None


def median_rmse(views, row, roughness):
    """Returns the median over views."""
    found = [rmse for rmse in (rmse_of_view(view, row, roughness) for view in views) if rmse]
    return statistics.median(found) if found else float("nan")


def mean_ratio(views, a, b, roughness):
    """Returns the geometric mean over views of the ratio of the errors of row `a` and row `b`, and its 95 % interval."""
    pairs = [(rmse_of_view(view, a, roughness), rmse_of_view(view, b, roughness)) for view in views]
    logs = [math.log(first / second) for first, second in pairs if first and second]
    if not logs:
        return float("nan"), float("nan"), float("nan")
    draw = random.Random(1)
    means = sorted(statistics.fmean(draw.choices(logs, k=len(logs))) for _ in range(1000))
    return math.exp(statistics.fmean(logs)), math.exp(means[25]), math.exp(means[974])


def short(number):
    return f"{number:.4f}".lstrip("0") if number < 1 else f"{number:.2f}"


def format_table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" + "|--:" * (len(head) - 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join(cells) + " |" for cells in rows]) + "\n"


def insert_tables(file, tables):
    """Replaces the text between the marks of a Markdown file."""
    text = open(file).read()
    begin, end = "<!-- laws -->\n", "<!-- /laws -->"
    if begin not in text or end not in text:
        sys.exit(f"rough: {file}: wanted the marks {begin.strip()} and {end}")
    with open(file, "w") as out:
        out.write(text[:text.index(begin) + len(begin)] + tables + text[text.index(end):])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--views", type=int, default=30)
    parser.add_argument("--size", default="128x128")
    parser.add_argument("-o", dest="out", default="out/rough")
    parser.add_argument("--into", metavar="FILE")
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
    headings = [f"{r} ({sum(rmse_of_view(view, ROWS[0], r) is not None for view in views)})" for r in roughnesses]
    tables = format_table(["row, rmse"] + headings,
                          [[f"`{row}`"] + [short(median_rmse(views, row, r)) for r in roughnesses] for row in ROWS])
    laws = []
    for technique in ("pyramid", "parallax"):
        for law in LAWS[1:]:
            cells = [f"`{technique}`, `{law}`"]
            for r in roughnesses:
                ratio, low, high = mean_ratio(views, f"{technique}:{KNOBS},law={law}",
                                              f"{technique}:{KNOBS},law=none", r)
                cells.append(f"{ratio:.2f} [{low:.2f} - {high:.2f}]")
            laws.append(cells)
    tables += "\n" + format_table(["rmse / rmse of `law=none`"] + roughnesses, laws)
    if arguments.into:
        insert_tables(arguments.into, tables)
    else:
        print(tables)


if __name__ == "__main__":
    main()
