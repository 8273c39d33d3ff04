#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures what a class takes on 1, 2 and 4 workers, and what 10 000 submissions would take.

Usage: class_scale.py SUBMISSIONS [TABLE]    (in a shell with the workspace's setup.bash)

SUBMISSIONS is a number, or three of them, such as 60,200,60: one for 1, 2 and 4 workers.
Every third submission is a correct package, and each other one has one defect: they are those that
judge the checker, always in the same order. What else runs shows in the figures: end it before.
TABLE, a CSV file, is written for the page.
"""

import contextlib
import csv
import pathlib
import random
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import psutil
from mrp_check.confined import cpp_headers
from mrp_check.contract import defects, packages, resources
from mrp_testing.cluster import cluster

_WORKERS = (1, 2, 4)
_MANY = 10_000
_SPEC = "pub_sub.yaml"
_ORDER = 22  # a seed
_PROGRESS = re.compile(r"check: ([1-9]\d*) of \d+: ")
_LOOK = 1.0  # seconds between two looks at the memory


def make_class(folder, count):
    """Make so many submissions; the first ones of a larger class are those of a smaller one."""
    styles = [style for style in packages.STYLES if packages.spec_of(style) == _SPEC]
    broken = [one for one in defects.read_all() if one.finds and one.base in styles]
    random.Random(_ORDER).shuffle(broken)
    for number in range(count):
        turn, rest = divmod(number, 3)
        defect = broken[(2 * turn + rest) % len(broken)] if rest else None
        path = folder / f"{number:05}"
        packages.lay_out(defect.base if defect else styles[turn % len(styles)], path)
        if defect:
            packages.break_(path, defect)


class Memory:
    """How much the processes of a name, with all below them, had at most; use it in a `with`.

    peaks: name -> MB, of one process with its own
    seen: name -> (submissions that were done, MB), at each look since the first was done
    """

    def __init__(self, processes):
        self.done, self.peaks, self.seen = 0, {}, {}
        self._processes, self._end = processes, threading.Event()
        self._thread = threading.Thread(target=self._look)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._end.set()
        self._thread.join()

    def _look(self):
        while not self._end.wait(_LOOK):
            for name, process in self._processes:
                with contextlib.suppress(psutil.Error):
                    found = _megabytes(psutil.Process(process.pid))
                    self.peaks[name] = max(found, self.peaks.get(name, 0))
                    if self.done:
                        self.seen.setdefault(name, []).append((self.done, found))


def _megabytes(process):
    found = 0
    for one in [process, *process.children(recursive=True)]:
        with contextlib.suppress(psutil.Error):  # it has ended
            found += one.memory_full_info().pss
    return found / 2**20


def measured(folder, count):
    """Check the class in `folder` on so many workers; return the figures, and the marks."""
    before, ends = _processor_seconds(), []
    shutil.rmtree(folder / "class.checked", ignore_errors=True)
    with cluster(folder, count) as (scheduler, address, workers):
        options = ("--spec", resources.folder("specs") / _SPEC, "--csv", folder / "table.csv")
        command = ("rosrun", "mrp_check", "check", "--class", folder / "class", *options)
        begin, said = time.monotonic(), []
        checker = subprocess.Popen(
            [*map(str, command), "--scheduler", address],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        processes = [("command", checker), ("scheduler", scheduler)]
        with Memory([*processes, *(("worker", one) for one in workers)]) as memory:
            for line in checker.stderr:
                said.append(line)
                match = _PROGRESS.match(line)
                if match:
                    memory.done = int(match[1])
                    ends.append((memory.done, time.monotonic() - begin))
        if checker.wait() > 1:
            sys.exit(f"error: expected marks; the checker says: {''.join(said)}")
        seconds = time.monotonic() - begin
    with open(folder / "table.csv", newline="") as file:
        marks = [{**row, "why": ""} for row in csv.DictReader(file)]
    return seconds, _processor_seconds() - before, ends, memory, marks


def _processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def at_many(points):
    """Return what there would be after 10 000 submissions, by a line through these points."""
    if len({done for done, _ in points}) < 2:
        return float("nan")  # such as of a class of one
    slope, begin = statistics.linear_regression(*zip(*points))
    return begin + slope * _MANY


def main(submissions, table=None):
    counts = [*map(int, submissions.split(","))]
    counts = counts * len(_WORKERS) if len(counts) == 1 else counts
    rows, first = [], None
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o711)
        cpp_headers.make(folder / cpp_headers.NAME)  # a machine does that once
        for workers, count in zip(_WORKERS, counts, strict=True):
            shutil.rmtree(folder / "class", ignore_errors=True)
            make_class(folder / "class", count)
            seconds, processor, ends, memory, marks = measured(folder, workers)
            first = first or (seconds / count, marks)
            moved = [a["submission"] for a, b in zip(first[1], marks) if a != b]
            # A worker has no more of them than before.
            then = {part: at_many(memory.seen.get(part, [])) for part in ("scheduler", "command")}
            rows.append(
                {
                    "workers": workers,
                    "submissions": count,
                    "seconds": f"{seconds:.0f}",
                    "processor seconds": f"{processor:.0f}",
                    "efficiency": f"{first[0] * count / seconds / workers:.2f}",
                    "MB of the scheduler": f"{memory.peaks['scheduler']:.0f}",
                    "MB of a worker": f"{memory.peaks['worker']:.0f}",
                    "marks": "the same" if not moved else f"{len(moved)} moved",
                    f"hours for {_MANY}": f"{at_many(ends) / 3600:.1f}",
                    "processor hours then": f"{processor / count * _MANY / 3600:.0f}",
                    **{f"MB of the {part} then": f"{many:.0f}" for part, many in then.items()},
                }
            )
            said = ", ".join(f"{name}: {value}" for name, value in rows[-1].items())
            print(said, *moved, flush=True)
    if table:
        with open(table, "w", newline="") as file:
            out = csv.DictWriter(file, rows[0], lineterminator="\n")
            out.writeheader()
            out.writerows(rows)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or not re.fullmatch(r"\d+(,\d+,\d+)?", sys.argv[1]):
        sys.exit(__doc__)
    main(*sys.argv[1:])
