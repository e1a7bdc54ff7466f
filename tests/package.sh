#!/bin/bash
# Builds the Debian package and checks it; installs the checkers that are missing.
#   tests/package.sh [BUILD]            by lintian, appstreamcli, desktop-file-validate and its list
#   tests/package.sh [BUILD] --root     then installs it into a bare Debian 12 and uses it (as root)
# BUILD is a configured build folder; build if it is not named.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/app/packages.sh"

build=$here/build
with_root=no
for word in "$@"; do
  case "$word" in
  --root) with_root=yes ;;
  -*)
    sed -n '2,5s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
  *) build=$word ;;
  esac
done
if [ ! -f "$build/CMakeCache.txt" ]; then
  echo "$build: is no build folder; configure it: cmake -S . -B $build -G Ninja" >&2
  exit 2
fi
# shellcheck disable=SC2086 # a list of words
need_packages $PATINA_PACKAGE_PACKAGES
need_tools dpkg-shlibdeps file lintian appstreamcli desktop-file-validate

work=$(mktemp -d)
clean() {
  for place in dev/shm dev sys proc; do
    ! mountpoint -q "$work/root/$place" || umount "$work/root/$place"
  done
  rm -rf --one-file-system "$work"
}
trap clean EXIT

say "Building the package"
rm -f "$build"/patina_*.deb
cmake --build "$build" --target deb -j "$(build_jobs)" >&2
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
  lib/patina/patina_images.so share/applications/local.patina.Patina.desktop \
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

if [ "$with_root" = yes ]; then
  say "Installing it into a bare Debian 12"
  need_packages mmdebstrap
  mmdebstrap --quiet --variant=minbase bookworm "$work/root"
  mount -t proc proc "$work/root/proc"
  mount --bind /sys "$work/root/sys"
  mount --bind /dev "$work/root/dev"
  mount -t tmpfs tmpfs "$work/root/dev/shm"
  cp "$package" "$work/root/"
  chroot "$work/root" sh -c 'export DEBIAN_FRONTEND=noninteractive
    apt-get -q update && apt-get -q -y install /patina_*.deb' </dev/null >"$work/apt.log" 2>&1 ||
    { cat "$work/apt.log" >&2; exit 1; }

  say "Using it there"
  chroot "$work/root" sh -ec '
    cd /tmp
    patina --version
    patina devices | tee devices.txt
    if grep -i example devices.txt; then exit 1; fi
    patina model plate -o plate.ply
    patina scene --add plate.ply -o relief \
      --image plate=/usr/share/icons/hicolor/128x128/apps/patina.png,relief,z
    xvfb-run -a patina render relief -o relief.png
    xvfb-run -a patina gui --first-picture-time
    xvfb-run -a patina demo -o demo
    test -s relief.png -a -s demo/report.md
    bash -c ". /usr/share/bash-completion/completions/patina && complete -p patina"
    apt-get -q -y purge patina
    test ! -e /usr/lib/patina' </dev/null >&2
fi
say "Passed"
