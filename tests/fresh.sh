#!/bin/bash
# Tries README's commands in a bare Debian system, which is made in a folder and removed afterwards:
# nothing is there but what the scripts install. Needs root, chroot and the package sources of this
# machine; where one of them is refused it fails.
#   tests/fresh.sh                     app/run.sh as an ordinary user, after root has installed what it
#                                      names; then, in a second system and another folder, app/run.sh
#                                      as root; both must build the same programs, byte for byte
#   tests/fresh.sh --tests [--quick]   app/run.sh as an ordinary user, then tests/run.sh as root
#   tests/fresh.sh --package FILE.deb  installs Debian's own way and uses what is installed
#   --release bookworm|trixie          the Debian that is tried; this machine's unless told
#   --keep                             leaves the system, without its mounts, and says where
# Each part prints its time. What the build has read must be what is declared (tests/declared.sh).
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/app/packages.sh"

# shellcheck disable=SC1091
host_release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
release=$host_release
mode=twice
quick=
keep=no
while [ $# -gt 0 ]; do
  case "$1" in
  --release) release=${2:?--release needs a name}; shift ;;
  --tests) mode=tests ;;
  --quick) quick=--quick ;;
  --package)
    mode=package
    package=$(realpath -e "${2:?--package needs a file}")
    shift
    ;;
  --keep) keep=yes ;;
  *) sed -n '2,12s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
  esac
  shift
done

if [ "$(id -u)" != 0 ]; then
  echo "tests/fresh.sh makes a system of its own and needs root for it" >&2
  exit 2
fi
need_packages mmdebstrap

# Mounts and processes live in namespaces of their own: both are gone when this script is.
if [ "${PATINA_FRESH_INSIDE:-}" != yes ]; then
  words=(--release "$release")
  [ $mode != tests ] || words+=(--tests)
  [ $mode != package ] || words+=(--package "$package")
  [ -z "$quick" ] || words+=("$quick")
  [ $keep = no ] || words+=(--keep)
  PATINA_FRESH_INSIDE=yes exec unshare --mount --pid --fork --kill-child --mount-proc "$0" "${words[@]}"
fi

# The folder of the clone has a space and a letter that is not ASCII, as people's have; the tests run
# in a plain one.
person=ada
clone="/srv/$person/Übung haptik/patina"
[ $mode != tests ] || clone=/srv/$person/patina
root=

remove_system() {
  umount -R "$root"/{proc,sys,dev} 2>/dev/null || true
  rm -rf --one-file-system "$root" "$root.list"
  root=
}

finish() {
  local code=$?
  trap - EXIT
  if [ -n "$root" ] && [ $keep = yes ]; then
    say "The system is kept in $root"
  elif [ -n "$root" ]; then
    remove_system
  fi
  [ $code -eq 0 ] || say "FAILED: this does not hold on a bare $release"
  exit $code
}
trap finish EXIT

# timed WHAT COMMAND...
timed() {
  local what=$1 began=$SECONDS
  shift
  say "$what"
  "$@"
  say "$what: $((SECONDS - began)) s"
}

# The lines of this machine's sources that name Debian's own archive, for the release that is tried.
sources() {
  apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
    sort -u | while read -r uri suite component; do
      case "$suite:$component" in
      "$host_release:main" | "$host_release-updates:main" | "$host_release-security:main")
        echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $uri" \
          "${suite/#$host_release/$release} main"
        ;;
      esac
    done
}

commit=$(git -C "$here" -c safe.directory="$here" rev-parse HEAD)

make_system() {
  root=$(mktemp -d "${TMPDIR:-/var/tmp}/patina-fresh-XXXXXX")
  chmod 755 "$root"
  sources >"$root.list"
  mmdebstrap --quiet --variant=minbase "$release" "$root" "$root.list"
  rm "$root.list"
  # A system that is thrown away need not survive a power cut.
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fresh"
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
  mount -t proc proc "$root/proc"
  mount -t sysfs -o ro sys "$root/sys"
  mount -t tmpfs -o mode=755 dev "$root/dev"
  local node
  for node in null zero full random urandom tty; do
    touch "$root/dev/$node"
    mount --bind "/dev/$node" "$root/dev/$node"
  done
  ln -s /proc/self/fd "$root/dev/fd"
  ln -s fd/0 "$root/dev/stdin"
  ln -s fd/1 "$root/dev/stdout"
  ln -s fd/2 "$root/dev/stderr"
  mkdir "$root/dev/shm" "$root/dev/pts"
  mount -t tmpfs -o mode=1777 shm "$root/dev/shm"
  mount -t devpts -o newinstance,ptmxmode=0666,mode=620 pts "$root/dev/pts"
  ln -s pts/ptmx "$root/dev/ptmx"
  echo "$person:x:1000:1000::/srv/$person:/bin/bash" >>"$root/etc/passwd"
  echo "$person:x:1000:" >>"$root/etc/group"
  mkdir -p "$root$clone"
  # What a person gets who downloads the commit: no history, and no git to read one.
  git -C "$here" -c safe.directory="$here" archive "$commit" | tar -x -C "$root$clone"
  chown -R 1000:1000 "$root/srv/$person"
}

# in_system USER SCRIPT: its environment is that of a first login without a display.
in_system() {
  local user=(--reuid=0 --regid=0 --clear-groups) home=/root
  if [ "$1" != root ]; then
    user=(--reuid=1000 --regid=1000 --clear-groups)
    home=/srv/$person
  fi
  chroot "$root" setpriv "${user[@]}" env -i HOME="$home" TERM=dumb LANG=C.UTF-8 CI="${CI:-}" \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin PATINA_WERROR=ON \
    bash -euc "cd '$clone'; $2" </dev/null
}

# An ordinary user is refused in one line, which names the command that root must run.
install_what_is_named() { # SCRIPT
  local said command
  if said=$(in_system $person "$1" 2>&1); then
    echo "$1 ran, though nothing is installed" >&2
    return 1
  fi
  command=$(sed -n 's/^Packages are missing. As root, run this, then start again: //p' <<<"$said")
  if [ -z "$command" ] || [ "$(wc -l <<<"$said")" != 1 ]; then
    printf '%s does not say in one line what root must install, but:\n%s\n' "$1" "$said" >&2
    return 1
  fi
  in_system root "$command" >"$root/tmp/apt.log" 2>&1 || { tail -n 20 "$root/tmp/apt.log"; return 1; }
}

first_command_as_person() {
  timed "A bare $release" make_system
  timed "What the first command names, installed by root" install_what_is_named app/run.sh
  timed "app/run.sh as an ordinary user" in_system $person app/run.sh
  in_system $person "test -s out/report.md
    build/bin/patina --version | tee out/version.txt
    grep -qF ${commit:0:12} out/version.txt"
  timed "The package" in_system $person "ninja -C build deb >&2 && ls -l build/patina_*.deb"
  timed "What the build has read" in_system root tests/declared.sh
}

# The digests of all that is built into bin, by name.
programs() {
  (cd "$root$clone/build/bin" && find . -type f -print0 | sort -z | xargs -0 sha256sum)
}

use_package() {
  cp "$package" "$root/package.deb"
  in_system root "
    export DEBIAN_FRONTEND=noninteractive
    apt-get -q update && apt-get -q -y install /package.deb" >"$root/tmp/apt.log" 2>&1 ||
    { tail -n 20 "$root/tmp/apt.log"; return 1; }
  in_system $person '
    cd ~
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
    bash -c ". /usr/share/bash-completion/completions/patina && complete -p patina"'
  in_system root "apt-get -q -y purge patina && test ! -e /usr/lib/patina" >/dev/null
}

if [ $mode = package ]; then
  timed "A bare $release" make_system
  timed "The package, installed and used" use_package
  say "The package holds on a bare $release"
  exit 0
fi
first_command_as_person
if [ $mode = tests ]; then
  timed "tests/run.sh as root" in_system root "tests/run.sh $quick"
else
  built=$(programs)
  remove_system
  clone=/srv/$person/patina
  timed "A second bare $release" make_system
  timed "app/run.sh as root" in_system root app/run.sh
  in_system root "test -s out/report.md"
  timed "The window" in_system root "ninja -C build patina-gui >&2"
  diff <(echo "$built") <(programs) || { echo "two builds of $commit differ"; exit 1; }
  say "Both built the same $(wc -l <<<"$built") programs and libraries"
fi
say "README's commands hold on a bare $release ($((SECONDS / 60)) min)"
