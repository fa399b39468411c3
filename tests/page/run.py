#!/usr/bin/python3
"""Opens a report in Chromium and uses its page as a reader would. run.py CATOPTRIC FOLDER, by ./dev test --label page."""

import base64
import json
import pathlib
import re
import struct
import subprocess
import sys
import time

import charts
import lag
import trade_map
from browser import expect, open_page, told_values, wait
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

SIZE = (96, 64)
ROWS = ["naive:bounces=1", "reuse", "secant", "raytrace:depth=1"]


def read_pixel(folder, name, x, y):
    """Returns the linear values of a pixel of images/NAME.js."""
    text = (folder / "images" / f"{name}.js").read_text()
    data = base64.b64decode(re.search(r', "(.*)"\);', text).group(1))
    return struct.unpack_from("<3e", data, 6 * (y * SIZE[0] + x))


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
        told = dict(charts.read_chart(browser, "return chart.order.map((row, i) => [chart.data.rows[row].label, plot.data[0][i]])"))
        expect(set(told) == set(ROWS), f"device {device}: the plot has the rows {list(told)}")
        for row in report["rows"]:
            ms = row["costs"][0]["ms"] if device == 1 else charts.judged_time(report, row)["median"]
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
    charts.test_chart(browser, report)
    charts.test_axes(browser, report)
    test_tables(browser)
    test_devices(browser, report)
    charts.test_themes(browser)
    test_contrast(browser, "light")
    test_print(browser)
    charts.test_library(page)
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
    charts.test_without_script(page, report)
    charts.test_lines(page, folder)
    charts.test_results_site(program, folder, report)
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
    lag.test_lag(program, folder / "lag")
    trade_map.test_map(program, folder / "map")
    print("page: passed")


if __name__ == "__main__":
    main()
