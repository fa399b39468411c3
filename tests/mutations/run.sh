#!/usr/bin/env bash
# Applies one mutation after the other to this checkout, which must be clean, and runs the tests that the patch names:
# they must turn red. Exit code 1 when one stays green. Called by ./dev mutate [NAME...].
set -euo pipefail
cd "$(dirname "$0")/../.."
build=build/ci
git diff --quiet -- engine shaders samples || { echo "mutate: engine/, shaders/ or samples/ has changes that are not committed" >&2; exit 2; }
names=("$@")
((${#names[@]})) || for patch in tests/mutations/*.patch; do names+=("$(basename "$patch" .patch)"); done
green=()
for name in "${names[@]}"; do
    patch=tests/mutations/$name.patch
    [[ -f $patch ]] || { echo "mutate: no mutation '$name'" >&2; exit 2; }
    read -r _ program filter < <(grep '^Test: ' "$patch")
    trap 'git apply -R "$patch"' EXIT
    git apply "$patch" || { trap - EXIT; exit 2; }
    cmake --build $build --target "$program" >/dev/null || { echo "mutate: $name does not compile" >&2; exit 2; }
    if red=$($build/"$program" --gtest_filter="$filter" 2>&1); then
        grep -q '\[  PASSED  \] 0 tests' <<<"$red" && { echo "mutate: $name: no test $filter" >&2; exit 2; }
        green+=("$name")
        printf '%-24s GREEN  %s\n' "$name" "$filter"
    else
        printf '%-24s red    %s\n' "$name" "$(grep -m1 -o '\[  FAILED  \] [A-Za-z0-9_/]*\.[A-Za-z0-9_/]*' <<<"$red" || echo "$filter ends in an error")"
    fi
    git apply -R "$patch"
    trap - EXIT
done
cmake --build $build >/dev/null
((${#green[@]} == 0)) || { echo "mutate: no test noticed: ${green[*]}" >&2; exit 1; }
