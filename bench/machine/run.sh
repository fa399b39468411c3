#!/usr/bin/env bash
# Measures and tests the packed programs in this script's folder (./dev pack) on this machine. Writes the results into
# one archive in the same folder, and nothing outside the folder.
# Needs bash, tar, gzip, timeout and other usual commands, and a Vulkan driver.
set -uo pipefail
export PATH=${PATH:-/usr/local/bin:/usr/bin:/bin} LC_ALL=C
cd "$(dirname "$0")" || exit 1
here=$PWD

usage() {
    cat <<'TEXT'
run.sh [-d DEVICE] [-t SECONDS] [-j JOBS] [--quick] [STEP...]
  -d DEVICE    index from 0 or part of a name, as 'catoptric list devices' has it (the fastest kind)
  -t SECONDS   the most that one step may take (600)
  -j JOBS      how many tests run at once (1); the other steps measure times and run alone
  --quick      small pictures, few rounds, a few tests: whether all of it runs
  STEP         only those whose names hold one of these words; 'devices' and 'info' always run
Steps: devices, info, bench, compare, stress, ratios, and gpu/..., reflect/..., drivers/... of tests.txt.
Exit code 0 when every step ended with 0, 1 otherwise. The archive is there in either case, and when this is stopped.
TEXT
}
device=() limit=600 jobs=1 quick=0 only=()
while (($#)); do
    case $1 in
    -d) device=(--device "${2:?-d wants a DEVICE}"); export CATOPTRIC_TEST_DEVICE=$2; shift ;;
    -t) limit=${2:?-t wants SECONDS}; shift ;;
    -j)
        jobs=${2:?-j wants JOBS}
        [[ $jobs =~ ^[1-9][0-9]*$ ]] || { echo "run.sh: -j: wanted a whole number from 1, found '$jobs'" >&2; exit 2; }
        shift
        ;;
    --quick) quick=1 ;;
    -h | --help) usage; exit 0 ;;
    -*) echo "run.sh: no option '$1'" >&2; usage >&2; exit 2 ;;
    *) only+=("$1") ;;
    esac
    shift
done

name=results-${HOSTNAME:-machine}-$(date -u +%Y%m%d-%H%M%S)
results=$here/$name
mkdir -p "$results" work/{home,cache,tmp} || exit 1
# Drivers and programs write their caches and settings into the folder `work`.
export HOME=$here/work/home XDG_CACHE_HOME=$here/work/cache XDG_CONFIG_HOME=$here/work/home TMPDIR=$here/work/tmp
export MESA_SHADER_CACHE_DIR=$here/work/cache __GL_SHADER_DISK_CACHE_PATH=$here/work/cache
# Tests read their files from here instead of from the source tree in which they were built.
export CATOPTRIC_TEST_SOURCE=$here/source
export VK_ADD_LAYER_PATH=$here/layers

# Vulkan drivers and the packed programs load some of the same libraries, and drivers need the version of this machine.
# If this machine's version of a packed library is newer, both load this machine's version.
rm -rf work/lib
mkdir -p work/lib
declare -A machine_has
while read -r file place; do machine_has[$file]=${machine_has[$file]:-$place}; done < <(
    { ldconfig -p || /sbin/ldconfig -p; } 2>/dev/null | sed -n 's|^\s*\(\S*\) (libc6,[^)]*64.* => \(/.*\)|\1 \2|p')
is_newer() { # is_newer THEIRS OWN: whether file name THEIRS has a higher version than file name OWN
    [[ $1 != "$2" && $(printf '%s\n' "$1" "$2" | sort -V | tail -n 1) == "$1" ]]
}
for library in lib/*.so*; do
    file=${library##*/} theirs=
    [[ -z ${machine_has[$file]:-} ]] || theirs=$(basename "$(readlink -f "${machine_has[$file]}")")
    own=$file
    [[ ! -L $library ]] || own=$(readlink "$library")
    if [[ -n $theirs ]] && is_newer "$theirs" "$own"; then
        echo "$file: this machine's $theirs is newer than $own" >>"$results/libraries.txt"
    else
        ln -s "../../lib/$own" "work/lib/$file"
    fi
done
export LD_LIBRARY_PATH=$here/work/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}

summary=$results/summary.txt failed=0 child=
printf '%-34s %-10s %8s\n' step exit seconds >"$summary"
note() { printf '%-34s %-10s %8s\n' "$@" | tee -a "$summary"; }
finish() { # packs the results; runs however the script ends
    [[ -z $child ]] || kill "$child" 2>/dev/null
    local tests
    mapfile -t tests < <(jobs -p)
    ((${#tests[@]} == 0)) || { kill "${tests[@]}"; wait; } 2>/dev/null
    tar -czf "$here/$name.tar.gz" -C "$here" "$name" && rm -rf "$results"
    echo "archive: $here/$name.tar.gz"
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

is_wanted() {
    ((${#only[@]})) || return 0
    local word
    for word in "${only[@]}"; do [[ $1 != *"$word"* ]] || return 0; done
    return 1
}
step() { # step NAME COMMAND...: runs a command; writes its log, exit code and seconds; continues if it fails
    local step=$1 begin=$EPOCHREALTIME code
    shift
    local log=$results/${step//\//-}.log
    echo "$*" >"$log"
    timeout -k 10 "$limit" "$@" >>"$log" 2>&1 &
    child=$!
    wait "$child"
    code=$?
    child=
    local milliseconds=$(((${EPOCHREALTIME/./} - ${begin/./}) / 1000)) # EPOCHREALTIME without dot: microseconds
    case $code in
    0) ;;
    124 | 137) failed=1 code="over $limit s" ;;
    *) failed=1 ;;
    esac
    note "$step" "$code" "$((milliseconds / 1000)).$((milliseconds % 1000 / 100))"
}
wanted() { ! is_wanted "$1" || step "$@"; }

catoptric=bin/catoptric
small=() rounds=6 pairs=7 stress=()
((quick)) && small=(--size 64x64 --frames 2 --warmup 1) rounds=2 pairs=1 stress=(--size 64x64 --only N1 C9)
step devices "$catoptric" list devices --json
step info "$catoptric" info --json "${device[@]}"
! command -v vulkaninfo >/dev/null || step vulkaninfo vulkaninfo
{ uname -srm; nproc; cat commit.txt; grep -m 1 'model name' /proc/cpuinfo; } >"$results/machine.txt" 2>/dev/null
wanted bench "$catoptric" bench "${device[@]}" "${small[@]}" --rounds "$rounds" -o "$results/bench.json" --quiet
wanted compare "$catoptric" compare "${device[@]}" "${small[@]}" -o "$results/compare" --quiet
wanted stress "$catoptric" stress "${device[@]}" "${stress[@]}" -o "$results/stress" --quiet
wanted ratios bin/catoptric_bench "$pairs"
running=0
await_test() { wait -n || failed=1; running=$((running - 1)); }
while read -r program file; do
    # --quick runs only the first test source of each program.
    ((quick)) && [[ $program == "${last:-}" ]] && continue
    last=$program
    test=("$program/$file" "bin/${program}_test" --from "${file}_test.cpp")
    is_wanted "${test[0]}" || continue
    if ((jobs == 1)) || [[ $file == timer ]]; then # compares times, so it runs alone
        while ((running)); do await_test; done
        step "${test[@]}"
        continue
    fi
    ((running < jobs)) || await_test
    (
        trap 'kill "$child" 2>/dev/null; exit 143' TERM
        failed=0
        step "${test[@]}"
        exit $failed
    ) &
    running=$((running + 1))
done <tests.txt
while ((running)); do await_test; done
exit $failed
