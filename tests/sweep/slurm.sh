#!/usr/bin/env bash
# slurm.sh CATOPTRIC SAMPLES WORK: starts a Slurm of one node in WORK, runs a small sweep there by Snakemake, cancels one
# of its jobs, and expects the tables that a single process writes. SAMPLES: samples/sweep. Exits with 77 and the reason
# if this machine cannot run Slurm, such as without the rights of root.
set -euo pipefail
name=slurm catoptric=$1 snakefile=$2/Snakefile work=$3
source "$(dirname "$0")/steps.sh"
skip() { echo "slurm: not run: $*" >&2; exit 77; }
for program in munged slurmctld slurmd sbatch snakemake; do
    command -v $program >/dev/null || die "wanted $program; ./dev test --label slurm installs it"
done
[[ $(id -u) == 0 ]] || skip "slurmd starts jobs as other users and needs the rights of root"
rm -rf "$work"; mkdir -p "$work"/{state,spool}; cd "$work"

stop() {
    local pid
    for pid in slurmd.pid slurmctld.pid munged.pid; do
        [[ ! -s $pid ]] || kill "$(<"$pid")" 2>/dev/null || true
    done
}
trap stop EXIT
host=$(hostname -s)
# Processes are tracked by their groups and not by cgroups, which containers often forbid.
cat >slurm.conf <<END
ClusterName=sweep
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$PWD/munge.socket
StateSaveLocation=$PWD/state
SlurmdSpoolDir=$PWD/spool
SlurmctldPidFile=$PWD/slurmctld.pid
SlurmdPidFile=$PWD/slurmd.pid
SlurmctldLogFile=$PWD/slurmctld.log
SlurmdLogFile=$PWD/slurmd.log
SlurmctldPort=16817
SlurmdPort=16818
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc)
PartitionName=all Nodes=$host Default=YES State=UP
END
export SLURM_CONF=$PWD/slurm.conf
head -c 1024 /dev/urandom >munge.key && chmod 400 munge.key
munged --force --key-file="$PWD/munge.key" --socket="$PWD/munge.socket" --pid-file="$PWD/munged.pid" \
    --log-file="$PWD/munged.log" --seed-file="$PWD/munge.seed" || skip "munged: $(tail -n 1 munged.log)"
slurmctld || skip "slurmctld: $(tail -n 1 slurmctld.log)"
slurmd -N "$host" || skip "slurmd: $(tail -n 1 slurmd.log)"
for ((i = 0; i < 100; ++i)); do [[ $(sinfo -h -o %T 2>/dev/null) != idle ]] || break; sleep .2; done
[[ $(sinfo -h -o %T) == idle ]] || skip "the node is $(sinfo -h -o %T): $(tail -n 1 slurmd.log)"

cat >sweep.json <<'END'
{"scenes": ["cornell-mirrors", "flat"], "techniques": ["reuse:face=32"],
 "options": {"size": "48x48", "frames": 6, "warmup": 1}, "views": {"count": 12, "seed": 5}, "timing": {"repeats": 1}}
END
run_in_one_process
run() { # run OPTION...
    snakemake -s "$snakefile" --jobs 2 --cluster-sync "sbatch --wait --ntasks 1 --output $PWD/job-%j.log" \
        --resources machine=1 --nolock --latency-wait 30 "$@" \
        --config sweep="$PWD/shared" out="$PWD/shared-merged" catoptric="$catoptric" batch=4
}
stop_a_job() {
    local job
    job=$(squeue -h -t R -o %i | head -n 1)
    [[ -n $job ]] || die "found no job to cancel: $(cat first.log)"
    scancel "$job"
}
run_and_stop_a_job
jobs=(job-*.log)
echo "slurm: 26 pieces by ${#jobs[@]} jobs of Slurm, one cancelled: same bytes as a single process"
