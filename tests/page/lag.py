"""Tests the pictures of the largest lag in the comparer of a report."""

import base64
import json
import re
import struct
import subprocess
import time

from browser import expect, open_page, told_values, wait
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

SIZE = (48, 32)
ROWS = ["reuse:face=16", "reuse:face=32"]
OTHERS = ["parallax:face=16", "raytrace:depth=4"]  # a row whose lag is 0 in this scene, and one that has none
PERIOD = 0.4  # seconds, short so that the lag takes few frames


def write_scene(path):
    """Writes two mirrors that face each other, and an emissive square that moves between them."""
    square = struct.pack("<12f", -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    times = struct.pack("<3f", 0, PERIOD / 2, PERIOD)
    places = struct.pack("<9f", -0.8, 0, 0, 0.8, 0.4, 0, -0.8, 0, 0)
    data = square + times + places
    views = [(0, 48), (48, 12), (60, 12), (72, 36)]
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0, "name": "near", "translation": [0, 0, -2], "scale": [2, 2, 1]},
                  {"mesh": 0, "name": "far", "translation": [0, 0, 3], "rotation": [0, 1, 0, 0], "scale": [2, 2, 1]},
                  {"mesh": 1, "name": "mover", "scale": [0.4, 0.4, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]},
                   {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 1}]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0, "baseColorFactor": [0.9, 0.9, 0.9, 1]}},
                      {"emissiveFactor": [1, 0.8, 0.5], "doubleSided": True}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 2, "path": "translation"}}],
                        "samplers": [{"input": 2, "output": 3}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
                      {"bufferView": 2, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [PERIOD]},
                      {"bufferView": 3, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in views],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
    path.write_text(json.dumps(scene))


def read_exr(path):
    """Returns the pixels of an EXR file, each with R, G and B, rounded to half floats."""
    text = subprocess.run(["oiiotool", str(path), "--ch", "R,G,B", "--dumpdata", str(path)], check=True, capture_output=True,
                          text=True).stdout
    pixels = {}
    for x, y, values in re.findall(r"Pixel \((\d+), (\d+)\): ([^\n]*)", text):
        rounded = struct.unpack("<3e", struct.pack("<3e", *map(float, values.split()[:3])))
        pixels[int(x), int(y)] = [float(f"{value:.4g}") for value in rounded]
    return pixels


def find_most_different_pixel(a, b):
    return max(a, key=lambda pixel: max(abs(x - y) for x, y in zip(a[pixel], b[pixel])))


def press(browser, keys):
    """Presses keys on the comparer, one after the other, and waits until it has drawn again after the last."""
    ready = "return document.querySelector('.comparer').dataset.ready"
    before = browser.execute_script(ready)
    browser.find_element(By.CSS_SELECTOR, ".comparer canvas").send_keys(keys)
    wait(browser, ready + f" !== '{before}'", True)


def read_left_of_canvas(browser, pixel):
    """Returns the colour of the canvas in the middle of a pixel of the left picture, side by side."""
    return browser.execute_script(
        """const c = document.querySelector('.comparer canvas');
           const [x, y, width, height] = arguments, scale = Math.min(c.width / 2 / width, c.height / height);
           const at = [c.width / 4 + (x + 0.5 - width / 2) * scale, c.height / 2 + (y + 0.5 - height / 2) * scale];
           const copy = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
           copy.drawImage(c, -Math.floor(at[0]), -Math.floor(at[1]));
           return [...copy.getImageData(0, 0, 1, 1).data].slice(0, 3)""", *pixel, *SIZE)


def srgb_code(x):
    x = min(max(x, 0), 1)
    return 255 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055)


def move_to(browser, start, end):
    across, down = end[0] - start[0], end[1] - start[1]
    browser.find_element(By.CSS_SELECTOR, ".comparer canvas").send_keys(
        (Keys.ARROW_RIGHT if across > 0 else Keys.ARROW_LEFT) * abs(across) + (Keys.ARROW_DOWN if down > 0 else Keys.ARROW_UP) * abs(down))
    wait(browser, f"return document.querySelector('.values').textContent.startsWith('Pixel {end[0]}, {end[1]}')", True)


def test_lag(program, folder):
    """The comparer shows each row's picture with the largest lag beside its reference and its picture at rest."""
    folder.mkdir(parents=True, exist_ok=True)
    write_scene(folder / "mirrors.gltf")
    subprocess.run([program, "compare", str(folder / "mirrors.gltf"), "--size", f"{SIZE[0]}x{SIZE[1]}", "--camera", "1,0.5,1:0,0,-2:60",
                    "--exposure", "0", "--frames", "1", "--warmup", "1", "-q", "--lag", "-o", str(folder), "--techniques", *ROWS,
                    *OTHERS], check=True, stdout=subprocess.DEVNULL)
    rows = json.loads((folder / "report.json").read_text())["lag"]["rows"]
    expect(rows.pop()["worst"] is None, f"{OTHERS[0]} has an instant of the worst lag, and no lag")
    expect([row["label"] for row in rows] == ROWS, f"lag was measured of {[row['label'] for row in rows]}")
    browser = open_page(folder / "report.html")
    picker = "[...document.querySelectorAll('.comparer label')].find(x => x.textContent.startsWith('Instant')).querySelector('select')"
    names = browser.execute_script(f"return [...{picker}.options].map(x => x.text)")
    wanted = [f"worst lag of {row['label']}: {row['worst']['speed']:g}x, {row['worst']['seconds']:.2f} s" for row in rows]
    expect(names == ["at rest"] + wanted, f"the instants are {names}, wanted {wanted}")
    press(browser, "e")
    pixel = (SIZE[0] // 2, SIZE[1] // 2)
    for number, row in enumerate(rows):
        worst = row["worst"]
        pictures = {"reference at {:.2f} s".format(worst["seconds"]): read_exr(folder / worst["reference"]),
                    "{}, moving at {:g}x".format(row["label"], worst["speed"]): read_exr(folder / worst["moving"]),
                    "{}, at rest".format(row["label"]): read_exr(folder / worst["still"])}
        labels = list(pictures)
        press(browser, "i")
        expect(browser.execute_script(f"return {picker}.selectedIndex") == number + 1, "the key I does not choose the next instant")
        shown = browser.execute_script("return document.querySelectorAll('.comparer select')[4].value")
        expect(shown == "picture", f"pictures of a lag have no maps, and the comparer shows '{shown}'")
        for left, right in ((0, 1), (1, 2), (2, 0)):
            for place, index in ((1, left), (2, right)):
                browser.execute_script(
                    """const select = document.querySelectorAll('.comparer select')[arguments[0]];
                       select.value = [...select.options].find(x => x.text === arguments[1]).value;
                       select.dispatchEvent(new Event('change'));""", place, labels[index])
            press(browser, "p")
            # At this pixel the two pictures differ most, so that one in place of the other is noticed.
            target = find_most_different_pixel(pictures[labels[left]], pictures[labels[right]])
            move_to(browser, pixel, target)
            pixel = target
            time.sleep(0.3)
            x, y, told = told_values(browser)
            place = (x, y)
            expect(set(told) == {labels[0], labels[left], labels[right]}, f"told are the pictures {list(told)}")
            for label, values in told.items():
                found = pictures[label][place]
                expect(values == found, f"pixel {place} of '{label}': the EXR has {found}, told {values}")
            expect(told[labels[left]] != told[labels[right]], f"'{labels[left]}' and '{labels[right]}' are equal")
            browser.find_element(By.CSS_SELECTOR, ".comparer canvas").send_keys("b")
            time.sleep(0.3)
            colour = read_left_of_canvas(browser, (pixel[0] - 1 if pixel[0] else 1, pixel[1]))
            there = pictures[labels[left]][pixel[0] - 1 if pixel[0] else 1, pixel[1]]
            for byte, value in zip(colour, there):
                expect(abs(byte - srgb_code(value)) <= 2, f"beside pixel {pixel} of '{labels[left]}' the canvas has {colour}, "
                                                          f"the EXR {there}")
    press(browser, "i")
    expect(browser.execute_script(f"return {picker}.selectedIndex") == 0, "the key I does not return to the rows")
    _, _, told = told_values(browser)
    expect(all(label in ROWS + OTHERS or label.startswith("reference raytrace") for label in told), f"at rest, told are the pictures {list(told)}")
    problems = [entry["message"] for entry in browser.get_log("browser")]
    expect(not problems, f"the console says {problems}")
    browser.quit()
