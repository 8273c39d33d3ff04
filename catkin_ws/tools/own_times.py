#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How long the workspace takes to build and to test, against what it took before.

Usage: own_times.py check|record

Another machine is faster or slower: so each time is a ratio to that of compiling one node on each
processor, measured in turns with it. Of builds it is the time of the processors, which does not
depend on how many there are, and on what else they do. `record` appends the ratios to
own_times.csv. `check` compares them with the last ones there that are of the same Debian, and fails
if one has grown by more than the noise, and by more than half.

The time of the tests is that of the last `make test`. Half of it is waiting, which is as long on
any machine: so on a faster one the ratio grows, and on a slower one the seconds do. Only where both
have grown so, it is the tests that take longer.
"""

import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time
import typing
import xml.etree.ElementTree as ElementTree

import history

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
HISTORY = WORKSPACE / "own_times.csv"
RESULTS = WORKSPACE / "build" / "test_results"
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_bench" / "src"))

from mrp_bench import stats  # noqa: E402

TESTS = "tests"

# Growth up to that is none. Of one commit on one machine, idle, just set up or busy, the ratios of
# builds differed by a quarter, far more than the rounds of a run; other machines may differ more.
_TOLERATED = 1.5

_ROUNDS = 3
_NODE = WORKSPACE / "src" / "mrp" / "src" / "publisher_cpp_node.cpp"


class Taken(typing.NamedTuple):
    """What a command took; cpu: the seconds of all processors together."""

    seconds: float
    cpu: float


class Figure(typing.NamedTuple):
    """seconds: the median. ratio: to what compiling one node takes."""

    seconds: float
    ratio: stats.Estimate


def regressions(rows, debian, found):
    """Return a line on each figure that is larger than the last one in the history.

    rows: of own_times.csv, in its order
    found: what took that long -> Figure
    """
    lines = []
    for what, (seconds, now) in found.items():
        before = history.last(rows, debian=debian, what=what)
        if not before:
            continue
        value, high = float(before["value"]), float(before["high"])
        if now.low <= high or now.value <= _TOLERATED * value:
            continue
        if what == TESTS and seconds <= _TOLERATED * float(before["seconds"]):
            continue
        lines.append(
            f"{what}: expected about {value:.2f} times as long as to compile one node, found "
            f"{now.value:.2f} [{now.low:.2f}, {now.high:.2f}], {now.value / value - 1:.0%} "
            f"more than at {before['commit']}"
        )
    return lines


def test_seconds(results):
    """Return how long the suites of the last `make test` took, or None if there was none."""
    if not (results / "workspace.xml").exists():
        return None
    # The folder has other tests' results, too.
    files = [results / "workspace.xml", *results.glob("mrp*/rosunit-*.xml")]
    suites = [suite for file in files for suite in ElementTree.parse(file).iter("testsuite")]
    return sum(float(suite.get("time")) for suite in suites)


def measure():
    """Return what took time -> Figure."""
    taken = {"node": [], "clean build": [], "build after one change": [], "build of nothing": []}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "src").mkdir()
        for package in (WORKSPACE / "src").glob("*/package.xml"):
            (folder / "src" / package.parent.name).symlink_to(package.parent)
        for number in range(_ROUNDS):
            print(f"round {number + 1} of {_ROUNDS}", flush=True)
            taken["node"].append(_compile_nodes())
            subprocess.run(["rm", "-rf", folder / "build", folder / "devel"], check=True)
            taken["clean build"].append(_catkin_make(folder))
            # The program is made anew as if its source had changed: the source itself is shared.
            for path in (folder / "build" / "mrp").rglob("publisher_cpp_node.cpp.o"):
                path.unlink()
            taken["build after one change"].append(_catkin_make(folder))
            taken["build of nothing"].append(_catkin_make(folder))
    nodes = taken.pop("node")
    found = {what: _figure(those, [[one.cpu] for one in nodes]) for what, those in taken.items()}
    seconds = test_seconds(RESULTS)
    if seconds is None:
        print("tests: not measured: run make test before")
    else:
        # Tests mostly wait.
        tests = [Taken(seconds, seconds)] * _ROUNDS
        found[TESTS] = _figure(tests, [[one.seconds] for one in nodes])
    return found


def _figure(taken, reference):
    return Figure(
        stats.median_of_rounds([[one.seconds] for one in taken]),
        stats.ratio([[one.cpu] for one in taken], reference),
    )


def _compile_nodes():
    """Compile a node on each processor at once: as in a build, each has the same to itself."""
    count = os.cpu_count()
    compile_one = f"g++ -c -O2 -g -o /dev/null {_NODE}"
    done = run(["sh", "-c", f"seq {count} | xargs -P {count} -I % {compile_one}"])
    return Taken(done.seconds, done.cpu / count)


def _catkin_make(folder):
    options = ["-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DCMAKE_BUILD_TYPE=RelWithDebInfo"]
    return run(["catkin_make", "-C", folder, *options])


def run(command):
    """Run a command; return what it took, as Taken. If it fails, exit with what it printed."""
    begin, used = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"error: {' '.join(map(str, command))} failed:\n{done.stdout}")
    now = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime
    return Taken(time.monotonic() - begin, cpu)


def main():
    if sys.argv[1:] not in (["check"], ["record"]):
        sys.exit(__doc__)
    debian = pathlib.Path("/etc/debian_version").read_text().split(".")[0]
    found = measure()
    for what, (seconds, ratio) in found.items():
        print(f"{what}: {ratio.value:.2f} [{ratio.low:.2f}, {ratio.high:.2f}], {seconds:.1f} s")
    if sys.argv[1] == "check":
        rows = history.read(HISTORY)
        if not history.last(rows, debian=debian):
            print(f"nothing to compare with: {HISTORY.name} has no times of Debian {debian}")
        sys.exit("\n".join(regressions(rows, debian, found)) or 0)
    rows = []
    for what, (seconds, ratio) in found.items():
        figures = {name: f"{number:.3f}" for name, number in ratio._asdict().items()}
        at = {"commit": history.commit(), "debian": debian, "what": what}
        rows.append({**at, **figures, "seconds": f"{seconds:.1f}"})
    history.append(HISTORY, rows)


if __name__ == "__main__":
    main()
