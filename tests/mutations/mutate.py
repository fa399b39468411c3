#!/usr/bin/env python3
"""Shows that the tests notice wrong code. Called by `./dev mutate`, from the top of a checkout that is built in build/ci.

mutate.py check            checks that each rule of rules.toml still fits the code; changes nothing
mutate.py run [NAME...]    applies the rules, or those named (by name or stress row), one after the other; the test or
                           stress row of each must fail
mutate.py run K/N          the same for the Kth of N parts of the rules
mutate.py drawn ...        tests mutants that a tool draws at random; see drawn.py

Exit codes: 0 all were noticed, 1 some were not, 2 nothing could be judged.
"""
import os
import re
import sys

sys.dont_write_bytecode = True
import checkout
import drawn
import rules

HERE = checkout.Checkout(".", "build/ci")
RULES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rules.toml")


def texts_with(rule):
    """Returns the text of each file that the rule changes, by path. Raises RuleError if it does not fit the code."""
    texts = {}
    for edit in rule.edits:
        before = texts.get(edit.file)
        if before is None:
            try:
                before = open(edit.file, encoding="utf-8").read()
            except FileNotFoundError:
                raise rules.RuleError(f"mutation '{rule.name}': there is no file {edit.file}") from None
        texts[edit.file] = rules.apply(edit, before, rule.name)
    return texts


def check(listed):
    """Prints the rules that no longer fit. Returns how many there are."""
    wrong = 0
    for rule in listed.values():
        try:
            texts_with(rule)
        except rules.RuleError as error:
            print(error, file=sys.stderr)
            wrong += 1
    return wrong


def fails_test(rule):
    """Runs the rule's tests. Returns the name of a failed test, or an empty text if all pass."""
    program, tests = rule.test.split(maxsplit=1)
    if not HERE.make(program):
        checkout.fail(f"{rule.name} does not compile")
    code, output = HERE.run([f"{HERE.build}/{program}", f"--gtest_filter={tests}"], 1800)
    if "Running 0 tests" in output:
        checkout.fail(f"{rule.name}: {program} has no test {tests}")
    failed = re.search(r"\[  FAILED  \] (\w[\w/]*\.[\w/]*)", output)
    return "" if code == 0 else failed[1] if failed else f"{tests} ends with {code}"


def fails_row(rule):
    """Runs the rule's stress row on small pictures. Returns the measured value and limit, or "" if the row passes."""
    if not HERE.make("catoptric_cli"):
        checkout.fail(f"{rule.name} does not compile")
    command = [f"{HERE.build}/catoptric", "stress", "--quiet", "--size", "128x128", "--only", rule.row]
    code, output = HERE.run(command, 1800)
    row = next((line.split() for line in output.splitlines() if line.split()[:1] == [rule.row]), None)
    if row is None or code not in (0, 1):
        checkout.fail(f"{rule.name}: stress row {rule.row} ended with {code}:\n{output}")
    return f"{rule.row}: {row[2]} of {row[3]}" if row[1] == "fail" else ""


def apply_all(listed):
    """Applies one rule after the other. Returns the names of the rules that no test noticed."""
    HERE.require_clean()
    unnoticed = []
    for rule in listed:
        with HERE.replaced(texts_with(rule)):
            failed = fails_row(rule) if rule.row else fails_test(rule)
        print(f"{rule.name:28} {'red    ' + failed if failed else 'GREEN  ' + (rule.row or rule.test)}", flush=True)
        if not failed:
            unnoticed.append(rule.name)
    HERE.make("all")
    return unnoticed


def main():
    verb, names = (sys.argv[1:2] or [""])[0], sys.argv[2:]
    if verb == "drawn":
        return drawn.main(names)
    try:
        listed = rules.read(RULES)
        if verb == "check":
            return 2 if check(listed) else 0
        if verb != "run":
            checkout.fail(f"wanted check, run or drawn, found '{verb}'")
        if part := re.fullmatch(r"(\d+)/(\d+)", " ".join(names)):
            names, listed = [], rules.part(listed, *map(int, part.groups()))
        chosen = [rule for rule in listed.values() if not names or rule.name in names or rule.row in names]
        for name in names:
            if not any(name in (rule.name, rule.row) for rule in chosen):
                checkout.fail(f"there is no mutation and no stress row '{name}' in {RULES}")
        unnoticed = apply_all(chosen)
    except rules.RuleError as error:
        checkout.fail(str(error))
    if unnoticed:
        print("mutate: nothing noticed", ", ".join(unnoticed), file=sys.stderr)
    return 1 if unnoticed else 0


if __name__ == "__main__":
    sys.exit(main())
