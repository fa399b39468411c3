#!/usr/bin/env python3
"""Builds the documentation as static pages. build.py CATOPTRIC OUT: CATOPTRIC is the program whose help makes the
reference, OUT is the folder of the pages.

The pages of the repository are written for a viewer of single files. This program copies them, adapts their links and
lists to MkDocs, adds pages that the program prints, and runs `mkdocs build --strict`."""

import html.parser
import json
import os
import pathlib
import posixpath
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
# Pages outside docs/, with their names in the site.
OTHER_PAGES = {"README.md": "readme.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}
# Column at which the help of the program begins its descriptions.
HELP_COLUMN = 28


def fail(*words):
    sys.exit("docs: " + " ".join(str(word) for word in words))


def list_pages():
    """Returns the place in the site of each page, by its path in the repository."""
    pages = {str(path.relative_to(ROOT)): str(path.relative_to(ROOT / "docs"))
             for path in sorted((ROOT / "docs").rglob("*.md"))}
    return pages | OTHER_PAGES


class Links:
    """Rewrites the links of pages, and notes which other files they need."""

    def __init__(self, pages):
        self.pages = pages
        self.files = {}

    def find_place(self, source, target):
        """Returns the place in the site of a file that a page links to, or None if a link to it has no page."""
        path = posixpath.normpath(posixpath.join(posixpath.dirname(source), target))
        if path in self.pages:
            return self.pages[path]
        if not (ROOT / path).exists():
            fail(f"{source}: the link '{target}' wanted a file {path}, found none")
        if (ROOT / path).is_dir():
            return self.pages.get(f"{path}/index.md")
        place = path.removeprefix("docs/") if path.startswith("docs/") else f"files/{path}"
        if not path.startswith("docs/") and posixpath.splitext(path)[1] not in (".png", ".svg"):
            place += ".txt" # a browser shows text, and offers to store other files
        self.files[path] = place
        return place

    def rewrite(self, source, text):
        """Returns a page's text with links that fit its place in the site. A link to a folder becomes its words."""
        here = posixpath.dirname(self.pages[source])

        def replace(match):
            words, target, anchor = match.group(1), match.group(2), match.group(3) or ""
            if not target or re.match(r"[a-z]+:", target):
                return match.group(0)
            place = self.find_place(source, target)
            if place is None:
                return words[1:-1]
            return f"{words}({posixpath.relpath(place, here or '.')}{anchor})"

        link = r"(\[(?:[^\[\]]|\[[^\]]*\])*\])\(([^)\s#]*)(#[^)\s]*)?\)"
        parts = re.split(r"^(```.*?^```)$", text, flags=re.M | re.S)
        return "".join(part if part.startswith("```") else re.sub(link, replace, part) for part in parts)


def is_list_item(line):
    return re.match(r"\s*([-*]|\d+\.) ", line) is not None


def adapt(text):
    """Returns the text with the empty lines and the indents that Python-Markdown wants around lists and tables."""
    lines, fenced, in_list = [], False, False
    for line in text.split("\n"):
        before = lines[-1] if lines else ""
        if line.startswith("```"):
            fenced = not fenced
            in_list = False
        elif not fenced:
            starts_list = is_list_item(line) and not line.startswith("    ")
            if starts_list and not in_list and before.strip():
                lines.append("")
            if line.startswith("|") and before.strip() and not before.startswith("|"):
                lines.append("")
            if before.startswith("<!--") and line.strip():
                lines.append("")
            if in_list and not line.strip():
                in_list = False
            if starts_list:
                in_list = True
                if line.startswith(" "):
                    line = "    " + line.lstrip()
        lines.append(line)
    return "\n".join(lines)


def run_help(program, *words):
    """Returns what the program prints. No file of the user changes it."""
    done = subprocess.run([program, *words], capture_output=True, text=True, check=False,
                          env=os.environ | {"XDG_CONFIG_HOME": "/nonexistent"})
    if done.returncode:
        fail(f"'{program} {' '.join(words)}' wanted exit code 0, found {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def read_help(text):
    """Returns the sections of a help text: (title, entries), (title, lines of examples) or (None, prose)."""
    sections = []
    for block in re.split(r"\n\n+", text.strip()):
        lines = block.split("\n")
        if not lines[0].endswith(":") or len(lines) < 2 or not lines[1].startswith("  "):
            sections.append((None, block))
        elif lines[0] == "Examples:":
            sections.append(("Examples", [line[2:] for line in lines[1:]]))
        else:
            entries = []
            for line in lines[1:]:
                if line.startswith(" " * HELP_COLUMN):
                    entries[-1][1] += (" " if entries[-1][1] else "") + line.strip()
                elif len(line) > HELP_COLUMN and line[HELP_COLUMN - 2:HELP_COLUMN] == "  ":
                    entries.append([line[:HELP_COLUMN].strip(), line[HELP_COLUMN:].strip()])
                else:
                    entries.append([line.strip(), ""])
            sections.append((lines[0][:-1], entries))
    return sections


def as_code(text):
    """Returns the text as code in a cell of a table. `\\|` is a bar in code of a cell."""
    return "`" + text.replace("|", "\\|") + "`"


def as_text(text):
    """Returns the text of a cell of a table, without special characters of Markdown or HTML."""
    return re.sub(r"([\\`*_{}\[\]|])", r"\\\1", text.replace("&", "&amp;").replace("<", "&lt;"))


def write_table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def write_help(title, text, level):
    """Returns a help text as a section in Markdown."""
    parts = [f"{'#' * level} {title}\n"]
    for name, content in read_help(text):
        if name is None and "Usage:" in content:
            summary, _, usage = content.partition("Usage:")
            usage, _, rest = usage.strip().partition("\n")
            parts.append(as_text(" ".join(summary.split())) + f"\n\n```\n{usage}\n```\n" +
                         (as_text(" ".join(rest.split())) + "\n" if rest else ""))
        elif name is None:
            parts.append(as_text(" ".join(content.split())) + "\n")
        elif name == "Examples":
            parts.append("Examples:\n\n```\n" + "\n".join(content) + "\n```\n")
        else:
            first = {"Positionals": "argument", "Verbs": "verb"}.get(name, "option")
            rows = [[f"[`{entry}`](#catoptric-{entry})" if name == "Verbs" else as_code(entry), as_text(words)]
                    for entry, words in content]
            parts.append(f"**{name}**\n\n" + write_table([first, "meaning"], rows))
    return "\n".join(parts)


def write_command_line(program):
    text = run_help(program, "help")
    verbs = [entry for title, content in read_help(text) if title == "Verbs" for entry, _ in content]
    if len(verbs) < 5:
        fail(f"'{program} help' wanted a list of verbs, found {verbs}")
    parts = ["# Command line (reference)\n\nThis page lists the verbs and options of the programs. The programs' help "
             "makes this page.\n", write_help("catoptric", text, 2)]
    parts += [write_help(f"catoptric {verb}", run_help(program, verb, "--help-all"), 2) for verb in verbs]
    window = pathlib.Path(program).with_name("catoptric-view")
    if window.exists():
        parts.append(write_help("catoptric-view", run_help(window, "--help-all"), 2))
    return "\n".join(parts)


def describe_range(knob):
    if "choices" in knob:
        return ", ".join(as_code(choice) for choice in knob["choices"])
    special = f" or {as_code(knob['special'])}" if "special" in knob else ""
    return f"{knob['low']:g} to {knob['high']:g}{special}" if "low" in knob else ""


def write_techniques(program):
    parts = ["# Techniques and knobs (reference)\n\nThis page lists the knobs of each technique, as `catoptric list "
             "techniques` prints them. A technique is written `name[:knob=value,...]`, such as "
             "`secant:steps=4,face=auto`.\n"]
    techniques = [technique for name in ([], ["auto"]) # `auto` chooses a technique, and is in no list of them
                  for technique in json.loads(run_help(program, "list", "techniques", *name, "--json"))["techniques"]]
    for technique in techniques:
        rows = [[as_code(knob["name"]), as_text(knob["help"]), describe_range(knob), as_code(str(knob["default"]))]
                for knob in technique["knobs"]]
        parts.append(f"## {technique['name']}\n\n{as_text(technique['summary'])}\n\n" +
                     (write_table(["knob", "meaning", "values", "default"], rows) if rows else ""))
    return "\n".join(parts)


def write_metrics(program):
    rows = [[as_code(metric["name"]), as_text(metric["summary"]), as_text(metric["unit"]), as_text(metric["mask"]),
             metric["better"] or ""]
            for metric in json.loads(run_help(program, "list", "metrics", "--json"))["metrics"]]
    return ("# Fields of report.json (reference)\n\nThis page lists the metrics of a row, as `catoptric list metrics` "
            "prints them. `compare` writes them to report.json, in the list `rows`. A metric `a/b` is the field `b` of "
            "the object `a`. \"Pixels\" says over which mask of pixels a metric is computed, and \"better\" says "
            "whether less or more is better.\n\n" + write_table(["field", "meaning", "unit", "pixels", "better"], rows))


def write_pages(program, folder):
    """Writes all pages and the files that they link to."""
    pages = list_pages()
    links = Links(pages)
    made = {"command-line.md": write_command_line(program), "techniques.md": write_techniques(program),
            "metrics.md": write_metrics(program)}
    links.pages = pages | {f"docs/{name}": name for name in made}
    for source, place in pages.items():
        path = folder / place
        path.parent.mkdir(parents=True, exist_ok=True)
        # Comments <!-- site: ... --> are for this site only: they link to pages that the repository lacks.
        text = re.sub(r"<!-- site: (.*?) -->", r"\1", (ROOT / source).read_text())
        path.write_text(adapt(links.rewrite(source, text)))
    for name, text in made.items():
        (folder / name).write_text(text)
    for source, place in links.files.items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / source, folder / place)


def write_search_index(out):
    """Turns the index of MkDocs into a script, because a page of a local file may load scripts but no JSON."""
    index = out / "search/search_index.json"
    entries = json.loads(index.read_text())["docs"] # of whole pages, and of the sections that each page consists of
    pages = {entry["location"]: entry["title"] for entry in entries if "#" not in entry["location"]}
    sections = [{"location": entry["location"], "page": pages[entry["location"].partition("#")[0]],
                 "title": entry["title"], "text": entry["text"]} for entry in entries if "#" in entry["location"]]
    (out / "search_index.js").write_text("const searchSections = " + json.dumps(sections, ensure_ascii=False) + ";\n")
    shutil.rmtree(index.parent)


class Page(html.parser.HTMLParser):
    """The links, the anchors and the fetched files of a built page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors, self.fetched = [], set(), []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.anchors |= {attributes.get("id"), attributes.get("name")}
        if tag == "a" and attributes.get("href"):
            self.links.append(attributes["href"])
        for name in ("src", "srcset", "data", "poster", *(("href",) if tag in ("link", "image", "use") else ())):
            if attributes.get(name):
                self.fetched.append(attributes[name])


def check_site(out):
    """Fails if a page links to nothing, needs the network, or is missing in the navigation."""
    pages = {path: Page(path) for path in sorted(out.rglob("*.html"))}
    reached = {out / "index.html"} | {(out / link).resolve() for link in pages[out / "index.html"].links}
    for path, page in pages.items():
        name = path.relative_to(out)
        if path not in reached:
            fail(f"{name}: wanted the page in 'nav' of mkdocs.yml, found it not there")
        for link in page.fetched + page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme in ("http", "https") or parts.netloc:
                if link in page.fetched:
                    fail(f"{name}: wanted all files in the site, found one of the network: {link}")
            elif not parts.scheme:
                target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
                if not target.is_file():
                    fail(f"{name}: the link '{link}' wanted a file, found none")
                if parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                    fail(f"{name}: the link '{link}' wanted a heading '{parts.fragment}', found none")
    for path in out.rglob("*.css"):
        if re.search(r"@import|url\(\s*['\"]?(?:[a-z]+:)?//", path.read_text()):
            fail(f"{path.relative_to(out)}: wanted all files in the site, found one of the network")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if shutil.which("mkdocs") is None:
        fail("wanted the program mkdocs, found none; ./dev docs installs it")
    if out.exists() and any(out.iterdir()) and not (out / "search_index.js").exists(): # MkDocs empties the folder
        fail(f"{out}: wanted an empty or no folder, or one of these pages, found other files in it")
    with tempfile.TemporaryDirectory() as folder:
        pages = pathlib.Path(folder) / "pages"
        write_pages(program, pages)
        done = subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--config-file", ROOT / "mkdocs.yml", "--site-dir",
                               out], check=False, env=os.environ | {"CATOPTRIC_PAGES": str(pages)})
    if done.returncode:
        fail("mkdocs wanted pages without a broken link, found the errors above")
    write_search_index(out)
    check_site(out)
    for name in ("sitemap.xml", "sitemap.xml.gz"): # they are of use only at a known address
        (out / name).unlink(missing_ok=True)


if __name__ == "__main__":
    main()
