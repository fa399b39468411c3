#!/usr/bin/env python3
"""Compares `auto` with rows of one technique each, in drawn views of six built-in and six drawn scenes.

auto.py [--first N] [--views N] [--size WxH] [--rough A] [--rounds N] [--frames N] [--rows T ...] [--again]
        CATOPTRIC OUT [SCENE...]
SCENE is the name of a scene, or a file.
Writes OUT/auto.json (every figure) and OUT/auto.md (a line for each scene). Prints the views in which a row beats
`auto`, in one of three ways:
  faster: the row's processor time is less than that of `auto` / 1.15, and its FLIP is no larger.
  better: the row's FLIP is less than that of `auto` / 1.1, and its processor time is no larger.
  traces more: `auto` searches captures and traces more rays from mirrors than `hybrid`, by more than 1 %. Single
  pixels differ, because `auto` draws what captures show of small mirrors in a simpler way.
With --rough, the mirrors whose material is named "mirror" get this roughness, and rows with rays of their lobes are
added.
The exit code is 1 if a row beats `auto`. Results in OUT/auto.json are kept; --again measures them again.

Each view is measured in two steps. The first step measures the FLIP of every row from one frame. The second step
measures the time of `auto` and of all rows with no more FLIP than `auto`, because no other row can beat `auto`.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys

sys.dont_write_bytecode = True
import scenes

SHIPPED = ["cornell-mirrors", "cornell-mirrors-closed", "courtyard", "flat", "gallery", "room"]
TRACED_KNOBS = ["depth=4", "depth=8", "depth=4,first=raster", "depth=8,first=raster"]
ROUGH_ROWS = [f"raytrace:depth=4,rays={rays}{first}" for rays in (1, 4, 16) for first in ("", ",first=raster")]
FASTER, BETTER = 1.15, 1.1


def list_rows(program):
    """Returns `auto`, every technique that draws each mirror's capture at most once, and rows of ray tracing alone."""
    listed = subprocess.run([program, "list", "techniques", "--json"], capture_output=True, text=True, check=True).stdout
    rows = ["auto"]
    for technique in json.loads(listed)["techniques"]:
        name, traits = technique["name"], technique["traits"]
        if traits["captures"] == "shared" or traits["mirrored_views"]:
            rows.append(name)
        elif traits["rays"]:
            rows += [f"{name}:{knobs}" for knobs in TRACED_KNOBS]
    return rows


def measured(arguments, name, scene, view, rows, timing):
    """Returns, by row: processor time of a frame in milliseconds, FLIP and rmse on mirrors, number of traced rays from
    mirrors, and the technique that draws each mirror."""
    folder = os.path.join(arguments.out, "compare")
    run = subprocess.run([arguments.program, "compare", scene, "-o", folder, "--size", arguments.size, "--camera", "seeded",
                          "--seed", str(view), *timing, *arguments.scene_options, "--quiet", "--json", "--techniques", *rows],
                         capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"auto: {name}, view {view}: {run.stderr}")
    found = {}
    for row in json.loads(run.stdout)["rows"]:
        error = row["error"]
        found[row["label"]] = {"ms": row["cpu_ms"]["median"], "flip": error["flip"], "rmse": error["rmse"],
                               "traced": (row.get("rays") or {}).get("mirror", 0),
                               "drawn": [[entry["technique"], entry["settings"]] for entry in row["plan"]],
                               "plan": sorted({entry["why"] for entry in row["plan"]}) if row["label"] == "auto" else []}
    return found


def rivals(found):
    """Returns the rows with no more FLIP than `auto`, which beat `auto` if they are fast enough."""
    ours = found["auto"]
    return [name for name, row in found.items()
            if name != "auto" and None not in (row["flip"], ours["flip"]) and row["drawn"] != ours["drawn"]
            and row["flip"] <= ours["flip"]]


def measure(arguments, name, scene, view, rows, found):
    """Measures the rows of a view whose results `found` lacks, and adds these results to `found`. Returns whether any
    row was measured."""
    missing = [row for row in rows if arguments.again or row not in found]
    if not missing:
        return False
    found.update(measured(arguments, name, scene, view, list(dict.fromkeys(["auto", *missing])),
                          ["--frames", "1", "--warmup", "4"]))
    timing = ["--frames", str(arguments.frames or 2 * arguments.rounds), "--warmup", "4", "--rounds", str(arguments.rounds)]
    timed = rivals(found)
    if timed:
        found.update(measured(arguments, name, scene, view, ["auto", *timed], timing))
    for row in found:
        found[row]["timed"] = row == "auto" and bool(timed) or row in timed
    return True


def beaten(found):
    """Returns the rows that beat `auto` in a view, each as (way, row, factor)."""
    ours, worse = found["auto"], []
    for name, row in found.items():
        if name == "auto" or row["flip"] is None or row.get("drawn") == ours.get("drawn", []):
            continue  # a row with the same plan as auto differs from auto only by noise
        if row["timed"] and row["flip"] <= ours["flip"] and row["ms"] * FASTER < ours["ms"]:
            worse.append(("faster", name, ours["ms"] / row["ms"]))
        if row["timed"] and row["ms"] <= ours["ms"] and row["flip"] * BETTER < ours["flip"]:
            worse.append(("better", name, ours["flip"] / max(row["flip"], 1e-9)))
        searches = all(technique != "raytrace" for technique, _ in ours.get("drawn", []))
        if name == "hybrid" and searches and ours["traced"] > 1.01 * row["traced"]:
            worse.append(("traces more", name, ours["traced"] / max(row["traced"], 1e-9)))
    return worse


def line_of(name, views):
    """Returns a scene's line of the table: median FLIP over the views, and the number of views in which a row beats
    `auto`."""
    cells = [name]
    for row in ("auto", "planar", "secant", "pyramid", "march", "hybrid"):
        flips = [found[row]["flip"] for found in views.values() if row in found and found[row]["flip"] is not None]
        cells.append(f"{statistics.median(flips):.4f}" if flips else "")
    timed = sum(1 for found in views.values() if found["auto"]["timed"])
    worse = sum(1 for found in views.values() if beaten(found))
    return "| " + " | ".join([*cells, f"{timed} of {len(views)}", f"{worse} of {len(views)}"]) + " |"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--first", type=int, default=1, help="number of the first view")
    parser.add_argument("--views", type=int, default=30, help="number of the last view")
    parser.add_argument("--size", default="96x96")
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--frames", type=int, help="measured, of each row; two a round if not given")
    parser.add_argument("--rows", nargs="+", help="rows to compare with auto, and auto; by default all techniques")
    parser.add_argument("--rough", type=float, help="roughness of the mirrors")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("program")
    parser.add_argument("out")
    parser.add_argument("scene", nargs="*")
    arguments = parser.parse_args()
    arguments.scene_options = []
    arguments.rows = arguments.rows or list_rows(arguments.program)
    if arguments.rough:
        arguments.scene_options = ["--mirror", f"mirror,roughness={arguments.rough}", "--reference-seconds", "10"]
        arguments.rows = [*arguments.rows, *ROUGH_ROWS]
    files = {**{name: name for name in SHIPPED}, **scenes.write(os.path.join(arguments.out, "scenes"))}
    chosen = arguments.scene or list(files)
    store = os.path.join(arguments.out, "auto.json")
    known = json.load(open(store)) if os.path.exists(store) else {}
    lines, count = [], 0
    for name in chosen:
        views = known.setdefault(name, {})
        numbers = range(arguments.first, arguments.views + 1)
        for view in numbers:
            found = views.setdefault(str(view), {})
            if measure(arguments, name, files.get(name, name), view, arguments.rows, found):
                with open(store, "w") as file:
                    json.dump(known, file, indent=1)
            for how, row, much in beaten(found):
                count += 1
                print(f"{name} view {view}: {row} is {how}, {much:.2f}x: {row} {found[row]['ms']:.1f} ms "
                      f"{found[row]['flip']:.4f}, auto {found['auto']['ms']:.1f} ms {found['auto']['flip']:.4f}; "
                      f"{'; '.join(found['auto']['plan'])}", flush=True)
        lines.append(line_of(name, {view: views[view] for view in map(str, numbers)}))
        print(lines[-1], flush=True)
    with open(os.path.join(arguments.out, "auto.md"), "w") as file:
        file.write("| scene | `auto`, FLIP | `planar` | `secant` | `pyramid` | `march` | `hybrid` | views timed | beaten in |\n"
                   "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n" + "\n".join(lines) + "\n")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
