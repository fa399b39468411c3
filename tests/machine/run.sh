#!/usr/bin/env bash
# Tests bench/machine: a packed folder runs elsewhere, a program that fails or hangs stops no other program, and one
# archive says how each program ended. Scripts stand in for the programs. Called by CTest: run.sh WORK.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
work=$1
rm -rf "$work"
mkdir -p "$work"/{build,elsewhere}
cd "$work"

fail() { echo "machine: $*" >&2; exit 1; }
expect() { grep -qE -- "$1" "$2" || fail "wanted '$1' in $2, found: $(cat "$2")"; }
stub() { # stub NAME LINE: writes a program that runs this line of shell
    printf '#!/usr/bin/env bash\n%s\n' "$2" >"build/$1"
    chmod +x "build/$1"
}
stub catoptric 'echo "catoptric $*"; [[ $1 == stress ]] && exit 1; exit 0'
stub catoptric_bench 'sleep 30'
stub gpu_test 'echo "gpu $* on ${CATOPTRIC_TEST_DEVICE:-any}"; exit 3'
stub drivers_test 'kill -SEGV $$'
stub catoptric-images.so ''
stub catoptric-draco.so ''

if "$source/bench/machine/pack.sh" build kit.tar.gz 2>refused.txt; then fail "packed a build without reflect_test"; fi
expect 'reflect_test: wanted a finished build' refused.txt
[[ ! -e kit.tar.gz ]] || fail "a refused pack left an archive"
stub reflect_test 'echo "reflect reads $CATOPTRIC_TEST_SOURCE"; echo kept >"$TMPDIR/kept"; ls "$CATOPTRIC_TEST_SOURCE/samples/scenes"'
"$source/bench/machine/pack.sh" build kit.tar.gz
tar -C elsewhere -xzf kit.tar.gz
kit=$work/elsewhere/catoptric-kit
[[ -e $kit/layers/VkLayer_khronos_validation.json ]] || fail "no validation layer in the archive"

code=0
(cd / && env -i "$kit/run.sh" -d 'A B' -t 1 --quick) >said.txt 2>&1 || code=$?
((code == 1)) || fail "steps failed: wanted exit code 1, found $code: $(cat said.txt)"
archives=("$kit"/results-*.tar.gz)
((${#archives[@]} == 1)) && [[ -s ${archives[0]} ]] || fail "wanted one archive, found ${archives[*]}"
mkdir results
tar -C results --strip-components=1 -xzf "${archives[0]}"
summary=results/summary.txt
expect '^info +0 ' $summary
expect '^rows/cornell-mirrors-512 +0 ' $summary
expect '^calibrate +0 ' $summary
expect '^auto/gallery-1 +0 ' $summary
expect '^stress +1 ' $summary
expect '^ratios +over 1 s +1\.[0-9]' $summary
expect '^gpu/[a-z_]+ +3 ' $summary
expect '^drivers/[a-z_]+ +139 ' $summary
expect '^reflect/[a-z_]+ +0 ' $summary
expect 'catoptric compare cornell-mirrors --device A B --size 64x64 .*--work' results/rows-cornell-mirrors-512.log
expect '^gpu --from [a-z_]+_test.cpp on A B$' "$(echo results/gpu-*.log)"
expect "reads $kit/source\$" "$(echo results/reflect-*.log)"
expect 'cornell-mirrors.glb' "$(echo results/reflect-*.log)"
[[ -e $kit/work/tmp/kept ]] || fail "what programs keep for a while lies outside the folder"
expect "archive: $kit/results-" said.txt

# run.sh must use a library of the machine instead of the packed one only if the machine's is newer.
rm -rf "$kit"/lib/libz.so* "$kit"/results-*
expect_library() { # expect_library VERSION LINES: packs a library of VERSION; LINES that call the machine's newer
    local unpacked=elsewhere/unpacked
    ln -sf "libz.so.$1" "$kit/lib/libz.so.1"
    env -i "$kit/run.sh" none >said.txt 2>&1 || fail "wanted exit code 0: $(cat said.txt)"
    rm -rf $unpacked && mkdir $unpacked
    tar -C $unpacked --strip-components=1 -xzf "$kit"/results-*.tar.gz
    rm "$kit"/results-*
    local said=0
    ! grep -sq "^libz.so.1: this machine's libz.so.* is newer than libz.so.$1\$" $unpacked/libraries.txt || said=1
    ((said == $2)) || fail "libz.so.$1: wanted $2 lines in libraries.txt, found $said"
    [[ $2 == 1 || -L $kit/work/lib/libz.so.1 ]] || fail "libz.so.$1: newer than the machine's, and not used"
    [[ $2 == 0 || ! -L $kit/work/lib/libz.so.1 ]] || fail "libz.so.$1: older than the machine's, and used"
}
expect_library 1.0.1 1
expect_library 1.99.0 0

# run.sh must run only the steps that are asked for, and exit with 0 if none of them fails.
env -i "$kit/run.sh" reflect/a >said.txt 2>&1 || fail "nothing failed: wanted exit code 0: $(cat said.txt)"
! grep -q '^gpu/' said.txt || fail "ran what was not asked for: $(cat said.txt)"
(($(grep -c '^reflect/' said.txt) == $(ls "$source"/tests/reflect/a*_test.cpp | wc -l))) || fail "not all: $(cat said.txt)"

# Steps that have no time left are named, and --resume runs those that have not ended with 0, and no others.
steps_of() { rm -rf unpacked && mkdir unpacked && tar -C unpacked --strip-components=1 -xzf "$kit"/results-*.tar.gz; }
stub_in_kit() { printf '#!/usr/bin/env bash\n%s\n' "$2" >"$kit/bin/$1"; chmod +x "$kit/bin/$1"; }
rm "$kit"/results-*
stub_in_kit catoptric '[[ $1 == compare ]] && sleep 3; exit 0'
code=0
env -i "$kit/run.sh" -b 2 rows/c calibrate >said.txt 2>&1 || code=$?
((code == 1)) || fail "no time left: wanted exit code 1, found $code: $(cat said.txt)"
steps_of
expect '^rows/cornell-mirrors-512 +over [12] s ' unpacked/summary.txt
expect '^calibrate +later ' unpacked/summary.txt
stub_in_kit catoptric 'echo "again: $1"; exit 0'
env -i "$kit/run.sh" --resume rows/c calibrate >said.txt 2>&1 || fail "resumed: wanted exit code 0: $(cat said.txt)"
! grep -q '^info' said.txt || fail "resumed what was done: $(cat said.txt)"
expect '^calibrate +0 ' said.txt
(($(ls "$kit"/results-*.tar.gz | wc -l) == 1)) || fail "a resumed run left two archives: $(ls "$kit")"
steps_of
expect '^info +0 ' unpacked/summary.txt
expect '^rows/cornell-mirrors-2048 +0 ' unpacked/summary.txt
rm "$kit"/results-*
code=0
env -i "$kit/run.sh" --resume >said.txt 2>&1 || code=$?
((code == 2)) || fail "nothing to resume: wanted exit code 2, found $code"
expect 'wanted an archive results-\*.tar.gz' said.txt

# An archive that would be too large leaves out its largest files, and says which.
stub_in_kit catoptric 'while (($#)); do [[ $1 != -o ]] || head -c 61M /dev/urandom >"$2"; shift; done'
env -i "$kit/run.sh" bench >said.txt 2>&1 || fail "large: wanted exit code 0: $(cat said.txt)"
expect '^left out for the archive.s 60 MiB: bench.json, 63963136 bytes' said.txt
steps_of
expect 'bench.json' unpacked/left-out.txt
[[ ! -e unpacked/bench.json ]] || fail "the largest file was kept"

# With -j, tests must run at the same time, except those that compare times, and their exit codes must still count.
stub_in_kit gpu_test 'at=$TMPDIR/running; mkdir -p "$at"; touch "$at/$$"; sleep .3; ls "$at" | wc -l; rm "$at/$$"'
rm "$kit"/results-*
env -i "$kit/run.sh" -j 4 gpu/t gpu/s >said.txt 2>&1 || fail "wanted exit code 0: $(cat said.txt)"
rm -rf parallel && mkdir parallel
tar -C parallel --strip-components=1 -xzf "$kit"/results-*.tar.gz
(($(cat parallel/gpu-*.log | grep -cx '[234]') >= 3)) || fail "-j 4 ran one test at a time: $(tail -n 1 parallel/gpu-*.log)"
expect '^1$' parallel/gpu-timer.log
stub_in_kit gpu_test 'exit 3'
env -i "$kit/run.sh" -j 4 gpu/t >said.txt 2>&1 && fail "a test failed beside others: wanted exit code 1, found 0"
expect '^gpu/timer +3 ' said.txt
expect '^gpu/texels +3 ' said.txt

code=0
env -i "$kit/run.sh" -j 0 >said.txt 2>&1 || code=$?
((code == 2)) || fail "-j 0: wanted exit code 2, found $code"
expect "-j: wanted a whole number from 1, found '0'" said.txt

# A small archive leaves out the module for picture files, which no step needs.
"$source/bench/machine/pack.sh" build --small small.tar.gz
tar -tf small.tar.gz >small.txt
if grep -q catoptric-images small.txt; then fail "--small packed the library of pictures"; fi

# If run.sh is stopped, its archive must hold the steps that were done.
rm "$kit"/results-*
env -i "$kit/run.sh" ratios >said.txt 2>&1 &
for ((i = 0; i < 100; ++i)); do grep -q '^info' said.txt && break; sleep .05; done
kill $!
wait $! || code=$?
((code == 143)) || fail "stopped: wanted exit code 143, found $code"
archives=("$kit"/results-*.tar.gz)
[[ -s ${archives[0]} ]] || fail "stopped: wanted an archive, found none"
tar -xzOf "${archives[0]}" --wildcards '*/summary.txt' >stopped.txt
expect '^info +0 ' stopped.txt
