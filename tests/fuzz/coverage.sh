#!/bin/bash
# Measures how much of each reader its seeds reach, by llvm-cov's regions; fails below 90 %.
#   tests/fuzz/coverage.sh [READER]...      all readers unless some are named
# It builds the fuzzers once more, into build-cov/. readers.txt says which sources are a reader's own.
# PATINA_MISSED=1 in the environment also prints the lines that are not reached.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
. "$here/app/build.sh"
cd "$here"
tree=$build_folder-cov
for tool in llvm-profdata llvm-cov; do
  command -v $tool >/dev/null || { echo "$tool is missing: install Debian's llvm" >&2; exit 2; }
done
flags='-fprofile-instr-generate -fcoverage-mapping'
configure "$tree" -DBUILD_TESTING=ON -DPATINA_FUZZ=ON -DCMAKE_C_COMPILER=clang \
  -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_FLAGS="$flags" -DCMAKE_CXX_FLAGS="$flags"
build "$tree"

measure() { # READER
  local program=$tree/bin/$1_fuzz profile=$tree/$1
  LLVM_PROFILE_FILE=$profile.profraw ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=0 \
    "$program" -runs=0 -artifact_prefix="$profile-" "tests/fuzz/corpus/$1" >"$profile.log" \
    2>&1 </dev/null || { tail -n 30 "$profile.log" >&2; return 1; }
  llvm-profdata merge -o "$profile.profdata" "$profile.profraw"
  llvm-cov export "$program" -instr-profile="$profile.profdata" 2>/dev/null | python3 -c '
import json, os, re, subprocess, sys
reader, sources, left_out = sys.argv[1], set(), set()
for line in open("tests/fuzz/readers.txt"):
    words = line.split()
    if words[0] != reader: continue
    if words[1].startswith("-"): left_out.add(words[1][1:])
    else: sources.update(os.path.abspath("modules/" + word) for word in words[1:])
functions = json.load(sys.stdin)["data"][0]["functions"]
mangled = "\n".join(function["name"] for function in functions)
names = subprocess.run(["c++filt"], input=mangled, capture_output=True, text=True).stdout
reached = {}  # how often each region of the sources was, in whichever instance of a template
for name, function in zip(names.splitlines(), functions):
    name = re.sub(r"patina::|\(anonymous namespace\)::|\[abi:cxx11\]", "", name)
    while name != (name := re.sub(r"<[^<>]*>", "", name)): pass
    name = re.split(r" |(?<!:):(?!:)", name.split("(")[0])[-1]
    if left_out & {name, name.split("::")[0]}: continue
    files = [os.path.normpath(file) for file in function["filenames"]]
    for region in function["regions"]:
        if region[7] == 0 and files[region[5]] in sources:  # code, not a macro or a gap
            at = (files[region[5]], *region[:4])
            reached[at] = reached.get(at, 0) + region[4]
missed = sorted(at for at, times in reached.items() if times == 0)
if os.environ.get("PATINA_MISSED"):
    for at in missed: print("  %s:%d:%d" % (os.path.relpath(at[0]), at[1], at[2]))
covered = len(reached) - len(missed)
share = 100 * covered / max(len(reached), 1)
print("%s: %d / %d, %.1f %%" % (reader, covered, len(reached), share))
sys.exit(share < 90)' "$1"
}

for program in "$tree"/bin/*_fuzz; do
  reader=$(basename "$program" _fuzz)
  [[ $# -gt 0 && " $* " != *" $reader "* ]] || measure "$reader" || failed="${failed:-} $reader"
done
[ -z "${failed:-}" ] || { echo "below 90 %:$failed" >&2; exit 1; }
