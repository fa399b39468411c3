"""Finds which tests run which lines of code. The build must have CATOPTRIC_REACHED (see reached.cpp).

A test is a test of CTest. The test "unit" is split by source files, because it is one process for all of them.
"""
import concurrent.futures
import dataclasses
import glob
import json
import os
import pathlib
import re
import shutil
import subprocess
import time

from checkout import CODE

# Labels and tests that judge no code of the engine in reasonable time, or that build other checkouts.
LEFT_OUT_LABELS = {"long", "clone", "fuzz", "limits-all", "renderers", "slurm", "install", "bench", "python",
                   "page", "sweep"}
LEFT_OUT_TESTS = re.compile("^(mutations|third-party|docs/.*)$")
# Tests that draw run code of this file.
DRAWING = "engine/gpu/specialise.cpp"
# The part of a source's path that all checkouts share.
SOURCE = re.compile(r"(?:^|/)((?:engine|samples)/[\w/]+\.[ch]pp)$")


@dataclasses.dataclass
class Test:
    """A command that judges code by its exit code."""
    name: str
    command: list[str]
    environment: dict[str, str]
    folder: str
    alone: bool  # no other test may run beside it

    @property
    def program(self):
        """The build target that the command needs."""
        name = os.path.basename(self.command[0])
        return name if name.endswith("_test") else "all"


def tests_of(checkout):
    """Returns the tests of a built checkout by name."""
    listed = subprocess.run(["ctest", "--test-dir", checkout.build, "--show-only=json-v1"], cwd=checkout.folder,
                            capture_output=True, text=True, check=True).stdout
    found = {}
    for test in json.loads(listed)["tests"]:
        has = {entry["name"]: entry["value"] for entry in test["properties"]}
        if LEFT_OUT_LABELS & set(has.get("LABELS", [])) or LEFT_OUT_TESTS.match(test["name"]):
            continue
        variables = dict(text.split("=", 1) for text in has.get("ENVIRONMENT", []))
        parts = [(test["name"], test["command"])]
        if test["name"] == "unit":
            files = sorted(os.path.basename(path) for path in glob.glob(checkout.path("tests/unit/*_test.cpp")))
            parts = [(f"unit/{file.removesuffix('_test.cpp')}", [*test["command"], "--from", file]) for file in files]
        for name, command in parts:
            found[name] = Test(name, command, variables, has["WORKING_DIRECTORY"], has.get("RUN_SERIAL", False))
    return found


def run(checkout, test, timeout, variables={}):
    """Runs a test. Returns its exit code and output."""
    return checkout.run(["nice", *test.command], timeout, {**test.environment, **variables}, test.folder)


class Reach:
    """For each test its time in seconds, and for each source the tests that run a line."""

    def __init__(self, code, tests, seconds, lines):
        self.code = code        # content_id() of the code that was run
        self.tests = tests      # tests_id() of the tests
        self.seconds = seconds  # {test: seconds}
        self.lines = lines      # {source: {line: [test]}}

    def tests_for(self, source, line, text):
        """Returns the names of the tests to run for a change of a line, those most likely to fail soon first.

        These are the tests that run a line of the function around it (function_around()), because only the first line
        of a basic block is recorded. If there is none, these are the tests that run a line of the file, or else all
        tests. For a shader these are the tests that draw. A test that has the name of the source comes first."""
        if not source.endswith("pp"):
            drawing = {test for tests in self.lines.get(DRAWING, {}).values() for test in tests}
            return sorted(drawing, key=lambda test: (not named_like(test, source), self.seconds[test]))
        share = self.count_lines(source, *function_around(text, line)) or self.count_lines(source, 1, 1 << 30)
        return sorted(share or self.seconds, key=lambda test: (not named_like(test, source),
                                                               (self.seconds[test] + .2) / share.get(test, 1)))

    def count_lines(self, source, first, last):
        """Returns for each test how many of these lines of a source it runs, both ends counted, if it runs any."""
        counts = {}
        for number, tests in self.lines.get(source, {}).items():
            for test in tests if first <= int(number) <= last else []:
                counts[test] = counts.get(test, 0) + 1
        return counts

    def save(self, path):
        pathlib.Path(path).write_text(json.dumps(vars(self)))

    @staticmethod
    def load(path):
        stored = json.loads(pathlib.Path(path).read_text())
        return Reach(stored["code"], stored.get("tests", ""), stored["seconds"], stored["lines"])


def named_like(test, source):
    """Returns whether a test has the name of a source, as unit/box that of engine/bvh/box.hpp."""
    return os.path.basename(test) == os.path.splitext(os.path.basename(source))[0]


def function_around(text, line):
    """Returns the first and last line of the function or class around a line, both counted from 1.

    A function ends with a brace at the begin of a line, as clang-format writes it."""
    ends = [number for number, of in enumerate(text.splitlines(), 1) if of.startswith("}")]
    return max([0, *(end for end in ends if end < line)]) + 1, min([*(end for end in ends if end >= line), 1 << 30])


def source_lines(module, offsets):
    """Returns the source and line of each offset in a program or library, or None where it is no code of ours."""
    asked = "".join(f"{offset - 1:#x}\n" for offset in offsets)  # an offset is that after a call
    told = subprocess.run(["addr2line", "-e", module], input=asked, capture_output=True, text=True, check=True).stdout
    found = []
    for text in told.splitlines():
        path, _, line = text.partition(" ")[0].rpartition(":")
        match = SOURCE.search(os.path.normpath(path))
        found.append((match[1], int(line)) if match and line.isdigit() else None)
    return found


def nonzero_offsets(path):
    """Returns the offsets of the bytes of a sparse file that are not 0."""
    found = []
    with open(path, "rb") as file:
        size, at = os.fstat(file.fileno()).st_size, 0
        while at < size:
            try:
                begin = os.lseek(file.fileno(), at, os.SEEK_DATA)
            except OSError:
                break
            at = os.lseek(file.fileno(), begin, os.SEEK_HOLE)
            file.seek(begin)
            found += [begin + place.start() for place in re.finditer(b"[^\0]", file.read(at - begin))]
    return found


def record(checkout, jobs):
    """Runs all tests. Returns a Reach, and an error text for each test that fails although no code is wrong."""
    tests, folder = tests_of(checkout), checkout.path(checkout.build, "reached")
    shutil.rmtree(folder, ignore_errors=True)
    seconds, wrong = {}, []

    def one(test):
        own = os.path.join(folder, test.name)
        os.makedirs(own)
        begin = time.monotonic()
        code, output = run(checkout, test, 1800, {"CATOPTRIC_REACHED": own})
        seconds[test.name] = round(time.monotonic() - begin, 2)
        if code != 0:
            wrong.append(f"{test.name} ended with {code}:\n{output[-2000:]}")

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, [test for test in tests.values() if not test.alone]))
    for test in tests.values():
        if test.alone:
            one(test)
    lines = lines_by_tests(checkout, folder, seconds)
    return Reach(checkout.content_id(CODE), checkout.tests_id(), seconds, lines), wrong


def lines_by_tests(checkout, folder, names):
    """Returns the tests that run each line, {source: {line: [test]}}, from the files that they wrote below `folder`."""
    lines = {}
    offsets = {}  # {module: {test: [offset]}}
    for name in names:
        for path in glob.glob(os.path.join(folder, glob.escape(name), "*")):
            if os.path.isfile(path):
                offsets.setdefault(os.path.basename(path), {})[name] = nonzero_offsets(path)
    for module, by_test in offsets.items():
        program = checkout.path(checkout.build, module)
        if not os.path.exists(program):
            continue
        every = sorted(set().union(*by_test.values()))
        place = dict(zip(every, source_lines(program, every)))
        for name, of in by_test.items():
            for source, line in {place[offset] for offset in of} - {None}:
                tests_there = lines.setdefault(source, {}).setdefault(str(line), [])
                if name not in tests_there:
                    tests_there.append(name)
    return lines
