#!/bin/bash
# Builds the Debian package and checks it; installs the checkers that are missing.
#   tests/package.sh [BUILD]            checks it by lintian, appstreamcli, desktop-file-validate and a
#                                       list of its files
# BUILD is a configured build folder; build if it is not named. tests/fresh.sh --package installs the
# package in a bare Debian and uses it there.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/app/packages.sh"
. "$here/app/build.sh"

case "${1:-}" in
-*)
  sed -n '2,6s/^# \{0,1\}//p' "$0" >&2
  exit 2
  ;;
esac
build=${1:-$here/build}
if [ ! -f "$build/CMakeCache.txt" ]; then
  echo "$build is no build folder; configure it: cmake -S '$here' -B '$build' -G Ninja" >&2
  exit 2
fi
# shellcheck disable=SC2086 # a list of words
need_packages $PATINA_PACKAGE_PACKAGES
need_tools dpkg-shlibdeps file lintian appstreamcli desktop-file-validate

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

say "Building the package"
rm -f "$build"/patina_*.deb
build "$build" deb
package=$(echo "$build"/patina_*.deb)

say "Checking $package"
lintian --allow-root --fail-on error,warning "$package"
dpkg-deb -x "$package" "$work/files"
share=$work/files/usr/share
appstreamcli validate --no-net "$share"/metainfo/*.xml
desktop-file-validate "$share"/applications/*.desktop

failed=0
fail() {
  echo "$package: $*" >&2
  failed=1
}
for file in bin/patina bin/patina-gui include/patina_device.h lib/udev/rules.d/70-patina.rules \
  lib/patina/patina_images.so lib/patina/patina-udev share/applications/local.patina.Patina.desktop \
  share/bash-completion/completions/patina share/doc/patina/changelog.gz \
  share/doc/patina/copyright share/doc/patina/examples/example_device.c \
  share/fish/vendor_completions.d/patina.fish share/icons/hicolor/scalable/apps/patina.svg \
  share/icons/hicolor/{48x48,64x64,128x128}/apps/patina.png share/man/man1/patina.1.gz \
  share/man/man1/patina-gui.1.gz share/metainfo/local.patina.Patina.metainfo.xml \
  share/mime/packages/patina.xml share/zsh/vendor-completions/_patina; do
  [ -s "$work/files/usr/$file" ] || fail "usr/$file is missing or empty"
done
commands=$("$build/bin/patina" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z-]\{1,\}\)  .*/\1/p')
[ -n "$commands" ] || fail "patina --help lists no command"
for command in $commands; do
  gzip -dc "$share/man/man1/patina-$command.1.gz" | grep -q '^\.SH NAME' ||
    fail "there is no manual page of patina $command"
done
[ -z "$(find "$work/files" -name '*device_example*')" ] || fail "the example device is a library"
[ "$failed" = 0 ] || exit 1
say "Passed"
