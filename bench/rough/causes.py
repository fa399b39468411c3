#!/usr/bin/env python3
"""Measures the causes of error of filtered look-ups by roughness.

causes.py PROGRAM [--size WxH] [-o FOLDER] [--into FILE] compares rows in the scene `roughness` with `--causes`, and prints
a table in Markdown, or writes it between `<!-- rough causes -->` and `<!-- /rough causes -->` of a file. Reports in
FOLDER are kept. Each line has the causes of the error in the pixels of the ball and the slab of one roughness.
"""
import argparse
import json
import os
import re
import subprocess
import sys

ROUGHNESSES = ["0.1", "0.3", "0.6"]
CAUSES = ["filter", "distance law", "lobe shape", "direction", "hidden target", "texels", "mirror in mirror", "rest"]


def measure_rows(arguments, technique):
    """Returns the rows of the report of `technique` with both ways to filter captures."""
    folder = os.path.join(arguments.out, technique)
    report = os.path.join(folder, "report.json")
    if not os.path.exists(report):
        subprocess.run([arguments.program, "compare", "roughness", "-o", folder, "--size", arguments.size, "--frames", "1",
                        "--warmup", "16", "--model", "required", "--causes", "--reference",
                        os.path.join(arguments.out, "halves.exr"), "--reference-seconds", "40", "--quiet", "--techniques",
                        f"{technique}:face=128,rough=mips", f"{technique}:face=128"], check=True)
    return json.load(open(report))["rows"]


def format_line(row, numbers, roughness):
    """Returns a line of the table: rmse and shares in the pixels of the mirrors with these numbers."""
    causes = {cause["cause"]: sum(cause["share_per_mirror"][n - 1] for n in numbers) for cause in row["causes"]["list"]}
    whole = sum(causes.values())
    errors = [error for error in row["error_per_mirror"] if error["mirror"] in numbers]
    pixels = sum(error["pixels"] for error in errors)
    square = sum(error["pixels"] * row["causes"]["squared_error_per_mirror"][error["mirror"] - 1] for error in errors) / pixels
    cells = [f"{square ** .5:.3f}".lstrip("0")] + [f"{100 * causes[cause] / whole:.0f}" for cause in CAUSES]
    return f"| `{row['label']}` | {roughness.lstrip('0')} | " + " | ".join(cells) + " |\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--size", default="48x48")
    parser.add_argument("-o", dest="out", default="out/rough-causes")
    parser.add_argument("--into", metavar="FILE")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    info = subprocess.run([arguments.program, "info", "roughness", "--json"], capture_output=True, text=True, check=True)
    names = [mirror["name"] for mirror in json.loads(info.stdout)["mirrors"]]
    table = "| row | roughness | rmse | " + " | ".join(CAUSES) + " |\n|---|--:" + "|--:" * (len(CAUSES) + 1) + "|\n"
    for technique in ("reuse", "parallax"):
        for row in measure_rows(arguments, technique):
            for roughness in ROUGHNESSES:
                numbers = [i + 1 for i, name in enumerate(names) if re.search(r" ([\d.]+)$", name)
                           and name.endswith(" " + roughness)]
                table += format_line(row, numbers, roughness)
    if not arguments.into:
        print(table)
        return
    text = open(arguments.into).read()
    begin, end = "<!-- rough causes -->\n", "<!-- /rough causes -->"
    if begin not in text or end not in text:
        sys.exit(f"causes: {arguments.into}: wanted the marks {begin.strip()} and {end}")
    with open(arguments.into, "w") as out:
        out.write(text[:text.index(begin) + len(begin)] + table + text[text.index(end):])


if __name__ == "__main__":
    main()
