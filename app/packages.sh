# shellcheck shell=sh disable=SC2034
# The Debian packages this project stands on, and how they get installed. Sourced by app/run.sh,
# tests/run.sh and tests/package.sh; the only place where they are listed.

# The last two are only read when the Debian package is made.
PATINA_BUILD_PACKAGES="g++ cmake ninja-build pkg-config libeigen3-dev libtbb-dev libopenmesh-dev
  nlohmann-json3-dev libssl-dev libusb-1.0-0-dev libvtk9-qt-dev qtbase5-dev
  libopenimageio-dev libopencv-contrib-dev libopencv-videoio-dev libavformat-dev
  libceres-dev libcairo2-dev libexpat1-dev libminizip-dev zlib1g-dev dpkg-dev file"
# For a machine without a display.
PATINA_HEADLESS_PACKAGES="xvfb xauth libgl1-mesa-dri"
PATINA_TEST_PACKAGES="$PATINA_HEADLESS_PACKAGES libgtest-dev libgmock-dev libbenchmark-dev
  libxcb-xtest0-dev openbox dbus-daemon clang libclang-rt-dev git python3 zsh fish umockdev poppler-utils"
# Only for the comparison with other programs; the tests pass without them.
PATINA_PEER_PACKAGES="libopenvdb-dev libembree-dev libapriltag-dev"
# For checking the Debian package.
PATINA_PACKAGE_PACKAGES="dpkg-dev file lintian appstream desktop-file-utils"

say() { printf '\n== %s\n' "$*" >&2; }

# Those of the named packages that are not installed.
missing_packages() {
  for package in "$@"; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$state" = installed ] || printf '%s ' "$package"
  done
}

# Installs what is missing, or says what to install and ends the script with 2.
need_packages() {
  [ "${PATINA_INSTALL:-yes}" = no ] && return 0
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    cat >&2 <<TEXT
This system has no apt-get. Install what these packages of Debian 12 hold, then run this again
with PATINA_INSTALL=no in the environment:
  $*
TEXT
    exit 2
  fi
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" = 0 ]; then
    as_root=
  elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    as_root="sudo -n"
  else
    echo "Packages are missing. As root, run this, then start again:" \
      "apt-get update && apt-get install -y --no-install-recommends $missing" >&2
    exit 2
  fi
  say "Installing $missing"
  install_packages "$missing" || exit 2
}

# With PATINA_INSTALL=no nothing has looked for these yet.
need_tools() {
  for tool in "$@"; do
    command -v "$tool" >/dev/null && continue
    echo "$tool is not on the PATH: install it, or let this script do so (unset PATINA_INSTALL)" >&2
    exit 2
  done
}

# Installs a list of packages, or says in one line why apt could not. An update that fails is no
# failure yet: the lists of before may do.
# shellcheck disable=SC2086 # $as_root and the list are meant to split into words.
install_packages() {
  log=$(mktemp) || {
    echo "No file can be made in ${TMPDIR:-/tmp}: free some space there, then run this again" >&2
    return 1
  }
  # The exit code goes past the pipe; nothing on the disk holds it, for the disk may be full.
  code=$({ {
    $as_root env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get update -q </dev/null 3>&- || true
    umask 022
    { $as_root env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get install -q -y \
      --no-install-recommends $1 </dev/null 3>&- && echo 0 >&3; } || echo 1 >&3
  } 2>&1 | tee "$log" >&2; } 3>&1) || true
  cause=
  if [ "$code" != 0 ]; then
    if [ ! -s "$log" ] || grep -qE 'No space left|enough free space' "$log"; then
      cause="the disk is full: free some space"
    elif grep -qE 'Could not get lock|Unable to (acquire|lock)' "$log"; then
      cause="another program is using apt: let it end"
    elif grep -qE 'Failed to fetch|Temporary failure|Unable to (locate|fetch|connect)|no installation candidate' "$log"; then
      cause="apt cannot reach what its sources name: look at the network and at /etc/apt/sources.list"
    else
      cause="its messages stand above"
    fi
    echo "The packages could not be installed: $cause; then run this again" >&2
  fi
  rm -f "$log"
  [ -z "$cause" ]
}
