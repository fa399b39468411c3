#!/usr/bin/env bash
# Draws views of a scene by Blender, three.js or Mitsuba, and compares them with rows of catoptric in one report.
set -euo pipefail
here=$(dirname -- "$(realpath -- "$0")")
usage() {
    cat <<'END'
report.sh SCENE OUT [OPTION...] [-- COMPARE-OPTION...]
Writes OUT/report/report.html, where pictures of other renderers stand beside ours. SCENE: a .glb or .gltf file.
Replaces the folders OUT/views, OUT/cycles, OUT/eevee, OUT/three and OUT/mitsuba.
  --rows LIST         other renderers, of cycles, eevee and three (all three, separated by commas), or mitsuba
  --environment FILE  picture that lights the scene, for the row mitsuba, whose other light is surfaces that emit
                      (none: only these emit, and --light is full)
  --count N           drawn views beside the scene's own: 1 (none) or at least 6 (6)
  --size WxH          size of the pictures (256x256)
  --camera C, --time T, --seed N
                      the scene's own view, and the seed of drawn views, as of 'catoptric views'
  --light KIND        direct: surfaces are lit by lights only; full: also by other surfaces, which Cycles, Mitsuba
                      and the reference show by path tracing (direct)
  --pixel KIND        centre: a pixel shows the point at its centre; area: the mean over its area (centre)
  --samples N         samples per pixel of Cycles and Mitsuba (64; EEVEE takes 16 for soft shadows)
  --catoptric FILE    program (catoptric)
COMPARE-OPTION: further options of 'catoptric compare', such as --techniques reuse secant (the default). --ambient is 0,
because no other renderer has this light.
cycles and eevee need blender, python3-numpy and, for eevee, xvfb. three needs chromium, chromium-driver,
python3-selenium and npm, which installs three.js into OUT. mitsuba needs a Python with mitsuba 3.9.1, named by the
variable CATOPTRIC_MITSUBA_PYTHON (/usr/bin/python3), and libllvm19.
END
}
die() { echo "report.sh: $*" >&2; exit 2; }

scene='' out='' rows=cycles,eevee,three count=6 size=256x256 light=direct pixel=centre samples=64 catoptric=catoptric environment='' view_options=()
while (($#)); do
    case $1 in
    --rows | --count | --size | --light | --pixel | --samples | --catoptric | --environment)
        (($# > 1)) || die "$1: wanted a value, found none"
        declare "${1#--}=$2"; shift 2 ;;
    --camera | --time | --seed)
        (($# > 1)) || die "$1: wanted a value, found none"
        view_options+=("$1" "$2"); shift 2 ;;
    --) shift; break ;;
    -h | --help) usage; exit ;;
    -*) die "unknown option '$1'; options of 'catoptric compare' follow '--'" ;;
    *)
        if [[ -z $scene ]]; then scene=$1; elif [[ -z $out ]]; then out=$1; else die "wanted SCENE OUT, found also '$1'"; fi
        shift ;;
    esac
done
[[ -n $scene && -n $out ]] || { usage >&2; exit 2; }
[[ $light == direct || $light == full ]] || die "--light: wanted direct or full, found '$light'"
[[ $pixel == centre || $pixel == area ]] || die "--pixel: wanted centre or area, found '$pixel'"
IFS=, read -ra names <<<"$rows"
compare_options=("$@")
[[ " ${compare_options[*]} " == *' --techniques '* ]] || compare_options+=(--techniques reuse secant)
truth=centre
[[ $pixel == centre ]] || truth=converged
if [[ $light == full ]]; then
    [[ $pixel == centre ]] || die "--light full: wanted --pixel centre, as 'compare --truth paths' draws, found $pixel"
    truth=paths
fi
if [[ $rows == mitsuba ]]; then
    [[ -n $environment || $light == full ]] || die "--rows mitsuba: wanted --environment FILE or --light full, found neither"
    [[ -z $environment ]] || view_options+=(--environment "$environment")
elif [[ ,$rows, == *,mitsuba,* || -n $environment ]]; then
    die "--rows: wanted mitsuba alone, because the other rows have no --environment, found '$rows'"
fi
need() { # need COMMAND PACKAGE
    command -v "$1" >/dev/null || die "wanted the program $1, found none; Debian's package $2 has it"
}

draw_by_blender() { # draw_by_blender ENGINE SAMPLES [COMMAND...]: COMMAND starts Blender
    local file blender
    blender=$(command -v blender)
    for file in "$out"/views/scene-*.glb; do
        # Blender's Python takes the modules of the first Python in PATH, which must be Debian's.
        PATH=/usr/bin:$PATH "${@:3}" "$blender" --background --factory-startup --python-exit-code 1 --python "$here/blender.py" -- \
            "$out/views" "${file##*/}" "$out/$1" --engine "$1" --samples "$2" --light "$light" --pixel "$pixel" \
            >"$out/$1.log" 2>&1 </dev/null || { tail -n 20 "$out/$1.log" >&2; die "$1: Blender failed; its output is in $out/$1.log"; }
    done
}
draw_by_three() {
    local modules=${CATOPTRIC_NODE_MODULES:-}
    if [[ -z $modules ]]; then
        modules=$out/npm/node_modules
        if [[ ! -d $modules/three ]]; then
            need npm npm
            mkdir -p "$out/npm"
            cp "$here/package.json" "$here/package-lock.json" "$out/npm"
            npm ci --prefix "$out/npm" --no-audit --no-fund --silent
        fi
    fi
    /usr/bin/python3 -B "$here/three.py" "$out/views" "$out/three" --modules "$modules" --pixel "$pixel"
}

draw_by_mitsuba() {
    local file light_options=(--bsdf plain)
    [[ -z $environment ]] || light_options=(--environment "$environment")
    for file in "$out"/views/scene-*.glb; do
        "${CATOPTRIC_MITSUBA_PYTHON:-/usr/bin/python3}" -B "$here/mitsuba_views.py" "$out/views" "${file##*/}" "$out/mitsuba" \
            "${light_options[@]}" --light "$light" --pixel "$pixel" --samples "$samples"
    done
}

for name in "${names[@]}"; do
    case $name in
    cycles) need blender blender ;;
    eevee) need blender blender; need xvfb-run xvfb ;;
    three) need chromium chromium; need chromedriver chromium-driver ;;
    mitsuba) ;;
    *) die "--rows: wanted names of cycles, eevee and three, or mitsuba, found '$name'" ;;
    esac
done
mkdir -p "$out"
rm -rf "$out/views" "$out/cycles" "$out/eevee" "$out/three" "$out/mitsuba"
"$catoptric" views "$scene" --count "$count" --size "$size" -o "$out/views" --quiet "${view_options[@]}"
/usr/bin/python3 -B "$here/pose.py" "$catoptric" "$scene" "$out/views" ${environment:+--environment "$environment"}
row_options=()
for name in "${names[@]}"; do
    echo "report.sh: $name draws $(wc -l <"$out/views/views.txt" | awk '{print $1 - 1}') views"
    case $name in
    cycles) draw_by_blender cycles "$samples" ;;
    eevee) draw_by_blender eevee 16 xvfb-run -a ;;
    three) draw_by_three ;;
    mitsuba) draw_by_mitsuba ;;
    esac
    row_options+=(--row "$name=$out/$name")
done
"$catoptric" compare "$scene" --views "$count" --size "$size" --truth "$truth" --ambient 0 -o "$out/report" \
    "${view_options[@]}" "${row_options[@]}" "${compare_options[@]}"
