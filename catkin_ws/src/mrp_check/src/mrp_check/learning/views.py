# SPDX-License-Identifier: BSD-3-Clause
"""What a screen shows of the exercises, as lines; each has a style, a name of STYLES."""

from __future__ import annotations

import os
import re
import textwrap
from typing import Iterator, Sequence, Tuple

from mrp_check.learning import exercise as exercises
from mrp_check.learning.watch import Check, Watched
from mrp_check.report import console

Line = Tuple[str, str]  # its style, its text

STYLES = {
    "bar": "reverse",
    "title": "bold",
    "place": "bold",
    "passed": "bold ansigreen",
    "wrong": "bold ansired",
    "busy": "ansiyellow",
    "added": "ansigreen",
    "removed": "ansired",
}

# Colours, and the window's title that roslaunch sets.
_ESCAPES = re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07")
_DIFF = {"+": "added", "-": "removed", "@": "busy"}


def heading(watched: Watched) -> str:
    course, exercise = watched.course, watched.exercise
    passed = len(course.exercises) - len(course.open)
    return f" {exercise.label} | {passed} passed"


def keys(watched: Watched) -> str:
    """Return the keys that do something now."""
    passed = watched.course.is_passed(watched.exercise)
    ways = ["n next", "s solution"] if passed else []
    return " " + "   ".join([*ways, "h hint", "r run", "l list", "x reset", "q quit"])


def state(watched: Watched) -> Line:
    """Return how the exercise stands."""
    check = watched.check
    if check is None or not check.done:
        doing = check.doing if check else ""
        return "busy", f"Checking: {doing or 'reading the package'} ..."
    if check.error:
        return "wrong", "It could not be checked."
    if check.passed:
        last = not watched.course.open
        return "passed", "Passed, as all others are." if last else "Passed. n goes on to the next."
    count = len(check.findings)
    return "wrong", f"Not yet: {count} {'thing is' if count == 1 else 'things are'} wrong."


def task(watched: Watched, hint: bool, width: int) -> Iterator[Line]:
    """Yield the task, the hint if it is asked for, and what is still wrong."""
    exercise = watched.exercise
    yield from _text(exercise.defect.task.split("\n", 2)[2], width, exercise.defect.title)
    yield "", ""
    yield from _wrapped(f"Your copy: {_short(str(exercise.place))}", width)
    if hint:
        yield "", ""
        yield from _text(exercise.defect.hint, width, "Hint")
    yield from _findings(watched.check, width)


def _findings(check: Check | None, width: int) -> Iterator[Line]:
    if check and check.done and check.error:
        yield "", ""
        yield from _wrapped(console.plain(check.error), width)
    elif check and check.report:
        for line in exercises.lines_of(check.findings, check.report):
            yield from _wrapped(line, width, "" if line.startswith(" ") else "place")


def list_of(watched: Watched, chosen: int) -> Iterator[Line]:
    """Yield all exercises, each with its state; chosen: the index of the one that is marked."""
    for index, exercise in enumerate(watched.course.exercises):
        passed = watched.course.is_passed(exercise)
        mark = ">" if index == chosen else " "
        state, defect = "passed" if passed else "open", exercise.defect
        text = f"{mark} {exercise.number:3}  {state:8}{defect.kind:10}{defect.title}"
        yield "bar" if index == chosen else "added" if passed else "", text


def nodes(watched: Watched, width: int) -> Iterator[Line]:
    """Yield what roslaunch and the nodes printed when the check ran them."""
    report = watched.check.report if watched.check else None
    if report and report.console:
        for line in report.console:
            yield from _wrapped(console.plain(_ESCAPES.sub("", line)), width)
    elif watched.check and watched.check.done:
        yield from _wrapped("The nodes did not run: see what is wrong.", width)
    else:
        yield from _wrapped("Their lines appear here when the check has run them.", width)


def diff(lines: Sequence[str], width: int) -> Iterator[Line]:
    for line in lines:
        yield from _wrapped(line, width, _DIFF.get(line[:1], ""))


def _text(text: str, width: int, title: str) -> Iterator[Line]:
    """Yield a title and a text, whose paragraphs are filled."""
    yield "title", title
    for paragraph in text.strip().split("\n\n"):
        yield "", ""
        yield from _wrapped(" ".join(paragraph.split()), width)


def _wrapped(text: str, width: int, style: str = "") -> Iterator[Line]:
    """Yield a line as lines that fit; those after the first are indented as it is, or more."""
    head = re.match(r"(  \w+: +)?\s*", text)
    indent = "  " if style == "place" else " " * head.end() if head else ""
    lines = textwrap.wrap(text, width, subsequent_indent=indent, break_on_hyphens=False)
    yield from ((style, line) for line in lines or [""])


def _short(path: str) -> str:
    """Return a path relative to where the reader is, if it is below."""
    relative = os.path.relpath(path)
    return path if relative.startswith("..") else relative
