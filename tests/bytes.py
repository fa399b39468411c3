#!/usr/bin/env python3
"""Compares everything that two builds of the program draw and print, byte by byte, over drawn cases.

bytes.py [--cases N] [--seed S] [--fresh] [--keep DIR] [--only KIND ...] OLD NEW
bytes.py --orders N [--seed S] PROGRAM
OLD and NEW are two programs `catoptric`. A case is a command line, drawn by S from scenes, techniques, knobs, odd
sizes and verbs, and both programs run it one after the other with the same number of driver threads (1 or 2). Every
choice of every knob of every technique occurs at least once, so N is a least number. Compared are exit codes, texts of
errors, EXR files with all layers, frames of films, pictures of reports, the frame's passes, the contents of scenes and
the figures of reports without times. --fresh gives each run an empty shader cache. --keep stores both results of each
case that differs. With --orders, the rows of a comparison are drawn in N orders, and each row must stay the same.
The exit code is 1 if a byte differs, and 2 if a program could not be run.
"""
import argparse
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOST_REFUSED = 20  # drawn comparisons of --orders that end with an error, one after the other
LONGEST = 300  # seconds of one run; a longer run is ended, and counts as a case that was not compared
STOPPED = "stopped"
KINDS = ("still", "film", "passes", "plan", "together", "models", "rows", "info", "broken")
# Largest drawn value of knobs whose cost grows with it.
MOST = {"face": 150, "capture": 150, "bounces": 3, "rays": 24, "samples": 9, "probes": 64, "shadow_map": 700, "taps": 40,
        "range": 1e6, "seed": 4294967295, "steps": 64}
# Values of knobs that a case leaves open, in most cases: the defaults draw hundreds of times as many texels.
CHEAP = {"face": 24, "shadow_map": 96, "taps": 6, "probes": 27, "capture": 24}
# Options of the scene, each given to some of the pictures.
SCENE_OPTIONS = [["--camera", "seeded", "--seed", "{}"], ["--time", "{}.25"], ["--exposure", "1.5"], ["--ambient", "0.2"],
                 ["--dielectric-mirrors"], ["--glass-shadow", "tint"], ["--light-samples", "3"], ["--environment", "studio"],
                 ["--environment", "studio", "--environment-shadows", "2"], ["--multiple-scattering", "turquin"],
                 ["--mirror-max-roughness", "0.3"], ["--model", "everything"]]
# Members of reports that depend on time, place or date.
UNSTEADY = {"version", "commit", "date", "command", "setup", "load", "device", "clear_ms", "pareto", "verdict", "judged_time",
            "host_parts", "noisy", "waited", "seconds", "closure", "reference_noise", "findings", "path_distance", "compile"}


def steady(value):
    """Returns a member of a report without what depends on time: figures of times and texts made of them."""
    if isinstance(value, dict):
        return {name: steady(part) for name, part in value.items()
                if name not in UNSTEADY and not (isinstance(part, dict) and "ci95" in part and "median" in part)}
    return [steady(part) for part in value] if isinstance(value, list) else value


class Case:
    """A command line without the program, the files that it reads, and what it writes."""

    def __init__(self, kind, words, files=(), checks_out=False):
        self.kind, self.words, self.files, self.checks_out = kind, words, dict(files), checks_out


class Draw:
    """Draws cases from the techniques, scenes and files of a program."""

    def __init__(self, program, seed):
        self.random = random.Random(seed)
        ask = lambda what: json.loads(subprocess.run([program, "list", what, "--json"], check=True, capture_output=True).stdout)
        self.techniques = {entry["name"]: entry["knobs"] for entry in ask("techniques")["techniques"]}
        samples = ROOT / "samples/scenes"
        self.files = {name: (samples / name).read_bytes() for name in
                      ("cornell-mirrors.glb", "cornell-mirrors.obj", "cornell-mirrors.mtl")}
        self.scenes = [entry["name"] for entry in ask("scenes")["scenes"]] + ["cornell-mirrors.glb", "cornell-mirrors.obj"]

    def number(self, knob):
        """Returns a value of a knob between its limits, as often small as large."""
        low, high = knob["low"], min(knob["high"], MOST.get(knob["name"], knob["high"]))
        at = self.random.random()
        value = max(low, 1) * (high / max(low, 1)) ** at if high > max(low, 1) else high
        return round(value) if isinstance(knob["default"], int) else round(value, 3)

    def values(self, knob):
        """Returns the values of a knob that must occur."""
        if "choices" in knob:
            return list(knob["choices"])
        special = [knob["special"]] if "special" in knob else []
        return [int(knob["low"]), self.number(knob), *special]

    def covering(self):
        """Returns (technique, settings) of up to three knobs each, in which every value of every knob occurs."""
        texts = []
        for name, knobs in self.techniques.items():
            left = [(knob["name"], value) for knob in knobs for value in self.values(knob)]
            self.random.shuffle(left)
            while left:
                settings = {}
                for knob, value in left[:]:
                    if knob not in settings and len(settings) < 3:
                        settings[knob] = value
                        left.remove((knob, value))
                texts.append((name, settings))
        self.random.shuffle(texts)
        return texts

    def text_of(self, name, settings):
        """Returns the text of a technique with settings. In nine of ten cases, knobs that are left open are cheap."""
        settings = dict(settings)
        if self.random.random() < .9:
            for knob in self.techniques[name]:
                if knob["name"] in CHEAP:
                    settings.setdefault(knob["name"], CHEAP[knob["name"]])
        return name + "".join((":" if place == 0 else ",") + f"{knob}={value}"
                              for place, (knob, value) in enumerate(settings.items()))

    def technique(self):
        """Returns the text of a technique with up to two drawn knobs."""
        name = self.random.choice([*self.techniques, "auto"])
        if name == "auto":
            return name
        knobs = self.random.sample(self.techniques[name], min(self.random.randint(0, 2), len(self.techniques[name])))
        return self.text_of(name, {knob["name"]: self.random.choice(self.values(knob)) for knob in knobs})

    def size(self):
        return f"{self.random.randrange(17, 62, 2)}x{self.random.randrange(11, 46, 2)}"

    def scene(self):
        """Returns the words that choose a scene, and its files."""
        scene = self.random.choice(self.scenes)
        words = [scene, "--size", self.size()]
        if self.random.random() < .4:
            words += [word.format(self.random.randint(1, 9)) for word in self.random.choice(SCENE_OPTIONS)]
        return words, self.files if "." in scene else {}

    def picture(self, technique):
        """Returns a case with one technique: a picture with all layers, a film of five frames, or the frame's passes."""
        words, files = self.scene()
        technique = ["--technique", technique]
        kind = self.random.choice(["still", "still", "film", "passes"])
        if kind == "passes":
            return Case(kind, ["graph", *words, *technique, "--format", "json"], files, True)
        if kind == "film":
            return Case(kind, ["render", *words, *technique, "--animate", "--frames", "5", "--warmup", "2", "-o", "{n}.exr"], files)
        return Case(kind, ["render", *words, *technique, "--aov", "all", "-o", "x.exr"], files)

    def plan(self):
        words, files = self.scene()
        plan = f"1={self.technique()} *={self.technique()}"
        return Case("plan", ["render", *words, "--plan", plan, "--aov", "all", "-o", "x.exr"], files)

    def rows(self, kind):
        words, files = self.scene()
        rows = list(dict.fromkeys(self.technique() for _ in range(self.random.randint(2, 4))))
        extra = {"together": ["--together"], "models": ["--model", "both"], "rows": ["--work"]}[kind]
        words = [word for word in words if word not in ("--model", "everything")]
        return Case(kind, ["compare", *words, *extra, "--frames", "2", "--warmup", "2", "--reference-seconds", "0",
                           "-o", "out", "--techniques", *rows], files)

    def info(self):
        words, files = self.scene()
        at = words.index("--size")
        words = [word for word in words[:at] + words[at + 2:] if word not in ("--model", "everything")]
        return Case("info", ["info", *words, "--json"], files, True)

    def broken(self):
        """Returns a scene file with cut, changed or repeated bytes."""
        name = self.random.choice(["cornell-mirrors.glb", "cornell-mirrors.obj"])
        data = bytearray(self.files[name])
        at = self.random.randrange(len(data) if self.random.random() < .5 else 3000)
        how = self.random.choice(["cut", "change", "repeat", "text"])
        if how == "cut":
            del data[at:]
        elif how == "change":
            for _ in range(self.random.choice([1, 1, 8])):
                data[self.random.randrange(min(len(data), 4000))] ^= 1 << self.random.randrange(8)
        elif how == "repeat":
            data[at:at] = data[at:at + 40]
        else:
            data[at:at + 6] = self.random.choice([b"nan   ", b"1e999 ", b"-1,-1,", b"\"\"{}[]", b"999999"])
        return Case("broken", ["info", name, "--json"], {**self.files, name: bytes(data)}, True)

    def cases(self, count, kinds):
        """Yields at least `count` cases of these kinds, or of all kinds. A case of several knobs that both programs refuse
        is followed by one case for each knob, so that each value is drawn in a picture."""
        others = [self.plan, self.info, lambda: self.rows("together")] * 3 + [lambda: self.rows("models")] * 2
        others += [lambda: self.rows("rows")] * 2 + [self.broken, lambda: self.picture(self.technique())] * 5
        made = 0

        def offered(case):
            nonlocal made
            if kinds and case.kind not in kinds:
                return False
            made += 1
            return (yield case)

        for place, (name, settings) in enumerate(self.covering()):
            refused = yield from offered(self.picture(self.text_of(name, settings)))
            if refused and len(settings) > 1:
                for knob, value in settings.items():
                    yield from offered(self.picture(self.text_of(name, {knob: value})))
            if place % 2:
                yield from offered(self.random.choice(others)())
        while made < count:
            yield from offered(self.random.choice(others)())


def run(program, case, folder, cache, threads):
    """Runs a case in an empty folder and returns what it left: {name: bytes}, and the exit code."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, data in case.files.items():
        (folder / name).write_bytes(data)
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache), "XDG_CONFIG_HOME": str(cache / "config"), "TZ": "UTC",
                   "MESA_SHADER_CACHE_DIR": str(cache / "mesa"), "LP_NUM_THREADS": str(threads)}
    try:
        ended = subprocess.run([program, *case.words, "-q"], cwd=folder, env=environment, capture_output=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return {STOPPED: b""}, None
    left = {"exit code": str(ended.returncode).encode(), "errors": ended.stderr}
    if case.checks_out:
        try:
            left["output"] = json.dumps(steady(json.loads(ended.stdout))).encode()
        except ValueError:
            left["output"] = ended.stdout
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.suffix in (".exr", ".png"):
            left[name] = path.read_bytes()
        elif path.name == "report.json":
            left[name] = json.dumps(steady(json.loads(path.read_bytes())), indent=1).encode()
    return left, ended.returncode


def differing(old, new):
    """Returns what differs between what two runs left, as text; empty if nothing does."""
    texts = []
    for name in sorted({*old, *new}):
        if name not in old or name not in new:
            texts.append(f"{name}: only {'old' if name in old else 'new'}")
        elif old[name] != new[name]:
            pairs = zip(old[name], new[name])
            at = next((place for place, (a, b) in enumerate(pairs) if a != b), min(len(old[name]), len(new[name])))
            shown = lambda data: data[max(at - 30, 0):at + 50] if name in ("exit code", "errors", "output", "out/report.json") else b""
            texts.append(f"{name}: {len(old[name])} and {len(new[name])} bytes, first at {at} {shown(old[name])} {shown(new[name])}")
    return texts


def compare(arguments, work):
    """Runs all cases and returns the exit code."""
    draw = Draw(arguments.programs[1], arguments.seed)
    cases = draw.cases(arguments.cases, arguments.only)
    counts, codes, different, stopped = {}, {}, 0, 0
    refused = None
    while True:
        try:
            case = cases.send(refused)
        except StopIteration:
            break
        refused = False
        threads = draw.random.choice([1, 2])
        results = []
        for place in draw.random.sample([0, 1], 2):  # neither program always runs first
            kept, cache = work / f"cache{place}", work / "cache"  # one path for both, because texts name it
            if kept.exists() and not arguments.fresh:
                kept.rename(cache)
            (cache / "mesa").mkdir(parents=True, exist_ok=True)
            results.append((place, run(arguments.programs[place], case, work / "run", cache, threads)))
            shutil.rmtree(kept, ignore_errors=True)
            cache.rename(kept)
        (old, code), (new, new_code) = (result for _, result in sorted(results, key=lambda entry: entry[0]))
        number = sum(counts.values()) + 1
        counts[case.kind] = counts.get(case.kind, 0) + 1
        if STOPPED in old and STOPPED in new:
            stopped += 1
            print(f"[{number}] over {LONGEST} s, not compared: {' '.join(case.words)}", flush=True)
            continue
        codes[new_code] = codes.get(new_code, 0) + 1
        refused = code not in (0, None) and new_code == code
        texts = differing(old, new)
        if texts:
            different += 1
            print(f"[{number}] differs, {threads} threads: catoptric {' '.join(case.words)}", *texts, sep="\n    ", flush=True)
            if arguments.keep:
                for name, left in (("old", old), ("new", new)):
                    for part, data in left.items():
                        path = pathlib.Path(arguments.keep) / str(number) / name / part
                        path.parent.mkdir(parents=True, exist_ok=True)
                        path.write_bytes(data)
        elif number % 20 == 0:
            print(f"[{number}] {different} differ", flush=True)
    kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items()))
    ended = ", ".join(f"{count} with exit code {code}" for code, count in sorted(codes.items(), key=str))
    print(f"bytes: {sum(counts.values())} cases ({kinds}; {ended}), seed {arguments.seed}: {different} differ"
          + (f", {stopped} not compared" if stopped else ""))
    return 1 if different else 0


def compare_orders(arguments, work):
    """Draws six rows in many orders and returns the exit code: 1 if a row depends on the rows before it."""
    draw = Draw(arguments.programs[0], arguments.seed)
    compared = different = refused = 0
    while compared < arguments.orders:
        if compared % 5 == 0 or refused:  # other rows and another scene
            words, files = draw.scene()
            rows, known = [], {}
            while len(rows) < 6:
                row = draw.technique()
                if row not in rows and "auto" not in row:
                    rows.append(row)
        draw.random.shuffle(rows)
        case = Case("order", ["compare", *words, "--frames", "2", "--warmup", str(draw.random.choice([2, 5])), "--reference-seconds",
                              "0", "-o", "out", "--techniques", *rows], files)
        (work / "cache/mesa").mkdir(parents=True, exist_ok=True)
        left, code = run(arguments.programs[0], case, work / "run", work / "cache", draw.random.choice([1, 2]))
        if code != 0:  # rows that this scene refuses, or that are equal
            refused += 1
            why = left.get("errors", b"").decode()[:200]
            if refused > MOST_REFUSED:
                print(f"bytes: {refused} drawn comparisons one after the other ended with an error, the last with {code}: {why}")
                return 2
            continue
        refused = 0
        compared += 1
        for row in json.loads(left["out/report.json"])["rows"]:
            image = left.get("out/" + (row.get("image") or ""), b"")
            figures = json.dumps({name: part for name, part in row.items() if name.startswith(("error", "mean", "rays"))})
            if known.setdefault((row["label"], case.words[case.words.index("--warmup") + 1]), (image, figures)) != (image, figures):
                different += 1
                print(f"[{compared}] row {row['label']} differs by its place: {' '.join(case.words)}", flush=True)
    print(f"bytes: {arguments.orders} orders of 6 rows, seed {arguments.seed}: {different} rows differ")
    return 1 if different else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--keep")
    parser.add_argument("--only", nargs="+", metavar="KIND", choices=KINDS)
    parser.add_argument("--orders", type=int, default=0)
    parser.add_argument("programs", nargs="+")
    arguments = parser.parse_args()
    if len(arguments.programs) != (1 if arguments.orders else 2):
        parser.error("wanted OLD and NEW, or one program with --orders")
    arguments.programs = [os.path.abspath(program) for program in arguments.programs]
    with tempfile.TemporaryDirectory(prefix="bytes-") as work:
        try:
            return (compare_orders if arguments.orders else compare)(arguments, pathlib.Path(work))
        except (OSError, subprocess.CalledProcessError) as error:
            print(f"bytes: {error}", file=sys.stderr)
            return 2


if __name__ == "__main__":
    sys.exit(main())
