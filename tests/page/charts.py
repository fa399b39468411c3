"""Tests of the charts of pages, which run.py calls."""

import json
import math
import pathlib
import re
import subprocess
import time

from browser import expect, open_page, wait
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys


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


TIME_NAMES = {"cpu_ms": "Processor time", "gpu_ms": "GPU time"}


def judged_time(report, row):
    """Returns the times by which the report orders rows: those of the processor where it draws the pictures."""
    return row[report["judged_time"]]


def round_number(value):
    return f"{float(f'{value:.4g}'):.10g}"


def test_chart(browser, report):
    """The chart tells the values of report.json, and its marks choose rows, by pointer and by keys."""
    wait(browser, "return document.querySelector('.plot .chart').chart.plot?.status", 1)
    for row in report["rows"]:
        actions = point_at_row(browser, row["label"])
        tip = read_tip(browser)
        times, flip = judged_time(report, row), row["error"]["flip"]
        interval = f" ({' to '.join(round_number(x) for x in times['ci95'])})" if times["ci95"] else ""
        wanted = [row["label"],
                  f"{TIME_NAMES[report['judged_time']]} of a frame, median, ms: {round_number(times['median'])}{interval}",
                  f"FLIP over the mirrors: {round_number(flip)}"]
        expect(tip[:3] == wanted, f"the pointer on a mark: wanted {wanted}, told {tip}")
        actions.click().perform()
        wait(browser, "return document.querySelectorAll('.comparer select')[1].selectedOptions[0].text", row["label"])
    box = browser.find_element(By.CSS_SELECTOR, ".plot .chart-box")
    by_time = [row["label"] for row in sorted(report["rows"], key=lambda row: judged_time(report, row)["median"])]
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
            expect(len(places) == len(report["rows"]), f"{metric}: the chart has {len(places)} marks")
            along = math.log10 if logarithmic else float
            for label, x, y in places:
                row = next(row for row in report["rows"] if row["label"] == label)
                for value, found, size, ends in ((judged_time(report, row)["median"], x, width, ranges["x"]),
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


def test_without_script(page, report):
    """Without script, the page shows the rows' plot as an SVG, and their table."""
    browser = open_page(page, script=False)
    places = [place for place in browser.find_elements(By.CSS_SELECTOR, ".plot svg") if place.is_displayed()]
    expect(places and places[0].size["width"] > 500, "without script the page shows no plot")
    titles = [x.get_attribute("textContent") for x in places[0].find_elements(By.CSS_SELECTOR, ".mark title")]
    expect({title.rsplit(": ", 1)[0] for title in titles} == {row["label"] for row in report["rows"]}, f"without script the plot has the rows {titles}")
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
    wanted = sorted(([row["label"], judged_time(report, row)["median"], row["error"]["flip"]] for row in report["rows"]),
                    key=lambda x: x[1])
    expect(places == wanted, f"the chart of the site: wanted {wanted}, found {places}")
    point_at_row(browser, wanted[0][0]).click().perform()
    expect(read_tip(browser)[0] == wanted[0][0], f"the pointer on a mark of the site tells {read_tip(browser)}")
    problems = [entry["message"] for entry in browser.get_log("browser")]
    expect(not problems, f"the console says {problems}")
    browser.quit()
