#!/usr/bin/env python3
"""Repeats a comparison beside busy programs, and says which first sentences contradict each other.

runs.py CATOPTRIC OUT [--runs N] [--busy N] -- SCENE OPTION...

The words after `--` are those of `compare`, without `-o`. While it runs, `--busy` processes use the processors without
end. Two runs contradict each other if one says that ray tracing beats a row and the other that it does not, or if both
name the fastest rows and have none in common. That a verdict is missing contradicts nothing. Writes OUT/runs.json, and
prints how often each sentence was said. The exit code is 1 if two runs contradict each other.
"""
import argparse
import collections
import itertools
import json
import pathlib
import subprocess
import sys


def measure(program, folder, words):
    """Runs one comparison. Returns the verdict of its report, and the number of noisy rows."""
    ended = subprocess.run([program, "compare", *words, "-o", str(folder), "-q"], capture_output=True, text=True, check=False)
    if ended.returncode not in (0, 1):  # 1: no row keeps a budget
        raise RuntimeError(f"exit code {ended.returncode}\n{ended.stderr}")
    report = json.loads((folder / "report.json").read_text())
    return report["verdict"] | {"noisy": sum(row["noisy"] for row in report["rows"]), "rows": len(report["rows"]),
                                "judged_time": report["judged_time"]}


def find_contradictions(one, other):
    """Returns what one run says and another denies."""
    found = []
    for a, b in ((one, other), (other, one)):
        for row in sorted(set(a["ray_tracing"]["beats"]) & set(b["ray_tracing"]["does_not_beat"])):
            found.append(f"ray tracing beats {row}, and does not beat it")
    names_fastest = one["fastest_are_equal"] and other["fastest_are_equal"]
    if names_fastest and not set(one["fastest"]) & set(other["fastest"]):
        found.append(f"fastest: {', '.join(one['fastest'])}, and {', '.join(other['fastest'])}")
    return found


def main():
    own, words = sys.argv[1:], []
    if "--" in own:
        own, words = own[:own.index("--")], own[own.index("--") + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--busy", type=int, default=2, help="processes that use the processors without end")
    options = parser.parse_args(own)
    options.folder.mkdir(parents=True, exist_ok=True)
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(options.busy)]
    try:
        runs = [measure(options.program, options.folder / "run", words) for _ in range(options.runs)]
    finally:
        for process in busy:
            process.kill()
    contradictions = [{"runs": [i, k], "what": what} for (i, one), (k, other) in itertools.combinations(enumerate(runs, 1), 2)
                      for what in find_contradictions(one, other)]
    (options.folder / "runs.json").write_text(json.dumps({"words": words, "busy": options.busy, "runs": runs,
                                                          "contradictions": contradictions}, indent=1) + "\n")
    for text, count in collections.Counter(run["text"] for run in runs).most_common():
        print(f"{count} of {len(runs)}: {text}")
    print(f"noisy rows: {sum(run['noisy'] for run in runs)} of {sum(run['rows'] for run in runs)}; "
          f"{len(contradictions)} contradictions")
    for one in contradictions:
        print(f"runs {one['runs'][0]} and {one['runs'][1]}: {one['what']}")
    return 1 if contradictions else 0


if __name__ == "__main__":
    sys.exit(main())
