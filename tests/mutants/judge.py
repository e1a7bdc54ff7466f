#!/usr/bin/env python3
"""Do the tests notice a mistake? Mutants of modules/haptics and modules/field, built in at once.

    tests/run.sh --mutants [N]      the first N of 200 (all unless told), on all processors

Each test first tells which mutants it comes by. A mutant is then given to those tests, the
shortest first, until one fails twice in a row, or until what they need untouched adds up to 15 s
of processor time; tests of more than 5 s are not asked. A test that takes several times what it
should fails, too. Survivors are read: each gets a test, loses its code, or has its reason in
equivalent.txt. Headers stay as they are: every test program has its own copy of their functions.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading

import mutate

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TREE = ROOT / "build-mutants"
MODULES = ("modules/haptics", "modules/field")
PROGRAMS = ("haptics_tests", "field_tests", "contact_tests", "stability_tests")
# They judge the machine as well as the code.
LEFT_OUT = re.compile(r"^(MeasureLatency|RunQueueWait)\.")
COUNT, SEED = 200, "1"
MOST = 9999  # the greatest number of a mutant; see mutant.h
SECONDS, LONGEST = 15.0, 5.0  # processor time of what is asked of a mutant, and of one test


def run(command, **options):
    return subprocess.run(command, text=True, **options)


def write(path, text):
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def lot(*said):
    return hashlib.sha256(" | ".join((SEED, *said)).encode()).digest()


def chosen(files, known):
    """COUNT of the mutants, as many from each site as one; equivalent ones are no mutants.

    Place, change and number follow from what the code says there: an edit moves no other mutant.
    """
    sites = {}
    for f in files:
        for m in mutate.mutants_of(f, (ROOT / f).read_text()):
            sites.setdefault((m.path, m.begin, m.end), []).append(m)
    drawn, alike = [], collections.Counter()
    for key in sorted(sites):
        alike[key[0], sites[key][0].was] += 1
        left = [m for m in sites[key] if (m.path, m.was, m.change) not in known]
        if left:
            m = min(left, key=lambda m: lot(m.path, m.was, m.change))
            drawn.append((lot(m.path, m.was, str(alike[m.path, m.was])), m))
    picked, taken, numbers = [], {}, set()
    for place, m in sorted(drawn, key=lambda d: d[0]):
        if len(picked) == COUNT * 5 // 4:  # some do not compile
            break
        if all(m.end <= b or e <= m.begin for b, e in taken.get(m.path, [])):
            m.number = int.from_bytes(place[:4], "big") % MOST + 1
            while m.number in numbers:
                m.number = m.number % MOST + 1
            numbers.add(m.number)
            picked.append(m)
            taken.setdefault(m.path, []).append((m.begin, m.end))
    return picked


def known_equivalents():
    known = set()
    for line in (HERE / "equivalent.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            path, was, change, _ = line.split(" | ", 3)
            known.add((path, was, change))
    return known


def build(mutants, jobs):
    """Builds; a change that does not compile is taken out. Those that are left."""
    write(TREE / "mutant.h", (HERE / "mutant.h").read_text())
    while True:
        sources = {m.path for m in mutants}
        for old in (TREE / "modules").rglob("*.cpp"):
            if str(old.relative_to(TREE)) not in sources:
                old.unlink()
        for f in sources:
            inside = [m for m in mutants if m.path == f]
            write(TREE / f, mutate.written((ROOT / f).read_text(), inside, TREE / "mutant.h"))
        done = run(["cmake", "-S", ROOT, "-B", TREE, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DPATINA_WERROR=OFF", "-DPATINA_MUTANTS=ON", "-DCMAKE_CXX_FLAGS=-w"],
                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            sys.exit(done.stdout)
        done = run(["ninja", "-C", TREE, "-j", str(jobs), "-k", "0", *PROGRAMS],
                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode == 0:
            return mutants
        wrong = {(m[1], int(m[2])) for m in
                 re.finditer(r"^(?:.*build-mutants/)?(modules/[\w/.]+):(\d+):\d+: +"
                             r"(?:(?:\w+ )?error|required from here)", done.stdout, re.M)}
        left = [m for m in mutants
                if not any((m.path, n) in wrong for n in range(m.line, m.last_line + 1))]
        if len(left) == len(mutants):
            sys.exit(done.stdout[-6000:] + "\nno mutant is to blame for this")
        print(f"{len(mutants) - len(left)} changes do not compile", flush=True)
        mutants = left


def tests_of(program):
    listed = run([TREE / "bin" / program, "--gtest_list_tests"], check=True,
                 stdout=subprocess.PIPE).stdout
    suite, names = "", []
    for line in listed.splitlines():
        line = line.split("#")[0].rstrip()
        if line.startswith("  "):
            names.append(suite + line.strip())
        elif line.endswith("."):
            suite = line.strip()
    return [n for n in names if not LEFT_OUT.match(n) and ".DISABLED_" not in n]


def run_test(program, test, seconds, **environment):
    """(whether it passed, processor seconds); beyond `seconds` it is ended and has not.

    So is one that sleeps for twenty times as long: a mutant may wait for what never comes.
    """
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
    with tempfile.TemporaryDirectory(prefix="patina_mutant") as folder:
        child = subprocess.Popen([TREE / "bin" / program, f"--gtest_filter={test}"], cwd=folder,
                                 env={**os.environ, **environment, "TEST_TMPDIR": folder},
                                 preexec_fn=limit, stdin=subprocess.DEVNULL,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        alarm = threading.Timer(20 * (seconds + 1), os.kill, (child.pid, signal.SIGKILL))
        alarm.start()
        _, status, usage = os.wait4(child.pid, 0)
        alarm.cancel()
        child.returncode = status
        return status == 0, usage.ru_utime + usage.ru_stime


def measure(test):
    """[program, test, processor seconds, mutants that it comes by]; none if too long to be asked."""
    with tempfile.NamedTemporaryFile("r", prefix="patina_reached") as reached:
        passed, seconds = run_test(*test, LONGEST, PATINA_MUTANTS_REACHED=reached.name)
        if not passed:
            print(f"left out, {seconds:.1f} s or failing by itself: {test[1]}", flush=True)
            return None
        return [*test, seconds, [int(n) for n in reached.read().split()]]


def reached_by(program, pool):
    """measure() of each test of a program, kept until the program changes."""
    stamp, kept = (TREE / "bin" / program).stat().st_mtime_ns, TREE / f"reached-{program}.json"
    if not kept.exists() or json.loads(kept.read_text())[0] != stamp:
        print(f"what each of {program} comes by", flush=True)
        every = [(program, t) for t in tests_of(program)]
        kept.write_text(json.dumps([stamp, [m for m in pool.map(measure, every) if m]]))
    return json.loads(kept.read_text())[1]


def judge(mutant, tests):
    """Who catches it, or nobody, and the processor seconds that this took."""
    asked = spent = 0.0
    for program, test, seconds, reached in tests:
        if mutant.number not in reached:
            continue
        asked += seconds
        if asked > SECONDS:
            break
        for _ in range(2):  # what fails once may be the machine's doing
            passed, took = run_test(program, test, 3 * seconds + 1, PATINA_MUTANT=str(mutant.number))
            spent += took
            if passed:
                break
        else:
            return test, spent
    return "", spent


def main():
    arguments = argparse.ArgumentParser(usage=__doc__)
    arguments.add_argument("count", nargs="?", type=int, default=COUNT)
    arguments.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    arguments.add_argument("--only", help="the numbers of mutants, with commas between")
    given = arguments.parse_args()
    files = sorted(str(p.relative_to(ROOT)) for m in MODULES for p in (ROOT / m).rglob("*.cpp"))
    mutants = build(chosen(files, known_equivalents()), given.jobs)[:given.count]
    if given.count == 0:  # built, and no more
        return 0
    if given.only:
        mutants = [m for m in mutants if str(m.number) in given.only.split(",")]
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        tests = sorted((t for p in PROGRAMS for t in reached_by(p, pool)), key=lambda t: t[2])
        caught = 0
        survivors = []
        for m, (by, seconds) in zip(mutants, pool.map(lambda m: judge(m, tests), mutants)):
            caught += bool(by)
            if not by:
                survivors.append(m)
            print(f"{m.number:4} {seconds:5.1f} s  {m.path}:{m.line}: {m.change}  "
                  f"{'caught by ' + by if by else 'SURVIVED'}"
                  f"{'' if any(m.number in t[3] for t in tests) else ', no test comes by'}", flush=True)
    for m in survivors:
        print(f"survived: {m.path}:{m.line} | {m.was} | {m.change}")
    share = 100 * caught / max(1, len(mutants))
    print(f"{caught} of {len(mutants)} mutants caught ({share:.0f} %), {len(survivors)} survived")
    return 0 if share >= 90 else 1


if __name__ == "__main__":
    sys.exit(main())
