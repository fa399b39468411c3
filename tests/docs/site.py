#!/usr/bin/env python3
"""Builds the site of the documentation, and checks that it is whole. site.py CATOPTRIC FOLDER, by ./dev test --label docs,
which installs MkDocs and Chromium."""

import pathlib
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What docs/site/build.py reads.
READ = ("docs", "mkdocs.yml", "README.md", "CONTRIBUTING.md", "CHANGELOG.md", "samples", "engine")


def expect(holds, what):
    if not holds:
        sys.exit(f"docs: {what}")


def build(root, program, out):
    return subprocess.run([sys.executable, "-B", root / "docs/site/build.py", program, out], capture_output=True, text=True,
                          check=False)


def list_options(program):
    """Returns the options of each verb by the completion for fish, which follows from the table of options."""
    script = subprocess.run([program, "completion", "fish"], capture_output=True, text=True, check=True).stdout
    options = {}
    for verb, kind, name in re.findall(r"__fish_seen_subcommand_from (\w+)' -(l|s) (\S+)", script):
        options.setdefault(verb, set()).add(("--" if kind == "l" else "-") + name)
    return options


def test_reference(program, out):
    """The page of the command line has a section of each verb, with all options of the verb and no others."""
    page = (out / "command-line.html").read_text()
    sections = {name: text for name, text in re.findall(r'<h2 id="catoptric-(\w+)">(.*?)(?=<h2|</main>)', page, re.S)}
    options = list_options(program)
    expect(len(options) >= 10 and sum(map(len, options.values())) > 100, f"wanted options of all verbs, found {options}")
    for verb, wanted in options.items():
        cells = re.findall(r"<td><code>(-[^<]*)</code></td>", sections.get(verb, ""))
        found = {word.split()[0] for cell in cells for word in cell.split(" ")[0].split(",") if word.startswith("--")}
        found |= {cell.split()[0] for cell in cells if not re.search("--", cell)}
        long_options = {name.partition("[")[0] for name in found}
        expect(wanted <= long_options, f"command-line.html, {verb}: wanted {wanted - long_options}, found them not there")
        expect(long_options - {"--help", "--help-all"} <= wanted, f"command-line.html, {verb}: found {long_options - wanted}, which is no option")
    techniques = (out / "techniques.html").read_text()
    metrics = (out / "metrics.html").read_text()
    for kind, text, mark in (("techniques", techniques, '<h2 id="{}">'), ("metrics", metrics, "<td><code>{}</code></td>")):
        lines = subprocess.run([program, "list", kind], capture_output=True, text=True, check=True).stdout.splitlines()
        for name in (line.split()[0] for line in lines if re.match(r"[a-z]\S*\s{2,}", line)):
            expect(mark.format(name) in text, f"{kind}.html: wanted {name}, found it not there")


def test_texts(out):
    """No page shows marks of Markdown as text, and each has a title of its own."""
    titles = {}
    for path in sorted(out.rglob("*.html")):
        text = re.sub(r"<(pre|code|script)\b.*?</\1>", "", path.read_text(), flags=re.S)
        mark = re.search(r"^(?:- |\d+\. |\||#+ |```).*|\]\([^)\s]+\)", text, re.M)
        expect(not mark, f"{path.relative_to(out)}: wanted no Markdown in the text, found '{mark and mark.group(0)}'")
        title = re.search(r"<title>(.*?)</title>", text).group(1)
        expect(title not in titles, f"{path.relative_to(out)}: has the title '{title}' of {titles.get(title)}")
        titles[title] = path.relative_to(out)
        expect(re.search(r"<h1[ >]", text), f"{path.relative_to(out)}: wanted a heading, found none")


def test_pages(out):
    """Each page of the repository is there, in one of the four kinds."""
    front = (out / "index.html").read_text()
    kinds = re.findall(r"<details open><summary>(.*?)</summary>", front)
    expect(kinds == ["Tutorial", "How-to", "Reference", "Explanation"], f"wanted the four kinds of pages, found {kinds}")
    pages = [str(path.relative_to(ROOT / "docs")) for path in (ROOT / "docs").rglob("*.md")]
    for page in [*pages, "readme.md", "contributing.md", "changelog.md"]:
        link = page.removesuffix(".md") + ".html"
        expect((out / link).is_file(), f"wanted a page of {page}, found none")
        expect(f'href="{link}"' in front.partition("<main")[0], f"wanted {page} in the navigation, found it not there")


def test_refusals(program, folder):
    """A broken link, a link to a missing heading, a page outside the navigation and a file of the network are errors."""
    network = "one of the network"
    for name, page, text, words in (
            ("link", "noise.md", "[x](nowhere.md)", "docs/noise.md: the link 'nowhere.md'"),
            ("heading", "noise.md", "[x](rough.md#nothing)", "noise.html: the link 'rough.html#nothing'"),
            ("own heading", "noise.md", "[x](#nothing)", "noise.html: the link '#nothing'"),
            ("page", "new.md", "# New", "new.html: wanted the page in 'nav'"),
            ("nav", "noise.md", None, "noise.md"),
            ("picture", "noise.md", "![x](https://example.org/x.png)", network),
            ("style", "site/theme/site.css", "@import '//example.org/x.css';", network)):
        copy = folder / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        copy.mkdir(parents=True)
        for source in READ:
            (shutil.copytree if (ROOT / source).is_dir() else shutil.copy)(ROOT / source, copy / source)
        changed = copy / "docs" / page
        if text is None:
            changed.unlink()
        else:
            changed.write_text((changed.read_text() if changed.exists() else "") + f"\n{text}\n")
        done = build(copy, program, copy / "out")
        said = done.stdout + done.stderr
        expect(done.returncode != 0 and words in said, f"a bad {name}: wanted '{words}', found exit code {done.returncode}: {said}")
    shutil.rmtree(copy)
    (copy / "out").mkdir(parents=True)
    (copy / "out/notes.txt").write_text("of the user")
    done = build(ROOT, program, copy / "out")
    expect(done.returncode != 0 and "wanted an empty or no folder" in done.stderr and (copy / "out/notes.txt").exists(),
           f"a folder with other files: wanted a refusal, found exit code {done.returncode}: {done.stderr}")


def open_browser():
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def test_browser(out):
    """Local pages fit a narrow and a wide window, load nothing from elsewhere, and their search finds a section."""
    browser = open_browser()
    for width in (400, 1400):
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        for path in sorted(out.rglob("*.html")):
            browser.get(path.as_uri())
            wide = browser.execute_script("return document.documentElement.scrollWidth")
            expect(wide <= width, f"{path.relative_to(out)}: at {width} pixels the page is {wide} wide")
            far = browser.execute_script("return performance.getEntriesByType('resource').map(x => x.name)"
                                         ".filter(x => !x.startsWith('file:') && !x.startsWith('data:'))")
            expect(not far, f"{path.relative_to(out)}: loads {far}")
        browser.get((out / "notes/mutants.html").as_uri())
        field = browser.find_element("css selector", ".search input")
        field.send_keys("clopper-pearson")
        time.sleep(0.3)
        found = browser.execute_script("return [...document.querySelectorAll('.search ol a')].map(x => x.href)")
        expect(any("/choose.html#" in link for link in found), f"a search for 'clopper-pearson' finds {found}")
        field.clear()
        field.send_keys("no-such-word-anywhere")
        time.sleep(0.3)
        said = browser.execute_script("return document.querySelector('.search ol').textContent")
        expect(said == "No section has all these words.", f"a search for nothing says '{said}'")
        browser.get(found[0])
        expect(browser.execute_script("return document.getElementById(location.hash.slice(1)) !== null"),
               f"the first result {found[0]} leads to no heading")
    problems = [entry["message"] for entry in browser.get_log("browser")]
    expect(not problems, f"the console says {problems}")
    browser.quit()


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    out = folder / "html"
    done = build(ROOT, program, out)
    expect(done.returncode == 0, f"wanted a site, found exit code {done.returncode}: {done.stdout}{done.stderr}")
    test_pages(out)
    test_reference(program, out)
    test_texts(out)
    test_browser(out)
    test_refusals(program, folder)
    print(f"docs: {len(list(out.rglob('*.html')))} pages, {sum(x.stat().st_size for x in out.rglob('*') if x.is_file())} bytes")


if __name__ == "__main__":
    main()
