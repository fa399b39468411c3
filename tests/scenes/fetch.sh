#!/usr/bin/env bash
# Unpacks scenes by other authors into build/scenes: the Debian packages assimp-testmodels and sweethome3d-furniture,
# and the npm package @webxr-input-profiles/assets. Installs nothing. Exits with 1 and the reason if a package cannot be
# downloaded. Called by ./dev scenes.
set -euo pipefail
cd "$(dirname "$0")/../.."
scenes=$PWD/build/scenes
give_up() { echo "scenes: $*" >&2; exit 1; }
[[ ! -e $scenes/complete ]] || exit 0
for tool in apt-get dpkg-deb npm python3; do command -v $tool >/dev/null || give_up "needs $tool"; done

rm -rf "$scenes/fetched" && mkdir -p "$scenes/fetched"
cd "$scenes/fetched"
for package in assimp-testmodels=5.2.5~ds0-1 sweethome3d-furniture=1.8-1; do
    apt-get -q download $package >&2 || give_up "cannot download $package; apt-get update may help"
done
npm pack --silent @webxr-input-profiles/assets@1.0.20 >&2 || give_up "cannot download @webxr-input-profiles/assets"

for package in *.deb; do dpkg-deb -x "$package" unpacked; done
tar -xzf webxr-input-profiles-assets-1.0.20.tgz
rm -rf "$scenes"/{assimp,furniture,webxr}
mv unpacked/usr/share/assimp/models "$scenes/assimp"
for archive in unpacked/usr/share/sweethome3d/furniture/*.sh3f; do
    python3 -m zipfile -e "$archive" "$scenes/furniture/$(basename "$archive" .sh3f)"
done
mv package/dist/profiles "$scenes/webxr"
rm -rf "$scenes/fetched"
touch "$scenes/complete"
