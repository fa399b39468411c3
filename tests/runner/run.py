#!/usr/bin/env python3
"""Runs the tests of all labels, or those that a change can touch. Called by ./dev, from the top of a built checkout.

run.py all [LABEL...] [--again]            runs each test, or each of these labels, that has not passed on this tree
run.py touched [BASE] [--minutes N] [--again]
                                           runs the tests that the paths changed since BASE can touch, for about N
                                           minutes (30): near tests first, then those that wait longest. BASE: HEAD, or
                                           HEAD~1 in a clean checkout.
run.py labels all|touched ...              prints the labels that these runs use
run.py packages LABEL...                   prints the Debian packages that these labels need and the machine lacks
run.py check                               checks table.py, and prints how old the last green run of each label is

A test that passed on this tree is not run again, without --again. tests/last-run.json records each label whose tests
all ran on this tree. Exit codes: 0 no test failed, 1 a test failed, 2 nothing was run, 130 or 143 interrupted.
"""
import argparse
import collections
import fcntl
import hashlib
import json
import os
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
import records
import table
import tests as ctest

UNKNOWN = 30  # seconds of a test that never ran


class Stop(Exception):
    """A signal asks the runner to end."""


def fail(text):
    print(f"test: {text}", file=sys.stderr)
    sys.exit(2)


def minutes(seconds):
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"


def changed_paths(top, base=""):
    """Returns the paths that differ between the commit `base` and the working tree."""
    dirty = records.git(top, "status", "--porcelain", "--", ".", f":!{records.FILE}")
    try:
        base = records.git(top, "merge-base", base or ("HEAD" if dirty else "HEAD~1"), "HEAD")
    except subprocess.CalledProcessError:
        fail(f"wanted a commit, found no '{base or 'HEAD~1'}'; try: git log")
    listed = records.git(top, "diff", "--name-only", base) + "\n" + \
        records.git(top, "ls-files", "--others", "--exclude-standard")
    return sorted({path for path in listed.splitlines() if path and path != records.FILE})


class Runner:
    """Runs tests of a build, keeps their results and says how long the rest takes."""

    def __init__(self, top, build, jobs=2, again=False):
        self.top, self.jobs, self.again = top, jobs, again
        self.tests = ctest.of_build(build)
        self.sizes = collections.Counter(label for test in self.tests for label in test.labels)
        self.folder = os.path.join(build, "runner")
        os.makedirs(os.path.join(self.folder, "logs"), exist_ok=True)
        self.lock = open(os.path.join(self.folder, "lock"), "w")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            fail(f"another run uses {build}; wait for its end")
        self.results = records.Results(os.path.join(self.folder, "results.jsonl"))
        if again:
            self.results.forget()
        self.records = records.Records(top)
        self.tree = records.tree_of(top)

    def log(self, test):
        return os.path.join(self.folder, "logs", f"{test.file_name}.log")

    def expected(self, test):
        """Returns the seconds that a test took last time here, else its share of a label's recorded time."""
        if row := self.results.of.get(test.name):
            return row["seconds"]
        record = self.records.of.get(test.labels[0])
        return record["seconds"] / self.sizes[test.labels[0]] if record else UNKNOWN

    def estimate(self, chosen):
        """Returns about how many seconds tests take, several at once."""
        alone = sum(self.expected(test) for test in chosen if test.alone)
        beside = [self.expected(test) for test in chosen if not test.alone]
        return alone + max([sum(beside) / self.jobs, *beside], default=0)

    def passed(self, test):
        row = self.results.of.get(test.name)
        return bool(row) and row["tree"] == self.tree and row["result"] == "passed"

    def remaining(self, chosen):
        """Returns the tests that have not passed on this tree, here or as the tree's record says."""
        def recorded(test):
            return not self.again and all(self.records.is_green(label, self.tree) for label in test.labels)
        return [test for test in chosen if not self.passed(test) and not recorded(test)]

    def fit(self, near, seconds):
        """Splits tests ({name: whether near}) into those to run in the time, and the rest.

        Order: quick near tests, other quick tests, near tests, tests whose last run is oldest."""
        def order(test):
            quick = not test.slow and not table.OUTSIDE & set(test.labels)
            rank = (0 if near[test.name] else 1) if quick else 2 if near[test.name] else 3
            row = self.results.of.get(test.name)
            return rank, row["date"] if row else "", hashlib.sha1((self.tree + test.name).encode()).digest()
        chosen, rest = [], []
        for test in sorted((test for test in self.tests if test.name in near), key=order):
            fits = self.passed(test) or self.estimate(self.remaining([*chosen, test])) <= seconds
            (chosen if fits else rest).append(test)
        return chosen, rest

    def store(self, test, outcome, seconds):
        """Keeps a result. Ends the run if the tree changed while the test ran."""
        if (present := records.tree_of(self.top)) != self.tree:
            raise Stop(f"the tree changed ({self.tree[:10]} to {present[:10]}) while {test.name} ran: run again", 2)
        self.results.add(test.name, self.tree, outcome, seconds)
        for label in test.labels:
            self.record(label)

    def record(self, label):
        """Records a label in the tree if all its tests ran on this tree."""
        tests = [test for test in self.tests if label in test.labels]
        rows = self.results.on(self.tree, tests)
        if tests and len(rows) == len(tests):
            self.records.set(label, self.tree, records.summary(rows))

    def queue(self, chosen):
        """Returns tests in the order to run: label by label, long tests first, those that run alone last."""
        labels = list(table.LABELS)
        place = lambda label: labels.index(label) if label in labels else len(labels)
        return sorted(chosen, key=lambda test: (place(test.labels[0]), test.alone, -self.expected(test)))

    def run(self, chosen):
        """Runs tests. A signal ends it within two seconds by Stop; the results so far stay."""
        queue, running, done, count = self.queue(chosen), [], 0, len(chosen)
        signals = []  # looked at between tests, so that none is lost while it starts or is stored
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, lambda number, _: signals.append(number))
        lacking = {label: table.missing_packages(label) for test in chosen for label in test.labels}
        try:
            while queue or running:
                if signals:
                    raise Stop(signal.Signals(signals[0]).name, 128 + signals[0])
                while queue and len(running) < self.jobs and not any(run.test.alone for run in running) and \
                        not (queue[0].alone and running):
                    test = queue.pop(0)
                    missing = [package for label in test.labels for package in lacking[label]]
                    if missing or not test.command:
                        done += 1
                        outcome = ctest.Outcome("not run", f"Debian package {', '.join(missing)} is not installed") \
                            if missing else ctest.Outcome("failed", "its program is not built")
                        self.store(test, outcome, 0)
                        print(f"[{done}/{count}] {outcome.result:7} {test.name}: {outcome.reason}", flush=True)
                        continue
                    running.append(ctest.Run(test, self.log(test)))
                for run in running[:]:
                    if (outcome := run.poll()) is None:
                        continue
                    running.remove(run)
                    self.store(run.test, outcome, run.seconds)
                    done += 1
                    left = self.estimate([*queue, *(other.test for other in running)])
                    print(f"[{done}/{count}] {outcome.result:7} {run.test.name} {run.seconds:.1f} s"
                          f"{': ' + outcome.reason if outcome.reason else ''} ({minutes(left)} left)", flush=True)
                time.sleep(.05)
        finally:
            ctest.end(running)


def say_summary(runner, chosen, rest):
    """Prints a table of labels, each test that failed or did not run, and the counts. Returns the counts."""
    total = collections.Counter()
    print(f"{'label':12} {'tests':>6} {'passed':>7} {'failed':>7} {'not run':>8} {'seconds':>8}")
    for label in sorted({test.labels[0] for test in chosen}, key=list(table.LABELS).index):
        tests = [test for test in chosen if test.labels[0] == label]
        rows = runner.results.on(runner.tree, tests)
        counts, note = records.summary(rows), ""
        if len(rows) < len(tests):
            note = f"  {len(tests) - len(rows)} wait"
            if not runner.again and runner.records.is_green(label, runner.tree):
                counts, note = runner.records.of[label], f"  on {runner.records.of[label]['date']}"
        total.update({key: counts[key] for key in ("passed", "failed", "not_run")})
        print(f"{label:12} {len(tests):6} {counts['passed']:7} {counts['failed']:7} {counts['not_run']:8} "
              f"{counts['seconds']:8}{note}")
    for test in chosen:
        for row in runner.results.on(runner.tree, [test]):
            for text in records.shortfalls(row):
                print(text, runner.log(test) if row["result"] == "failed" else "")
    if rest:
        labels = sorted({test.labels[0] for test in rest}, key=list(table.LABELS).index)
        print(f"not run: {len(rest)} tests of {', '.join(labels)}: beyond the time, "
              f"{minutes(runner.estimate(rest))} more: ./dev test --all")
    print(f"test: {total['passed']} passed, {total['failed']} failed, {total['not_run'] + len(rest)} not run")
    return records.summary(runner.results.on(runner.tree, chosen))


def run_tests(options):
    top, start = os.getcwd(), time.monotonic()
    runner = Runner(top, options.build, options.jobs, options.again)
    rest, chosen = [], runner.tests
    if options.verb == "all" and options.words:
        chosen = [test for test in runner.tests if set(options.words) & set(test.labels)]
    if options.verb == "touched":
        paths = changed_paths(top, *options.words)
        try:
            near = table.touched(paths, runner.tests)
        except KeyError as path:
            fail(f"no row of tests/runner/table.py matches the path {path}; add one")
        chosen, rest = runner.fit(near, options.minutes * 60)
        print(f"test: {len(paths)} paths changed, which can touch {len(near)} tests, "
              f"{minutes(runner.estimate([*chosen, *rest]))}")
    left = runner.remaining(chosen)
    unknown = sum(test.name not in runner.results.of for test in left)
    print(f"test: {len(left)} of {len(chosen)} tests to run on tree {runner.tree[:10]}, about "
          f"{minutes(runner.estimate(left))}{f' ({unknown} have never run here)' if unknown else ''}", flush=True)
    code = 0
    try:
        runner.run(left)
    except Stop as stop:
        print(f"test: stopped: {stop.args[0]}. The results stay; the same command runs the rest.", file=sys.stderr)
        code = stop.args[1]
    for label in table.LABELS:
        runner.record(label)
    counts = say_summary(runner, chosen, rest)
    if options.verb == "touched" and not code:
        runner.records.set("touched", runner.tree, {**counts, "left_out": len(rest)})
    print(f"test: took {minutes(time.monotonic() - start)}")
    return code or (1 if counts["failed"] else 0)


def check(options):
    """Checks the table against the tree and the build, then prints ages of runs."""
    top = os.getcwd()
    with open("CMakePresets.json", encoding="utf-8") as file:
        presets = json.load(file)["testPresets"]
    suite = next(preset for preset in presets if preset["name"] == "suite")["filter"]["exclude"]["label"]
    paths = records.git(top, "ls-files", "--cached", "--others", "--exclude-standard").splitlines()
    wrong = table.faults(ctest.of_build(options.build), [path for path in paths if os.path.lexists(path) and path != records.FILE],
                         set(suite.strip("^()$").split("|")))
    for text in wrong:
        print(f"check: tests/runner/table.py: {text}", file=sys.stderr)
    print("last green run of each label (./dev test --all):", *records.Records(top).ages(table.LABELS), sep="\n  ")
    return 1 if wrong else 0


def refuse_words(verb, words):
    """Ends the program if the words after a verb are no labels, or more than a commit."""
    for word in words if verb == "all" else words[1:]:
        if verb != "all" or word not in table.LABELS:
            fail(f"{verb}: wanted {'labels of ' + ', '.join(table.LABELS) if verb == 'all' else 'one commit'}, "
                 f"found '{word}'")


def main():
    parser = argparse.ArgumentParser(prog="./dev test", usage=__doc__)
    parser.add_argument("verb", choices=["all", "touched", "labels", "packages", "check"])
    parser.add_argument("words", nargs="*")
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--build", default="build/ci")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    if options.verb == "packages":
        print(*sorted({package for label in options.words for package in table.missing_packages(label)}), sep="\n")
        return 0
    if options.verb == "labels":
        of, options.words = options.words[0], options.words[1:]
        refuse_words(of, options.words)
        if of == "touched":
            print(*table.labels_of(changed_paths(os.getcwd(), *options.words)), sep="\n")
        else:
            print(*(options.words or table.LABELS), sep="\n")
        return 0
    refuse_words(options.verb, options.words)
    if options.verb == "check":
        return check(options)
    return run_tests(options)


if __name__ == "__main__":
    sys.exit(main())
