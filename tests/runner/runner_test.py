#!/usr/bin/env python3
"""Tests of the runner with a build whose tests are short scripts."""
import io
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from contextlib import redirect_stderr, redirect_stdout
from unittest import mock

sys.dont_write_bytecode = True
import records
import run
import table
import tests as ctest

RUN = pathlib.Path(__file__).with_name("run.py").resolve()


class Project:
    """A git repository with a build of fake tests. Each test adds its name to the file `ran`."""

    def __init__(self, folder, tests):
        """tests: {name: (script of sh, further properties of CTest)}."""
        self.top = pathlib.Path(folder).resolve()
        self.build = self.top / "build"
        self.build.mkdir()
        (self.top / "tests").mkdir()
        (self.top / ".gitignore").write_text("/build/\n")
        (self.top / "engine.cpp").write_text("int x;\n")
        self.declare(tests)
        for words in ["init -q", "add -A", "-c user.name=a -c user.email=a@b commit -q -m first"]:
            subprocess.run(["git", *words.split()], cwd=self.top, check=True)

    def declare(self, tests):
        lines = []
        for name, (script, properties) in tests.items():
            script = f"echo {name} >>{self.build}/ran; {script}".replace("\\", "\\\\").replace('"', '\\"').replace("$", "\\$")
            lines.append(f'add_test("{name}" "/bin/sh" "-c" "{script}")\n'
                         f'set_tests_properties("{name}" PROPERTIES {properties})\n')
        (self.build / "CTestTestfile.cmake").write_text("".join(lines))

    def start(self, *words):
        return subprocess.Popen([sys.executable, str(RUN), *words, "--build", str(self.build), "--jobs", "1"],
                                cwd=self.top, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def run(self, *words):
        """Returns exit code and output of the runner."""
        process = self.start(*words)
        output = process.communicate()[0]
        return process.returncode, output

    def ran(self):
        path = self.build / "ran"
        return path.read_text().split() if path.exists() else []

    def record(self):
        return json.loads((self.top / records.FILE).read_text())

    def wait_for(self, name):
        while name not in self.ran():
            time.sleep(.02)


class Runs(unittest.TestCase):
    def project(self, tests):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return Project(folder.name, tests)

    def test_a_killed_run_continues_with_the_tests_that_had_not_ended(self):
        project = self.project({"a": ("true", "LABELS unit"), "b": ("[ -e go ] || sleep 60", "LABELS bench"),
                                "c": ("true", "LABELS cli")})
        killed = project.start("all")
        project.wait_for("b")
        killed.kill()
        killed.communicate()
        self.assertEqual(list(project.record()), ["unit"])
        (project.build / "go").touch()
        code, output = project.run("all")
        self.assertEqual(code, 0, output)
        self.assertEqual(project.ran(), ["a", "b", "b", "c"])
        self.assertIn("2 of 3 tests to run", output)
        self.assertIn("3 passed, 0 failed, 0 not run", output)
        self.assertEqual(list(project.record()), ["bench", "cli", "unit"])

    def test_an_interrupt_ends_tests_and_keeps_results(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            project = self.project({"a": ("true", "LABELS unit"),
                                    "b": ("trap '' INT TERM; echo $$ >pid; sleep 60; sleep 60", "LABELS cli")})
            process = project.start("all")
            project.wait_for("b")
            process.send_signal(number)
            output = process.communicate(timeout=30)[0]
            self.assertEqual(process.returncode, 128 + number, output)
            self.assertIn(f"stopped: {signal.Signals(number).name}", output)
            pid = int((project.build / "pid").read_text())
            self.assertFalse(os.path.exists(f"/proc/{pid}/cwd"))
            self.assertEqual(list(project.record()), ["unit"])
            self.assertIn("cli               1       0       0        0        0  1 wait", output)

    def test_a_test_that_fails_is_listed_and_runs_again(self):
        project = self.project({"a": ("true", "LABELS unit"), "b": ("echo '[  FAILED  ] X.y'; exit 3", "LABELS unit"),
                                "c": ("kill -SEGV $$", "LABELS cli")})
        code, output = project.run("all")
        self.assertEqual(code, 1)
        self.assertIn("failed: b: exit code 3, X.y ", output)
        self.assertIn("failed: c: signal SIGSEGV ", output)
        record = project.record()["unit"]
        self.assertEqual([record[key] for key in ("passed", "failed", "not_run", "green")], [1, 1, 0, None])
        project.run("all")
        self.assertEqual(sorted(project.ran()), ["a", "b", "b", "c", "c"])

    def test_what_did_not_run_is_named_with_its_reason_and_is_not_green(self):
        cases = r"printf '[ RUN      ] A.%s\nx.cpp:1: Skipped\nno disk\n\n[  SKIPPED ] A.%s (0 ms)\n' b b"
        project = self.project({"a": ("echo no root; exit 77", "LABELS unit SKIP_RETURN_CODE 77"),
                                "b": (cases, "LABELS cli"),
                                "c": (cases + "; echo '[  PASSED  ] 0 tests.'", "LABELS view")})
        code, output = project.run("all")
        self.assertEqual(code, 0, output)
        for text in ("not run: a: no root", "not run: b: A.b: no disk", "not run: c: no disk",
                     "1 passed, 0 failed, 3 not run"):
            self.assertIn(text, output)
        self.assertEqual(project.record()["cli"]["not_run"], 1)
        self.assertEqual(project.record()["view"]["green"], None)
        project.run("all")  # tries again what may run now
        self.assertEqual(sorted(project.ran()), ["a", "a", "b", "c", "c"])

    def test_a_missing_package_or_program_is_said(self):
        project = self.project({"a": ("true", "LABELS unit"), "b": ("true", "LABELS cli")})
        with mock.patch.dict(table.LABELS, {"unit": ("no-such-package",)}), redirect_stdout(io.StringIO()):
            runner = run.Runner(str(project.top), str(project.build))
            runner.tests[1].command = []
            runner.run(runner.tests)
            runner.lock.close()
        self.assertEqual(project.ran(), [])
        self.assertEqual(project.record()["unit"]["reasons"],
                         ["not run: a: Debian package no-such-package is not installed"])
        self.assertEqual(project.record()["cli"]["reasons"], ["failed: b: its program is not built"])

    def test_every_change_of_the_tree_but_of_the_record_makes_results_stale(self):
        project = self.project({"a": ("true", "LABELS unit")})
        change = [lambda: None,
                  lambda: (project.top / "engine.cpp").write_text("int y;\n"),
                  lambda: (project.top / "new.txt").write_text("new"),
                  lambda: subprocess.run(["git", "add", "-A"], cwd=project.top, check=True),
                  lambda: (project.build / "other").write_text("ignored by git")]
        counts = []
        for each in change:
            each()
            self.assertEqual(project.run("all")[0], 0)
            counts.append(len(project.ran()))
        self.assertEqual(counts, [1, 2, 3, 3, 3])
        project.run("all", "--again")
        self.assertEqual(len(project.ran()), 4)

    def test_a_recorded_green_label_does_not_run_in_another_build(self):
        project = self.project({"a": ("true", "LABELS unit")})
        project.run("all")
        (project.build / "runner/results.jsonl").unlink()
        code, output = project.run("all")
        self.assertEqual((code, project.ran()), (0, ["a"]), output)
        self.assertIn("unit              1       1       0", output)
        self.assertIn("1 passed, 0 failed, 0 not run", output)

    def test_a_tree_that_changes_under_a_test_ends_the_run(self):
        project = self.project({"a": ("echo int z >../engine.cpp", "LABELS unit")})
        code, output = project.run("all")
        self.assertEqual(code, 2)
        self.assertIn("the tree changed", output)
        self.assertFalse((project.top / records.FILE).exists())

    def test_half_a_line_of_results_is_ignored(self):
        project = self.project({"a": ("true", "LABELS unit")})
        project.run("all")
        path = project.build / "runner/results.jsonl"
        path.write_text(path.read_text() + '{"test": "a", "tr')
        project.run("all")
        self.assertEqual(project.ran(), ["a"])

    def test_the_record_is_written_whole(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "file")
            records.write_whole(path, "old")
            with mock.patch("os.fsync", side_effect=OSError("no space")), self.assertRaises(OSError):
                records.write_whole(path, "new and longer")
            self.assertEqual(pathlib.Path(path).read_text(), "old")

    def test_a_second_run_in_a_build_is_refused(self):
        project = self.project({"a": ("true", "LABELS unit")})
        first = run.Runner(str(project.top), str(project.build))
        code, output = project.run("all")
        self.assertEqual(code, 2)
        self.assertIn("another run uses", output)
        first.lock.close()

    def test_touched_runs_what_fits_and_counts_the_rest_as_not_run(self):
        tests = {f"cli/{name}": ("true", f'LABELS "cli{mark}"') for name, mark in
                 [("quick", ""), ("slow1", ";slow"), ("slow2", ";slow")]}
        project = self.project({**tests, "page": ("true", "LABELS page"), "unit": ("true", "LABELS unit")})
        (project.top / "tests/cli").mkdir()
        (project.top / "tests/cli/quick_test.cpp").write_text("")
        self.assertEqual(project.run("touched", "--minutes", "1")[0], 0)  # 30 s for each test that never ran
        self.assertEqual(len(project.ran()), 2)
        self.assertEqual(project.ran()[0], "cli/quick")
        self.assertEqual(project.record()["touched"]["left_out"], 1)
        code, output = project.run("touched", "--minutes", "1")
        self.assertEqual(sorted(project.ran()), ["cli/quick", "cli/slow1", "cli/slow2"], output)
        self.assertEqual(project.record()["touched"]["left_out"], 0)

    def test_labels_are_chosen_by_name(self):
        project = self.project({"a": ("true", "LABELS unit"), "b": ("true", "LABELS cli")})
        self.assertEqual(project.run("all", "cli")[0], 0)
        self.assertEqual(project.ran(), ["b"])
        code, output = project.run("all", "clo")
        self.assertEqual(code, 2)
        self.assertIn("found 'clo'", output)

    def test_a_path_without_a_row_is_refused(self):
        project = self.project({"a": ("true", "LABELS unit")})
        (project.top / "new.txt").write_text("")
        code, output = project.run("touched")
        self.assertEqual(code, 2)
        self.assertIn("no row of tests/runner/table.py matches the path 'new.txt'", output)


def fake(name, *labels):
    return ctest.Test(name, list(labels), False, ["x"], {}, "", 1, False, None)


class Judged(unittest.TestCase):
    def test_skipped_cases_are_found_among_other_output(self):
        output = ("[ RUN      ] A.ok\n[1, 2]\n[       OK ] A.ok (1 ms)\n[ RUN      ] A.b\n[3]\nx.cpp:1: Skipped\nno disk\n\n"
                  "[  SKIPPED ] A.b (0 ms)\n[ RUN      ] A.c\n[  SKIPPED ] A.c (0 ms)\n[  PASSED  ] 1 test.\n"
                  "[  SKIPPED ] 2 tests, listed below:\n[  SKIPPED ] A.b\n[  SKIPPED ] A.c\n")
        outcome = ctest.judge(fake("a", "unit"), 0, output)
        self.assertEqual((outcome.result, outcome.skipped), ("passed", ["A.b: no disk", "A.c: no reason said"]))

    def test_an_unknown_property_of_a_test_is_refused(self):
        listed = {"tests": [{"name": "a", "properties": [{"name": "FIXTURES_REQUIRED", "value": ["x"]}]}]}
        with self.assertRaisesRegex(ValueError, "test a: property FIXTURES_REQUIRED is unknown"):
            ctest.read(json.dumps(listed))


class Table(unittest.TestCase):
    TESTS = [fake("unit", "unit"), fake("cli/sweep", "cli"), fake("reflect/secant", "reflect"), fake("page", "page"),
             fake("limits/reflect/secant", "limits-all"), fake("long/stress", "long"), fake("long/mutations_1", "long")]

    def test_paths_choose_their_labels(self):
        rows = [("docs/*", ""), ("engine/*", "unit | reflect"), ("samples/stress/*", "long/stress cli")]
        self.assertEqual(table.touched(["docs/a.md"], self.TESTS, rows), {})
        self.assertEqual(table.touched(["engine/x.cpp"], self.TESTS, rows), {"unit": True, "reflect/secant": False})
        self.assertEqual(table.touched(["engine/reflect/secant.cpp", "samples/stress/a.cpp"], self.TESTS, rows),
                         {"unit": True, "reflect/secant": True, "long/stress": True, "cli/sweep": True})
        with self.assertRaises(KeyError):
            table.touched(["other"], self.TESTS, rows)

    def test_no_change_runs_the_mutations(self):
        for path in ("engine/core/a.cpp", "shaders/a.frag", "tests/mutations/rules.toml", "dev", "CMakeLists.txt"):
            self.assertNotIn("long/mutations_1", table.touched([path], self.TESTS), path)

    def test_an_untold_label_or_path_is_a_fault(self):
        rows = [("a/*", "unit cli | reflect"), ("b", "page limits-all long/stress")]
        labels = {label: () for label in ("unit", "cli", "reflect", "page", "limits-all", "long")}
        def faults(tests=self.TESTS, paths=("a/x", "b"), labels=labels, rows=rows, excluded=table.OUTSIDE):
            return table.faults(tests, paths, set(excluded), labels, rows)
        self.assertEqual(faults(), [])
        self.assertIn("label 'new'", faults([*self.TESTS, fake("x", "new")])[0])
        self.assertEqual(faults(labels={**labels, "old": ()})[0], "label 'old' of LABELS has no test")
        self.assertEqual(faults(rows=[rows[0], ("b", "page limits-all")]),
                         ["no row of PATHS names label 'long' or a test of it"])
        self.assertEqual(faults(paths=["a/x", "b", "c"]), ["path 'c' matches no row of PATHS"])
        self.assertEqual(faults(paths=["b"]), ["row 'a/*' of PATHS matches no path"])
        self.assertIn("'gone' of PATHS", faults(rows=[*rows, ("b", "gone")])[0])
        self.assertIn("test 'x' has no label", faults([*self.TESTS, fake("x")]))
        self.assertEqual(faults(excluded=table.OUTSIDE - {"page"}), ["OUTSIDE and CMakePresets.json differ in page"])

    def test_labels_with_packages_are_found_from_paths(self):
        self.assertEqual(table.labels_of(["engine/report/page/report.js"]), ["unit", "cli", "page", "docs"])
        self.assertEqual(table.labels_of(["samples/stress/x.cpp"]), ["unit", "cli", "long"])


if __name__ == "__main__":
    unittest.main()
