"""Tests the map of the trade in a report: its times and fronts against sums of the report's counts, and its controls."""

import glob
import json
import math
import pathlib
import random
import re
import subprocess
import sys

from browser import expect, open_page, wait
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "docs"))
import make_map

COSTS = ROOT / "docs/costs"
RAYS = {"camera_rays", "mirror_rays", "shadow_rays", "nodes", "triangles", "node_lanes", "triangle_lanes"}
RASTER = {"shadow_lookups", "colour_lookups", "distance_lookups", "colour_lanes", "distance_lanes", "search_lanes",
          "vertices", "primitives", "fragments", "draws"}
FIXED = {"vertices", "primitives", "frames", "passes", "draws", "dispatches"}
ROWS = ["reuse:face=32", "secant:face=32", "planar", "raytrace:depth=2", "hybrid:face=32"]


def predict(row, costs, point, bound=None):
    """Returns the time of a row of report.json at a point, ms, as the sum over the kinds of work. `bound`: "rays" takes the
    lowest costs of rays and the highest of all else, "raster" the reverse."""
    ms, rest = 0, row["work_at_rest"][0]
    for unit in costs["costs"]:
        kind = unit["work"]
        kept = rest.get(kind) or 0
        captures = max((row["work"].get(kind) or 0) - kept, 0) / point["period"]
        count = kept * (1 if kind in FIXED else point["pixels"]) + captures
        low, high = unit.get("range", [unit["ns"]] * 2)
        ns = unit["ns"] if bound is None else low if (kind in RAYS) == (bound == "rays") else high
        ms += count * ns * (point["raster"] if kind in RASTER else 1) * 1e-6
    return ms


def read_map(browser, point, device):
    return browser.execute_script(
        """const {data} = document.querySelector('.map').map, {find_rows, find_best} = catoptric_map;
           const point = {...arguments[0], period: arguments[0].period ?? Infinity};
           return [find_rows(data, data.devices[arguments[1]], point), find_best(data, data.devices[arguments[1]], point)]""",
        {**point, "period": None if math.isinf(point["period"]) else point["period"]}, device)


def test_sums(browser, report):
    """At drawn points, times, fronts and best rows are those of sums over report.json and the files of costs."""
    files = sorted(name for name in glob.glob(str(COSTS / "*.json")) if not name.endswith(".times.json"))
    devices = [json.loads(pathlib.Path(name).read_text()) for name in files]
    names = browser.execute_script("return document.querySelector('.map').map.data.devices.map(x => x.name)")
    expect(names == [device["device"] for device in devices], f"the devices are {names}")
    rows, draw = report["rows"], random.Random(72)
    for _ in range(20):
        device = draw.randrange(len(devices))
        point = {"pixels": 4 ** draw.uniform(-2, 4), "raster": 2 ** draw.uniform(-6, 6), "max_flip": draw.choice([0.01, 0.05, 0.2]),
                 "period": draw.choice([1, 2 ** draw.uniform(0, 6), math.inf])}
        times = [predict(row, devices[device], point) for row in rows]
        flips = [row["error"]["flip"] for row in rows]
        beaten = [any(times[j] <= times[i] and flips[j] <= flips[i] and (times[j] < times[i] or flips[j] < flips[i])
                      for j in range(len(rows))) for i in range(len(rows))]
        told, best = read_map(browser, point, device)
        for i, row in enumerate(told):
            expect(math.isclose(row["ms"], times[i], rel_tol=1e-9), f"{point} on {names[device]}: {rows[i]['label']} takes "
                   f"{times[i]} ms, the map says {row['ms']}")
            expect(row["front"] == (not beaten[i]), f"{point} on {names[device]}: front of {rows[i]['label']}")
        fit = [i for i in range(len(rows)) if flips[i] <= point["max_flip"]]
        wanted = min(fit, key=lambda i: times[i]) if fit else -1
        expect(best == wanted, f"{point} on {names[device]}: best is {wanted}, the map says {best}")


def test_picture(page, report):
    """The picture that docs/make_map.py draws of this page: kinds of the fastest rows at drawn cells are those of sums, its
    dashed lines lie at the balances of docs/costs.md, and each column is full."""
    costs = json.loads((COSTS / "rtx-2080-ti.json").read_text())
    draw, rows, max_flip = random.Random(20261201), report["rows"], 0.05
    maps = make_map.read_maps(page, max_flip)
    for _ in range(60):
        k, line, column = draw.randrange(len(make_map.PICTURES)), draw.randrange(make_map.STEPS), draw.randrange(len(make_map.PERIODS))
        width, height = make_map.PICTURES[k]
        raster = 2 ** (-3 + 12 * (line + 0.5) / 48)
        point = {"pixels": width * height / (48 * 32), "raster": raster, "period": make_map.PERIODS[column]}
        wanted = []
        for bound in (None, "rays", "raster"):
            fit = [row for row in rows if row["error"]["flip"] <= max_flip]
            best = min(fit, key=lambda row: predict(row, costs, point, bound))["technique"]
            wanted.append({"raytrace": "rays", "planar": "planar", "hybrid": "hybrid"}.get(best, "captures"))
        expect(maps[k][line][column] == wanted, f"{point} of picture {k}: wanted {wanted}, found {maps[k][line][column]}")
    marks = dict(make_map.read_marks())
    unit = {cost["work"]: cost["ns"] for cost in costs["costs"]}
    balance = unit["colour_lookups"] / (unit["mirror_rays"] + 15 * unit.get("nodes", 0))
    expect(math.isclose(marks["card without ray cores"], balance, rel_tol=0.02), f"a look-up takes {balance} rays, the picture says {marks}")
    drawn = make_map.draw([("flat", maps)], list(marks.items()))
    columns = {}
    for x, y, height in re.findall(r'<rect x="(\d+)" y="([\d.]+)" width="18" height="(\d+)" fill="#', drawn):
        columns.setdefault(x, []).append((float(y), float(y) + float(height)))
    ends = [sorted({end for area in areas for end in area if sum(end in other for other in areas) == 1}) for areas in columns.values()]
    panels = [make_map.TOP, make_map.TOP + 144, make_map.TOP + 144 + 46, make_map.TOP + 2 * 144 + 46]
    expect(ends == [panels] * 8, f"the areas of the columns leave gaps or overlap: {ends}")


def test_margin(browser):
    """A row is on the front at its margin and off it beyond."""
    found = browser.execute_script(
        """const {data} = document.querySelector('.map').map, {find_rows, find_margin} = catoptric_map, list = [];
           for (const device of data.devices)
               for (const period of [1, 8, Infinity]) {
                   const point = {pixels: 1, raster: 1, period};
                   find_rows(data, device, point).forEach(({front}, i) => {
                       if (!front) return;
                       const margin = find_margin(data, device, point, i);
                       if (margin === Infinity) return;
                       const at = factor => find_rows(data, device, {...point, raster: factor})[i].front;
                       list.push([at(margin * 0.999), at(margin * 1.01)]);
                   });
               }
           return list""")
    expect(found and all(pair == [True, False] for pair in found), f"margins of rows on fronts: {found}")


def test_controls(browser):
    """The answer follows the device, the sliders, the keys and the pointer."""
    read = lambda: browser.execute_script("return document.querySelector('.map .answer').textContent")
    state = lambda: browser.execute_script("return {...document.querySelector('.map').map.state}")
    first = read()
    expect("with captures drawn in each frame" in first and " ms" in first, f"the map says '{first}'")
    canvas = browser.find_elements(By.CSS_SELECTOR, ".map canvas")[0]
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
    canvas.send_keys(Keys.ARROW_RIGHT * 4 + Keys.ARROW_UP * 2)
    expect((state()["period"], state()["raster"]) == (1, 0.5), f"the keys led to {state()}")
    expect("each 2 frames" in read(), f"after the keys the map says '{read()}'")
    sliders = browser.find_elements(By.CSS_SELECTOR, ".map input[type=range]")
    expect([slider.get_attribute("value") for slider in sliders[:2]] == ["0.5", "1"], "the sliders do not follow the keys")
    ActionChains(browser).move_to_element_with_offset(canvas, canvas.size["width"] // 4, 0).click().perform()
    expect(abs(state()["period"] - 4.5) < 0.1 and abs(state()["raster"]) < 0.1, f"the pointer led to {state()}")
    sliders[1].send_keys(Keys.HOME)
    expect(state()["period"] == 0, f"Home on the slider led to {state()}")
    browser.find_element(By.CSS_SELECTOR, ".map input[type=checkbox]").click()
    expect("at rest" in read(), f"at rest the map says '{read()}'")
    answers = set()
    for i in range(len(browser.execute_script("return document.querySelector('.map').map.data.devices"))):
        browser.execute_script("""const select = document.querySelector('.map select'); select.value = arguments[0];
                                  select.dispatchEvent(new Event('change'));""", str(i))
        answers.add(read())
    expect(len(answers) > 3, f"all devices say {answers}")


def test_map(program, folder):
    folder.mkdir(exist_ok=True)
    subprocess.run([program, "compare", "flat", "--size", "48x32", "--frames", "6", "--warmup", "1", "--map", "-q", "-o", str(folder),
                    "--techniques", *ROWS], check=True, stdout=subprocess.DEVNULL)
    report = json.loads((folder / "report.json").read_text())
    browser = open_page(folder / "report.html")
    wait(browser, "return document.querySelector('.map').dataset.ready")
    test_sums(browser, report)
    test_margin(browser)
    test_controls(browser)
    test_picture(folder / "report.html", report)
    problems = [entry["message"] for entry in browser.get_log("browser")]
    expect(not problems, f"the console says {problems}")
    browser.quit()
    browser = open_page(folder / "report.html", 360)
    wide = browser.execute_script("return document.documentElement.scrollWidth")
    expect(wide <= 360, f"at 360 pixels the page with a map is {wide} wide")
    browser.quit()
