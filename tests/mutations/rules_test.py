#!/usr/bin/env python3
"""Tests of rules.py and drawn.py: what a rule matches and refuses, how folders share mutants, and the report."""
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import drawn
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
        import io
        out = io.StringIO()
        drawn.report([{"folder": "a", "outcome": outcome, "file": "f", "line": 1, "before": "x", "after": "y"}
                      for outcome in ["killed"] * 3 + ["survived", "same code", "does not compile"]], out)
        self.assertIn("| a | 3 | 1 | 0.75 | 1 | 1 |", out.getvalue())
        self.assertIn("survived: f:1", out.getvalue())


if __name__ == "__main__":
    unittest.main()
