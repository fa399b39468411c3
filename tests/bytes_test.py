#!/usr/bin/env python3
"""Tests of bytes.py with small programs in place of `catoptric`: what it finds, and what it covers."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import bytes as tool

# A program with two techniques. FAULT is replaced by one line of Python that may change what it writes.
PROGRAM = '''#!{python} -B
import hashlib, json, os, pathlib, sys
words = sys.argv[1:]
log = pathlib.Path({log!r})
log.open("a").write(json.dumps(words) + "\\n")
choice = dict(name="law", default="cone", choices=["none", "cone", "exact"])
size = dict(name="face", default=256, low=1.0, high=16384.0, special="auto")
if words[:2] == ["list", "techniques"]:
    print(json.dumps(dict(techniques=[dict(name="near", knobs=[choice, size]), dict(name="far", knobs=[size])])))
elif words[:2] == ["list", "scenes"]:
    print(json.dumps(dict(scenes=[dict(name="box"), dict(name="hall")])))
else:
    picture, error, code, flip = hashlib.sha256(json.dumps(words).encode()).digest(), "", 0, .25
    text = " ".join(words)
    order = words[words.index("--techniques") + 1:-1] if "--techniques" in words else []
    {fault}
    print(error, end="", file=sys.stderr)
    if words[0] in ("info", "graph"):
        print(json.dumps(dict(version=os.getpid(), picture=list(picture))))
    if words[0] == "render":
        pathlib.Path("x.exr").write_bytes(picture)
    if words[0] == "compare":
        pathlib.Path("out").mkdir()
        rows = [dict(label=row, error=dict(flip=flip + place * drift), image=None,
                     gpu_ms=dict(median=os.getpid(), ci95=None)) for place, row in enumerate(order)]
        pathlib.Path("out/report.json").write_text(json.dumps(dict(date=os.getpid(), rows=rows)))
    sys.exit(code)
'''


class Bytes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def program(self, name, fault="drift = 0"):
        path = pathlib.Path(self.folder.name) / name
        log = str(path) + ".log"
        path.write_text(PROGRAM.format(python=sys.executable, log=log, fault=fault if "drift" in fault else "drift = 0; " + fault))
        path.chmod(0o755)
        return str(path)

    def run_tool(self, *words):
        return subprocess.run([sys.executable, "-B", tool.__file__, *words], capture_output=True, text=True)

    def test_equal_programs_differ_in_nothing(self):
        ended = self.run_tool("--cases", "60", self.program("old"), self.program("new"))
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertIn("seed 1: 0 differ", ended.stdout)

    def test_one_changed_byte_is_found_wherever_it_is(self):
        faults = {
            "x.exr": ("still", "picture = picture[:-1] if 'law=exact' in text else picture"),
            "output": ("info", "picture = picture[1:]"),
            "errors": ("broken", "error = 'catoptric: box.glb: wanted' if 'cornell-mirrors.obj' in text else error"),
            "exit code": ("film", "code = 70"),
            "out/report.json": ("together", "flip = .25000001"),
        }
        for part, (kind, fault) in faults.items():
            ended = self.run_tool("--cases", "20", "--only", kind, "--", self.program("old"), self.program("new", fault))
            self.assertEqual(ended.returncode, 1, part + ended.stdout + ended.stderr)
            self.assertIn(f"    {part}: ", ended.stdout)
            self.assertNotIn(" 0 differ", ended.stdout.splitlines()[-1])

    def test_a_missing_file_is_found(self):
        texts = tool.differing({"x.exr": b"1", "errors": b""}, {"errors": b""})
        self.assertEqual(texts, ["x.exr: only old"])

    def test_every_value_of_every_knob_is_drawn(self):
        new = self.program("new")
        self.run_tool("--cases", "1", self.program("old"), new)
        commands = pathlib.Path(new + ".log").read_text()
        for setting in ("near:", "far:", "law=none", "law=cone", "law=exact", "face=1", "face=auto"):
            self.assertIn(setting, commands)

    def test_refused_settings_are_drawn_one_by_one(self):
        new = self.program("new", "code = 64 if 'law=' in text and 'face=' in text else 0")
        self.run_tool("--cases", "1", self.program("old", "code = 64 if 'law=' in text and 'face=' in text else 0"), new)
        drawn = [json.loads(line) for line in pathlib.Path(new + ".log").read_text().splitlines()]
        alone = {word.replace(",face=24", "") for words in drawn for word in words if word.startswith("near:")}
        self.assertLessEqual({"near:law=none", "near:law=cone", "near:law=exact"}, alone)

    def test_a_seed_draws_the_same_cases_again(self):
        one, two, three = (self.program(name) for name in ("one", "two", "three"))
        for seed, program in (("5", one), ("5", two), ("6", three)):
            self.run_tool("--seed", seed, "--cases", "1", "--only", "still", "plan", "--", program, program)
        logs = [pathlib.Path(program + ".log").read_text() for program in (one, two, three)]
        self.assertEqual(logs[0], logs[1])
        self.assertNotEqual(logs[0], logs[2])

    def test_times_and_dates_are_left_out(self):
        report = {"date": 1, "rows": [{"gpu_ms": {"median": 1, "ci95": None}, "error": {"flip": .5, "median": 3}}]}
        self.assertEqual(tool.steady(report), {"rows": [{"error": {"flip": .5, "median": 3}}]})

    def test_a_row_that_depends_on_its_place_is_found(self):
        steady = self.run_tool("--orders", "5", self.program("steady"))
        self.assertEqual(steady.returncode, 0, steady.stdout + steady.stderr)
        ended = self.run_tool("--orders", "5", self.program("drifts", "drift = 1e-7"))
        self.assertEqual(ended.returncode, 1, ended.stdout + ended.stderr)
        self.assertIn("differs by its place", ended.stdout)

    def test_a_program_that_is_missing_ends_with_2(self):
        ended = self.run_tool(self.program("old"), os.path.join(self.folder.name, "none"))
        self.assertEqual(ended.returncode, 2)
        self.assertIn("No such file", ended.stderr)


if __name__ == "__main__":
    unittest.main()
