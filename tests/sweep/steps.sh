# Steps that the tests of sweeps share. A test sets `name` and `catoptric`, writes sweep.json into its folder, and reads
# this file.
die() { echo "$name: $*" >&2; exit 1; }
run_in_one_process() { # runs the sweep by a single process; its tables are those that other runs must write
    "$catoptric" sweep plan sweep.json -o single --quiet
    "$catoptric" sweep run single --quiet
    "$catoptric" sweep merge single -o single-merged --quiet
}
expect_same_tables() { # expect_same_tables FOLDER: expects the bytes of a single process, and times
    local file
    for file in merged.json errors.csv summary.csv; do
        cmp "single-merged/$file" "$1/$file" || die "$1/$file differs from that of a single process"
    done
    [[ -s $1/times.csv ]] || die "$1: found no times"
}
# Runs the sweep `shared`, stops a job as soon as a result is there, runs it again, and expects the tables of a single
# process. The test defines `run [OPTION...]`, which runs Snakemake, and `stop_a_job`.
run_and_stop_a_job() {
    local snakemake i
    "$catoptric" sweep plan sweep.json -o shared --quiet
    run >first.log 2>&1 & snakemake=$!
    for ((i = 0; i < 600; ++i)); do
        ls shared/results/*.json >/dev/null 2>&1 && break
        sleep .1
    done
    stop_a_job
    ! wait "$snakemake" || die "wanted a failure of the job that was stopped"
    [[ ! -e shared-merged/merged.json ]] || die "merged although a job was stopped"
    run --rerun-incomplete >second.log 2>&1 || die "the second run failed: $(cat second.log)"
    expect_same_tables shared-merged
}
