#!/bin/bash
# Installs what is missing, builds with warnings as errors, and runs every test.
#   tests/run.sh                        all tests, then a short form of what follows
#   tests/run.sh --sanitize address     unit and stability tests under ASan and UBSan
#   tests/run.sh --sanitize thread      hand-over and servo tests under TSan
#   tests/run.sh --fuzz [SECONDS]       each reader's fuzzer, 20 s each unless told (in all tests 10,
#                                       and 20 for what comes over a wire)
#   tests/run.sh --quick                the tests alone, without sanitizers and fuzzers
#   tests/run.sh --benchmarks           the long form of the benchmarks and of the contact course
#   tests/run.sh --mutants [N]          whether the unit tests notice mistakes: N of 200 mutants
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/app/packages.sh"
. "$here/app/build.sh"
cd "$here"

usage() {
  sed -n '2,10s/^# \{0,1\}//p' "$0" >&2
  exit 2
}

# Every tree of the tests is configured alike.
configure_tests() { # FOLDER [CMAKE ARGUMENT]...
  configure "$@" -DBUILD_TESTING=ON -DPATINA_WERROR=ON
}

run_tests() {
  say "Building with warnings as errors"
  local peers=OFF
  [ -n "$(missing_packages $PATINA_PEER_PACKAGES)" ] || peers=ON
  configure_tests "$build_folder" -DPATINA_PEERS=$peers
  build "$build_folder"
  say "All tests"
  # One more than there are processors: many a test waits for a hand or a clock.
  if ! ctest --test-dir "$build_folder" --output-on-failure -j "$(($(nproc) + 1))" </dev/null; then
    # A clock that was measured beside other tests may be wrong; a defect fails alone, too.
    say "Those that failed, again and one at a time"
    ctest --test-dir "$build_folder" --output-on-failure --rerun-failed </dev/null
  fi
}

# LeakSanitizer needs ptrace, which some containers forbid.
leak_option() {
  local said
  said=$("$1" --gtest_list_tests 2>&1 >/dev/null || true)
  if [[ $said == *"LeakSanitizer has encountered a fatal"* ]]; then
    echo "LeakSanitizer may not run here (no ptrace): leaks are not checked" >&2
    echo detect_leaks=0
  else
    echo detect_leaks=1
  fi
}

# Each check is built first, by both processors, and run then, which takes one.
address_folders() { # short or full
  echo core geometry field scene
  [ "$1" = short ] || echo workspace haptics stability
}

build_address() { # short or full
  say "Building for the address and undefined-behaviour sanitizers"
  configure_tests "$build_folder-asan" -DPATINA_SANITIZE=address -DPATINA_GUI=OFF
  # shellcheck disable=SC2046
  build "$build_folder-asan" $(address_folders "$1" | xargs -n 1 | sed 's/$/_tests/')
}

run_address() { # short or full
  say "Address and undefined-behaviour sanitizers"
  local leaks folder most='*'
  [ "$1" = full ] || most='-*Signs*:Plate*:SampleLayer*:Redistance*:MergeFields*:LooseTriangles*:InnerFaces*'
  leaks=$(leak_option "$build_folder-asan/bin/core_tests")
  for folder in $(address_folders "$1"); do
    ASAN_OPTIONS=$leaks:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1 \
      timeout 1800 "$build_folder-asan/bin/${folder}_tests" --gtest_brief=1 \
      --gtest_filter="$most" </dev/null
  done
}

build_thread() {
  say "Building for the thread sanitizer"
  configure_tests "$build_folder-tsan" -DPATINA_SANITIZE=thread -DPATINA_GUI=OFF
  build "$build_folder-tsan" core_tests haptics_tests
}

run_thread() {
  say "Thread sanitizer: hand-over and servo"
  # gcc 12's runtime stops where the kernel spreads addresses too widely; a fixed layout helps.
  local run=()
  if ! "$build_folder-tsan/bin/core_tests" --gtest_list_tests >/dev/null 2>&1; then
    run=(setarch "$(uname -m)" -R)
    if ! "${run[@]}" "$build_folder-tsan/bin/core_tests" --gtest_list_tests >/dev/null 2>&1; then
      echo "ThreadSanitizer cannot run on this kernel (address layout): skipped" >&2
      return 0
    fi
  fi
  "${run[@]}" "$build_folder-tsan/bin/core_tests" --gtest_brief=1 \
    --gtest_filter='Ring.*:SnapshotExchange.*' </dev/null
  # Debian's TBB is not instrumented, so that whatever its workers wrote looks like a race. On one
  # processor it starts none; races are found by order, not by chance, so one is enough.
  local processor
  processor=$(taskset -cp $$ | sed 's/.*: *//; s/[^0-9].*//')
  timeout 900 taskset -c "$processor" "${run[@]}" "$build_folder-tsan/bin/haptics_tests" --gtest_brief=1 \
    --gtest_filter='*Servo*:*TipTarget*:*Mouse*' </dev/null
}

run_benchmarks() {
  say "Benchmarks, long form"
  configure_tests "$build_folder"
  build "$build_folder" benchmarks_tests contact_tests
  PATINA_LONG=1 "$build_folder/bin/benchmarks_tests" </dev/null
  PATINA_LONG=1 "$build_folder/bin/contact_tests" --gtest_filter='ContactCourse.*' </dev/null
  if [ -z "$(missing_packages $PATINA_PEER_PACKAGES)" ]; then
    configure_tests "$build_folder" -DPATINA_PEERS=ON
    build "$build_folder" peers_tests
    "$build_folder/bin/peers_tests" </dev/null
  else
    say "Without $PATINA_PEER_PACKAGES: no comparison with it"
  fi
}

# In full each source by itself, so that an include that is missing is found, too.
build_fuzz() { # short or full
  say "Building the fuzzers"
  local unity=ON
  [ "$1" = short ] || unity=OFF
  configure_tests "$build_folder-fuzz" -DPATINA_FUZZ=ON -DCMAKE_UNITY_BUILD=$unity \
    -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
  build "$build_folder-fuzz"
}

run_fuzz() { # seconds each
  say "Fuzzing each reader for $1 s, those of a wire for 20 s at least"
  local program reader seeds each
  for program in "$build_folder-fuzz"/bin/*_fuzz; do
    reader=$(basename "$program" _fuzz)
    mkdir -p "$build_folder-fuzz/found/$reader"
    seeds=tests/fuzz/corpus/$reader
    [ -d "$seeds" ] || seeds=
    # A finding is a file that the reader must survive: keep it as a seed when it is mended.
    each=$1
    case $reader in
    falcon | spacemouse | probe | probe_packets) [ "$each" -ge 20 ] || each=20 ;;
    esac
    if ! "$program" -max_total_time="$each" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
      -artifact_prefix="$build_folder-fuzz/found/$reader-" "$build_folder-fuzz/found/$reader" \
      ${seeds:+"$seeds"} \
      </dev/null >"$build_folder-fuzz/$reader.log" 2>&1; then
      tail -n 60 "$build_folder-fuzz/$reader.log"
      echo "the $reader reader does not survive a file; it is kept in $build_folder-fuzz/found/"
      return 1
    fi
    echo "$reader: $(awk '/number_of_executed_units/ {print $2}' "$build_folder-fuzz/$reader.log") inputs survived"
  done
}

mode=all
seconds=20
while [ $# -gt 0 ]; do
  case "$1" in
  --sanitize)
    case "${2:-}" in address | thread) mode=$2 ;; *) usage ;; esac
    shift
    ;;
  --fuzz)
    mode=fuzz
    case "${2:-}" in
    '' | -*) ;;
    *[!0-9]*) usage ;;
    *) seconds=$2; shift ;;
    esac
    ;;
  --quick) mode=quick ;;
  --benchmarks) mode=benchmarks ;;
  --mutants)
    mode=mutants
    mutants=200
    case "${2:-}" in
    '' | -*) ;;
    *[!0-9]*) usage ;;
    *) mutants=$2; shift ;;
    esac
    ;;
  *) usage ;;
  esac
  shift
done

need_writable "$build_folder" PATINA_BUILD
# shellcheck disable=SC2086 # lists of words
need_packages $PATINA_BUILD_PACKAGES $PATINA_TEST_PACKAGES
if [ "$mode" = all ] && [ "${PATINA_INSTALL:-yes}" != no ]; then
  # In a shell of its own: what it cannot install is left out, and the tests go on.
  (need_packages $PATINA_PEER_PACKAGES) || say "Without $PATINA_PEER_PACKAGES: no comparison with it"
fi

case $mode in
all)
  failed=
  run_and_note() {
    # Each in a shell of its own with errexit, so that one failure does not hide the next.
    set +e
    (set -e; "$@")
    local code=$?
    set -e
    [ $code -eq 0 ] || failed="$failed $1"
  }
  run_and_note run_tests
  run_and_note build_address short
  run_and_note build_thread
  run_and_note build_fuzz short
  # All at once, for each takes one processor; what they print follows one after the other.
  logs=$(mktemp -d)
  (run_thread) >"$logs/thread" 2>&1 &
  thread=$!
  (run_fuzz 10) >"$logs/fuzz" 2>&1 &
  fuzz=$!
  run_and_note run_address short
  wait $thread || failed="$failed run_thread"
  wait $fuzz || failed="$failed run_fuzz"
  cat "$logs/thread" "$logs/fuzz"
  rm -r "$logs"
  if [ -n "$failed" ]; then
    say "FAILED:$failed"
    exit 1
  fi
  ;;
quick) run_tests ;;
address) build_address full; run_address full ;;
thread) build_thread; run_thread ;;
fuzz) build_fuzz full; run_fuzz "$seconds" ;;
benchmarks) run_benchmarks ;;
mutants)
  say "Mutants of modules/haptics and modules/field"
  tests/mutants/judge.py "$mutants"
  ;;
esac
say "Passed"
