#!/usr/bin/env bash
# missing.sh VENV WORK: checks that each missing part of the system is one sentence with the name of its package. A copy
# of the package asks for libraries that do not exist.
set -euo pipefail
venv=$1 work=$2
die() { echo "python: $*" >&2; exit 1; }
expect() { # expect TEXT PACKAGE: checks the last line of a traceback
    local last
    last=$(tail -n 1 <<<"$1")
    [[ $last == catoptric.* || $last == ImportError:* ]] || die "wanted an exception, found: $1"
    [[ $last == *"apt-get install"*"$2"* ]] || die "wanted the package $2, found: $last"
    [[ $last != *". "* ]] || die "wanted one sentence, found: $last"
}
raises() { ! "$venv/bin/python" -c "$1" 2>&1 || die "wanted an exception: $1"; }

expect "$(export VK_DRIVER_FILES=/no/driver.json VK_ICD_FILENAMES=/no/driver.json
    raises 'import catoptric; catoptric.Engine()')" mesa-vulkan-drivers
rm -rf "$work"; mkdir -p "$work"
cp -r "$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("platlib"))')"/catoptric* "$work"
export PYTHONPATH=$work
patchelf --replace-needed libOpenImageIO.so.2.4 libOpenImageIO-missing.so.2.4 "$work/catoptric/catoptric-images.so"
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81' >"$work/grey.hdr"
expect "$(raises "import catoptric; catoptric.read_picture('$work/grey.hdr')")" libopenimageio2.4
patchelf --replace-needed libvulkan.so.1 libvulkan-missing.so.1 "$work/catoptric/libcatoptric.so.0"
expect "$(raises 'import catoptric')" libvulkan1
echo "missing driver, loader and OpenImageIO: one sentence each"
