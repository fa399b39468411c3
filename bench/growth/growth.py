#!/usr/bin/env python3
"""Measures how time and memory grow with pixels, samples, bounces, face, triangles, mirrors and lights.

growth.py [--rounds N] CATOPTRIC OUT [VARIABLE...]: measures every size in each round, and fits power laws to the
medians. Writes OUT/growth.md, OUT/growth.json and a plot of each variable. Time is the processor time of all threads.
Memory is the peak memory of a process that renders one picture. All variables take half an hour.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # imports write no files into the source folder
import fit
import plot
import scenes

FRAMES = 2  # measured frames of each row in a round


def words(program, verb, scene_files, size, *more):
    built_in = not scene_files[0].endswith(".glb")
    return [program, verb, *scene_files, *([] if built_in else ["--camera", scenes.CAMERA]),
            "--size", f"{size}x{size}", "--quiet", *more]


def bench(program, scene_files, size, techniques, rounds):
    """Returns, by benchmark name, the processor time of each round in milliseconds."""
    run = subprocess.run(words(program, "bench", scene_files, size, "--frames", str(FRAMES * rounds), "--warmup", "3",
                               "--rounds", str(rounds), "--json", "--techniques", *techniques),
                         capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"growth: {' '.join(run.args)}\n{run.stderr}")
    found = {}
    for entry in json.loads(run.stdout)["benchmarks"]:
        if entry["run_type"] == "iteration":
            assert entry["time_unit"] == "ms"
            found.setdefault(entry["name"], []).append(entry["cpu_time"])
    return found


def peak_megabytes(program, scene_file, size, technique, folder):
    """Returns the peak memory, in megabytes, of a process that renders one picture."""
    child = subprocess.Popen(words(program, "render", [scene_file], size, "--frames", "1", "--warmup", "1", "--model",
                                   "everything", "--technique", technique, "-o", os.path.join(folder, "picture.png")))
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"growth: {' '.join(child.args)}: ended with {os.waitstatus_to_exitcode(status)}")
    return usage.ru_maxrss / 1024


def knob_series(program, folder, rounds, scene, size, rows):
    """Measures a knob of a technique at several values. `rows` holds pairs of a name and a table that gives, for each
    size, the technique with its knob."""
    title = os.path.splitext(os.path.basename(scene))[0]
    found = bench(program, [scene], size, [t for _, by_size in rows for t in by_size.values()], rounds)
    return [{"name": name, "sizes": list(by_size),
             "rounds": list(zip(*(found[f"frame/{title}/{size}x{size}/{t}"] for t in by_size.values()))),
             "megabytes": [peak_megabytes(program, scene, size, t, folder) for t in by_size.values()]}
            for name, by_size in rows]


def measure_pixels(program, folder, rounds):
    scene, edges = "cornell-mirrors", [64, 128, 256, 512]
    rows = ["raytrace:depth=4", "parallax:face=64", "secant:face=64", "pyramid:face=64", "hybrid:face=64"]
    passes = []
    for k in range(rounds):  # every other round goes through the sizes backwards, so that slow drifts cancel
        passes.append({})
        for edge in edges if k % 2 == 0 else reversed(edges):
            passes[-1][edge] = bench(program, [scene], edge, rows, 1)
    return [{"name": row, "sizes": [edge * edge for edge in edges],
             "rounds": [[p[edge][f"frame/{scene}/{edge}x{edge}/{row}"][0] for edge in edges] for p in passes],
             "megabytes": [peak_megabytes(program, scene, edge, row, folder) for edge in edges]} for row in rows]


def measure_samples(program, folder, rounds):
    return knob_series(program, folder, rounds, "cornell-mirrors", 64, [
        ("raytrace:depth=4", {n: f"raytrace:depth=4,samples={n}" for n in (1, 4, 16, 64, 256)})])


def measure_bounces(program, folder, rounds):
    balls = os.path.join(folder, "balls.glb")  # all balls are mirrors, so that paths have many bounces
    scenes.write(balls, lattice=4, mirrors=64, lights=1, edge=8)
    return (knob_series(program, folder, rounds, balls, 128, [
        ("raytrace, 64 mirrors", {n: f"raytrace:depth={n}" for n in (1, 2, 4, 8, 16, 32)})]) +
        knob_series(program, folder, rounds, "cornell-mirrors", 128, [
            ("raytrace", {n: f"raytrace:depth={n}" for n in (1, 2, 4, 8, 16, 32)}),
            ("naive:face=64", {n: f"naive:face=64,bounces={n}" for n in (1, 2, 4, 8)})]))


def measure_face(program, folder, rounds):
    return knob_series(program, folder, rounds, "cornell-mirrors", 128, [
        (row, {n * n: f"{row}:face={n}" for n in (32, 64, 128, 256, 512)}) for row in ("parallax", "secant", "pyramid")])


def scene_series(program, folder, rounds, size, techniques, parts, made):
    """Measures techniques on scenes of several sizes. `made` gives the arguments of `scenes.write` for each size.
    `parts` names parts of loading to measure, too. With parts, the size is the number of triangles."""
    files, sizes = [], []
    for n, shape in made.items():
        files.append(os.path.join(folder, f"scene-{n}.glb"))
        triangles = scenes.write(files[-1], **shape)
        sizes.append(triangles if parts else n)
    found = bench(program, files, size, techniques, rounds)
    names = [os.path.basename(file)[:-4] for file in files]
    series = [{"name": row, "sizes": sizes,
               "rounds": list(zip(*(found[f"frame/{name}/{size}x{size}/{row}"] for name in names))),
               "megabytes": [peak_megabytes(program, file, size, row, folder) for file in files]} for row in techniques]
    return series + [{"name": part, "sizes": sizes, "rounds": list(zip(*(found[f"{part}/{name}"] for name in names)))}
                     for part in parts]


def measure_triangles(program, folder, rounds):
    return scene_series(program, folder, rounds, 256, ["raytrace:depth=4", "parallax:face=64"],
                        ["load", "session", "hierarchy"],
                        {edge: {"lattice": 2, "mirrors": 2, "lights": 1, "edge": edge}
                         for edge in (3, 6, 11, 19, 34, 58, 102)})


def measure_mirrors(program, folder, rounds):
    return scene_series(program, folder, rounds, 128,
                        ["raytrace:depth=4", "parallax:face=32", "secant:face=32", "hybrid:face=32"], [],
                        {n: {"lattice": 4, "mirrors": n, "lights": 1, "edge": 8} for n in (1, 2, 4, 8, 16, 32, 64)})


def measure_crowd(program, folder, rounds):
    return scene_series(program, folder, rounds, 128, ["parallax:face=32"], [],
                        {n: {"lattice": 6, "mirrors": n, "lights": 1, "edge": 8} for n in (64, 128, 216)})


def measure_lattice(program, folder, rounds):
    return scene_series(program, folder, rounds, 128, ["parallax:face=32"], [],
                        {n ** 3: {"lattice": n, "mirrors": n ** 3, "lights": 1, "edge": 8} for n in (4, 5, 6)})


def measure_lights(program, folder, rounds):
    return scene_series(program, folder, rounds, 128, ["raytrace:depth=4", "parallax:face=64"], [],
                        {n: {"lattice": 2, "mirrors": 2, "lights": n, "edge": 16} for n in (1, 2, 4, 8, 16)})


UNITS = {"pixels": "pixels", "samples": "samples a pixel", "bounces": "bounces", "face": "texels of a face",
         "triangles": "triangles", "mirrors": "mirrors, of 64 balls", "crowd": "mirrors, of 216 balls",
         "lattice": "mirrors, with no other balls", "lights": "point lights"}
MEASURE = {name: globals()[f"measure_{name}"] for name in UNITS}


def table(found):
    lines = ["| against | of | from | to | ms | exponent | last step | peak MB |", "|---|---|--:|--:|--:|--:|--:|--:|"]
    for variable, series in found.items():
        for s in series:
            memory = s.get("megabytes")
            lines.append(
                f"| {variable} | `{s['name']}` | {plot.short(s['sizes'][0])} | {plot.short(s['sizes'][-1])} | "
                f"{s['ms'][0]:.3g} - {s['ms'][-1]:.3g} | {s['exponent']:.2f} [{s['low']:.2f} - {s['high']:.2f}] | "
                f"{s['last']:.2f} | " + (f"{memory[0]:.0f} - {memory[-1]:.0f} |" if memory else "|"))
    return "\n".join(lines) + "\n"


def write_all(out, found):
    with open(os.path.join(out, "growth.json"), "w", encoding="utf-8") as file:
        json.dump(found, file, indent=1)
        file.write("\n")
    with open(os.path.join(out, "growth.md"), "w", encoding="utf-8") as file:
        file.write("# Growth\nMade by `./dev bench growth`; what it says, and how it was measured: "
                   "[performance.md](../performance.md).\n\n" + table(found))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("out")
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("variables", nargs="*", metavar="VARIABLE", help=", ".join(UNITS) + " (all)")
    options = parser.parse_args()
    for variable in options.variables:
        if variable not in UNITS:
            parser.error(f"no variable '{variable}': there are {', '.join(UNITS)}")
    os.makedirs(options.out, exist_ok=True)
    program = os.path.abspath(options.program)
    path = os.path.join(options.out, "growth.json")
    found = {}
    if options.variables and os.path.exists(path):  # results of other variables are kept
        with open(path, encoding="utf-8") as file:
            found = json.load(file)
    for variable in options.variables or UNITS:
        with tempfile.TemporaryDirectory() as folder:
            series = MEASURE[variable](program, folder, options.rounds)
        for s in series:
            fitted = fit.fit(s["sizes"], s.pop("rounds"))
            s["ms"] = [round(ms, 4) for ms in fitted.pop("medians")]
            s.update({name: round(value, 6) for name, value in fitted.items()})
        found[variable] = series
        found = {name: found[name] for name in UNITS if name in found}
        plot.write(os.path.join(options.out, f"{variable}.svg"), variable, UNITS[variable], series)
        write_all(options.out, found)
        print(table({variable: series}), flush=True)


if __name__ == "__main__":
    main()
