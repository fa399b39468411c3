#!/usr/bin/env python3
"""Tests of rules.py, drawn.py and reach.py: what a rule matches, how mutants are counted, which tests run a line."""
import contextlib
import io
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
import checkout
import drawn
import judge
import reach
import rules

CODE = """
int sum(int a, int b); // int sum(int a, int b) { return a + b; }
int sum(int a, int b) {
    return a + /* and */ b;
}
int difference(int a, int b) noexcept {
    if (b == 0) { return a + b; }
    return a - b;
}
const char* text() { return "a + b } \\" { "; }
"""


class Rules(unittest.TestCase):
    def edited(self, find, replace, function="", text=CODE):
        return rules.apply(rules.Edit("x.cpp", find, replace, function), text, "name")

    def test_a_pattern_matches_whatever_the_white_space_and_comments(self):
        self.assertIn("return a * b;\n}", self.edited("return a+b;", "return a * b;", "sum"))
        self.assertEqual(self.edited("return  a - b", "return b"), self.edited("return a-b", "return b"))

    def test_a_pattern_is_sought_in_the_body_of_the_function_alone(self):
        changed = self.edited("a + b", "a", "difference")
        self.assertIn("if (b == 0) { return a; }", changed)
        self.assertIn("a + /* and */ b", changed)

    def test_tokens_are_compared_whole(self):
        with self.assertRaises(rules.RuleError):
            self.edited("differ", "x")
        self.assertEqual([token for token, _, _ in rules.tokens("a<<=1.5e-3f; // b\n'\\''")], ["a", "<<=", "1.5e-3f", ";", "'\\''"])

    def test_a_pattern_that_occurs_twice_or_not_at_all_is_refused_with_place_and_count(self):
        with self.assertRaisesRegex(rules.RuleError, r"mutation 'name': x.cpp: wanted `a \+ b` once, found it 2 times"):
            self.edited("a + b", "")
        with self.assertRaisesRegex(rules.RuleError, r"x.cpp, function sum: wanted `a - b` once, found it 0 times"):
            self.edited("a - b", "", "sum")

    def test_a_rule_without_a_test_is_refused(self):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write('[[mutation]]\nname = "x"\nwrong = "y"\n[[mutation.edits]]\nfile = "f"\nfind = "a"\nreplace = ""\n')
            file.flush()
            with self.assertRaisesRegex(rules.RuleError, "wanted a name of its own, edits, and a test or a stress row"):
                rules.read(file.name)

    def test_there_are_at_most_forty_rules(self):
        here = os.path.dirname(os.path.abspath(__file__))
        self.assertLessEqual(len(rules.read(os.path.join(here, "rules.toml"))), 40)

    def test_parts_hold_each_rule_once(self):
        listed = {str(i): i for i in range(82)}
        for count in (1, 3, 8, 100):
            parts = [rules.part(listed, number, count) for number in range(1, count + 1)]
            self.assertEqual([name for found in parts for name in found], list(listed))
        for number in (0, 9):
            with self.assertRaisesRegex(rules.RuleError, f"wanted a part from 1/8 to 8/8, found '{number}/8'"):
                rules.part(listed, number, 8)


class Drawn(unittest.TestCase):
    def test_folders_share_the_count_by_their_lines(self):
        lines = {"big": ["a"] * 9, "small": ["a"]}
        before, drawn.code_lines = drawn.code_lines, lambda path: 100
        try:
            self.assertEqual(drawn.shares(lines, 100), {"big": 90, "small": 10})
            self.assertEqual(drawn.shares(lines, 10)["small"], drawn.kLeast)
        finally:
            drawn.code_lines = before

    def test_the_report_counts_only_what_could_be_noticed(self):
        out = io.StringIO()
        records = [{"folder": "a", "outcome": outcome, "file": "f", "line": 1, "before": "x", "after": "y"}
                   for outcome in ["killed"] * 3 + ["survived"] * 2 + ["undecided", "same code", "does not compile"]]
        records[3]["equal"] = "b is 0"
        drawn.report(records, out)
        self.assertIn("| a | 3 | 1 | 1 | 1 | 0.50 | 1 | 1 |", out.getvalue())
        self.assertIn("survived: f:1", out.getvalue())
        self.assertIn("equal (b is 0): f:1", out.getvalue())

    def test_a_draw_is_handed_out_once_and_replaced_if_it_judges_nothing(self):
        before, drawn.draw = drawn.draw, lambda files, seed: ({"file": files[0], "line": 1, "seconds": 0}, seed)
        try:
            with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
                store = os.path.join(folder, "store.json")
                draws = drawn.Draws(store, "code", "s", {"a": ["f"]}, {"a": 2}, again=False)
                first, second = draws.take(), draws.take()
                self.assertEqual((first[1], second[1]), ("s/a/0", "s/a/1"))
                draws.put(dict(first[0], outcome="same code", after=""))
                third = draws.take()
                self.assertEqual(third[1], "s/a/2")
                draws.put(dict(second[0], outcome="killed", after=""))
                draws.put(dict(third[0], outcome="undecided", after=""))
                self.assertIsNone(draws.take())
                with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()) as text:
                    drawn.Draws(store, "other code", "s", {"a": ["f"]}, {"a": 2}, again=False)
                self.assertIn("wanted mutants of this code, found those of other code", text.getvalue())
                # A second run takes up only what is undecided.
                draws = drawn.Draws(store, "code", "s", {"a": ["f"]}, {"a": 2}, again=True)
                self.assertEqual(draws.take()[1], "s/a/2")
                draws.put(dict(third[0], outcome="survived", after=""))
                self.assertIsNone(draws.take())
                # A run of other folders leaves it alone.
                self.assertEqual(drawn.Draws(store, "code", "s", {}, {}, again=True).again, [])
        finally:
            drawn.draw = before


class Reached(unittest.TestCase):
    def test_tests_that_run_the_function_come_in_the_order_of_their_time_for_each_of_its_lines(self):
        lines = {"f.cpp": {"2": ["slow", "quick"], "3": ["slow"], "6": ["other"]},
                 reach.DRAWING: {"1": ["slow", "other"]}}
        found = reach.Reach("code", "tests", {"slow": 10, "quick": 1, "other": 1}, lines)
        text = "int f() {\n    a();\n    b();\n}\nint g() {\n    c();\n}\nint h = 1;\n"
        self.assertEqual([reach.function_around(text, line) for line in (1, 4, 5, 8)], [(1, 4), (1, 4), (5, 7), (8, 1 << 30)])
        self.assertEqual(found.tests_for("f.cpp", 3, text), ["quick", "slow"])
        self.assertEqual(found.tests_for("f.cpp", 5, text), ["other"])
        self.assertEqual(sorted(found.tests_for("f.cpp", 8, text)), ["other", "quick", "slow"])
        self.assertEqual(found.tests_for("g.cpp", 1, text), ["quick", "other", "slow"])
        self.assertEqual(found.tests_for("x.glsl", 1, text), ["other", "slow"])
        # The test that has the name of the source comes first.
        lines["engine/x/slow.cpp"] = lines["f.cpp"]
        self.assertEqual(found.tests_for("engine/x/slow.cpp", 3, text), ["slow", "quick"])

    def test_lines_that_a_program_runs_are_recorded_also_if_a_signal_ends_it(self):
        here = os.path.dirname(os.path.abspath(__file__))
        with tempfile.TemporaryDirectory() as folder:
            os.makedirs(os.path.join(folder, "engine/x"))
            source, program = os.path.join(folder, "engine/x/a.cpp"), os.path.join(folder, "program")
            pathlib.Path(source).write_text("int main(int count, char**) {\n    if (count > 1)\n        return 1;\n"
                                            "    __builtin_trap();\n}\n")
            common = ["g++", "-g1", "-c", "-o"]
            subprocess.run([*common, program + "1.o", "-fsanitize-coverage=trace-pc", source], check=True)
            subprocess.run([*common, program + "2.o", os.path.join(here, "reached.cpp")], check=True)
            subprocess.run(["g++", "-o", program, program + "1.o", program + "2.o"], check=True)
            for arguments in [[], ["x"]]:
                reached = os.path.join(folder, "reached" + "".join(arguments))
                os.mkdir(reached)
                subprocess.run([program, *arguments], env={**os.environ, "CATOPTRIC_REACHED": reached})
                offsets = reach.nonzero_offsets(os.path.join(reached, "program"))
                found = reach.source_lines(program, offsets)
                self.assertIn(("engine/x/a.cpp", 2), found)
                self.assertEqual(("engine/x/a.cpp", 3) in found, bool(arguments))


class Interrupted(unittest.TestCase):
    def test_an_interrupt_restores_the_code_and_ends_the_test_that_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "x.cpp")
            source.write_text("right")
            program = ("import checkout, sys; here = checkout.Checkout(sys.argv[1], 'build')\n"
                       "with here.replaced({'x.cpp': 'wrong'}): here.run(['sh', '-c', 'echo $$ >part; mv part started; sleep 60; :'], 60)")
            process = subprocess.Popen([sys.executable, "-B", "-c", program, folder], stderr=subprocess.DEVNULL,
                                       cwd=pathlib.Path(__file__).parent, preexec_fn=default_interrupt)
            while not pathlib.Path(folder, "started").exists():
                time.sleep(.02)
            self.assertEqual(source.read_text(), "wrong")
            process.send_signal(signal.SIGINT)
            process.wait(timeout=30)
            self.assertEqual(source.read_text(), "right")
            test = pathlib.Path("/proc", pathlib.Path(folder, "started").read_text().strip(), "cwd")
            for _ in range(250):  # The kernel ends a process soon after the signal; the test itself takes 60 s.
                if not test.exists():
                    break
                time.sleep(.02)
            self.assertFalse(test.exists())


def default_interrupt():
    """Lets a process be interrupted, even if this one runs in the background."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


class Compared(unittest.TestCase):
    def test_object_files_differ_if_their_code_does_and_not_if_only_debug_information_does(self):
        with tempfile.TemporaryDirectory() as folder:
            os.makedirs(os.path.join(folder, judge.BUILD))
            source = os.path.join(folder, "a.cpp")

            def compiled(text, name="a"):
                pathlib.Path(source).write_text(text)
                subprocess.run(["g++", "-g", "-c", "-o", os.path.join(folder, judge.BUILD, f"{name}.o"), source], check=True)

            compiled("int f() { return 1; }")
            compiled("int g() { return 3; }", "b")
            for _ in range(2):  # a second start finds what the first has left
                objects = judge.Objects(checkout.Checkout(folder, judge.BUILD))
                compiled("\n\nint f() { return 1; }")
                self.assertFalse(objects.differ())
                compiled("int f() { return 2; }")
                self.assertTrue(objects.differ())
                self.assertFalse(objects.differ(since=time.time_ns()))  # of an earlier mutant
                compiled("int f() { return 1; }")
                self.assertFalse(objects.differ())


if __name__ == "__main__":
    unittest.main()
