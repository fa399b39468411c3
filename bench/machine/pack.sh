#!/usr/bin/env bash
# Packs what another machine needs to measure and test this build: programs, the libraries that they load, the files
# that their tests read, and run.sh. That machine needs bash, the usual commands beside it, tar and a Vulkan driver.
# Called by ./dev pack: pack.sh BUILD [--small] [ARCHIVE]. Needs a finished build; writes nothing but ARCHIVE
# (catoptric-kit.tar.gz; .tar.xz takes minutes and is much smaller). --small leaves out the library of picture files
# with what it loads, more than half of it all; then run.sh leaves out compare, which writes OpenEXR.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
build=$(cd "$1" && pwd) modules=(catoptric-images.so)
if [[ ${2:-} == --small ]]; then modules=(); shift; fi
archive=${2:-catoptric-kit.tar.gz}

programs=(catoptric catoptric_bench)
tests=(gpu reflect drivers) # the others are of the host, or need a compiler, a display or the layer of faults
validation=VkLayer_khronos_validation

fail() { echo "pack: $*" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
kit=$work/catoptric-kit
mkdir -p "$kit"/{bin,lib,layers,source}

copy_libraries() { # copy_libraries FILE...: what they load, but for the C library and what belongs to the kernel
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
        # Under its full name, by which run.sh tells which of two is newer, with a link by the one that is asked for.
        [[ -e $kit/lib/$name ]] && continue
        place=$(readlink -f "$place")
        cp "$place" "$kit/lib/"
        [[ ${place##*/} == "$name" ]] || ln -s "${place##*/}" "$kit/lib/$name"
    done < <(for file in "$@"; do ldd "$file" 2>/dev/null || true; done | sort -u)
}
copy_validation() { # the layer that the tests switch on
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
for test in "${tests[@]}"; do # as CTest has them: each source in a process of its own
    for file in "$source/tests/$test"/*_test.cpp; do echo "$test $(basename "$file" _test.cpp)"; done
done >"$kit/tests.txt"
# Files of the tree that these tests read: scenes, and the sources that say how many techniques there are.
(cd "$source" && cp -r --parents -t "$kit/source" samples/scenes engine/reflect)
cp "$here/run.sh" "$kit/"
git -C "$source" describe --always --dirty >"$kit/commit.txt"
# Made aside: an archive that is there is a whole one.
new=$(dirname "$archive")/new-$(basename "$archive")
export XZ_OPT=${XZ_OPT:--9} # whose window is wider than a program: they share most of what they are
tar -C "$work" -caf "$new" catoptric-kit
mv "$new" "$archive"
echo "packed: $archive ($(du -h "$archive" | cut -f 1))"
