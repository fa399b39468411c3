#!/usr/bin/env bash
# run.sh CATOPTRIC SAMPLES WORK: runs a small sweep by Snakemake with two jobs, kills one of its processes, and expects
# the tables that a single process writes. Runs it as a job of Open Job Description, too. SAMPLES: samples/sweep.
set -euo pipefail
name=sweep catoptric=$1 snakefile=$2/Snakefile template=$2/openjd.yaml work=$3
source "$(dirname "$0")/steps.sh"
command -v snakemake >/dev/null || die "wanted snakemake; ./dev test --label sweep installs it"
rm -rf "$work"; mkdir -p "$work"; cd "$work"
cat >sweep.json <<'END'
{"scenes": ["cornell-mirrors", "flat"], "techniques": ["reuse:face=32", "secant:face=32"],
 "options": {"size": "48x48", "frames": 6, "warmup": 1}, "views": {"count": 20, "seed": 5}, "timing": {"repeats": 1}}
END
run_in_one_process

run() { # run OPTION...
    snakemake -s "$snakefile" --cores 2 --resources machine=1 --nolock "$@" \
        --config sweep=shared out=shared-merged catoptric="$catoptric" batch=4
}
stop_a_job() {
    local program
    program=$(pgrep -f "^$catoptric sweep run shared" | head -n 1) || die "found no program to kill: $(cat first.log)"
    kill -KILL "$program"
}
run_and_stop_a_job
run >third.log 2>&1 || die "the third run failed"
grep -q 'Nothing to be done' third.log || die "a third run had work to do: $(cat third.log)"
rm "$(ls shared/results/*.json | head -n 1)" shared-merged/merged.json
run >fourth.log 2>&1 || die "a deleted result was not made again: $(cat fourth.log)"
cmp single-merged/merged.json shared-merged/merged.json || die "merged.json differs after a deleted result"
echo "sweep: 42 pieces by Snakemake, one job killed: same bytes as a single process"

# The same sweep as a job of Open Job Description.
python3 -m venv openjd
openjd/bin/pip install --quiet 'openjd-cli>=0.8,<0.9'
openjd/bin/openjd check "$template" >check.log || die "the template is refused: $(cat check.log)"
"$catoptric" sweep plan sweep.json -o farm --quiet
openjd/bin/openjd run "$template" --step Merge --run-dependencies -p Sweep="$PWD/farm" -p Out="$PWD/farm-merged" \
    -p Workers=2 -p Catoptric="$catoptric" >farm.log 2>&1 || die "the job failed: $(cat farm.log)"
expect_same_tables farm-merged
rm "$(ls farm/results/*.json | head -n 1)"
! openjd/bin/openjd run "$template" --step Merge --no-run-dependencies -p Sweep="$PWD/farm" -p Out="$PWD/incomplete" \
    -p Catoptric="$catoptric" >incomplete.log 2>&1 || die "a job merged a sweep without a result"
grep -q 'wanted the results of' incomplete.log || die "the job does not say what is missing: $(cat incomplete.log)"
echo "sweep: 42 pieces by Open Job Description: same bytes as a single process"
