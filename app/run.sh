#!/bin/sh
# Installs what is missing, builds, and runs the main job: a surface that you see and feel.
#   app/run.sh [MESH or WORKSPACE] [--unit mm|cm|m|in|fit]
# With no argument: from a scan to a feel on a toy, step by step in the window. With no display the
# same job runs without a window, which is not built then, and leaves pictures and tables in out/.
#   The first time takes about 10 minutes on two cores and 4 GB of disk: 3 GB of packages and 1 GB
#   in build/. A run that was stopped goes on where it was.
#   PATINA_BUILD=FOLDER   builds there instead of in build/
#   PATINA_OUT=FOLDER     writes there instead of into out/
#   PATINA_JOBS=N         runs N compilers at once
#   PATINA_INSTALL=no     installs no packages: the libraries are there already
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/app/packages.sh"
. "$here/app/build.sh"

case "${1:-}" in
-h | --help)
  sed -n '2,12s/^# \{0,1\}//p' "$0"
  exit 0
  ;;
esac
# Options alone name nothing to feel: then it is the dinosaur, in its own unit.
named=no
value=no
for word in "$@"; do
  if [ "$value" = yes ]; then
    value=no
    continue
  fi
  case "$word" in
  --unit | --iso | --log) value=yes ;;
  -*) ;;
  *)
    if [ ! -e "$word" ]; then
      echo "$word: there is no such file or folder" >&2
      exit 2
    fi
    named=yes
    ;;
  esac
done

out=${PATINA_OUT:-$here/out}
need_writable "$build_folder" PATINA_BUILD
[ -n "${DISPLAY:-}" ] || need_writable "$out" PATINA_OUT
# shellcheck disable=SC2086 # lists of words
if [ -n "${DISPLAY:-}" ]; then
  need_packages $PATINA_BUILD_PACKAGES
  need_tools c++ cmake ninja
else
  need_packages $PATINA_BUILD_PACKAGES $PATINA_HEADLESS_PACKAGES
  need_tools c++ cmake ninja xvfb-run
fi

say "Building (the first time takes some minutes)"
if [ ! -f "$build_folder/build.ninja" ]; then
  mkdir -p "$build_folder"
  need_disk "$build_folder" 1100
  configure "$build_folder" -DBUILD_TESTING=OFF -DPATINA_WERROR="${PATINA_WERROR:-OFF}"
fi
# Without a display no window is opened, and none is built: a fifth of the time.
targets="patina patina-gui"
[ -n "${DISPLAY:-}" ] || targets=patina
# shellcheck disable=SC2086 # a list of words
build "$build_folder" $targets
bin=$build_folder/bin

if [ -n "${DISPLAY:-}" ]; then
  [ $# -gt 0 ] || set -- --demo
  exec "$bin/patina-gui" "$@"
fi

mkdir -p "$out"
in_window() { xvfb-run -a -s "-screen 0 1280x800x24" "$@" </dev/null; }
if [ $# -eq 0 ]; then
  say "No display: from a scan to a feel without a window"
  in_window "$bin/patina" demo -o "$out"
  say "Done. $out/report.md says what each step found"
  exit 0
fi
if [ "$named" = no ]; then
  "$bin/patina" model dinosaur -o "$out/dinosaur.ply"
  set -- "$out/dinosaur.ply"
fi
say "No display: what the object is, how it feels and what it looks like"
"$bin/patina" info "$@" --json >"$out/info.json"
# A tip that goes down from above the object to its middle within a second.
awk '{ text = text $0 }
  END {
    gsub(/[ \t]/, "", text)
    print "t [s],x [m],y [m],z [m]"
    if (!match(text, /"bounds":\[\[[^]]*\],\[[^]]*\]/)) exit
    bounds = substr(text, RSTART + 10, RLENGTH - 10)
    gsub(/[][]/, "", bounds)
    split(bounds, b, ",")
    for (i = 0; i <= 1000; ++i)
      printf "%g,%g,%g,%g\n", i / 1000, (b[1] + b[4]) / 2, (b[2] + b[5]) / 2,
        b[6] + (b[6] - b[3]) * (0.1 - 0.6 * i / 1000)
  }' "$out/info.json" >"$out/tip.csv"
"$bin/patina" feel "$@" --path "$out/tip.csv" -o "$out/forces.csv" --json >"$out/feel.json"
in_window "$bin/patina" render "$@" -o "$out/picture.png"

say "Done. Pictures and tables are in $out"
cat <<TEXT
  picture.png            the object
  info.json              the mesh, its defects, the stages and their costs
  tip.csv                a tip that goes down to the object's middle
  forces.csv  feel.json  what it feels, one row a servo tick
TEXT
