# SPDX-License-Identifier: BSD-3-Clause
"""An exercise at which somebody works: it is checked again each time that a file of it changes.

Nothing here waits: somebody who shows it calls look() again and again. The files are looked at, and
not the kernel asked for what changes: it does not say what another machine changes, as in a
container's volume or on a network's disk.
"""

from __future__ import annotations

import os
import pathlib
import threading
from typing import Callable, Tuple

from mrp_check.contract.errors import CannotCheck, PackageError
from mrp_check.contract.finding import Finding
from mrp_check.contract.verdict import Report
from mrp_check.learning import exercise as exercises
from mrp_check.learning import tool_output
from mrp_check.package.package import BACKUP, Package, is_of_tools
from mrp_check.sandbox import confine
from mrp_check.verdict import check

INTERVAL = 0.05  # seconds between two calls of look()

_Stamp = Tuple[Tuple[object, ...], ...]


class _Stopped(BaseException):
    """The check is to end: its verdict is of no use any more."""


class Check(threading.Thread):
    """A check of an exercise's copy: start() makes it in the background, run() at once.

    scratch: a folder for several checks, as check.check() keeps it; each has its own without it
    say: called with a sentence that says what it does

    doing: what it does at the moment
    report: what is known so far; findings: those of it that keep the exercise from being passed
    tools: the lines in which a tool says what is wrong
    done: whether that is all
    error: why it could not be checked, in a sentence
    """

    def __init__(
        self,
        exercise: exercises.Exercise,
        scratch: pathlib.Path | None = None,
        say: Callable[[str], None] = lambda sentence: None,
    ) -> None:
        super().__init__(daemon=True)
        self.doing = ""
        self._say = say
        self.report: Report | None = None
        self.findings: list[Finding] = []
        self.tools: list[str] = []
        self.done = False
        self.error = ""
        self._exercise, self._scratch = exercise, scratch
        self._stopped = threading.Event()

    @property
    def passed(self) -> bool:
        return self.done and not self.findings and not self.error

    def run(self) -> None:
        try:
            report = check.check(
                Package(self._exercise.place),
                self._exercise.spec,
                progress=self._go_on,
                kept=self._scratch,
                early=self._know,
            )
            self._know(report)
            self.error = "" if self.findings else report.reason
        except (CannotCheck, PackageError) as error:
            self.error = str(error)
        except _Stopped:
            return
        except Exception as error:  # such as a file that has gone while it was read
            self.error = f"The checker itself failed: {type(error).__name__}: {error}."
        self.done = True

    def _go_on(self, sentence: str) -> None:
        if self._stopped.is_set():
            raise _Stopped
        self.doing = sentence
        self._say(sentence)

    def _know(self, report: Report) -> None:
        if self._stopped.is_set():
            raise _Stopped
        self.findings = exercises.wrong(report)
        if self.findings:
            self.tools = tool_output.lines_of(report, self._exercise.place)
        self.report = report

    def stop(self) -> None:
        """End it, and wait for its end: nothing of it runs then."""
        self._stopped.set()
        while self.is_alive():
            confine.stop()
            self.join(INTERVAL)


class Watched:
    """An exercise that is checked each time one of its files changes.

    exercise: at which somebody works
    check: the last one, which may still go on; None before the first
    """

    def __init__(self, course: exercises.Course, scratch: pathlib.Path) -> None:
        self.course, self._scratch = course, scratch
        self.check: Check | None = None
        self._seen: _Stamp | None = None  # the last time, and when the last check began
        self._checked: _Stamp | None = None
        self.open((course.open or course.exercises)[0])

    def open(self, exercise: exercises.Exercise) -> None:
        """Go to an exercise."""
        self.stop()
        exercise.prepare()
        self.exercise = exercise
        self._seen = self._checked = None

    def reset(self) -> None:
        """Start the exercise again, without the student's changes."""
        self.stop()
        self.exercise.remove()
        self.exercise.prepare()
        self._checked = None

    def again(self) -> None:
        """Check it again, though nothing has changed."""
        if self.check is None or self.check.done:
            self._checked = None

    def look(self) -> None:
        """Begin a check if a file has changed; keep that the exercise is passed, if it is."""
        stamp = _stamp(self.exercise.place)
        # An editor writes a file in several steps.
        settled, self._seen = stamp == self._seen, stamp
        if self._checked not in (None, stamp) and self.check and not self.check.done:
            self.stop()
        if settled and stamp != self._checked:
            self.stop()
            self._checked = stamp
            self.check = Check(self.exercise, self._scratch)
            self.check.start()
        elif self.check and self.check.passed and stamp == self._checked:
            self.course.add(self.exercise)

    def stop(self) -> None:
        """End the check."""
        if self.check:
            self.check.stop()
        self.check = None


def _stamp(place: pathlib.Path) -> _Stamp:
    """Return what is different after a file was saved: of those that people write."""
    found = []
    for folder, folders, names in os.walk(place):
        folders[:] = sorted(name for name in folders if not is_of_tools(name))
        for name in sorted(names):
            path = os.path.join(folder, name)
            if not BACKUP.search(name) and not name.startswith((".", "#")):
                try:
                    entry = os.stat(path)
                except OSError:  # it has just gone
                    continue
                found.append((path, entry.st_mtime_ns, entry.st_size, entry.st_mode))
    return tuple(found)
