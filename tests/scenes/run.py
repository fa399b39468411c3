#!/usr/bin/env python3
"""run.py PROGRAM MEASURE [PATTERN...]: measures scenes and writes docs/scenes.md. Called by ./dev scenes.

The scenes are those of valid.txt and refused.txt below build/scenes and the built-in scenes, named 'own/NAME'. With
PATTERNs, only scenes whose name contains a PATTERN are measured. docs/scenes.md shows all scenes measured so far.
PROGRAM: catoptric; MEASURE: catoptric_scenes."""
import datetime
import json
import pathlib
import shlex
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "build/scenes"
ROWS = SCENES / "rows"
PICTURES = SCENES / "pictures"
PACKAGES = {"assimp": "assimp-testmodels 5.2.5", "furniture": "sweethome3d-furniture 1.8",
            "webxr": "@webxr-input-profiles/assets 1.0.20"}
OWN = ["flat", "room", "gallery", "courtyard", "cornell-mirrors", "cornell-mirrors-closed"]
SMALL = ["--size", "64x64"]
LIMIT_S, OFF, LEAST_CHANGED, LEAST_VARIATION = 60, .005, .05, .1
TIMED_OUT = 124


def listed(name):
    lines = (ROOT / "tests/scenes" / name).read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def run(command, limit=600):
    """Runs a command. Returns its exit code (128 + n after signal n), seconds, stdout, and the last error on stderr."""
    began = time.monotonic()
    try:
        ended = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return TIMED_OUT, limit, "", "not done in time"
    code = ended.returncode if ended.returncode >= 0 else 128 - ended.returncode
    said = [line for line in ended.stderr.splitlines() if line.strip() and "warning:" not in line]
    return code, time.monotonic() - began, ended.stdout, said[-1] if said else ""


def place(name):
    return name[4:] if name.startswith("own/") else str(SCENES / name)


def row_file(name):
    return ROWS / (name.replace("/", "__") + ".json")


def measure(program, tool, name, refused):
    row = {"name": name, "codes": {}}
    row["codes"]["info"], _, out, row["says"] = run([program, "info", place(name), "--json", "-q"])
    if not refused and row["codes"]["info"] == 0:
        row["info"] = json.loads(out)
        folder = PICTURES / name.replace("/", "__")
        folder.mkdir(parents=True, exist_ok=True)
        render = [program, "render", place(name), "--technique", "raytrace", *SMALL, "-o", folder / "render.png", "-q"]
        row["codes"]["render"], row["seconds"], _, says = run(render)
        row["says"] = row["says"] or (says if row["codes"]["render"] else "")
        wishes = row["info"]["mirror_options"][:1] if not row["info"]["mirrors"] else []
        row["mirror_option"] = wishes[0] if wishes else ""
        if row["info"]["mirrors"] or wishes:
            compare = [program, "compare", place(name), *SMALL, "--techniques", "reuse", "parallax", "raytrace",
                       "--frames", "1", "--warmup", "3", "-q", "-o", SCENES / "report" / name.replace("/", "__")]
            row["codes"]["compare"], row["compare_seconds"], _, says = run(compare + sum(map(shlex.split, wishes), []))
            row["says"] = row["says"] or (says if row["codes"]["compare"] else "")
        row["codes"]["measure"], _, out, says = run([tool, place(name), folder])
        row["says"] = row["says"] or (says if row["codes"]["measure"] else "")
        row["cameras"] = [json.loads(line) for line in out.splitlines()]
    row_file(name).write_text(json.dumps(row))
    print(name, row["codes"], row["says"], file=sys.stderr, flush=True)


def share(agreement):
    """Returns the share of judged pixels that are off, or None if no pixel was judged."""
    judged = agreement["judged"]
    return (agreement["off"] + agreement["background_off"]) / judged if judged else None


def worst(row, what):
    shares = [share(camera[what]) for camera in row.get("cameras", [])]
    shares = [value for value in shares if value is not None]
    return max(shares) if shares else None


def percent(value, digits=2):
    return "–" if value is None else f"{100 * value:.{digits}f}"


def judged(row):
    """Returns the share of pixels that were judged, among those that show a surface, over all cameras."""
    all_of = [camera["agreement"] for camera in row.get("cameras", [])]
    shown = sum(one["shown"] for one in all_of)
    return sum(one["judged"] for one in all_of) / shown if shown else None


def edges(rows):
    """Returns a sentence about pixels left out as edges and how many of them are off, over all files."""
    all_of = [camera["agreement"] for row in rows for camera in row.get("cameras", [])]
    total = {key: sum(one[key] for one in all_of) for key in ("shown", "judged", "edge", "edge_off")}
    return (f"- Of the pixels that show a surface {percent(total['judged'] / total['shown'], 0)} % were judged and "
            f"{percent(total['edge'] / total['shown'], 0)} % left out as edges, of which {percent(total['edge_off'] / total['edge'])} % are off.")


def shown_name(name):
    package, rest = name.split("/", 1)
    return rest


def line(row):
    info = row.get("info")
    codes = "/".join(str(row["codes"].get(verb, "–")) for verb in ("info", "render", "compare"))
    if not info:
        return f"| {shown_name(row['name'])} | {codes} | – | – | – | {row['says']} | – | – | – | – |"
    gaps = " ".join(gap["id"] for gap in info["gaps"])
    return (f"| {shown_name(row['name'])} | {codes} | {info['triangles']} | {len(info['mirrors'])} | {len(info['lights'])} | "
            f"{gaps or '–'} | {percent(judged(row), 0)} | {percent(worst(row, 'agreement'))} | "
            f"{percent(worst(row, 'agreement_dielectric_mirrors'))} | {row['seconds']:.1f} |")


def head(first):
    return (f"| {first} | info/render/compare | triangles | mirrors | lights | gaps | judged, % | off, % | "
            "off with dielectric mirrors, % | s |\n|---|---|--:|--:|--:|---|--:|--:|--:|--:|")


def lowest(row, list_name, figure):
    """Returns the lowest figure over the objects of a file and the object's name, or None without objects."""
    found = [(one[figure], one["object"]) for camera in row.get("cameras", []) for one in camera[list_name]]
    return min(found, key=lambda pair: pair[0]) if found else None


def sums(valid, refused):
    loaded = [row for row in valid if row["codes"].get("render") == 0 and row["seconds"] <= LIMIT_S]
    compared = [row for row in valid if "compare" in row["codes"]]
    textured = [(row, lowest(row, "textures", "changed")) for row in valid if lowest(row, "textures", "changed")]
    plain = [(row, low) for row, low in textured if low[0] < LEAST_CHANGED]
    lit = [(row, lowest(row, "lit", "variation")) for row in valid if lowest(row, "lit", "variation")]
    dull = [(row, low) for row, low in lit if low[0] < LEAST_VARIATION]
    signals = [row["name"] for row in valid + refused if any(code > 128 for code in row["codes"].values())]

    def agree(what):
        known = [row for row in valid if worst(row, what) is not None]
        good = [row for row in known if worst(row, what) <= OFF]
        return (f"{len(good)} of {len(known)}", [f"{shown_name(row['name'])} ({percent(worst(row, what))} %)"
                                               for row in known if row not in good])

    def named(pairs):
        return "; ".join(f"{shown_name(row['name'])} ('{low[1]}', {percent(low[0], 1)} %)" for row, low in pairs) or "none"
    outside, others = agree("agreement")
    with_mirrors, others_with = agree("agreement_dielectric_mirrors")
    refusals = [row for row in refused if row["codes"]["info"] in (65, 66) and row["says"]]
    good_compares = [row for row in compared if row["codes"]["compare"] == 0]
    return "\n".join([
        f"- Valid files that render within {LIMIT_S} s at 64x64: {len(loaded)} of {len(valid)}; the slowest took "
        f"{max(row['seconds'] for row in loaded):.1f} s.",
        f"- Comparisons of three techniques that ended with 0: {len(good_compares)} of {len(compared)}, in which the "
        "file's mirrors, or the first candidate that `info` names, is a mirror.",
        f"- Raster against rays at 128x128, off <= {percent(OFF, 1)} %: {outside}; more: {', '.join(others) or 'none'}.",
        f"- The same with `--dielectric-mirrors`: {with_mirrors}; more: {', '.join(others_with) or 'none'}.",
        edges(valid),
        f"- Files with visible base-colour textures that vary, where the mean in their place changes at least "
        f"{percent(LEAST_CHANGED, 0)} % of every such object's pixels: {len(textured) - len(plain)} of {len(textured)}; "
        f"the others: {named(plain)}.",
        f"- Files in which the luminance over every lit object's normals varies by at least {percent(LEAST_VARIATION, 0)} %: "
        f"{len(lit) - len(dull)} of {len(lit)}; the others: {named(dull)}.",
        f"- Files that must be refused and are, with a sentence: {len(refusals)} of {len(refused)}; signals: "
        f"{', '.join(signals) or 0}."])


NOTES = """Columns. Exit codes of the three verbs. *judged*: of the pixels that show a surface, those that are compared. Left out are
mirrors, what is smooth enough to reflect (a smooth dielectric), and pixels within one pixel of which a ray (three by three a
pixel, followed on the processor) meets another object, passes through another number of cut-out surfaces, finds another
light hidden, another texel of a texture that is not filtered, a surface that is sharp where this one is not, or an
outline of the same object: a place more than two pixels off both surfaces' planes. *off*: the judged pixels whose largest
channel differs by more than .02 between `naive:bounces=0` and `raytrace`, both times 2^exposure and clamped to [0,1], at
128x128 (background pixels that are off count, too); of several cameras the worst. *off with dielectric mirrors*: the same with
`--dielectric-mirrors`, where mirrors alone are left out. *s*: `catoptric render --technique raytrace --size 64x64`, process and all.

Objects of at least 32 pixels are asked about textures and normals. A texture varies where the texels that are seen have a
standard deviation above 8/255 in some channel; a pixel is changed by more than 1/255. Normals: those that differ by more
than 30 degrees, without textures and colours of vertices, as means over normals of about one direction; what is black is not lit.

`female02` has each of its faces twice in one place, with normals whose axes are exchanged in the second: which of the two
is in front is a matter of rounding, and raster and rays round differently."""


def own_rows(rows):
    text = [head("scene")]
    for name in OWN:
        row = rows.get(f"own/{name}")
        if row:
            text.append(line(row))
    text += ["", "Each camera by itself:", "", "| scene | camera | judged, % | off, % | off with dielectric mirrors, % |", "|---|---|--:|--:|--:|"]
    for name in OWN:
        for camera in rows.get(f"own/{name}", {}).get("cameras", []):
            one, other = camera["agreement"], camera["agreement_dielectric_mirrors"]
            text.append(f"| {name} | {camera['camera']} | {percent(one['judged'] / max(1, one['shown']), 0)} | "
                        f"{percent(share(one))} | {percent(share(other))} |")
    text += [""] + [f"![{name}](images/scene-{name}.png)" for name in OWN]
    return "\n".join(text)


def write_page():
    rows = {}
    for name in listed("valid.txt") + listed("refused.txt") + [f"own/{one}" for one in OWN]:
        if row_file(name).exists():
            rows[name] = json.loads(row_file(name).read_text())
    valid = [rows[name] for name in listed("valid.txt") if name in rows]
    refused = [rows[name] for name in listed("refused.txt") if name in rows]
    text = [f"<!-- generated by ./dev scenes on {datetime.date.today()} -->", "# Scenes", "",
            "Scenes that come with the program, and files that others made, as this program shows them. `./dev scenes` fetches "
            "those files from packages and measures all of them anew; it is no test.", "",
            "## What comes with it", "", own_rows(rows), "", "## Files from elsewhere", ""]
    if valid:
        text += [sums(valid, refused), "", NOTES, ""]
    for package, title in PACKAGES.items():
        text += [f"### {title}", "", head("file")]
        text += [line(row) for row in valid if row["name"].startswith(package + "/")] + [""]
    text += ["### Files that must be refused", "", "All of assimp-testmodels.", "", "| file | exit | says |", "|---|--:|---|"]
    for row in refused:
        says = row["says"].replace(str(SCENES) + "/assimp/", "").replace("catoptric: ", "")
        text.append(f"| {shown_name(row['name'])} | {row['codes']['info']} | {says} |")
    (ROOT / "docs/scenes.md").write_text("\n".join(text) + "\n")


def draw_own(program):
    for name in OWN:
        run([program, "render", name, "--technique", "raytrace:samples=4", "--size", "400x300", "-q",
             "-o", ROOT / f"docs/images/scene-{name}.png"])


def main():
    program, tool, patterns = sys.argv[1], sys.argv[2], sys.argv[3:]
    ROWS.mkdir(parents=True, exist_ok=True)
    (SCENES / "report").mkdir(exist_ok=True)
    refused = set(listed("refused.txt"))
    names = [f"own/{name}" for name in OWN] + listed("valid.txt") + listed("refused.txt")
    names = [name for name in names if not patterns or any(pattern in name for pattern in patterns)]
    if any(name.startswith("own/") for name in names):
        draw_own(program)
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda name: measure(program, tool, name, name in refused), names))
    write_page()


main()
