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
run.sh [-d DEVICE] [-b SECONDS] [-t SECONDS] [-j JOBS] [--resume] [--quick] [STEP...]
  -d DEVICE    index from 0 or part of a name, as 'catoptric list devices' has it (the fastest kind)
  -b SECONDS   the most that all steps may take (480); steps that have no time left are named "later"
  -t SECONDS   the most that one step may take (600)
  -j JOBS      how many tests run at once (1); the other steps measure times and run alone
  --resume     go on with the newest archive in this folder: only steps that have not ended with 0 in it
  --quick      small pictures, few rounds, a few tests: whether all of it runs
  STEP         only those whose names hold one of these words; 'devices' and 'info' always run
Steps, those first whose figures tell most: devices, info, rows/SCENE-EDGE (times, errors and counted work, and after
'calibrate' predicted times), calibrate (unit costs), auto/SCENE-SEED ('auto' beside other rows in drawn views), and
gpu/..., reflect/..., drivers/... of tests.txt, bench, stress, ratios.
Exit code 0 when every step ended with 0, 1 otherwise. The archive is there in either case, and when this is stopped.
TEXT
}
device=() budget=480 limit=600 jobs=1 quick=0 resume=0 only=()
whole_number() { # whole_number OPTION VALUE: ends the script unless VALUE is a whole number from 1
    [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || { echo "run.sh: $1: wanted a whole number from 1, found '${2:-}'" >&2; exit 2; }
}
while (($#)); do
    case $1 in
    -d) device=(--device "${2:?-d wants a DEVICE}"); export CATOPTRIC_TEST_DEVICE=$2; shift ;;
    -b) whole_number -b "${2:-}"; budget=$2; shift ;;
    -t) whole_number -t "${2:-}"; limit=$2; shift ;;
    -j) whole_number -j "${2:-}"; jobs=$2; shift ;;
    --resume) resume=1 ;;
    --quick) quick=1 ;;
    -h | --help) usage; exit 0 ;;
    -*) echo "run.sh: no option '$1'" >&2; usage >&2; exit 2 ;;
    *) only+=("$1") ;;
    esac
    shift
done

name=results-${HOSTNAME:-machine}-$(date -u +%Y%m%d-%H%M%S)
declare -A is_done=()
if ((resume)); then
    archive=$(ls -t results-*.tar.gz 2>/dev/null | head -n 1)
    [[ -n $archive ]] || { echo "run.sh: --resume: wanted an archive results-*.tar.gz in $here, found none" >&2; exit 2; }
    name=${archive%.tar.gz}
    tar -xzf "$archive" || exit 1
    while read -r step code _; do [[ $code != 0 ]] || is_done[$step]=1; done <"$name/summary.txt"
fi
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

summary=$results/summary.txt failed=0 child= watch=
[[ -e $summary ]] || printf '%-34s %-10s %8s\n' step exit seconds >"$summary"
note() { printf '%-34s %-10s %8s\n' "$@" | tee -a "$summary"; }
most_mib=60
leave_out() { # leaves out the largest files until the archive has at most most_mib, and says which
    local size file
    while size=$(tar -cz -C "$here" "$name" | wc -c); ((size > most_mib << 20)); do
        read -r size file < <(find "$results" -type f -printf '%s %p\n' | sort -rn | head -n 1)
        echo "left out for the archive's $most_mib MiB: ${file#"$results"/}, $size bytes" | tee -a "$results/left-out.txt"
        rm "$file"
    done
}
finish() { # packs the results; runs however the script ends
    [[ -z $child ]] || kill "$child" 2>/dev/null
    [[ -z $watch ]] || kill "$watch" 2>/dev/null
    local tests
    mapfile -t tests < <(jobs -p)
    ((${#tests[@]} == 0)) || { kill "${tests[@]}"; wait; } 2>/dev/null
    leave_out
    tar -czf "$here/new-$name.tar.gz" -C "$here" "$name" && mv "$here/new-$name.tar.gz" "$here/$name.tar.gz" && rm -rf "$results"
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
    local step=$1 begin=$EPOCHREALTIME code most=$((budget - SECONDS))
    shift
    [[ -z ${is_done[$step]:-} ]] || return 0
    if ((most <= 0)); then
        failed=1
        note "$step" later -
        return 1
    fi
    ((most < limit)) || most=$limit
    local log=$results/${step//\//-}.log
    echo "$*" >"$log"
    timeout -k 10 "$most" "$@" >>"$log" 2>&1 &
    child=$!
    wait "$child"
    code=$?
    child=
    local milliseconds=$(((${EPOCHREALTIME/./} - ${begin/./}) / 1000)) # EPOCHREALTIME without dot: microseconds
    case $code in
    0) ;;
    124 | 137) failed=1 code="over $most s" ;;
    *) failed=1 ;;
    esac
    note "$step" "$code" "$((milliseconds / 1000)).$((milliseconds % 1000 / 100))"
}
wanted() { ! is_wanted "$1" || step "$@"; }

catoptric=bin/catoptric
frames=() rounds=6 pairs=7 stress=() edges=(1024 2048) seeds=(1 2)
((quick)) && frames=(--frames 2 --warmup 1) rounds=2 pairs=1 stress=(--size 64x64 --only N1 C9) edges=(1024) seeds=(1)
size_of() { ((quick)) && echo 64x64 || echo "$1x$1"; } # size_of EDGE
rows=(reuse parallax secant march pyramid layered hybrid planar raytrace:depth={1,2,4,8} raytrace:depth=4,first=raster auto)
costs=()
compare_rows() { # compare_rows SCENE EDGE OPTION...: the step of a scene's rows in pictures of EDGE x EDGE pixels
    local scene=$1 edge=$2
    shift 2
    [[ ! -e $results/calibration.json ]] || costs=(--costs "$results/calibration.json")
    wanted "rows/$scene-$edge" "$catoptric" compare "$scene" "${device[@]}" --size "$(size_of "$edge")" "${frames[@]}" --work \
        "${costs[@]}" -o "$results/rows-$scene-$edge" --quiet "$@" --techniques "${rows[@]}"
}

step devices "$catoptric" list devices --json
step info "$catoptric" info --json "${device[@]}"
! command -v vulkaninfo >/dev/null || step vulkaninfo vulkaninfo
{ uname -srm; nproc; cat commit.txt; grep -m 1 'model name' /proc/cpuinfo; } >"$results/machine.txt" 2>/dev/null
if command -v nvidia-smi >/dev/null; then # clocks, limits of clocks, heat and power of each second
    nvidia-smi --query-gpu=timestamp,clocks.sm,clocks.mem,clocks_throttle_reasons.active,temperature.gpu,power.draw,utilization.gpu \
        --format=csv -l 1 >>"$results/clocks.csv" 2>&1 &
    watch=$!
    disown # no test to wait for
fi
compare_rows cornell-mirrors 512 --model both
wanted calibrate "$catoptric" bench --calibrate "${device[@]}" -o "$results/calibration.json" --quiet
compare_rows courtyard 512 --model required
for edge in "${edges[@]}"; do compare_rows cornell-mirrors "$edge" --model both; done
compare_rows room 1024 --model both
for seed in "${seeds[@]}"; do
    for scene in cornell-mirrors flat room courtyard gallery; do
        wanted "auto/$scene-$seed" "$catoptric" compare "$scene" "${device[@]}" --size "$(size_of 512)" "${frames[@]}" --model required \
            --camera seeded --seed "$seed" -o "$results/auto-$scene-$seed" --quiet --techniques auto "${rows[@]:2:11}"
    done
done
wanted bench "$catoptric" bench "${device[@]}" --size "$(size_of 512)" "${frames[@]}" --rounds "$rounds" -o "$results/bench.json" --quiet
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
wanted stress "$catoptric" stress "${device[@]}" "${stress[@]}" -o "$results/stress" --quiet
wanted ratios bin/catoptric_bench "$pairs"
exit $failed
