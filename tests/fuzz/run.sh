#!/usr/bin/env bash
# run.sh TARGET SECONDS FOLDER: builds tests/fuzz/TARGET.cpp in FOLDER with libFuzzer and the sanitizers, and runs it on
# the committed corpus. Inputs that fail are written to FOLDER/TARGET.
set -euo pipefail
target=$1 seconds=$2
mkdir -p "$3/objects" "$3/$target"
folder=$(cd "$3" && pwd)
cd "$(dirname "$0")/../.."
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 folder
compile() { # compile SOURCE: compiles a file; ccache skips unchanged files
    local compiler=(clang++-16)
    ! command -v ccache >/dev/null || compiler=(ccache clang++-16)
    "${compiler[@]}" -std=c++20 -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined,fuzzer-no-link \
        -fno-sanitize-recover=undefined -fPIC -Iengine -Ishaders -Itests/fuzz $(pkg-config --cflags OpenEXR) \
        -DCATOPTRIC_MODULES_FROM_PROGRAMS='"."' -c "$1" -o "$folder/objects/${1//\//_}.o"
}
export -f compile
modules=(engine/images/images.cpp engine/draco/draco.cpp)
sources=(engine/core/*.cpp engine/scene/*.cpp engine/import/*.cpp "tests/fuzz/$target.cpp")
{
    flock 9 # targets share the engine's object files, so only one target builds at a time
    printf '%s\0' "${modules[@]}" "${sources[@]}" | xargs -0 -n 1 -P "$(nproc)" bash -c 'compile "$1"' compile
    objects=("${sources[@]//\//_}")
    objects=("${objects[@]/#/$folder/objects/}")
    clang++-16 -fsanitize=address,undefined,fuzzer "${objects[@]/%/.o}" -o "$folder/$target/$target" \
        -ltinygltf -ltinyobjloader -lmeshoptimizer -lpng $(pkg-config --libs OpenEXR)
    clang++-16 -shared -fsanitize=address,undefined "$folder/objects/engine_images_images.cpp.o" \
        -o "$folder/$target/catoptric-images.so" -lOpenImageIO -lOpenImageIO_Util
    clang++-16 -shared -fsanitize=address,undefined "$folder/objects/engine_draco_draco.cpp.o" \
        -o "$folder/$target/catoptric-draco.so" -ldraco
} 9>"$folder/lock"
# leaks.txt suppresses leaks of OpenImageIO's own tables.
LSAN_OPTIONS=suppressions=tests/fuzz/leaks.txt:print_suppressions=0 \
    "$folder/$target/$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=65536 \
    -dict="tests/fuzz/$target.dict" -artifact_prefix="$folder/$target/" -print_final_stats=1 \
    "$folder/$target" "tests/fuzz/corpus/$target"
