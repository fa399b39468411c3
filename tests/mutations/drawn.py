"""Draws mutants of C++ and GLSL code with universalmutator, builds each, runs the tests, and reports the share killed.

mutate.py drawn [--count N] [--seed S] [--folder F...] [--test-seconds T] [--out FILE]

Each folder of code gets a share of the N mutants by its lines, but at least kLeast. A draw chooses a file (weighted by
lines of code), a line of the file, and one mutant of the line. Mutants that do not compile, or that change no
object code and no SPIR-V, are recorded and replaced by another draw. Results are written to FILE
(out/mutants/seed-S.json) after each mutant, so that an interrupted run can continue.
"""
import argparse
import contextlib
import glob
import hashlib
import io
import json
import os
import random
import re
import subprocess
import sys
import time

import checkout

kLeast = 6            # smallest number of mutants of a folder
kMostTries = 12       # largest number of draws per counted mutant of a folder
kStageTests = 3       # time limit of a stage, in multiples of the limit of a test
NOT_RUN = "^(long|clone|fuzz|limits-all)$"
# Stages of tests, cheap and general ones first: the target to build, the tests to run, and the tests to leave out.
STAGES = [("unit_test", "^unit$", "^$"), ("gpu_test", "^gpu/", "^$"), ("reflect_test", "^reflect/", "^$"),
          ("all", "^cli/", "^$"), ("all", ".", "^(unit$|gpu/|reflect/|cli/)")]
RULES = {".cpp": ["universal.rules", "c_like.rules", "cpp.rules"], ".hpp": ["universal.rules", "c_like.rules", "cpp.rules"]}


def sources():
    """Returns the code files of each folder: {folder: [path]}. Leaves out shaders for tests."""
    listed = subprocess.run(["git", "ls-files", *checkout.CODE], capture_output=True, text=True, check=True).stdout.split()
    folders = {}
    for path in listed:
        if not re.search(r"\.(cpp|hpp|glsl|frag|vert|comp)$", path) or path.startswith("shaders/tests/"):
            continue
        parts = path.split("/")
        folder = parts[0] if parts[0] == "shaders" else "/".join(parts[:2])
        if "." not in folder and folder not in ("samples/scenes", "samples/embedded"):
            folders.setdefault(folder, []).append(path)
    return {folder: files for folder, files in folders.items()
            if folder.startswith(("engine/", "shaders")) or folder in ("samples/catoptric", "samples/view")}


def code_lines(path):
    """Returns the number of lines that hold code."""
    return sum(1 for line in open(path, encoding="utf-8") if line.strip() and not line.strip().startswith("//"))


def shares(folders, count):
    """Returns how many mutants each folder gets."""
    lines = {folder: sum(map(code_lines, files)) for folder, files in folders.items()}
    return {folder: max(kLeast, round(count * of / sum(lines.values()))) for folder, of in lines.items()}


def mutants_of(path):
    """Returns the mutants of a file by line: {number from 1: [(text of the line, rule)]}."""
    from universalmutator import mutator
    lines = open(path, encoding="utf-8").read().splitlines(keepends=True)
    with contextlib.redirect_stdout(io.StringIO()):
        found = mutator.mutants_regexp(lines, ruleFiles=RULES.get(os.path.splitext(path)[1], ["universal.rules", "c_like.rules"]),
                                       ignorePatterns=[r"^\s*(//|///|#|namespace|using |static_assert)"])
    by_line = {}
    for number, text, rule in found:
        if text != lines[number - 1]:
            by_line.setdefault(number, []).append((text, rule[0]))
    return by_line


def draw(files, seed):
    """Returns a mutant as a record: file, line, the text before and after, and the rule. The same seed draws the same."""
    chance = random.Random(seed)
    while True:
        path = chance.choices(files, weights=map(code_lines, files))[0]
        by_line = mutants_of(path)
        if by_line:
            break
    line = chance.choice(sorted(by_line))
    after, rule = chance.choice(by_line[line])
    before = open(path, encoding="utf-8").read().splitlines(keepends=True)[line - 1]
    return {"file": path, "line": line, "before": before.strip(), "after": after.strip(), "rule": rule}, after


class Objects:
    """Hashes of the object files of a build. SPIR-V is compiled into these files."""

    def __init__(self):
        self.known = {}
        self.baseline = self.hashes()

    def hashes(self):
        for path in glob.glob(f"{checkout.BUILD}/**/*.o", recursive=True):
            stamp = os.stat(path).st_mtime_ns
            if self.known.get(path, (0, ""))[0] != stamp:
                self.known[path] = (stamp, hashlib.sha1(open(path, "rb").read()).hexdigest())
        return {path: value for path, (_, value) in self.known.items()}

    def differ(self):
        """Returns whether some object file differs from that of the correct code. Object files of tests count too."""
        now = self.hashes()
        return any(now[path] != value for path, value in self.baseline.items())


def judge(record, objects, test_seconds):
    """Builds the mutant in the checkout and runs the tests until one fails. Adds "outcome" and "by" to the record.

    A test that takes longer than test_seconds fails."""
    first = True
    for target, tests, left_out in STAGES:
        targets = [target, "catoptric_cli", "catoptric-view"] if record["file"].startswith("samples/") else [target]
        if not checkout.build(*targets):
            # A later target can only fail in code that no earlier target compiles.
            return record.update(outcome="does not compile")
        if first and not objects.differ():
            return record.update(outcome="same code")
        first = False
        code, output = checkout.run(["nice", "ctest", "--test-dir", checkout.BUILD, "-j2", "--stop-on-failure", "--timeout",
                                     str(test_seconds), "-R", tests, "-E", left_out, "-LE", NOT_RUN],
                                    kStageTests * test_seconds)
        if code != 0:
            failed = re.search(r"(\S+) \.+\s*\**(Failed|Timeout|Exception|Subprocess|Not Run)", output)
            return record.update(outcome="killed", by=failed[1] if failed else f"{tests} ended with {code}")
    record.update(outcome="survived")


def report(records, out=sys.stdout):
    """Prints the share of killed mutants by folder, and the mutants that survived."""
    print("| folder | killed | survived | share | no compile | same code |\n|---|--:|--:|--:|--:|--:|", file=out)
    folders = sorted({record["folder"] for record in records})
    for folder in [*folders, "all"]:
        count = {}
        for record in records:
            if folder in (record["folder"], "all"):
                count[record["outcome"]] = count.get(record["outcome"], 0) + 1
        killed, survived = count.get("killed", 0), count.get("survived", 0)
        share = f"{killed / (killed + survived):.2f}" if killed + survived else ""
        print(f"| {folder} | {killed} | {survived} | {share} | {count.get('does not compile', 0)} | "
              f"{count.get('same code', 0)} |", file=out)
    for record in records:
        if record["outcome"] == "survived":
            print(f"\nsurvived: {record['file']}:{record['line']}\n-   {record['before']}\n+   {record['after']}", file=out)


def main(arguments):
    parser = argparse.ArgumentParser(prog="mutate drawn")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--folder", nargs="+", help="only these, for example engine/bvh shaders")
    parser.add_argument("--test-seconds", type=int, default=300, help="time limit of a test; more on a busy machine")
    parser.add_argument("--out")
    chosen = parser.parse_args(arguments)
    store = chosen.out or f"out/mutants/seed-{chosen.seed}.json"
    checkout.require_clean()
    checkout.BUILD = "build/mutants"
    folders = sources()
    wanted = shares(folders, chosen.count)
    records = json.load(open(store)) if os.path.exists(store) else []
    known = {(record["folder"], record["draw"]): record for record in records}
    if not checkout.build("all"):
        checkout.fail("the code that is right does not build")
    objects = Objects()
    os.makedirs(os.path.dirname(store) or ".", exist_ok=True)
    # Folders take turns, so that an interrupted run has judged mutants of all folders.
    counted, draws = dict.fromkeys(folders, 0), dict.fromkeys(folders, 0)
    while True:
        open_folders = [folder for folder in folders if counted[folder] < wanted[folder]
                        and draws[folder] < kMostTries * wanted[folder] and folder in (chosen.folder or folders)]
        if not open_folders:
            break
        for folder in open_folders:
            number = draws[folder]
            draws[folder] += 1
            record = known.get((folder, number))
            if record is None:
                begin = time.monotonic()
                record, after = draw(folders[folder], f"{chosen.seed}/{folder}/{number}")
                lines = open(record["file"], encoding="utf-8").read().splitlines(keepends=True)
                lines[record["line"] - 1] = after
                with checkout.replaced({record["file"]: "".join(lines)}):
                    judge(record, objects, chosen.test_seconds)
                record.update(folder=folder, draw=number, seconds=round(time.monotonic() - begin))
                records.append(record)
                json.dump(records, open(store + ".new", "w"), indent=1)
                os.replace(store + ".new", store)
                print(f"{record['outcome']:16} {record.get('by', ''):28} {record['file']}:{record['line']}: {record['after']}",
                      flush=True)
            counted[folder] += record["outcome"] in ("killed", "survived")
    checkout.build("all")
    report(records)
    judged = [record for record in records if record["outcome"] in ("killed", "survived")]
    return 1 if any(record["outcome"] == "survived" for record in judged) else 0
