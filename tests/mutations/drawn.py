"""Draws mutants of C++ and GLSL code with universalmutator, builds each, and prints the share that tests notice.

mutate.py drawn [--count N] [--seed S] [--folder F...] [--jobs N] [--most-seconds T] [--again] [--out FILE]

Each folder of code gets a share of the N mutants by its lines, but at least kLeast. A draw chooses a file (weighted by
lines of code), a line of the file, and one mutant of the line. Mutants that do not compile, or that change no
object code and no SPIR-V, are recorded and replaced by another draw. Results are written to FILE
(out/mutants/seed-S.json) after each mutant, so that an interrupted run can continue.

A mutant of C++ is judged by the tests that run its function (reach.py), which a run of all tests finds out first. Tests
that are quick and run much of the function come first, and the first that fails ends the search. Mutants are judged in
--jobs worktrees of the last commit, under out/mutants (judge.py). Tests that would take longer than --most-seconds in
sum are left out, and a mutant that the others do not notice is "undecided". Such mutants, and survivors if there are
new tests, are continued by a later run with --again. Two members of a record in FILE are written by hand: "first" is a
list of tests to run before others, and "equal" says why the mutant does the same as the code, so that no test can
notice it.
"""
import argparse
import contextlib
import io
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import threading
import traceback

import checkout
import reach
from judge import BUILD, JUDGED, Judge

kLeast = 6            # smallest number of mutants of a folder
kMostTries = 12       # largest number of draws per counted mutant of a folder
RULES = ["universal.rules", "c_like.rules"]


def sources():
    """Returns the code files of each folder: {folder: [path]}. Leaves out shaders for tests."""
    listed = subprocess.run(["git", "ls-files", *checkout.CODE], capture_output=True, text=True, check=True).stdout
    folders = {}
    for path in listed.split():
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
    rules = [*RULES, "cpp.rules"] if path.endswith("pp") else RULES
    with contextlib.redirect_stdout(io.StringIO()):
        found = mutator.mutants_regexp(lines, ruleFiles=rules,
                                       ignorePatterns=[r"^\s*(//|///|#|namespace|using |static_assert)"])
    by_line = {}
    for number, text, rule, *_ in found:
        if text != lines[number - 1]:
            by_line.setdefault(number, []).append((text, rule[0]))
    return by_line


def draw(files, seed):
    """Returns a mutant and the new text of its line. The same seed draws the same.

    The mutant is a record: file, line, the text before and after, and the rule."""
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


def report(records, out=sys.stdout):
    """Prints the share of killed mutants by folder, and the mutants that were not noticed.

    Those that do the same as the code ("equal") count as not noticed, because only a reader says that they do."""
    print("| folder | killed | equal | survived | undecided | share | no compile | same code |", file=out)
    print("|---|--:|--:|--:|--:|--:|--:|--:|", file=out)
    folders = sorted({record["folder"] for record in records})
    for folder in [*folders, "all"]:
        count = {}
        for record in records:
            if folder in (record["folder"], "all"):
                outcome = "equal" if "equal" in record else record["outcome"]
                count[outcome] = count.get(outcome, 0) + 1
        killed, judged = count.get("killed", 0), sum(count.get(outcome, 0) for outcome in (*JUDGED, "equal"))
        print(f"| {folder} | {killed} | {count.get('equal', 0)} | {count.get('survived', 0)} | "
              f"{count.get('undecided', 0)} | {f'{killed / judged:.2f}' if judged else ''} | {count.get('does not compile', 0)} | "
              f"{count.get('same code', 0)} |", file=out)
    for record in records:
        if record["outcome"] in ("survived", "undecided"):
            equal = f"equal ({record['equal']})" if "equal" in record else record["outcome"]
            print(f"\n{equal}: {record['file']}:{record['line']}", file=out)
            print(f"-   {record['before']}\n+   {record['after']}", file=out)


class Draws:
    """Hands out the draws of all folders to several judges, and stores their results."""

    def __init__(self, store, code, seed, folders, wanted, again):
        self.store, self.code, self.seed, self.folders, self.wanted = store, code, seed, folders, wanted
        self.records = []
        if os.path.exists(store):
            stored = json.loads(pathlib.Path(store).read_text())
            if stored["code"] != code:
                checkout.fail(f"{store}: wanted mutants of this code, found those of other code; choose another --out")
            self.records = stored["records"]
        self.again = [record for record in self.records if again and "equal" not in record and
                      record["folder"] in folders and record["outcome"] in ("undecided", "survived")]
        self.known = {(record["folder"], record["draw"]): record for record in self.records}
        self.next = dict.fromkeys(folders, 0)
        self.pending = dict.fromkeys(folders, 0)  # judged, or being judged
        self.busy = 0
        self.changed = threading.Condition()

    def draw(self, folder, number):
        return draw(self.folders[folder], f"{self.seed}/{folder}/{number}")

    def take(self):
        """Returns a mutant to be judged, as draw() does, or None if none is left. Waits for results that matter."""
        with self.changed:
            while True:
                if self.again:
                    record = self.again.pop(0)
                    self.busy += 1
                    return record, self.draw(record["folder"], record["draw"])[1]
                # Folders take turns, so that an interrupted run has judged mutants of all folders.
                for folder in sorted(self.folders, key=lambda folder: self.pending[folder] / self.wanted[folder]):
                    wanted, number = self.wanted[folder], self.next[folder]
                    if self.pending[folder] < wanted and number < kMostTries * wanted:
                        self.next[folder] += 1
                        if (folder, number) in self.known:
                            self.pending[folder] += self.known[folder, number]["outcome"] in JUDGED
                            break
                        record, after = self.draw(folder, number)
                        record.update(folder=folder, draw=number)
                        self.pending[folder] += 1
                        self.busy += 1
                        return record, after
                else:
                    if self.busy == 0:
                        return None
                    self.changed.wait()

    def put(self, record):
        """Stores a record that was judged."""
        with self.changed:
            self.busy -= 1
            if (record["folder"], record["draw"]) not in self.known:
                self.records.append(record)
                self.known[record["folder"], record["draw"]] = record
                self.pending[record["folder"]] -= record["outcome"] not in JUDGED
            records = ",\n".join(json.dumps(record) for record in self.records)  # a line each
            pathlib.Path(self.store + ".new").write_text(f'{{"code": "{self.code}", "records": [\n{records}\n]}}\n')
            os.replace(self.store + ".new", self.store)
            print(f"{record['outcome']:16} {record['seconds']:4} s {record.get('by', ''):28} "
                  f"{record['file']}:{record['line']}: {record['after']}", flush=True)
            self.changed.notify_all()


def main(arguments):
    parser = argparse.ArgumentParser(prog="mutate drawn")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--folder", nargs="+", help="only these, for example engine/bvh shaders")
    parser.add_argument("--jobs", type=int, default=max(1, (os.cpu_count() or 1)), help="mutants judged at a time")
    parser.add_argument("--most-seconds", type=float, default=1e9, help="time of tests for a mutant")
    parser.add_argument("--again", action="store_true", help="continue mutants that are undecided or survived")
    parser.add_argument("--out")
    chosen = parser.parse_args(arguments)
    store = chosen.out or f"out/mutants/seed-{chosen.seed}.json"
    os.makedirs(os.path.dirname(store) or ".", exist_ok=True)
    here = checkout.Checkout(".", BUILD)
    here.require_clean()
    reached_file = "out/mutants/reached.json"
    if not os.path.exists(reached_file) or reach.Reach.load(reached_file).code != here.content_id(checkout.CODE):
        print("mutate: runs all tests to see which code each runs", flush=True)
        if not here.make("all"):
            checkout.fail("the code that is right does not build")
        reached, wrong = reach.record(here, chosen.jobs)
        if wrong:
            checkout.fail("tests fail, although no code is wrong:\n" + "\n".join(wrong))
        reached.save(reached_file)
    reached = reach.Reach.load(reached_file)
    folders = {folder: files for folder, files in sources().items() if folder in (chosen.folder or sources())}
    wanted = shares(sources(), chosen.count)
    draws = Draws(store, here.content_id(checkout.CODE), chosen.seed, folders, wanted, chosen.again)
    shaders = here.path(BUILD, "test_cache")
    judges = [Judge(f"out/mutants/tree-{number}", reached, shaders) for number in range(chosen.jobs)]

    def work(judge):
        try:
            while task := draws.take():
                judge.judge(*task, chosen.most_seconds)
                draws.put(task[0])
        except BaseException:
            traceback.print_exc()
            os._exit(2)  # the other judges would wait for a result that never comes

    workers = [threading.Thread(target=work, args=[judge]) for judge in judges]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    report(draws.records)
    return 1 if any(record["outcome"] in ("survived", "undecided") and "equal" not in record
                    for record in draws.records) else 0
