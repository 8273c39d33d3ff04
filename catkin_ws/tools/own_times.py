#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What building and testing the workspace took, against what it took before.

Usage: own_times.py check|record

tools/timed.py has kept how long each stage of the last `make test-all` took. `record` appends that
to own_times.csv, with the number of tests. `check` compares it with the last rows there that are of
the same Debian, and fails if a stage takes more than half as long again, or if tests are fewer.

Another machine is faster or slower: so a stage's processor time counts in times of compiling one
node. What a stage waits for is as long on any machine: so its seconds must have grown both as they
are and in times of compiling one node.
"""

import json
import os
import pathlib
import statistics
import sys
import xml.etree.ElementTree as ElementTree

import history
import timed

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
HISTORY = WORKSPACE / "own_times.csv"
RESULTS = WORKSPACE / "build" / "test_results"

# Of one commit on one machine, idle, just set up or busy, the ratios differed by a quarter; other
# machines may differ more.
_TOLERATED = 1.5

_ROUNDS = 3
_NODE = WORKSPACE / "src" / "mrp" / "src" / "publisher_cpp_node.cpp"
_COUNT = "number of tests"


def regressions(before, now):
    """Return a line on each stage that takes longer, and on tests that are fewer.

    before, now: rows of the history, with the same columns, of one Debian; before may lack stages
    """
    lines = []
    for row in now:
        stage, old = row["stage"], history.last(before, stage=row["stage"])
        if not old:
            continue
        if stage == _COUNT:
            if int(row["tests"]) < int(old["tests"]):
                lines.append(f"{stage}: expected {old['tests']} or more, found {row['tests']}")
            continue
        work = _growth(old, row, "processor", "node")
        wait = min(_growth(old, row, "seconds", "node"), _growth(old, row, "seconds"))
        if max(work, wait) > _TOLERATED:
            lines.append(
                f"{stage}: expected about {old['seconds']} s and {old['processor']} s of processor "
                f"time, as at {old['commit']} where a node took {old['node']} s to compile; found "
                f"{row['seconds']} s and {row['processor']} s, a node {row['node']} s"
            )
    return lines


def _growth(old, new, column, unit=None):
    """Return how much larger a column is now, each in terms of its row's column `unit`."""
    ratio = float(new[column]) / max(float(old[column]), 0.1)
    return ratio * float(old[unit]) / float(new[unit]) if unit else ratio


def count_tests(results):
    """Return how many test cases the JUnit files of the last `make test-all` have."""
    files = [*results.glob("pytest_*.xml"), *results.glob("mrp*/rosunit-*.xml")]
    return sum(len(list(ElementTree.parse(path).iter("testcase"))) for path in files)


def compile_node():
    """Return the processor seconds of compiling a node, while each processor compiles one."""
    count = os.cpu_count()
    compile_one = f"g++ -c -O2 -g -o /dev/null {_NODE}"
    code, _, processor = timed.run("sh", "-c", f"seq {count} | xargs -P {count} -I % {compile_one}")
    if code != 0:
        sys.exit("error: expected to compile a node; g++ says above why it could not")
    return processor / count


def measured():
    """Return the rows of the last run: what the history's columns say."""
    if not timed.TIMES.exists():
        sys.exit("error: nothing was measured: run make test-all first")
    node = statistics.median(compile_node() for _ in range(_ROUNDS))
    at = {
        "commit": history.commit(),
        "debian": pathlib.Path("/etc/debian_version").read_text().split(".")[0],
    }
    figures = {"node": f"{node:.2f}", "seconds": 0, "processor": 0, "tests": 0}
    stages = json.loads(timed.TIMES.read_text())
    rows = [{**at, "stage": stage, **figures, **taken} for stage, taken in stages.items()]
    return [*rows, {**at, "stage": _COUNT, **figures, "tests": count_tests(RESULTS)}]


def main(action):
    rows = measured()
    for row in rows:
        print("{stage:18} {seconds:6} s, {processor:6} s of work, {tests} tests".format(**row))
    if action == "record":
        history.append(HISTORY, rows)
        return 0
    before = [row for row in history.read(HISTORY) if row["debian"] == rows[0]["debian"]]
    if not before:
        print(f"nothing to compare with: {HISTORY.name} has no times of Debian {rows[0]['debian']}")
    return "\n".join(regressions(before, rows)) or 0


if __name__ == "__main__":
    if sys.argv[1:] not in (["check"], ["record"]):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
