# The Debian packages this project stands on, and how they get installed. Sourced by app/run.sh and
# tests/run.sh; the only place where they are listed.

PATINA_BUILD_PACKAGES="g++ cmake ninja-build pkg-config libeigen3-dev libtbb-dev libopenmesh-dev
 nlohmann-json3-dev libssl-dev libusb-1.0-0-dev libvtk9-qt-dev qtbase5-dev
  libopenimageio-dev libopencv-contrib-dev libopencv-videoio-dev"
# For a machine without a display.
PATINA_HEADLESS_PACKAGES="xvfb xauth libgl1-mesa-dri"
PATINA_TEST_PACKAGES="$PATINA_HEADLESS_PACKAGES libgtest-dev libgmock-dev libbenchmark-dev
  libxcb-xtest0-dev openbox dbus-daemon clang libclang-rt-dev python3 zsh umockdev"
# Only for the comparison with other programs; the tests pass without them.
PATINA_PEER_PACKAGES="libopenvdb-dev libembree-dev libapriltag-dev"

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
This system has no apt-get. Install what these packages of Debian 12 or 13 hold, then run this again
with PATINA_INSTALL=no in the environment:
  $(echo "$@")
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
    cat >&2 <<TEXT
Packages are missing and this user may not install them. As root, run
  apt-get update && apt-get install --no-install-recommends $missing
and then this script again. (Libraries of your own instead: set PATINA_INSTALL=no.)
TEXT
    exit 2
  fi
  say "Installing $missing"
  if ! install_packages "$missing"; then
    echo "apt-get could not install: $missing" >&2
    echo "Look at its messages above; the network and /etc/apt/sources.list are the usual causes." >&2
    exit 2
  fi
}

# With PATINA_INSTALL=no nothing has looked for these yet.
need_tools() {
  for tool in "$@"; do
    command -v "$tool" >/dev/null && continue
    echo "$tool is not on the PATH: install it, or let this script do so (unset PATINA_INSTALL)" >&2
    exit 2
  done
}

# $as_root and the list are meant to split into words.
# shellcheck disable=SC2086
install_packages() {
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q </dev/null >&2 &&
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $1 \
      </dev/null >&2
}

# As many compilers as there are processors, but no more than 1.2 GB of free memory each allow.
build_jobs() {
  jobs=$(nproc)
  free_kb=$(awk '/MemAvailable/ {print $2}' /proc/meminfo)
  by_memory=$((${free_kb:-4000000} / 1200000))
  [ "$by_memory" -ge 1 ] || by_memory=1
  [ "$by_memory" -lt "$jobs" ] && jobs=$by_memory
  echo "$jobs"
}
