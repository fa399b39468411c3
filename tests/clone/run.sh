#!/usr/bin/env bash
# Tests the README's first command as a newcomer would run it. Clones this checkout with its uncommitted changes into an
# empty folder (WORK) and runs `./dev demo` there, with a small picture. Called by CTest: run.sh SOURCE WORK.
set -euo pipefail
source=$1 work=$2
rm -rf "$work"
git clone --quiet --no-hardlinks "$source" "$work"
git -C "$source" diff --binary HEAD | git -C "$work" apply --allow-empty
(cd "$source" && git ls-files -z --others --exclude-standard | xargs -0r cp --parents -t "$work")
cd "$work"
./dev demo --size 64x64 --frames 1
report=$work/out/demo/report.html
[[ -s $report ]] || { echo "clone: wanted a report in $report, found none" >&2; exit 1; }
for word in parallax raytrace '</html>'; do
    grep -qF "$word" "$report" || { echo "clone: $report does not hold '$word'" >&2; exit 1; }
done
untracked() { git -C "$1" ls-files --others --exclude-standard; }
diff <(untracked "$source") <(untracked .) >&2 ||
    { echo "clone: wanted the demo to leave nothing that git does not ignore, found the above" >&2; exit 1; }
