#!/usr/bin/env bash
# deb.sh BUILD WORK PICTURE [HELP2MAN [MKDOCS]]: builds the Debian package of the build, unpacks it into an empty root, and
# tries its programs, completions and, if the build makes them, pages of the manual and static pages there.
set -euo pipefail
build=$1 work=$2
die() { echo "deb: $*" >&2; exit 1; }
rm -rf "$work"; mkdir -p "$work/root"
cmake --build "$build" --target package_files
cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work" >"$work/log" || { cat "$work/log"; die "cpack failed"; }
package=("$work"/catoptric_*.deb)
[[ -e ${package[0]} ]] || die "cpack wrote no package"
depends=$(dpkg-deb -f "${package[0]}" Depends)
for wanted in libvulkan1 libc6; do
    [[ $depends == *$wanted* ]] || die "wanted a dependency on $wanted, found: $depends"
done
[[ $depends != *libcatoptric* ]] || die "the package depends on itself: $depends"
dpkg-deb -x "${package[0]}" "$work/root"
root=$work/root/usr
for file in bin/catoptric include/catoptric/compare.hpp share/catoptric/shaders/lib/mirror.glsl \
    share/bash-completion/completions/catoptric share/zsh/vendor-completions/_catoptric \
    share/fish/vendor_completions.d/catoptric.fish share/doc/catoptric/copyright share/doc/catoptric/glossary.md; do
    [[ -s $root/$file ]] || die "wanted usr/$file, found none"
done
grep -q 'Leon Sorokin' "$root/share/doc/catoptric/copyright" || die "wanted the licence of uPlot in usr/share/doc/catoptric/copyright"
[[ $(find "$work/root" -type f -not -path "$root/*") == '' ]] || die "the package writes outside of usr"
"$root/bin/catoptric" --version | grep -q '^catoptric ' || die "the unpacked program does not start"
"$root/bin/catoptric" diff "$3" "$3" >/dev/null || die "the unpacked program finds no image module"
if [[ -n ${4:-} && $4 != *-NOTFOUND ]]; then
    for page in catoptric catoptric-compare; do
        [[ -s $root/share/man/man1/$page.1 || -s $root/share/man/man1/$page.1.gz ]] || die "wanted the page $page(1)"
    done
fi
if [[ -n ${5:-} && $5 != *-NOTFOUND ]]; then
    for page in index tutorial command-line notes/ADR-005-captures; do
        grep -q '</html>' "$root/share/doc/catoptric/html/$page.html" || die "wanted the page html/$page.html"
    done
    [[ -s $root/share/doc/catoptric/html/images/first.png ]] || die "wanted the pictures of the pages in html/images"
fi
complete() { # complete WORD...: prints what bash offers for the last word
    bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _catoptric; echo "${COMPREPLY[*]}"' \
        bash "$root/share/bash-completion/completions/catoptric" "$@"
}
expect() { # expect OFFER WORD...
    local offer=$1 found; shift
    found=$(cd "$work/root" && complete "$@")
    [[ $found == "$offer" ]] || die "'$*': wanted '$offer', found '$found'"
}
expect 'compare completion' catoptric comp
expect '--techniques' catoptric compare --techn
expect 'secant' catoptric render --technique sec
expect 'cornell-mirrors cornell-mirrors-closed courtyard cornell-rough' catoptric compare co
expect 'bash' catoptric completion b
expect '' catoptric compare no-such-file
echo "deb: $(basename "${package[0]}"), $(stat -c %s "${package[0]}") bytes"
