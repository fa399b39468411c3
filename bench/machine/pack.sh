#!/usr/bin/env bash
# pack.sh BUILD [--small] [ARCHIVE]: packs an archive with which another machine can measure and test this build.
# The archive holds programs, the shared libraries that they load, the files that their tests read, and run.sh. The
# other machine needs bash, the usual Unix commands, tar and a Vulkan driver.
# ./dev pack calls this script. BUILD must be a finished build. The script writes only ARCHIVE (default
# catoptric-kit.tar.gz; a name in .tar.xz gives a much smaller archive in minutes).
# --small leaves out the modules for Draco and for pictures other than PNG and OpenEXR, with their libraries, which are
# more than half of the archive. No step of run.sh needs them.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
build=$(cd "$1" && pwd) modules=(catoptric-images.so catoptric-draco.so)
if [[ ${2:-} == --small ]]; then modules=(); shift; fi
archive=${2:-catoptric-kit.tar.gz}

programs=(catoptric catoptric_bench)
tests=(gpu reflect drivers) # the other test programs need no GPU, or need a compiler, a display or the fault layer
validation=VkLayer_khronos_validation

fail() { echo "pack: $*" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
kit=$work/catoptric-kit
mkdir -p "$kit"/{bin,lib,layers,source}

copy_libraries() { # copy_libraries FILE...: copies the libraries that the files load, except those of the C library
    local line name place
    while read -r line; do
        case $line in
        *'not found'*) fail "$line: a library is missing here, too" ;;
        *' => /'*) ;;
        *) continue ;;
        esac
        read -r name _ place _ <<<"$line"
        case $name in
        ld-linux* | libc.so* | libm.so* | libdl.so* | libpthread.so* | librt.so* | libresolv.so* | libutil.so* | \
            libnss_* | libanl.so* | libBrokenLocale.so* | libthread_db.so* | libmvec.so*) continue ;;
        esac
        # Copies the library under its full versioned name, by which run.sh finds the newer of two libraries. A link has
        # the name that programs ask for.
        [[ -e $kit/lib/$name ]] && continue
        place=$(readlink -f "$place")
        cp "$place" "$kit/lib/"
        [[ ${place##*/} == "$name" ]] || ln -s "${place##*/}" "$kit/lib/$name"
    done < <(for file in "$@"; do ldd "$file" 2>/dev/null || true; done | sort -u)
}
copy_validation() { # copies the Vulkan validation layer, which the tests enable
    local folder manifest library
    for folder in /usr/share/vulkan /etc/vulkan /usr/local/share/vulkan; do
        manifest=$folder/explicit_layer.d/$validation.json
        [[ -e $manifest ]] || continue
        library=$(ldconfig -p | sed -n "s|.*lib$validation.so.* => ||p" | head -n 1)
        [[ -n $library ]] || fail "$manifest: wanted its library, found none (Debian: vulkan-validationlayers)"
        cp "$library" "$kit/layers/"
        sed -E "s|(\"library_path\": *\")[^\"]*|\1./lib$validation.so|" "$manifest" >"$kit/layers/$validation.json"
        copy_libraries "$library"
        return
    done
    fail "wanted $validation.json, found none (Debian: vulkan-validationlayers)"
}

for file in "${programs[@]}" "${tests[@]/%/_test}" "${modules[@]}"; do
    [[ -e $build/$file ]] || fail "$build/$file: wanted a finished build, found no such file"
    cp "$build/$file" "$kit/bin/"
done
copy_libraries "$kit"/bin/*
copy_validation
for test in "${tests[@]}"; do # one entry for each test source, as in CTest, so that each runs in its own process
    for file in "$source/tests/$test"/*_test.cpp; do echo "$test $(basename "$file" _test.cpp)"; done
done >"$kit/tests.txt"
# Copies the source files that these tests read: scenes, and the sources of the techniques, which a test counts.
(cd "$source" && cp -r --parents -t "$kit/source" samples/scenes engine/reflect)
cp "$here/run.sh" "$kit/"
git -C "$source" describe --always --dirty >"$kit/commit.txt"
# The archive is written under another name and then renamed, so that a file with the final name is always complete.
new=$(dirname "$archive")/new-$(basename "$archive")
export XZ_OPT=${XZ_OPT:--9} # level 9 has a window larger than a program, so xz finds the code that programs share
tar -C "$work" -caf "$new" catoptric-kit
mv "$new" "$archive"
echo "packed: $archive ($(du -h "$archive" | cut -f 1))"
