"""Which labels of tests a change of a path can touch, and what the tests of a label need."""
import fnmatch
import shutil
import subprocess

# Label -> Debian packages that its tests need beside those of the build. The cheap labels come first.
LABELS = {
    "unit": (), "bench": (), "allocations": (), "install": ("help2man", "mkdocs"), "gpu": (), "fuzzed": (), "view": (),
    "limits": (), "drivers": (), "faults": (), "cli": (), "reflect": (),
    "page": ("chromium", "chromium-driver", "python3-selenium"),
    "sweep": ("snakemake", "procps", "python3-venv"),
    "slurm": ("snakemake", "slurmctld", "slurmd", "slurm-client", "munge"),
    "python": ("python3-venv", "python3-dev"),
    "clone": (), "guides": (),
    "docs": ("mkdocs", "chromium", "chromium-driver", "python3-selenium"),
    "fuzz": (),
    "renderers": ("chromium", "chromium-driver", "python3-selenium", "blender", "python3-numpy", "xvfb", "xauth",
                  "npm", "libllvm19", "python3-venv"),
    "limits-all": (),
    "long": ("clang-16", "libclang-rt-16-dev"),
}
# Labels that the usual suite leaves out (CMakePresets.json).
OUTSIDE = {"page", "sweep", "slurm", "python", "clone", "guides", "docs", "fuzz", "renderers", "limits-all", "long"}
# Packages in whose place a program of another source will do.
PROGRAMS = {"npm": "npm"}

DRAWN = "gpu reflect cli limits drivers view faults allocations"  # tests that draw pictures
PICTURES = f"{DRAWN} fuzzed page python sweep docs renderers limits-all long/stress long/worth long/outside_figures"
FILES = "fuzzed fuzz long/fuzz_*"  # tests of file readers
ALWAYS = "docs/cover"  # reads pages, ./dev and tests
# Path -> labels. The first row whose pattern matches a path counts; * matches "/" too. An item with "/" is a pattern of
# tests. The items before "|" are near: their tests run first. Those after it run in the time that is left.
PATHS = [
    ("tests/CMakeLists.txt", f"unit bench allocations fuzzed | {DRAWN} install"),
    ("tests/bytes*.py", "bytes"),
    ("tests/support/*", f"unit | {DRAWN} fuzzed long/worth long/outside_figures long/audit long/choose"),
    ("tests/allocations/*", "allocations"),
    ("tests/bench/*", "bench | drivers"),
    ("tests/cli/*", "cli"),
    ("tests/clone/*", "clone"),
    ("tests/docs/*", "docs/*"),
    ("tests/draco/*", "unit"),
    ("tests/drivers/*", "drivers"),
    ("tests/faults/*", "faults | view"),
    ("tests/fuzz/*", "long/fuzz_*"),
    ("tests/fuzzed/*", "fuzzed | fuzz"),
    ("tests/golden/*", "unit"),
    ("tests/guides/*", "guides"),
    ("tests/gpu/*", "gpu | limits/gpu/*"),
    ("tests/install/*", "install"),
    ("tests/limits/*", "limits | limits-all"),
    ("tests/long/audit_test.cpp", "long/audit"),
    ("tests/long/choose_test.cpp", "long/choose"),
    ("tests/long/outside_figures_test.cpp", "long/outside_figures"),
    ("tests/long/worth_test.cpp", "long/worth"),
    ("tests/machine/*", "bench"),
    ("tests/mutations/*", "mutations"),
    ("tests/page/*", "page"),
    ("tests/python/*", "python"),
    ("tests/reflect/*", "reflect | limits/reflect/*"),
    ("tests/renderers/*", "fidelity renderers"),
    ("tests/runner/*", "runner"),
    ("tests/scenes/*", ""),  # ./dev scenes
    ("tests/sweep/*", "sweep slurm"),
    ("tests/unit/*", "unit"),
    ("tests/view/*", "view"),
    ("engine/core/*", f"unit | {PICTURES} {FILES} bench"),
    ("engine/images/*", f"unit {FILES} | cli"),
    ("engine/draco/*", f"unit {FILES} | cli"),
    ("engine/import/*", f"unit fuzzed | {PICTURES} {FILES} long/choose long/audit"),
    ("engine/scene/*", f"unit fuzzed | {PICTURES} {FILES} long/choose long/audit"),
    ("engine/bvh/*", f"unit drivers | {PICTURES}"),
    ("engine/require/*", f"unit | {PICTURES} long/choose long/audit"),
    ("engine/gpu/*", f"unit gpu | {PICTURES}"),
    ("engine/graph/*", f"unit gpu allocations | {PICTURES}"),
    ("engine/render/*", f"unit gpu | {PICTURES}"),
    ("engine/reflect/*", f"unit | {PICTURES} long/audit"),
    ("engine/measure/*", "unit | cli reflect gpu faults view drivers limits page python sweep docs long/worth"),
    ("engine/report/page/*", "unit page | cli docs third-party"),
    ("engine/report/*", "unit page | cli reflect faults view python sweep docs"),
    ("engine/session/*", f"unit | {PICTURES} long/audit long/choose"),
    ("engine/study/*", f"unit | {PICTURES} long/audit"),
    ("engine/embed*", "gpu/embed install | gpu cli python"),
    ("engine/*.hpp", f"unit install python | {PICTURES}"),
    ("engine/exported.map", "install python"),
    ("engine/CMakeLists.txt", f"unit install | {PICTURES}"),
    ("shaders/tests/*", "gpu unit"),
    ("shaders/*", f"unit | {PICTURES}"),
    ("samples/view/*", "view | install"),
    ("samples/stress/*", "unit cli/stress long/stress"),
    ("samples/benchmark/*", "cli/bench cli/costs unit | cli"),
    ("samples/sweep/*", "cli/sweep sweep slurm"),
    ("samples/renderers/*", "fidelity renderers"),
    ("samples/catoptric/*", "unit | cli faults view fuzzed docs page sweep slurm"),
    ("samples/scenes/*", "unit | cli docs"),
    ("samples/*", "install"),  # programs outside this build, and the list of programs
    ("python/*", "python install"),
    ("bench/growth/*", "growth"),
    ("bench/machine/*", "bench"),
    ("bench/peers/*", "drivers"),
    ("bench/*", ""),  # ./dev bench
    ("docs/costs/*", "unit cli/costs cli/wishes | cli docs install"),
    ("docs/site/*", "docs/site install"),
    ("docs/*", "docs/cover docs/tutorial docs/site | docs"),
    ("README.md", "docs/cover docs/site clone"),
    ("CONTRIBUTING.md", "docs/cover docs/site guides"),
    ("*.md", "docs/cover docs/site"),
    ("mkdocs.yml", "docs/site"),
    ("LICENSE", "install"),
    ("CMakeLists.txt", f"unit install clone | {DRAWN} python"),
    ("CMakePresets.json", f"unit runner install clone | {DRAWN} python"),
    ("cmake/*", f"unit install clone | {DRAWN} python"),
    ("dev", "runner clone | install python"),
    (".ci/*", ""),
    (".clang-*", ""),
    (".gitignore", "clone"),
]


def row_of(path, rows=PATHS):
    """Returns the first row that matches a path, or None."""
    return next((row for row in rows if fnmatch.fnmatchcase(path, row[0])), None)


def is_of(test, item):
    """Returns whether a test is of an item of a row: a label, or a name or pattern of tests."""
    return item in test.labels or fnmatch.fnmatchcase(test.name, item)


def touched(paths, tests, rows=PATHS):
    """Returns the tests that changed paths can touch: {name: True if near, else False}. A test of a changed source is
    near. Raises KeyError for a path without a row."""
    found = {}
    for path in paths:
        row = row_of(path, rows)
        if row is None:
            raise KeyError(path)
        near, _, far = row[1].partition("|")
        near += " " + ALWAYS
        stem = path.rsplit("/", 1)[-1].split(".", 1)[0].removesuffix("_test")
        for test in tests:
            named = "/" in test.name and test.name.split("/")[-1] == stem and test.name.count("/") == 1
            if any(is_of(test, item) for item in near.split()):
                found[test.name] = True
            elif any(is_of(test, item) for item in far.split()):
                found[test.name] = found.get(test.name, False) or named
    return found


def labels_of(paths, rows=PATHS):
    """Returns the labels whose packages the tests of changed paths may need."""
    items = {item for path in paths for item in (row_of(path, rows) or ("", ""))[1].replace("|", " ").split()}
    return [label for label in LABELS if label in items or any(item.startswith(label + "/") for item in items)]


def faults(tests, paths, excluded, labels=LABELS, rows=PATHS):
    """Returns what is wrong with the table: a label, path or pattern that one side lacks.

    `excluded` names the labels that the suite of CMakePresets.json leaves out."""
    wrong = []
    used = {label for test in tests for label in test.labels}
    items = {item for _, text in rows for item in text.replace("|", " ").split()}
    wrong += [f"label '{label}' of tests/CMakeLists.txt is not in LABELS" for label in sorted(used - set(labels))]
    wrong += [f"label '{label}' of LABELS has no test" for label in labels if label not in used]
    wrong += [f"no row of PATHS names label '{label}' or a test of it" for label in labels
              if not any(is_of(test, item) for item in items for test in tests if label in test.labels)]
    wrong += [f"test '{test.name}' has no label" for test in tests if not test.labels]
    wrong += [f"'{item}' of PATHS is no label and matches no test" for item in sorted(items)
              if not any(is_of(test, item) for test in tests)]
    wrong += [f"path '{path}' matches no row of PATHS" for path in paths if row_of(path, rows) is None]
    matched = {row_of(path, rows) for path in paths}
    wrong += [f"row '{row[0]}' of PATHS matches no path" for row in rows if row not in matched]
    if excluded != OUTSIDE:
        wrong.append(f"OUTSIDE and CMakePresets.json differ in {', '.join(sorted(excluded ^ OUTSIDE))}")
    return wrong


def missing_packages(label):
    """Returns the packages of a label that are not installed."""
    missing = []
    for package in LABELS.get(label, ()):
        if package in PROGRAMS and shutil.which(PROGRAMS[package]):
            continue
        if not shutil.which("dpkg-query"):
            continue  # another distribution: the tests themselves say what they lack
        ended = subprocess.run(["dpkg-query", "-W", "-f", "${Status}", package], capture_output=True, text=True)
        if "ok installed" not in ended.stdout:
            missing.append(package)
    return missing
