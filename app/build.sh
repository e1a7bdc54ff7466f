# shellcheck shell=sh
# How the programs are configured and built. Sourced by app/run.sh and tests/run.sh.

# The folder that is built in. PATINA_BUILD names another one, for a source folder that is read only.
# shellcheck disable=SC2034
build_folder=${PATINA_BUILD:-$here/build}
case $build_folder in /*) ;; *) build_folder=$PWD/$build_folder ;; esac

# As many compilers as there are processors, but no more than 1.2 GB of free memory each allow.
# PATINA_JOBS sets the number.
build_jobs() {
  if [ -n "${PATINA_JOBS:-}" ]; then
    echo "$PATINA_JOBS"
    return
  fi
  jobs=$(nproc)
  free_kb=$(awk '/MemAvailable/ {print $2}' /proc/meminfo)
  by_memory=$((${free_kb:-4000000} / 1200000))
  [ "$by_memory" -ge 1 ] || by_memory=1
  [ "$by_memory" -lt "$jobs" ] && jobs=$by_memory
  echo "$jobs"
}

# Ends the script with 2 if a folder is not there and cannot be made, or cannot be written to.
# VARIABLE is the one in the environment that names another folder.
need_writable() { # FOLDER VARIABLE
  near=$1
  while [ ! -e "$near" ]; do near=$(dirname "$near"); done
  if [ ! -d "$near" ] || [ ! -w "$near" ]; then
    echo "$near cannot be written to: name another folder, as in $2=/tmp/patina $0" >&2
    exit 2
  fi
}

# Ends the script with 2 if a folder's disk has less room than a first build needs.
need_disk() { # FOLDER MEGABYTES
  free_mb=$(df -Pk "$1" | awk 'NR == 2 {print int($4 / 1024)}')
  if [ "${free_mb:-$2}" -lt "$2" ]; then
    echo "The disk of $1 is too full: building needs about $2 MB, and $free_mb MB are free. Free" \
      "some, or name a folder on another disk by PATINA_BUILD" >&2
    exit 2
  fi
}

# Says in one line why a command failed whose output is in LOG, and ends the script.
explain_failure() { # LOG
  if grep -q '^Missing: ' "$1"; then
    grep '^Missing: ' "$1" >&2
  elif [ -e "$1" ] && [ ! -w "$1" ]; then
    echo "$1 cannot be written to: remove it, or name another folder by PATINA_BUILD" >&2
  elif [ ! -s "$1" ] || grep -q 'No space left on device' "$1"; then
    echo "The disk of ${1%/*} or of ${TMPDIR:-/tmp} is full: free some space, then run this again;" \
      "it goes on from there" >&2
  elif grep -qE 'Killed signal|^Killed|(virtual )?memory exhausted|(cc1plus|cc1|ld|as|c\+\+): .*(out of memory|Cannot allocate memory)' "$1"; then
    echo "The compiler ran out of memory: close other programs, then run this again with" \
      "PATINA_JOBS=1 in the environment; it goes on from there" >&2
  else
    [ "${2:-}" = shown ] || cat "$1" >&2
    echo "This step failed; its messages stand above and in $1" >&2
    exit 1
  fi
  exit 2
}

# Configures a folder for a release build. CMake is heard only if it fails.
configure() { # FOLDER [CMAKE ARGUMENT]...
  tree=$1
  shift
  mkdir -p "$tree" || exit 2
  if grep -q '^CMAKE_GENERATOR:INTERNAL=' "$tree/CMakeCache.txt" 2>/dev/null &&
    ! grep -q '^CMAKE_GENERATOR:INTERNAL=Ninja$' "$tree/CMakeCache.txt"; then
    echo "$tree was configured for another generator than Ninja: remove it, or name another folder" \
      "by PATINA_BUILD" >&2
    exit 2
  fi
  LC_ALL=C cmake -S "$here" -B "$tree" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
    "$@" >"$tree/configure.log" 2>&1 || explain_failure "$tree/configure.log"
}

build() { # FOLDER [TARGET]...
  tree=$1
  shift
  # The exit code goes past the pipe; nothing on the disk holds it, for the disk may be full.
  code=$({ { { LC_ALL=C cmake --build "$tree" -j "$(build_jobs)" ${1:+--target "$@"} 2>&1 3>&- &&
    echo 0 >&3; } || echo 1 >&3; } | tee "$tree/build.log" >&2; } 3>&1) || true
  [ "$code" = 0 ] || explain_failure "$tree/build.log" shown
}
