#!/usr/bin/env bash
# Unpacks Mesa's Vulkan drivers from Debian's backports into build/drivers/mesa25. The system's drivers stay unchanged.
# Prints the path of the file by which the Vulkan loader finds the unpacked software driver. Exits with 1 and the reason
# if the drivers cannot be downloaded. Called by ./dev drivers.
set -euo pipefail
cd "$(dirname "$0")/../.."
drivers=$PWD/build/drivers
prefix=$drivers/mesa25
give_up() { echo "drivers: $*" >&2; exit 1; }
command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || give_up "needs apt-get and dpkg-deb"
release=$(. /etc/os-release; echo "${VERSION_CODENAME:-}")

# Use the Debian mirror from which the system installs its own packages.
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Release: $release" 'Component: main' | sed -n 1p)
[[ $mirror ]] || give_up "no source of apt's names the release '$release'"

# Run apt-get with its own lists, archives and sources in build/drivers/apt. From the system it only reads which
# packages are installed.
work=$drivers/apt
mkdir -p "$work/state/lists/partial" "$work/cache/archives/partial"
printf 'deb %s %s main\n' "$mirror" "$release" "$mirror" "$release-backports" >"$work/sources.list"
apt=(apt-get -q -o Dir::State="$work/state" -o Dir::State::status=/var/lib/dpkg/status -o Dir::Cache="$work/cache"
    -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o Dir::Etc::Preferences=/dev/null -o Dir::Etc::PreferencesParts=/dev/null
    -o APT::Sandbox::User="$(id -un)" -o Debug::NoLocking=true)
"${apt[@]}" update >&2 || give_up "$mirror has no suite '$release-backports'"
# Download the drivers, and the needed libraries that the system lacks or has in an older version.
rm -f "$work"/cache/archives/*.deb
"${apt[@]}" install -y --download-only --reinstall --no-install-recommends -t "$release-backports" mesa-vulkan-drivers >&2 ||
    give_up "cannot download mesa-vulkan-drivers of $release-backports"

rm -rf "$prefix"
for package in "$work"/cache/archives/*.deb; do
    dpkg-deb -x "$package" "$prefix"
    dpkg-deb -W --showformat='${Package} ${Version}\n' "$package" >>"$prefix/packages"
done
grep -q '^mesa-vulkan-drivers 25' "$prefix/packages" ||
    give_up "wanted Mesa 25, $release-backports has: $(grep mesa-vulkan-drivers "$prefix/packages")"
library=$(find "$prefix/usr/lib" -name libvulkan_lvp.so)
[[ $library ]] || give_up "the package has no libvulkan_lvp.so"
cat >"$prefix/icd.json" <<END
{"file_format_version": "1.0.0", "ICD": {"library_path": "$library", "api_version": "1.3.0"}}
END
ln -s "$(dirname "$library")" "$prefix/lib" # the folder that tests add to LD_LIBRARY_PATH
echo "$prefix/icd.json"
