#!/usr/bin/env python3
"""Runs the commands of the documentation. `commands.py CATOPTRIC FOLDER [PAGE...]` runs the commands of these pages, or
of all pages, in FOLDER. `commands.py` alone checks that a test covers each command, and that tests named in tables
exist.

A command is a line of a block of code that names no language. Pictures are small, and frames and views are few."""

import fnmatch
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# Commands that another test covers: pattern of the command, file of the test, and words that the file holds.
ELSEWHERE = [
    (r"\./dev (demo|setup)\b", "tests/clone/run.sh", "./dev demo"), # which begins with setup
    (r"\./dev test\b", "dev", "run_tests"), # each run of the tests
    (r"\./dev wheel\b", "tests/python/run.sh", "wheel.sh"),
    (r"\./dev pack\b", "tests/machine/run.sh", "pack.sh"),
    (r"\./dev bench growth\b", "tests/CMakeLists.txt", "bench/growth/fit_test.py"),
    (r"\./dev bench peers\b", "tests/drivers/whitted_test.cpp", "peers/"),
    (r"samples/renderers/report\.sh\b", "tests/renderers/run.py", "docs/renderers.md"),
    (r"python3 samples/renderers/torus_room\.py\b", "tests/renderers/mitsuba_test.py", "torus_room.py"),
    (r"apt install\b", "tests/runner/table.py", '"blender", "python3-numpy", "xvfb", "xauth"'),
    (r"snakemake .*--cluster-sync\b", "tests/sweep/slurm.sh", "--cluster-sync"),
    (r"snakemake\b", "tests/sweep/run.sh", "snakemake -s"),
    (r"openjd run\b", "tests/sweep/run.sh", "openjd run"),
    (r"catoptric-view\b", "tests/view/audit_test.cpp", "--screenshot"),
    (r"live_loop\b", "tests/install/run.cmake", "--audit"),
    (r"catoptric stress\b", "tests/CMakeLists.txt", "catoptric_cli stress"),
    (r"catoptric compare -o out --lag\b", "tests/cli/result_test.cpp", '"--lag"'), # takes 2300 frames
    (r"catoptric bench --tune\b", "tests/cli/bench_test.cpp", "--tune"),
    (r"catoptric bench --calibrate\b", "tests/cli/calibrate_test.cpp", "--calibrate"),
    (r"catoptric bench --costs\b", "tests/cli/costs_test.cpp", "--costs"),
    (r"tar -xf catoptric-kit\.tar\.gz", "tests/machine/run.sh", "tar -x"),
    (r"python3 -m venv env$|env/bin/pip install catoptric", "tests/python/run.sh", "pip\" install"),
    (r"VK_DRIVER_FILES=\S+ LD_LIBRARY_PATH=", "tests/drivers/second_driver.hpp", "mesa25"),
]
# A motion of the camera, for pages that show none.
CAMERA_KEYS = '{"keys": [{"time": 0, "camera": "0,1,4:0,1,0:45"}, {"time": 0.05, "camera": "1,1,4:0,1,0:45"}]}'
# What the commands of this test begin with.
STARTS = r"(catoptric|cat|for|mkdir|export|xdg-open|oiiotool) "
# Lines that programs print, in blocks that show a command's output.
PRINTED = r"(worse|unknown|baseline): |captures: at most \d|mirror on the light's path"


def fail(*words):
    sys.exit("docs: " + " ".join(str(word) for word in words))


def list_pages():
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
    return {str(page.relative_to(ROOT)): page.read_text() for page in pages}


def read_blocks(text):
    """Returns the blocks of commands: fenced without a language or as `sh`, or indented. Data in JSON is none."""
    found, rest = [], text
    for match in re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.M | re.S):
        if match.group(1) in ("", "sh") and not match.group(2).startswith("{"):
            found.append((match.start(), match.group(2)))
        rest = rest[:match.start()] + re.sub(r"[^\n]", "#", match.group(0)) + rest[match.end():]
    for match in re.finditer(r"^ {4}\S.*\n(?:^ {4,}\S.*\n)*", rest, re.M):
        lines_before = rest[:match.start()].rstrip().split("\n")
        in_list = re.match(r"\s*([-*]|\d+\.) |\s+\S", lines_before[-1]) is not None
        if not in_list and not match.group(0).lstrip().startswith("{"):
            found.append((match.start(), re.sub(r"^ {4}", "", match.group(0), flags=re.M)))
    return [block for _, block in sorted(found)]


def split_commands(block):
    """Returns the commands of a block. A command ends with its line, its here-document or its loop."""
    commands, end = [], None
    for line in block.rstrip("\n").split("\n"):
        if end is None and commands and commands[-1].endswith("\\"):
            commands[-1] = commands[-1][:-1].rstrip() + " " + line.strip()
        elif end is None:
            commands.append(line)
        else:
            commands[-1] += "\n" + line
            if line == end:
                end = None
            continue
        here = re.search(r"<<\s*'?(\w+)'?", line)
        if here:
            end = here.group(1)
        elif line.startswith("for ") and not re.search(r";\s*done\s*$", line):
            end = "done"
    return [command for command in commands if command.strip() and not re.match(f"#|{PRINTED}", command)]


def find_test(command):
    """Returns the entry of ELSEWHERE that covers the command, or None."""
    for entry in ELSEWHERE:
        if re.match(entry[0], command):
            return entry
    return None


def check_cover(pages):
    """Returns the commands to run by page. Fails if no test covers a command, or an entry of ELSEWHERE covers none."""
    used, here = set(), {}
    for name, text in pages.items():
        here[name] = []
        for block in read_blocks(text):
            commands = []
            for command in split_commands(block):
                entry = find_test(command)
                if entry:
                    used.add(entry)
                elif re.match(STARTS, command):
                    commands.append(command)
                else:
                    fail(f"{name}: wanted a test of the command '{command}', found none. Name its test in ELSEWHERE of "
                         "tests/docs/commands.py, or name the language of the block if it holds no commands")
            here[name].append(commands)
    for pattern, file, words in ELSEWHERE:
        if (pattern, file, words) not in used:
            fail(f"tests/docs/commands.py: ELSEWHERE: wanted a command that fits '{pattern}', found none in the pages")
        if words not in (ROOT / file).read_text():
            fail(f"tests/docs/commands.py: ELSEWHERE: '{pattern}' wanted '{words}' in {file}, found it not there")
    return here


def check_test_names(pages):
    """Fails if a table names a test that does not exist. A star stands for any characters, as in Suite.*"""
    sources = "\n".join(file.read_text() for file in sorted((ROOT / "tests").rglob("*_test.cpp")))
    tests = {f"{suite}.{test}" for suite, test in
             re.findall(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)", sources, re.M)}
    for name, text in pages.items():
        for line in text.split("\n"):
            for wanted in re.findall(r"\b[A-Z]\w+\*?\.(?:[A-Z]\w+\*?|\*(?!\*))", line if line.startswith("| ") else ""):
                if not fnmatch.filter(tests, wanted):
                    fail(f"{name}: wanted the name of a test, found '{wanted}', which no test has")


def check_minutes(pages):
    """Fails unless README.md and the tutorial name the same minutes of the first report and of the whole tutorial."""
    readme, tutorial = (" ".join(pages[name].split()) for name in ("README.md", "docs/tutorial.md"))
    first = re.search(r"that of `--quick` (\w[\w ]*) \(", readme)
    whole = re.search(r"(\w+) minutes from a fresh machine", readme)
    for found, wanted in ((first, "The first report takes {}"), (whole, "the steps take about {} minutes")):
        if not found or wanted.format(found.group(1)) not in tutorial:
            fail(f"docs/tutorial.md: wanted '{wanted.format(found.group(1) if found else '')}', as README.md says")


def expect_refusal(words, text):
    """Expects that a page with this text is refused with these words."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "tests/docs"
        shutil.copytree(ROOT / "docs", pathlib.Path(folder) / "docs", ignore=shutil.ignore_patterns("*.png", "*.svg"))
        shutil.copytree(ROOT / "tests", pathlib.Path(folder) / "tests")
        for file in ("README.md", "CONTRIBUTING.md", "dev"):
            shutil.copy(ROOT / file, folder)
        (pathlib.Path(folder) / "docs/new.md").write_text(text)
        done = subprocess.run([sys.executable, "-B", copy / "commands.py"], capture_output=True, text=True, check=False)
    if done.returncode != 1 or words not in done.stderr:
        fail(f"a page '{text}': wanted a refusal with '{words}', found exit code {done.returncode}: {done.stderr}")


def write_inputs(folder, text, program, environment):
    """Writes the files that the commands of a page name: a scene, pictures, results, and what the page itself shows."""
    (folder / "docs/images").mkdir(parents=True)
    (folder / "out/demo").mkdir(parents=True)
    (folder / "out/demo/report.html").write_text("written by ./dev demo")
    shutil.copytree(ROOT / "docs/costs", folder / "docs/costs")
    shutil.copytree(ROOT / "samples", folder / "samples")
    sweep = json.loads((folder / "samples/sweep/roughness.json").read_text())
    sweep["scenes"] = sweep["scenes"][:1]
    sweep["techniques"] = [sweep["techniques"][0], sweep["techniques"][-1]]
    sweep["axes"]["mirror"] = sweep["axes"]["mirror"][:2]
    sweep["knobs"]["face"] = [16]
    sweep["options"] = {"size": "16x16", "frames": 6, "warmup": 1, "reference": "raytrace:depth=4,rays=4"}
    sweep["views"]["count"] = 6
    for file in (folder / "samples/sweep/roughness.json", folder / "sweep.json"):
        file.write_text(json.dumps(sweep))
    own = re.search(r'^```json\n(\{\n  "scenes".*?)^```$', text, re.M | re.S) # the page shows a sweep of its own
    if own:
        shown = json.loads(own.group(1))
        shown["options"]["size"] = "16x16"
        (folder / "sweep.json").write_text(json.dumps(shown))
    for name in ("scene", "room", "a", "b"):
        shutil.copy(ROOT / "samples/scenes/cornell-mirrors.glb", folder / f"{name}.glb")
    for name in ("card", "my-card"):
        shutil.copy(ROOT / "docs/costs/gtx-770.json", folder / f"{name}.json")
    keys = re.search(r'^\{"keys":.*?^```', text, re.M | re.S)
    (folder / "path.json").write_text(keys.group(0).removesuffix("```") if keys else CAMERA_KEYS)
    subprocess.run(["catoptric", "render", "scene.glb", "--technique", "raytrace", "-o", "mine.exr", "-q"], cwd=folder,
                   env=environment, check=True, stdout=subprocess.DEVNULL)
    for name in ("a", "b"):
        shutil.copy(folder / "mine.exr", folder / f"{name}.exr")
    if "merged/results.json" in text and "sweep merge" not in text:
        for words in (["plan", "sweep.json", "-o", "sweep"], ["run", "sweep"], ["merge", "sweep", "-o", "merged"]):
            subprocess.run(["catoptric", "sweep", *words, "-q"], cwd=folder, env=environment, check=True,
                           stdout=subprocess.DEVNULL)
    before = folder.parent / "before/build/release/catoptric"
    before.parent.mkdir(parents=True, exist_ok=True)
    before.unlink(missing_ok=True)
    before.symlink_to(program)
    if "before.json" in text:
        subprocess.run(["catoptric", "bench", "scene.glb", "--techniques", "reuse", "-o", "before.json", "-q"], cwd=folder,
                       env=environment, check=True, stdout=subprocess.DEVNULL)


def run_page(name, blocks, folder, environment):
    """Runs the commands of a page in order, each block in a shell of its own, except that a tutorial is one shell."""
    scripts = ["\n".join(commands) for commands in blocks if commands]
    if name == "docs/tutorial.md":
        scripts = ["\n".join(scripts)]
    for script in scripts:
        begun = time.monotonic()
        done = subprocess.run(["bash", "-exuc", script], cwd=folder, env=environment, check=False, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            fail(f"{name}: wanted exit code 0, found {done.returncode} from the last command of:\n{done.stdout[-3000:]}")
        print(f"{name}: {time.monotonic() - begun:5.1f} s: {script.splitlines()[0]}", flush=True)


def main():
    pages = list_pages()
    here = check_cover(pages)
    check_minutes(pages)
    check_test_names(pages)
    if len(sys.argv) == 1:
        expect_refusal("docs/new.md: wanted a test of the command 'unknown --option'", "Text:\n\n    unknown --option\n")
        expect_refusal("docs/new.md: wanted a test of the command './dev format'", "```\n./dev demo\n./dev format\n```\n")
        expect_refusal("docs/new.md: wanted a test of the command 'catoptrics list'", "```sh\ncatoptrics list\n```\n")
        expect_refusal("docs/new.md: wanted the name of a test, found 'Memory.Wrong*'", "| a | Memory.Wrong* |\n")
        print(f"docs: a test covers each command; {sum(len(block) for page in here.values() for block in page)} run here")
        return
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    bin_folder = folder / "bin"
    bin_folder.mkdir(parents=True)
    for tool, text in (("catoptric", (HERE / "small.py").read_text()),
                       ("xdg-open", '#!/bin/sh\ntest -s "$1" || { echo "xdg-open: no file $1"; exit 4; }\n')):
        (bin_folder / tool).write_text(text)
        (bin_folder / tool).chmod(0o755)
    environment = os.environ | {"PATH": f"{bin_folder}:{os.environ['PATH']}", "CATOPTRIC_PROGRAM": str(program),
                                "XDG_CONFIG_HOME": str(folder / "config")}
    for name in sys.argv[3:] or here:
        if name not in here:
            fail(f"wanted one of the pages {', '.join(here)}, found '{name}'")
        work = folder / name.replace("/", "-").removesuffix(".md")
        if any(here[name]):
            write_inputs(work, pages[name], program, environment)
        run_page(name, here[name], work, environment)


if __name__ == "__main__":
    main()
