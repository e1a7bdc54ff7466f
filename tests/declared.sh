#!/bin/bash
# Looks up which Debian package each header and library comes from that a build has read, and fails
# if one is neither named by PATINA_BUILD_PACKAGES nor brought by a package that is.
#   tests/declared.sh [BUILD FOLDER]
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/app/packages.sh"
build=$(realpath -e "${1:-$here/build}")
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
export LC_ALL=C

# shellcheck disable=SC2086 # a list of words
apt-cache depends --recurse --installed --no-recommends --no-suggests --no-conflicts --no-breaks \
  --no-replaces --no-enhances $PATINA_BUILD_PACKAGES | grep '^[a-z0-9]' | sed 's/:.*//' |
  sort -u >"$work/declared"

# What the compiler read stands in the dependencies that ninja keeps, what the linker was given in
# the rules.
libraries() {
  grep -oE '[ =]/[^ :|$]*\.(so|a)(\.[0-9]+)*( |$)' "$build/build.ninja" | tr -d ' ='
  { grep -oE ' -l[A-Za-z0-9_+.-]+' "$build/build.ninja" || true; } | sed 's/ -l//' | sort -u |
    while read -r name; do g++ -print-file-name="lib$name.so"; done
}
{
  ninja -C "$build" -t deps | sed -n 's/^    \(\/.*\)/\1/p'
  libraries
} | sort -u | grep '^/' | grep -vF -e "$here/" -e "$build/" | xargs -d '\n' realpath -e |
  sort -u >"$work/read"

# Packages list some files under /lib, which is a link to /usr/lib.
for list in /var/lib/dpkg/info/*.list; do
  package=${list##*/}
  package=${package%.list}
  awk -v package="${package%%:*}" '{ sub("^/lib", "/usr/lib"); print $0 "\t" package }' "$list"
done | sort -t $'\t' -k 1,1 >"$work/owned"
join -t $'\t' -a 1 -o 0,2.2 -e '(no package)' "$work/read" "$work/owned" >"$work/owners"

awk -F '\t' 'NR == FNR { declared[$1]; next } !($2 in declared) { print $2 ": " $1 }' \
  "$work/declared" "$work/owners" >"$work/outside"
echo "The build has read $(wc -l <"$work/read") headers and libraries of" \
  "$(cut -f 2 "$work/owners" | sort -u | wc -l) packages; $(wc -l <"$work/outside") are not declared"
[ ! -s "$work/outside" ] || { head -n 40 "$work/outside" >&2; exit 1; }
