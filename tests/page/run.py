#!/usr/bin/python3
"""Opens a report in Chromium and uses its page as a reader would. run.py CATOPTRIC FOLDER, by ./dev test --label page."""

import base64
import json
import math
import pathlib
import re
import struct
import subprocess
import sys
import time

from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

SIZE = (96, 64)
ROWS = ["naive:bounces=1", "reuse", "secant", "raytrace:depth=1"]


def open_page(path, width=1400, dark=False, script=True, comparer=True):
    """Returns a browser that shows the page once its comparer is drawn, if it has one. `script`: whether scripts run."""
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    # Windows of a headless browser are at least 500 pixels wide, so the width of the page is set by emulation.
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                            {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
    if dark:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": not script})
    browser.get(path.resolve().as_uri())
    if script and comparer:
        wait(browser, "return document.querySelector('.comparer')?.dataset.ready")
    return browser


def wait(browser, script, wanted=None):
    """Waits until a script returns a true value, or the wanted value."""
    found = None
    for _ in range(100):
        found = browser.execute_script(script)
        if found == wanted or (wanted is None and found):
            return found
        time.sleep(0.1)
    raise AssertionError(f"{script}: wanted {wanted or 'a value'}, found {found!r}")


def expect(holds, what):
    if not holds:
        raise AssertionError(what)


def read_pixel(folder, name, x, y):
    """Returns the linear values of a pixel of images/NAME.js."""
    text = (folder / "images" / f"{name}.js").read_text()
    data = base64.b64decode(re.search(r', "(.*)"\);', text).group(1))
    return struct.unpack_from("<3e", data, 6 * (y * SIZE[0] + x))


def told_values(browser):
    """Returns the pixel and the values of each picture that the comparer's line tells."""
    text = browser.execute_script("return document.querySelector('.values').textContent")
    x, y = map(int, re.match(r"Pixel (\d+), (\d+)", text).groups())
    values = {}
    for part in text.split("Linear values, as half floats: ")[1].rstrip(".").split("; "):
        label, numbers = part.rsplit(": ", 1)
        values[label] = [float(number) for number in numbers.split()]
    return x, y, values


def choose(browser, name, text):
    """Chooses an option of one of the comparer's controls."""
    browser.execute_script(
        """const label = [...document.querySelectorAll('.comparer label')].find(x => x.textContent.startsWith(arguments[0]));
           const select = label.querySelector('select');
           select.value = [...select.options].find(x => x.text === arguments[1]).value;
           select.dispatchEvent(new Event('change'));""", name, text)


def canvas_pixel(browser, x, y):
    """Returns the colour of the comparer's canvas at a share of its width and height."""
    return browser.execute_script(
        """const c = document.querySelector('.comparer canvas');
           const copy = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
           copy.drawImage(c, -(c.width * arguments[0] | 0), -(c.height * arguments[1] | 0));
           return [...copy.getImageData(0, 0, 1, 1).data]""",
        x, y)


def chosen_right(browser):
    return browser.execute_script("return document.querySelectorAll('.comparer select')[1].selectedOptions[0].text")


def test_values(browser, folder):
    """The line of values tells what the files hold, for the pixel that the keys reached."""
    canvas = browser.find_element(By.CSS_SELECTOR, ".comparer canvas")
    choose(browser, "Right", "reuse")
    for keys in ("", Keys.ARROW_LEFT * 9 + Keys.ARROW_UP * 4, Keys.ARROW_RIGHT * 3 + Keys.ARROW_DOWN * 11):
        if keys:
            canvas.send_keys(keys)
        time.sleep(0.5)
        x, y, values = told_values(browser)
        for label, name in (("reference raytrace:depth=16", "reference"), ("reuse", "reuse")):
            wanted = [float(f"{value:.4g}") for value in read_pixel(folder, name, x, y)]
            expect(values[label] == wanted, f"pixel {x}, {y} of {label}: wanted {wanted}, told {values[label]}")
    expect((x, y) == (SIZE[0] // 2 - 9 + 3, SIZE[1] // 2 - 4 + 11), f"the keys led to pixel {x}, {y}")


def test_pictures(browser):
    """The split, the differences, the masks and the exposure change what is drawn, each as its name says."""
    canvas = browser.find_element(By.CSS_SELECTOR, ".comparer canvas")
    canvas.send_keys("0")
    choose(browser, "Right", "naive:bounces=1")
    canvas.send_keys("d")
    time.sleep(1)
    left = [canvas_pixel(browser, x / 40, y / 40)[:3] for x in range(8, 18) for y in range(8, 32)]
    right = [canvas_pixel(browser, x / 40, y / 40)[:3] for x in range(22, 32) for y in range(8, 32)]
    expect(all(pixel == [0, 0, 0] for pixel in left), "the reference differs from itself")
    expect(any(pixel != [0, 0, 0] for pixel in right), "a naive row shows no difference from the reference")
    canvas.send_keys("p")
    time.sleep(1)
    before = canvas_pixel(browser, 0.3, 0.2)
    canvas.send_keys("]]")
    time.sleep(1)
    expect(sum(canvas_pixel(browser, 0.3, 0.2)) > sum(before), "a stop more of exposure brightens nothing")
    canvas.send_keys("[[")
    choose(browser, "Pixels", "mirrors")
    time.sleep(1)
    dim = canvas_pixel(browser, 0.3, 0.2)
    expect(sum(dim[:3]) < 0.5 * sum(before[:3]), f"a wall stays as bright as before under the mask: {before}, {dim}")
    choose(browser, "Pixels", "all")
    shown = browser.execute_script("return document.querySelector('.comparer canvas').toDataURL()")
    canvas.send_keys("++++")
    time.sleep(0.5)
    expect(shown != browser.execute_script("return document.querySelector('.comparer canvas').toDataURL()"),
           "zoom changes nothing")
    canvas.send_keys("0f")
    time.sleep(0.5)
    expect(browser.execute_script("return document.querySelectorAll('.comparer select')[2].value") == "flip",
           "the key F does not choose the layout")


def read_chart(browser, script):
    """Returns what a script computes of the shown chart of rows, `chart`, and of its plot by uPlot, `plot`."""
    return browser.execute_script(
        """const chart = [...document.querySelectorAll('.plot .chart')].find(x => x.checkVisibility()).chart, plot = chart.plot;
           return (() => { """ + script + " })()")


def point_at_row(browser, label):
    """Moves the pointer to the mark of a row."""
    box = browser.find_element(By.CSS_SELECTOR, ".plot .u-over")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", box)
    x, y = read_chart(browser, f"""const row = chart.data.rows.findIndex(x => x.label === {json.dumps(label)});
        return chart.find_place({{series: 1, index: chart.order.indexOf(row)}})""")
    size = box.size
    actions = ActionChains(browser)
    actions.move_to_element_with_offset(box, round(x - size["width"] / 2), round(y - size["height"] / 2)).perform()
    return actions


def read_tip(browser):
    """Returns the lines of the chart's values beside the pointer, or nothing if it shows none."""
    return read_chart(browser, "return [...chart.tip.children].map(x => x.textContent)")


def round_number(value):
    return f"{float(f'{value:.4g}'):.10g}"


def test_chart(browser, report):
    """The chart tells the values of report.json, and its marks choose rows, by pointer and by keys."""
    wait(browser, "return document.querySelector('.plot .chart').chart.plot?.status", 1)
    for row in report["rows"]:
        actions = point_at_row(browser, row["label"])
        tip = read_tip(browser)
        times, flip = row["gpu_ms"], row["error"]["flip"]
        interval = f" ({' to '.join(round_number(x) for x in times['ci95'])})" if times["ci95"] else ""
        wanted = [row["label"], f"GPU time of a frame, median, ms: {round_number(times['median'])}{interval}",
                  f"FLIP over the mirrors: {round_number(flip)}"]
        expect(tip[:3] == wanted, f"the pointer on a mark: wanted {wanted}, told {tip}")
        actions.click().perform()
        wait(browser, "return document.querySelectorAll('.comparer select')[1].selectedOptions[0].text", row["label"])
    box = browser.find_element(By.CSS_SELECTOR, ".plot .chart-box")
    by_time = [row["label"] for row in sorted(report["rows"], key=lambda row: row["gpu_ms"]["median"])]
    by_flip = [row["label"] for row in sorted(report["rows"], key=lambda row: row["error"]["flip"])]
    browser.execute_script("arguments[0].blur()", box)
    for key, labels in ((Keys.ARROW_RIGHT, by_time), (Keys.ARROW_UP, by_flip)):
        box.send_keys(Keys.HOME)
        expect(read_tip(browser)[0] == by_time[0], f"the key Home leads to {read_tip(browser)}")
        for label in labels[labels.index(by_time[0]) + 1:]:
            box.send_keys(key)
            expect(read_tip(browser)[0] == label, f"the key {key!r}: wanted {label}, told {read_tip(browser)}")
    for key in (Keys.END, Keys.HOME):
        box.send_keys(key, Keys.ENTER)
        wait(browser, "return document.querySelectorAll('.comparer select')[1].selectedOptions[0].text",
             by_time[0 if key == Keys.HOME else -1])
    box.send_keys(Keys.ESCAPE)
    expect(read_tip(browser) == [], "the key Escape leaves the values")


def choose_axes(browser, metric, logarithmic):
    """Chooses the metric of the chart and the kind of both axes."""
    browser.execute_script(
        """const chart = document.querySelector('.plot .chart'), select = chart.querySelector('select');
           select.value = [...select.options].find(x => x.text === arguments[0]).value;
           select.dispatchEvent(new Event('change'));
           for (const box of chart.querySelectorAll('input')) if (box.checked !== arguments[1]) box.click();""",
        metric, logarithmic)
    time.sleep(0.3)


def test_axes(browser, report):
    """Marks stand where a logarithmic or linear axis between its ends has their values; 0 has a lane."""
    for metric, read in (("rmse over the mirrors", lambda row: row["error"]["rmse"]),
                         ("MiB", lambda row: row["memory_bytes"] / 2 ** 20),
                         ("FLIP over the mirrors", lambda row: row["error"]["flip"])):
        for logarithmic in (True, False):
            choose_axes(browser, metric, logarithmic)
            ranges, width, height, places = read_chart(browser, """return [chart.ranges, plot.over.clientWidth,
                plot.over.clientHeight, chart.order.map((row, index) => [chart.data.rows[row].label,
                ...chart.find_place({series: 1, index})])]""")
            expect(len(places) == len(ROWS), f"{metric}: the chart has {len(places)} marks")
            along = math.log10 if logarithmic else float
            for label, x, y in places:
                row = next(row for row in report["rows"] if row["label"] == label)
                for value, found, size, ends in ((row["gpu_ms"]["median"], x, width, ranges["x"]),
                                                 (read(row), height - y, height, ranges["y"])):
                    if logarithmic and value <= 0:
                        expect(0 < found < size * 0.2, f"{metric} of {label}: 0 stands at {found} of {size}")
                        continue
                    low, high = along(ends["low"]), along(ends["high"])
                    wanted = (along(value) - low) / (high - low) * size
                    expect(abs(found - wanted) <= 1, f"{metric} of {label}: wanted {wanted}, found {found}")
    choose_axes(browser, "FLIP over the mirrors", True)


def read_mark_colour(browser):
    """Returns the colour of the chart in the middle of a filled mark, and the page's accent, which it should be."""
    return read_chart(browser, """const row = chart.order.find(i => chart.data.rows[i].front && !chart.data.rows[i].hidden);
        const [x, y] = chart.find_place({series: 1, index: chart.order.indexOf(row)}, true);
        const probe = document.createElement('i');
        probe.style.color = 'var(--accent)', document.body.append(probe);
        const accent = getComputedStyle(probe).color.match(/\\d+/g).map(Number);
        probe.remove();
        const copy = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
        copy.drawImage(plot.ctx.canvas, -Math.round(x), -Math.round(y));
        return [[...copy.getImageData(0, 0, 1, 1).data.slice(0, 3)], accent]""")


def test_themes(browser):
    """Charts follow a change of the theme, and paper has the light theme whatever the screen has."""
    accents = set()
    for theme in ("dark", "light", "dark"):
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": theme}]})
        time.sleep(0.5)
        found, accent = read_mark_colour(browser)
        expect(found == accent, f"{theme}: a mark has the colour {found}, wanted {accent}")
        accents.add(tuple(accent))
    expect(len(accents) == 2, f"the themes have the accents {accents}")
    browser.execute_script("dispatchEvent(new Event('beforeprint'))")
    time.sleep(0.3)
    found, accent = read_mark_colour(browser)
    expect(found == accent and sum(accent) < 400, f"on paper a mark has the colour {found}, wanted {accent}")
    expect(read_chart(browser, "return plot.ctx.canvas.width") >= 1500, "the chart on paper has few pixels")
    browser.execute_script("dispatchEvent(new Event('afterprint'))")
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    time.sleep(0.3)


def test_library(page):
    """The page has the library of charts as it is in the repository, with its licence, and is small without it and data."""
    text = page.read_text()
    folder = pathlib.Path(__file__).parents[2] / "engine/report/page/third_party/uplot"
    for name in ("uPlot.iife.min.js", "uPlot.min.css", "LICENSE"):
        expect((folder / name).read_text() in text, f"the page lacks {name} as it is in the repository")
    bare = re.sub(r'(?s)data:image/png;base64,[A-Za-z0-9+/=]*|(?<=<script type="application/json">).*?(?=</script>)', "", text)
    expect(len(bare.encode()) <= 250_000, f"without pictures and data the page has {len(bare.encode())} bytes")


def test_without_script(page):
    """Without script, the page shows the rows' plot as an SVG, and their table."""
    browser = open_page(page, script=False)
    places = [place for place in browser.find_elements(By.CSS_SELECTOR, ".plot svg") if place.is_displayed()]
    expect(places and places[0].size["width"] > 500, "without script the page shows no plot")
    titles = [x.get_attribute("textContent") for x in places[0].find_elements(By.CSS_SELECTOR, ".mark title")]
    expect({title.rsplit(": ", 1)[0] for title in titles} == set(ROWS), f"without script the plot has the rows {titles}")
    browser.quit()


def test_lines(page, folder):
    """A chart of lines tells the value of each point to the keys, joins points with values, and has a lane for 0."""
    data = {"kind": "lines", "says": "two lines", "x_name": "instant, s", "y_name": "FLIP", "x": [1, 2, 4], "x_ticks": [1, 4],
            "lines": [{"name": "slow", "y": [0.25, 0, 0.5]}, {"name": "fast", "y": [0.125, None, 0.75]}],
            "log_x": True, "log_y": True}
    text, count = re.subn(r'(?s)(?<=<div class="chart"><script type="application/json">).*?(?=</script>)',
                          lambda found: json.dumps(data), page.read_text(), count=1)
    expect(count == 1, "the page has no chart")
    folder.mkdir(exist_ok=True)
    (folder / "lines.html").write_text(text)
    browser = open_page(folder / "lines.html")
    wait(browser, "return document.querySelector('.plot .chart').chart.plot?.status", 1)
    box = browser.find_element(By.CSS_SELECTOR, ".plot .chart-box")
    for keys, line, x, y in ((Keys.HOME, "slow", 1, 0.25), (Keys.ARROW_RIGHT, "slow", 2, 0), (Keys.ARROW_RIGHT, "slow", 4, 0.5),
                             (Keys.ARROW_UP, "fast", 4, 0.75), (Keys.ARROW_LEFT, "fast", 1, 0.125),
                             (Keys.ARROW_UP, "slow", 1, 0.25)):
        box.send_keys(keys)
        wanted = [line, f"instant, s: {x}", f"FLIP: {y}"]
        expect(read_tip(browser) == wanted, f"a chart of lines: wanted {wanted}, told {read_tip(browser)}")
    xs, zero, low, height = read_chart(browser, """return [[0, 1, 2].map(index => chart.find_place({series: 1, index})[0]),
        chart.find_place({series: 1, index: 1})[1], chart.find_place({series: 2, index: 0})[1], plot.over.clientHeight]""")
    expect(abs(xs[0]) <= 1 and abs(xs[1] - xs[2] / 2) <= 1, f"1, 2 and 4 on a logarithmic axis stand at {xs}")
    expect(low < zero < height, f"0 stands at {zero}, the least other value at {low} of {height}")
    browser.quit()


def test_results_site(program, folder, report):
    """The page of a scene in a site of results has a chart with the values of its report, without a comparer."""
    site = folder / "site"
    subprocess.run([program, "results", "add", str(folder / "report.json"), str(site)], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([program, "results", "build", str(site)], check=True, stdout=subprocess.DEVNULL)
    browser = open_page(next(site.glob("scene-*.html")), comparer=False)
    wait(browser, "return document.querySelector('.plot .chart').chart.plot?.status", 1)
    places = read_chart(browser, "return chart.order.map((row, i) => [chart.data.rows[row].label, plot.data[0][i], plot.data[1][i]])")
    wanted = sorted(([row["label"], row["gpu_ms"]["median"], row["error"]["flip"]] for row in report["rows"]), key=lambda x: x[1])
    expect(places == wanted, f"the chart of the site: wanted {wanted}, found {places}")
    point_at_row(browser, wanted[0][0]).click().perform()
    expect(read_tip(browser)[0] == wanted[0][0], f"the pointer on a mark of the site tells {read_tip(browser)}")
    problems = [entry["message"] for entry in browser.get_log("browser")]
    expect(not problems, f"the console says {problems}")
    browser.quit()


def test_tables(browser):
    """Headers sort the table of rows."""
    header = "[...document.querySelectorAll('table.all thead th')].findIndex(x => x.textContent.trim() === 'FLIP')"
    column = browser.execute_script("return " + header)
    expect(column > 0, "the table of rows has no column FLIP")
    for wanted_order in (False, True):
        browser.execute_script(f"document.querySelectorAll('table.all thead button')[{column}].click()")
        cells = browser.execute_script(
            f"return [...document.querySelectorAll('table.all tbody tr')].map(r => r.cells[{column}].textContent)")
        numbers = [float(cell) for cell in cells]
        expect(len(numbers) == len(ROWS) and numbers == sorted(numbers, reverse=wanted_order), f"sorted: {numbers}")


def test_first_screen(browser):
    """The answer, the device and the comparer stand on the first screen."""
    places = browser.execute_script(
        """return ['.answer', '.kicker', '.comparer canvas'].map(x => document.querySelector(x).getBoundingClientRect().top)""")
    expect(places[0] < 400 and places[1] < 400, f"the answer and the device stand at {places[:2]}")
    expect(places[2] < 400, f"the pictures stand at {places[2]}")


def test_devices(browser, report):
    """The switch shows the answer and the plot by the times of another device, and back."""
    names = browser.execute_script("return [...document.querySelectorAll('.devices option')].map(x => x.textContent)")
    expect(len(names) == 2 and names[1] == "card (given), predicted from counted work", f"the devices are {names}")
    answers = []
    for device in (1, 0):
        browser.execute_script(
            """const choice = document.querySelector('.devices');
               choice.value = arguments[0];
               choice.dispatchEvent(new Event('change'));""", str(device))
        shown = [x for x in browser.find_elements(By.CSS_SELECTOR, ".answer") if x.is_displayed()]
        expect(len(shown) == 1, f"device {device}: {len(shown)} answers are shown")
        answers.append(shown[0].text)
        plots = [x for x in browser.find_elements(By.CSS_SELECTOR, ".plot .chart") if x.is_displayed()]
        expect(len(plots) == 1, f"device {device}: {len(plots)} plots are shown")
        wait(browser, f"return document.querySelectorAll('.plot .chart')[{device}].chart.plot?.status", 1)
        told = dict(read_chart(browser, "return chart.order.map((row, i) => [chart.data.rows[row].label, plot.data[0][i]])"))
        expect(set(told) == set(ROWS), f"device {device}: the plot has the rows {list(told)}")
        for row in report["rows"]:
            ms = row["costs"][0]["ms"] if device == 1 else row["gpu_ms"]["median"]
            found = told[row["label"]]
            expect(abs(found - ms) <= 1e-6 * ms, f"device {device}, {row['label']}: wanted {ms} ms, found {found}")
    expect("on card (given)" in answers[0] and "card" not in answers[1], f"the answers are {answers}")


def relative_luminance(colour):
    linear = [c / 255 / 12.92 if c / 255 <= 0.03928 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in colour]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_contrast(browser, name):
    """Each text has a contrast of 4.5 with its background (WCAG 2, 1.4.3)."""
    pairs = browser.execute_script(
        """const read = text => text.match(/[\\d.]+/g).map(Number);
           return [...document.querySelectorAll('body *')].filter(x => [...x.childNodes].some(n => n.nodeType === 3 &&
               n.textContent.trim()) && x.checkVisibility() && !x.closest('svg, script, style')).map(x => {
               let at = x, back = [0, 0, 0, 0];
               while (at && (back.length === 4 && back[3] === 0)) back = read(getComputedStyle(at).backgroundColor), at = at.parentElement;
               return [x.tagName + ' ' + x.textContent.trim().slice(0, 30), read(getComputedStyle(x).color), back];
           })""")
    expect(len(pairs) > 50, "the page has hardly any text")
    for what, front, back in pairs:
        light = sorted((relative_luminance(front[:3]), relative_luminance(back[:3])))
        ratio = (light[1] + 0.05) / (light[0] + 0.05)
        expect(ratio >= 4.5, f"{name}: '{what}' has a contrast of {ratio:.2f}")


def test_print(browser):
    data = browser.execute_cdp_cmd("Page.printToPDF", {})["data"]
    pages = len(re.findall(rb"/Type\s*/Page\b", base64.b64decode(data)))
    expect(1 <= pages <= 6, f"the page prints to {pages} pages")


def test_causes(program, folder):
    """The key C paints each pixel by its largest cause, as the file of the report does, and the line names the cause."""
    subprocess.run([program, "compare", "cornell-mirrors", "--size", f"{SIZE[0]}x{SIZE[1]}", "--frames", "1", "--warmup", "1",
                    "-q", "--causes", "-o", str(folder), "--techniques", "reuse:face=32"], check=True, stdout=subprocess.DEVNULL)
    browser = open_page(folder / "report.html")
    canvas = browser.find_element(By.CSS_SELECTOR, ".comparer canvas")
    ready = "return document.querySelector('.comparer').dataset.ready"
    before = browser.execute_script(ready)
    canvas.send_keys("c")
    wait(browser, ready + f" !== '{before}'", True)
    colours = {tuple(cause["colour"]): cause["name"] for cause in browser.execute_script(
        "return JSON.parse(arguments[0])", re.search(r'<script type="application/json">(.*?)</script>',
                                                     (folder / "report.html").read_text()).group(1))["causes"]}
    data = re.search(r', "(.*)"\);', (folder / "images" / "causes-reuse-face32.js").read_text()).group(1)
    expect(base64.b64decode(data) == (folder / "images" / "causes-reuse-face32.png").read_bytes(),
           "the script holds other bytes than the picture of causes")
    pixels = browser.execute_async_script(
        """const done = arguments[1], image = new Image();
           image.onload = () => {
               const pen = new OffscreenCanvas(image.width, image.height).getContext('2d');
               pen.drawImage(image, 0, 0);
               done([...pen.getImageData(0, 0, image.width, image.height).data]);
           };
           image.src = 'data:image/png;base64,' + arguments[0];""", data)
    places = {}  # a pixel of each cause, and one without
    for y in range(SIZE[1]):
        for x in range(SIZE[0]):
            at = 4 * (y * SIZE[0] + x)
            places.setdefault(colours.get(tuple(pixels[at:at + 3]), ""), (x, y))
    expect(len(places) > 2, f"the picture shows the causes {list(places)} alone")
    pixel = (SIZE[0] // 2, SIZE[1] // 2)
    for cause, (x, y) in places.items():
        across, down = x - pixel[0], y - pixel[1]
        canvas.send_keys((Keys.ARROW_RIGHT if across > 0 else Keys.ARROW_LEFT) * abs(across) +
                         (Keys.ARROW_DOWN if down > 0 else Keys.ARROW_UP) * abs(down))
        pixel = (x, y)
        text = wait(browser, "const text = document.querySelector('.values').textContent;"
                             f"return text.startsWith('Pixel {x}, {y}') && text")
        found = re.search(r"reuse:face=32: [^;]*?(?: \(([^)]*)\))?\.$", text)
        expect(found and (found.group(1) or "") == cause, f"pixel {x}, {y}: wanted the cause '{cause}', told '{text}'")
    problems = [entry["message"] for entry in browser.get_log("browser")]
    expect(not problems, f"the console says {problems}")
    browser.quit()


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    costs = folder / "card.json"
    costs.write_text("""{"schema": "catoptric/costs/1", "device": "card", "origin": "given",
        "costs": [{"work": "camera_rays", "ns": 100, "range": [50, 200]}, {"work": "frames", "ns": 1000000}]}""")
    subprocess.run([program, "compare", "cornell-mirrors", "--size", f"{SIZE[0]}x{SIZE[1]}", "--frames", "6", "--warmup", "1",
                    "--max-ms", "1000", "--costs", costs, "-q", "-o", str(folder), "--techniques", *ROWS], check=True,
                   stdout=subprocess.DEVNULL)
    page = folder / "report.html"
    browser = open_page(page)
    test_first_screen(browser)
    test_values(browser, folder)
    test_pictures(browser)
    report = json.loads((folder / "report.json").read_text())
    test_chart(browser, report)
    test_axes(browser, report)
    test_tables(browser)
    test_devices(browser, report)
    test_themes(browser)
    test_contrast(browser, "light")
    test_print(browser)
    test_library(page)
    problems = [entry["message"] for entry in browser.get_log("browser")]
    expect(not problems, f"the console says {problems}")
    browser.quit()
    for width in (360, 600, 1400, 2560):
        browser = open_page(page, width, dark=width == 600)
        if width == 600:
            test_contrast(browser, "dark")
        wide = browser.execute_script("return document.documentElement.scrollWidth")
        expect(wide <= width, f"at {width} pixels the page is {wide} wide")
        browser.quit()
    test_without_script(page)
    test_lines(page, folder)
    test_results_site(program, folder, report)
    # Without the values beside it, the page shows those of its 8-bit pictures and says so.
    alone = folder / "alone"
    alone.mkdir(exist_ok=True)
    (alone / "report.html").write_bytes(page.read_bytes())
    browser = open_page(alone / "report.html")
    note = wait(browser, "return document.querySelector('.comparer .note').textContent")
    expect("8-bit pictures" in note and "is not beside this page" in note, f"the page alone says '{note}'")
    x, y, values = told_values(browser)
    for told, real in zip(values["reference raytrace:depth=16"], read_pixel(folder, "reference", x, y)):
        expect(abs(told - min(real, 1)) <= 0.005 + 0.01 * real, f"pixel {x}, {y} of the 8-bit picture: {told}, {real}")
    browser.quit()
    test_causes(program, folder / "causes")
    print("page: passed")


if __name__ == "__main__":
    main()
