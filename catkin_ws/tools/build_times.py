#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How long the workspace takes to build, against what it took before.

Usage: build_times.py check|record

Another machine is faster or slower: so each time is a ratio to that of compiling one node,
measured in turns with it. `record` appends the ratios to build_times.csv. `check` compares them
with the last ones there that are of the same Debian, and fails if one has grown by more than the
noise, and by more than a tenth.
"""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import time

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
HISTORY = WORKSPACE / "build_times.csv"
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_bench" / "src"))

from mrp_bench import stats  # noqa: E402

# Growth up to that is none: a new file is not a regression.
_TOLERATED = 1.1

_ROUNDS = 4
_FIELDS = ["debian", "commit", "what", "value", "low", "high"]
_NODE = WORKSPACE / "src" / "mrp" / "src" / "publisher_cpp_node.cpp"


def regressions(history, debian, found):
    """Return a line on each ratio that is larger than the last one in the history.

    history: the rows of build_times.csv, in its order
    found: what was built -> stats.Estimate
    """
    lines = []
    for what, now in found.items():
        before = [row for row in history if (row["debian"], row["what"]) == (debian, what)]
        if not before:
            continue
        value, high = float(before[-1]["value"]), float(before[-1]["high"])
        if now.low > high and now.value > _TOLERATED * value:
            lines.append(
                f"{what}: expected about {value:.2f} times as long as to compile one node, found "
                f"{now.value:.2f} [{now.low:.2f}, {now.high:.2f}], {now.value / value - 1:.0%} "
                f"more than at {before[-1]['commit']}"
            )
    return lines


def measure():
    """Return what is built -> stats.Estimate of its time's ratio to that of compiling one node."""
    times = {"node": [], "clean build": [], "build after one change": [], "build of nothing": []}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "src").mkdir()
        for package in (WORKSPACE / "src").glob("*/package.xml"):
            (folder / "src" / package.parent.name).symlink_to(package.parent)
        changed = folder / "changed.cpp"
        for number in range(_ROUNDS):
            print(f"round {number + 1} of {_ROUNDS}", flush=True)
            changed.write_text(_NODE.read_text())
            times["node"].append([_seconds(["g++", "-c", "-O2", "-g", "-o", "/dev/null", changed])])
            subprocess.run(["rm", "-rf", folder / "build", folder / "devel"], check=True)
            times["clean build"].append([_catkin_make(folder)])
            # The program is made anew as if its source had changed: the source itself is shared.
            for path in (folder / "build" / "mrp").rglob("publisher_cpp_node.cpp.o"):
                path.unlink()
            times["build after one change"].append([_catkin_make(folder)])
            times["build of nothing"].append([_catkin_make(folder)])
    reference = times.pop("node")
    return {what: stats.ratio(rounds, reference) for what, rounds in times.items()}


def _catkin_make(folder):
    options = ["-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DCMAKE_BUILD_TYPE=RelWithDebInfo"]
    return _seconds(["catkin_make", "-C", folder, *options])


def _seconds(command):
    """Run a command; return how long it took."""
    begin = time.monotonic()
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"error: {' '.join(map(str, command))} failed:\n{done.stdout}")
    return time.monotonic() - begin


def main():
    if sys.argv[1:] not in (["check"], ["record"]):
        sys.exit(__doc__)
    debian = pathlib.Path("/etc/debian_version").read_text().split(".")[0]
    found = measure()
    for what, ratio in found.items():
        print(f"{what}: {ratio.value:.2f} [{ratio.low:.2f}, {ratio.high:.2f}]")
    history = []
    if HISTORY.exists():
        with open(HISTORY, newline="") as file:
            history = list(csv.DictReader(file))
    if sys.argv[1] == "check":
        lines = regressions(history, debian, found)
        sys.exit("\n".join(lines) or 0)
    commit = subprocess.run(
        ["git", "-C", WORKSPACE, "rev-parse", "--short", "HEAD"],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    ).stdout.strip()
    is_new = not HISTORY.exists()
    with open(HISTORY, "a", newline="") as file:
        table = csv.writer(file, lineterminator=os.linesep)
        if is_new:
            table.writerow(_FIELDS)
        for what, ratio in found.items():
            table.writerow([debian, commit, what, *(f"{number:.3f}" for number in ratio)])


if __name__ == "__main__":
    main()
