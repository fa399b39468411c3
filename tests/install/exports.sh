#!/usr/bin/env bash
# exports.sh LIBRARY INCLUDE_FOLDER: checks that the library exports exactly the functions that its installed headers
# mark with CATOPTRIC_API. Each function that these headers declare without a definition must have the mark.
set -euo pipefail
headers=$(find "$2/catoptric" -name '*.hpp' ! -name export.hpp)

# Compare names of functions without namespace, class and arguments. Types of exceptions are left out, because they are
# templates and inline.
shown=$(nm -D --defined-only -C "$1" | cut -d' ' -f3- | sed 's/\[abi:cxx11\]//')
strangers=$(grep -Ev '^(typeinfo( name)? for |vtable for )?catoptric::' <<<"$shown" || true)
[[ -z $strangers ]] || { printf 'exported, though not of catoptric:\n%s\n' "$strangers"; exit 1; }
errors='^((typeinfo( name)?|vtable) for )?catoptric::Error(Of<.*>)?($|::)'
exported=$(grep -Ev "$errors" <<<"$shown" | sed -E 's/\(.*//; s/.*:://' | sort -u)
declarations=$(cat $headers | sed 's#//.*##' | tr -s ' \n' '  ')
marked=$(grep -oE 'CATOPTRIC_API [^;{]*' <<<"$declarations" | grep -v '^CATOPTRIC_API Error' |
    sed -E 's/\(.*//; s/.*[ &*]//' | sort -u)
difference=$(diff <(echo "$marked") <(echo "$exported")) ||
    { printf 'marked in headers (<) and exported (>) differ:\n%s\n' "$difference"; exit 1; }

unmarked=$(grep -nE '^[A-Za-z][A-Za-z_:<>,&* ]*[ &*][a-z_]+\(' $headers |
    grep -Ev ':(CATOPTRIC_API|inline|constexpr|template|void (fail|check)|\[\[noreturn\]\] void fail|    )' || true)
[[ -z $unmarked ]] || { printf 'declared in an installed header, but not exported:\n%s\n' "$unmarked"; exit 1; }
echo "$(wc -l <<<"$exported") names exported"
