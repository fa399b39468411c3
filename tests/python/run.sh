#!/usr/bin/env bash
# run.sh BUILD WORK: builds the wheel, installs it into a clean virtual environment, and checks the package there. Then
# adds pandas, mypy and what runs a notebook, and checks the table, the types, docs/python.md and docs/python.ipynb.
set -euo pipefail
build=$(realpath -- "$1") work=$2 here=$(dirname -- "$(realpath -- "$0")")
source=$here/../..
die() { echo "python: $*" >&2; exit 1; }
rm -rf "$work/wheels" "$work/venv" "$work/files"
mkdir -p "$work/files"
work=$(realpath -- "$work")
"$source/python/wheel.sh" "$build" "$work" "$work/wheels"
wheel=$(echo "$work"/wheels/*.whl)
bytes=$(stat -c %s "$wheel")
names=$("${PYTHON:-python3}" -m zipfile -l "$wheel" | awk 'NR > 1 {print $1}')
libraries=$(sed -n 's,^catoptric\.libs/lib\([a-z0-9]*\)-.*,\1,p' <<<"$names")
[[ -n $libraries ]] || die "$wheel: wanted libraries in catoptric.libs, found none"
for name in LICENSE uplot nanobind glm nlohmann spirv $libraries; do # of each library, and of what is compiled into ours
    grep -q "dist-info/licenses/.*$name" <<<"$names" || die "$wheel: wanted the licence of $name, found: $names"
done
((bytes <= 40000000)) || die "$wheel: wanted at most 40 MB, found $bytes bytes"

cd "$work/files" # no folder of the sources, so that Python finds the installed package
seconds_since() { date +%s.%N | awk -v from="$1" '{printf "%.1f", $1 - from}'; }
begin=$(date +%s.%N)
"${PYTHON:-python3}" -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet "$wheel"
installed=$(seconds_since "$begin")
"$work/venv/bin/python" "$here/five_lines.py"
seconds=$(seconds_since "$begin")
echo "a new environment, pip install and five lines: $seconds s, of which $installed s to install"
((${seconds%.*} < 60)) || die "a new environment, pip install and five lines: wanted at most 60 s, found $seconds s"
"$work/venv/bin/python" "$here/check.py" package "$build/catoptric"
PATH=$work/tool/bin:$PATH "$here/missing.sh" "$work/venv" "$work/missing"

"$work/venv/bin/pip" install --quiet pandas==3.1.1 mypy==2.4.1 nbclient==0.11.0 ipykernel==7.4.0
"$work/venv/bin/python" "$here/check.py" table
"$work/venv/bin/mypy" --strict "$here/five_lines.py"
"$work/venv/bin/python" "$here/check.py" documents "$source/docs"
