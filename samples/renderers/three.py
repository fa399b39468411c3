#!/usr/bin/python3
"""three.py FOLDER OUT [OPTION...]: draws the views of a folder of pose.py by three.js, in Chromium without a window.

Writes OUT/view-000.exr, OUT/view-001.exr and so on, with linear light in 32-bit floats. Each smooth metal object shows
the picture of a cube camera in its middle. --modules names the folder with three.js, as 'npm ci' makes it.
"""

import argparse
import base64
import functools
import http.server
import json
import pathlib
import shutil
import sys
import threading

from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

HERE = pathlib.Path(__file__).resolve().parent
KINDS = {".html": "text/html", ".mjs": "text/javascript", ".js": "text/javascript", ".glb": "model/gltf-binary"}


def read_options():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--modules", type=pathlib.Path, default=HERE / "node_modules", help="folder with three.js")
    parser.add_argument("--face", type=int, default=256, help="edge of the faces of cube cameras")
    parser.add_argument("--rounds", type=int, default=2, help="captures of each mirror: 2 shows mirrors in mirrors")
    parser.add_argument("--timeout", type=int, default=1800, help="most seconds for the views of one scene")
    parser.add_argument("--pixel", choices=("centre", "area"), default="centre",
                        help="what a pixel shows: the point at its centre, or the mean over 16 points of its area")
    return parser.parse_args()


class Handler(http.server.BaseHTTPRequestHandler):
    """Serves the page, three.js and the scenes."""

    def __init__(self, places, *arguments):
        self.places = places
        super().__init__(*arguments)

    def do_GET(self):
        path = self.path.split("?")[0]
        for prefix, folder in self.places:
            file = (folder / path.removeprefix(prefix).lstrip("/")).resolve()
            if path.startswith(prefix) and file.is_relative_to(folder.resolve()) and file.is_file():
                data = file.read_bytes()
                self.send_response(200)
                self.send_header("Content-Type", KINDS.get(file.suffix, "application/octet-stream"))
                self.send_header("Content-Length", str(len(data)))
                self.end_headers()
                self.wfile.write(data)
                return
        self.send_error(404)

    def log_message(self, *arguments):
        pass


def open_browser(address, timeout):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    # SwiftShader draws WebGL on the processor.
    for argument in ("--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    browser.set_script_timeout(timeout)
    browser.get(address)
    return browser


def draw(browser, posed, options):
    """Draws all views, scene by scene."""
    for scene in dict.fromkeys(view["scene"] for view in posed["views"]):
        views = [view for view in posed["views"] if view["scene"] == scene]
        job = {"file": f"/scenes/{scene}", "lamps": views[0]["lamps"], "views": views, "width": posed["width"],
               "height": posed["height"], "face": options.face, "rounds": options.rounds,
               "side": 4 if options.pixel == "area" else 1}
        result = browser.execute_async_script(
            """const [job, done] = arguments;
               const wait = () => window.ready ? window.drawScene(job).then(done, error => done({error: String(error.stack)}))
                                               : setTimeout(wait, 50);
               wait();""", job)
        if "error" in result:
            raise WebDriverException(f"{scene}: {result['error']}")
        for view, data in zip(views, result["files"]):
            (options.out / f"{view['name']}.exr").write_bytes(base64.b64decode(data))
    return result


def main():
    options = read_options()
    modules = options.modules / "three"
    if not modules.is_dir():
        sys.exit(f"three.py: wanted three.js in {modules}, found none; 'npm ci' in {HERE} installs it")
    posed = json.loads((options.folder / "posed.json").read_text())
    options.out.mkdir(parents=True, exist_ok=True)
    shutil.copy(options.folder / "views.json", options.out) # 'compare --row' checks that its views are these
    places = [("/three/", modules), ("/scenes/", options.folder), ("/", HERE)]
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, places))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    browser = open_browser(f"http://127.0.0.1:{server.server_address[1]}/three.html", options.timeout)
    try:
        result = draw(browser, posed, options)
        print(f"three.py: {len(posed['views'])} views by three.js {result['three']}, {result['renderer']}")
    except WebDriverException as error:
        messages = "\n".join(entry["message"] for entry in browser.get_log("browser"))
        sys.exit(f"three.py: {error.msg}\n{messages}")
    finally:
        browser.quit()
        server.shutdown()


if __name__ == "__main__":
    main()
