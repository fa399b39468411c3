#!/usr/bin/env python3
"""Counts right and wrong verdicts of `compare --baseline` on a known slowdown of one pass, and on none.

trials.py CATOPTRIC OUT [--trials N] [--frames N] [--rounds N] [--ratio R] [--work] [--technique T] [--pass P] [--knob K --before A --now B]

A trial measures a row three times: the baseline with the knob's value A, the same settings again, and the value B,
which makes one pass slower. The label of the baseline's row is rewritten for the third run, so that the gate takes it
for the same row. By default the pass `raytrace` takes 15 instead of 13 samples per pixel, which visits 15.5 % more BVH
nodes. Writes OUT/trials.json, and prints how often each quantity got each verdict. OUT keeps the reports of the last
trial. A trial takes about 10 s of processor time with llvmpipe.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import xml.etree.ElementTree

VERDICTS = ("worse", "unknown", "kept")


def compare(program, folder, technique, options, baseline=None):
    """Runs one comparison. Returns its report, and the verdict of each quantity if there is a baseline."""
    folder.mkdir(exist_ok=True)
    command = [program, "compare", options.scene, "-o", str(folder), "-q", "--size", options.size, "--frames",
               str(options.frames), "--rounds", str(options.rounds), "--warmup", "4", "--reference", "raytrace:depth=16,samples=16", "--techniques", technique]
    if options.work:
        command.append("--work")
    if baseline:
        command += ["--baseline", str(baseline), "--max-time-ratio", str(options.ratio), "--junit", str(folder / "junit.xml")]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    if ended.returncode not in ((0, 1) if baseline else (0,)):
        raise RuntimeError(f"{' '.join(command)}: exit code {ended.returncode}\n{ended.stderr}")
    report = json.loads((folder / "report.json").read_text())
    if not baseline:
        return report, {}
    verdicts = {}
    for case in xml.etree.ElementTree.parse(folder / "junit.xml").iter("testcase"):
        verdicts[case.get("name")] = ("worse" if case.find("failure") is not None else
                                      "unknown" if case.find("skipped") is not None else "kept")
    return report, verdicts


def pass_time(report, name):
    for one in report["rows"][0]["passes"]:
        if one["name"] == name:
            return one["gpu_ms"]["median"]
    raise RuntimeError(f"wanted the pass '{name}', found {[one['name'] for one in report['rows'][0]['passes']]}")


def count_verdicts(trials, kind, quantity):
    """Returns the number of trials with each verdict on a quantity."""
    found = [trial[kind].get(quantity) for trial in trials]  # a short pass is not judged in every trial
    return {verdict: found.count(verdict) for verdict in VERDICTS}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--trials", type=int, default=20)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--scene", default="cornell-mirrors")
    parser.add_argument("--size", default="64x64")
    parser.add_argument("--technique", default="raytrace")
    parser.add_argument("--pass", dest="pass_name", default="raytrace", help="the pass that the knob makes slower")
    parser.add_argument("--knob", default="samples")
    parser.add_argument("--before", default="13")
    parser.add_argument("--now", default="15")
    parser.add_argument("--work", action="store_true", help="also judge counted work, which repeats on a busy machine")
    parser.add_argument("--ratio", type=float, default=1.1, help="--max-time-ratio of the gate")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    before, now = (f"{options.technique}:{options.knob}={value}" for value in (options.before, options.now))
    trials = []
    for number in range(1, options.trials + 1):
        base, _ = compare(options.program, options.folder / "base", before, options)
        base_file = options.folder / "base" / "report.json"
        same, same_verdicts = compare(options.program, options.folder / "same", before, options, base_file)
        renamed = json.loads(base_file.read_text())
        renamed["rows"][0]["label"] = now
        renamed_file = options.folder / "renamed.json"
        renamed_file.write_text(json.dumps(renamed))
        slow, slow_verdicts = compare(options.program, options.folder / "slow", now, options, renamed_file)
        trials.append({"same": same_verdicts, "slow": slow_verdicts,
                       "noisy": [report["rows"][0]["noisy"] for report in (base, same, slow)],
                       "pass_ms": [pass_time(report, options.pass_name) for report in (base, same, slow)]})
        worse = {kind: [name for name, verdict in trials[-1][kind].items() if verdict == "worse"] for kind in ("same", "slow")}
        print(f"trial {number}: noisy {trials[-1]['noisy']}, {options.pass_name} "
              f"{' '.join(format(ms, '.2f') for ms in trials[-1]['pass_ms'])} ms, worse: {worse}", flush=True)
        (options.folder / "trials.json").write_text(json.dumps(
            {"before": before, "now": now, "pass": options.pass_name, "ratio": options.ratio, "frames": options.frames,
             "device": base["device"], "trials": trials}, indent=1) + "\n")
    quantities = sorted(set().union(*(trial[kind] for trial in trials for kind in ("same", "slow"))))
    print(f"\n{len(trials)} trials, {sum(any(trial['noisy']) for trial in trials)} with a run that other programs disturbed")
    for name, index in (("same", 1), ("slow", 2)):
        ratios = [trial["pass_ms"][index] / trial["pass_ms"][0] for trial in trials]
        print(f"time of {options.pass_name}, {name} / baseline: median {statistics.median(ratios):.3f}, "
              f"{min(ratios):.3f} to {max(ratios):.3f}")
    print("\n| settings | quantity | worse | unknown | kept |\n|---|---|--:|--:|--:|")
    for kind in ("same", "slow"):
        for quantity in quantities:
            counts = count_verdicts(trials, kind, quantity)
            if quantity.startswith("work: ") and all(count_verdicts(trials, both, quantity)["kept"] == len(trials)
                                                     for both in ("same", "slow")):
                continue  # a count that the slower settings leave as it is
            print(f"| {kind} | {quantity} | " + " | ".join(str(counts[verdict]) for verdict in VERDICTS) + " |")


if __name__ == "__main__":
    main()
