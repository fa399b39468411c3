"""Draws docs/images/map.svg from reports of `compare SCENE --map`: which kind of row is fastest, over all devices.

The page of each report computes the map (engine/report/page/map.js); this script reads it there on a grid.
"""
import argparse
import math
import pathlib
import sys
from html import escape
from itertools import groupby

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tests/page"))
from browser import open_page, wait

DEVICE = "GeForce RTX 2080 Ti"  # its rays are traced in software
# What the left side of the picture calls the rows of the table of balances in docs/costs.md.
MARKS = {DEVICE: "card without ray cores", "the same with ray-tracing cores": "card with ray cores",
         "llvmpipe of Mesa 22.3, for a subgroup of 8": "llvmpipe", "NVIDIA H200": "NVIDIA H200"}
POWERS = (-3, 9)  # of the factor on costs of raster work, 2 to the power
PERIODS = [1, 2, 4, 8, 16, 32, 64, math.inf]
STEPS = 48  # of each factor of 2^12, from bottom to top
PICTURES = [(512, 512), (1920, 1080)]
KINDS = {"rays": ("#3ca951", "rays"), "hybrid": ("#a463f2", "captures, and rays where they do not know"),
         "captures": ("#4269d0", "captures"), "planar": ("#efb118", "mirrored views"), "none": ("#bbb", "no row")}
CELL, LINE, LEFT, TOP, GAP = 18, 3, 190, 30, 14

READ = """
const {data} = document.querySelector('.map').map, {find_best} = catoptric_map, [name, points] = arguments;
const device = data.devices.find(device => device.name === name);
const label = index => index < 0 ? '' : data.rows[index].label;
return points.map(point => [undefined, 'rays', 'raster'].map(bound =>
    label(find_best(data, device, {...point, period: point.period ?? Infinity}, bound))))"""


def read_marks():
    """Returns the name and the balance of each device of MARKS: how many rays take as long as a look-up. DEVICE is first."""
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in (ROOT / "docs/costs.md").read_text().splitlines()]
    found = {row[0]: float(row[4]) for row in rows if len(row) == 5 and row[0] in MARKS}
    if missing := MARKS.keys() - found:
        sys.exit(f"make_map: docs/costs.md: wanted the balance of {', '.join(MARKS)}, found none of {', '.join(missing)}")
    return [(name, found[device]) for device, name in MARKS.items()]


def kind_of(label):
    technique = label.split(":")[0]
    return {"": "none", "raytrace": "rays", "hybrid": "hybrid", "planar": "planar"}.get(technique, "captures")


def read_maps(report, max_flip):
    """Returns for each picture the kinds of row that are fastest: lines from the cheapest raster work, of a triple for each
    period. The triple has the kind by the given costs, and by both ends of their ranges."""
    browser = open_page(report)
    try:
        wait(browser, "return document.querySelector('.map')?.dataset.ready")
        size = browser.execute_script("const {width, height} = document.querySelector('.map').map.data; return width * height")
        maps = []
        for width, height in PICTURES:
            points = [{"raster": 2 ** (POWERS[0] + (line + .5) / STEPS * (POWERS[1] - POWERS[0])), "max_flip": max_flip,
                       "pixels": width * height / size, "period": None if math.isinf(period) else period}
                      for line in range(STEPS) for period in PERIODS]
            told = [[kind_of(label) for label in labels] for labels in browser.execute_script(READ, DEVICE, points)]
            maps.append([told[i:i + len(PERIODS)] for i in range(0, len(told), len(PERIODS))])
        return maps
    finally:
        browser.quit()


def draw_panel(x, y, lines, marks):
    out = []
    for j, column in enumerate(zip(*lines)):
        left, first = x + j * CELL + (3 if math.isinf(PERIODS[j]) else 0), 0
        for (kind, is_open), run in groupby((cell[0], len(set(cell)) > 1) for cell in column):
            count = len(list(run))
            first += count
            at = f'x="{left}" y="{y + (STEPS - first) * LINE}" width="{CELL}" height="{count * LINE}"'
            out.append(f'<rect {at} fill="{KINDS[kind][0]}"/>')
            if is_open:
                out.append(f'<rect {at} fill="url(#open)"/>')
    out += [f'<path d="M{x} {y + up(balance / marks[0][1]):.1f}h{len(PERIODS) * CELL + 3}" stroke="#000" stroke-dasharray="2 2"/>' for _, balance in marks]
    return out


def up(factor):
    """Returns the distance from the top of a panel at which raster work costs `factor` times that of DEVICE."""
    return STEPS * LINE * (1 - (math.log2(factor) - POWERS[0]) / (POWERS[1] - POWERS[0]))


def draw(scenes, marks):
    """Returns the picture of a list of (name, maps of `read_maps`). `marks`: as read_marks returns them."""
    panel_width, panel_height = len(PERIODS) * CELL + 3, STEPS * LINE
    width = LEFT + len(scenes) * (panel_width + GAP)
    height = TOP + len(PICTURES) * (panel_height + 46) + 40
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12" shape-rendering="crispEdges">',
           '<pattern id="open" width="6" height="6" patternUnits="userSpaceOnUse"><path d="M0 6L6 0" stroke="#fff" stroke-width="1.3"/></pattern>',
           f'<rect width="{width}" height="{height}" fill="#fff"/>']
    for k, (name, maps) in enumerate(scenes):
        x = LEFT + k * (panel_width + GAP)
        out.append(f'<text x="{x + panel_width / 2}" y="{TOP - 12}" text-anchor="middle" font-weight="bold">{escape(name)}</text>')
        for row, lines in enumerate(maps):
            y = TOP + row * (panel_height + 46)
            out += draw_panel(x, y, lines, marks)
            for j, period in enumerate(PERIODS):
                text = "rest" if math.isinf(period) else str(period) if period in (1, 4, 16) else ""
                out.append(f'<text x="{x + (j + .5) * CELL + (3 if text == "rest" else 0)}" y="{y + panel_height + 14}" text-anchor="middle" font-size="11">{text}</text>')
    for row, (wide, high) in enumerate(PICTURES):
        y = TOP + row * (panel_height + 46)
        out.append(f'<text x="{LEFT - 8}" y="{y - 12}" text-anchor="end" font-weight="bold">{wide}x{high}</text>')
        for name, balance in marks:
            out.append(f'<text x="{LEFT - 8}" y="{y + up(balance / marks[0][1]) + 4:.1f}" text-anchor="end">{escape(name)}: {balance:g}</text>'.replace(": 0.", ": ."))
    y = height - 30
    out.append(f'<text x="{LEFT}" y="{y}">across: frames between two drawings of the captures; up: the cost of a look-up, in rays</text>')
    x = LEFT
    for kind in KINDS:
        colour, text = KINDS[kind]
        if not any(kind in cell[0] for _, maps in scenes for lines in maps for line in lines for cell in line):
            continue
        out.append(f'<rect x="{x}" y="{y + 9}" width="12" height="12" fill="{colour}"/><text x="{x + 17}" y="{y + 19}">{text}</text>')
        x += 36 + 7 * len(text)
    out.append(f'<rect x="{x}" y="{y + 9}" width="12" height="12" fill="#888"/><rect x="{x}" y="{y + 9}" width="12" height="12" fill="url(#open)"/>'
               f'<text x="{x + 17}" y="{y + 19}">the ranges of the costs do not decide</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=pathlib.Path, help="folder of a report; its name names the scene")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--max-flip", type=float, default=.05)
    arguments = parser.parse_args()
    scenes = [(folder.name, read_maps(folder / "report.html", arguments.max_flip)) for folder in arguments.folders]
    arguments.output.write_text(draw(scenes, read_marks()))


if __name__ == "__main__":
    main()
