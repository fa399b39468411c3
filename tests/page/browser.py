"""Opens pages in Chromium, for the tests of pages."""

import re
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service


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
        if found if wanted is None else found == wanted:
            return found
        time.sleep(0.1)
    raise AssertionError(f"{script}: wanted {wanted or 'a value'}, found {found!r}")


def expect(holds, what):
    if not holds:
        raise AssertionError(what)


def told_values(browser):
    """Returns the pixel and the values of each picture that the comparer's line tells."""
    text = browser.execute_script("return document.querySelector('.values').textContent")
    x, y = map(int, re.match(r"Pixel (\d+), (\d+)", text).groups())
    values = {}
    for part in text.split("Linear values, as half floats: ")[1].rstrip(".").split("; "):
        label, numbers = part.rsplit(": ", 1)
        values[label] = [float(number) for number in numbers.split()]
    return x, y, values
