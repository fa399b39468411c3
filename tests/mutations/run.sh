#!/usr/bin/env bash
# Applies wrong code to this checkout, which must be clean, and runs what must turn red. Exit code 1 when something
# stays green. Called by ./dev mutate.
#   run.sh [NAME...]            one patch after the other, and the tests that it names
#   run.sh --stress [NAME...]   the patches of each line of stress/batches in one build, and the rows of `catoptric
#                               stress` that they turn red; with names of patches or rows only these, one by one
set -euo pipefail
cd "$(dirname "$0")/../.."
build=build/ci here=tests/mutations
git diff --quiet -- engine shaders samples || { echo "mutate: engine/, shaders/ or samples/ has changes that are not committed" >&2; exit 2; }
green=() applied=()

take_back() { # in the order opposite to that in which they went in
    local i
    for ((i = ${#applied[@]} - 1; i >= 0; --i)); do git apply -R "${applied[i]}"; done
    applied=()
}
trap take_back EXIT
apply() { # apply PATCH...
    local patch
    for patch in "$@"; do
        git apply "$patch" || exit 2
        applied+=("$patch")
    done
}
build() { # build TARGET NAME...
    nice cmake --build $build --target "$1" >/dev/null || { echo "mutate: ${*:2} does not compile" >&2; exit 2; }
}
patch_of() { # patch_of NAME [FOLDER]
    local patch
    for patch in ${2:+"$here/$2/$1.patch"} "$here/$1.patch"; do
        [[ ! -f $patch ]] || { echo "$patch"; return; }
    done
    echo "mutate: no mutation '$1'" >&2
    return 2
}

mutate_tests() {
    local names=("$@") name patch program filter red command
    ((${#names[@]})) || for patch in $here/*.patch; do names+=("$(basename "$patch" .patch)"); done
    for name in "${names[@]}"; do
        patch=$(patch_of "$name")
        read -r _ program filter < <(grep '^Test: ' "$patch")
        apply "$patch"
        if [[ $program == ctest ]]; then # Test: ctest REGEX
            build all "$name"
            command=(ctest --test-dir $build --output-on-failure -R "$filter")
        else
            build "$program" "$name"
            command=($build/"$program" --gtest_filter="$filter")
        fi
        if red=$("${command[@]}" 2>&1); then
            grep -q '\[  PASSED  \] 0 tests' <<<"$red" && { echo "mutate: $name: no test $filter" >&2; exit 2; }
            green+=("$name")
            printf '%-24s GREEN  %s\n' "$name" "$filter"
        else
            printf '%-24s red    %s\n' "$name" "$(grep -m1 -o '\[  FAILED  \] [A-Za-z0-9_/]*\.[A-Za-z0-9_/]*' <<<"$red" || echo "$filter ends in an error")"
        fi
        take_back
    done
}

# A row is judged small: wrong code is no question of pixels.
mutate_rows() { # mutate_rows ROW:NAME...
    local pair patch rows=() names=() table
    for pair in "$@"; do
        rows+=("${pair%%:*}") names+=("${pair#*:}")
        patch=$(patch_of "${pair#*:}" stress)
        apply "$patch"
    done
    build catoptric_cli "${names[@]}"
    table=$($build/catoptric stress --quiet --size 128x128 --only "${rows[@]}") || (($? == 1)) || { echo "mutate: stress ended in an error" >&2; exit 2; }
    for pair in "$@"; do
        # id, verdict, measured, threshold, seconds, what
        awk -v row="${pair%%:*}" -v name="${pair#*:}" '
            $1 == row {
                what = $0
                for (i = 1; i <= 5; ++i) sub(/^ *[^ ]+ +/, "", what)
                printf "%-4s %-24s %-6s %10s of %-8s %s\n", row, name, $2 == "fail" ? "red" : "GREEN", $3, $4, substr(what, 1, 100)
                red = $2 == "fail"
            }
            END {exit !red}' <<<"$table" || green+=("${pair%%:*} with ${pair#*:}")
    done
    take_back
}

mutate_stress() {
    local line pair pairs name
    while read -r line; do
        [[ -n $line && $line != '#'* ]] || continue
        read -ra pairs <<<"$line"
        if (($# == 0)); then
            mutate_rows "${pairs[@]}"
            continue
        fi
        for pair in "${pairs[@]}"; do
            for name in "$@"; do
                [[ $name != "${pair%%:*}" && $name != "${pair#*:}" ]] || mutate_rows "$pair"
            done
        done
    done <$here/stress/batches
}

if [[ ${1:-} == --stress ]]; then mutate_stress "${@:2}"; else mutate_tests "$@"; fi
nice cmake --build $build >/dev/null
((${#green[@]} == 0)) || { printf 'mutate: nothing noticed: %s\n' "${green[@]}" >&2; exit 1; }
