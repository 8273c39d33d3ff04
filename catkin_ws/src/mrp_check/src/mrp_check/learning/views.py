# SPDX-License-Identifier: BSD-3-Clause
"""What a screen shows of the exercises, as lines; each has a style, a name of STYLES."""

from __future__ import annotations

import re
import textwrap
from typing import Iterator, Sequence, Tuple

from mrp_check.learning import exercise as exercises
from mrp_check.learning import tool_output
from mrp_check.learning.watch import Check, Watched
from mrp_check.report import terminal

StyledLine = Tuple[str, str]  # its style, its text

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

_DIFF = {"+": "added", "-": "removed", "@": "busy"}


def heading(watched: Watched) -> str:
    course, exercise = watched.course, watched.exercise
    passed = len(course.exercises) - len(course.open)
    return f" {exercise.label} | {passed} passed"


def keys(watched: Watched) -> str:
    """Return the keys that do something now."""
    passed = watched.course.is_passed(watched.exercise)
    first = ["n next", "s solution"] if passed else ["o open", "e explain", "h hint"]
    return " " + "   ".join([*first, "p page", "r run", "l list", "x reset", "q quit"])


def state(watched: Watched) -> StyledLine:
    """Return how the exercise stands."""
    check, course = watched.check, watched.course
    if check is None or not check.done:
        doing = check.doing if check else ""
        return "busy", f"Checking: {doing or 'reading the package'} ..."
    if check.error:
        return "wrong", "It couldn't be checked."
    if check.passed:
        return "passed", (
            f"Passed: {exercises.progress(course)} n shows the next one."
        ) if course.open else (f"Passed: you have finished all {len(course.exercises)}. Well done!")
    count = len(check.findings)
    return "wrong", f"Not yet: {count} {'thing is' if count == 1 else 'things are'} wrong."


def task(watched: Watched, hint: bool, explains: bool, width: int) -> Iterator[StyledLine]:
    """Yield the task, which file to open, and how it stands.

    hint: whether the hint is asked for; explains: whether the explanation is
    """
    exercise, check = watched.exercise, watched.check
    text = exercise.defect.task.split("\n", 2)[2]
    yield from _text(re.sub(r"Read more: `\w+`.*", "", text), width, exercise.defect.title)
    yield "", ""
    if check and check.passed:
        yield from _wrapped(f"You've learned: {exercise.defect.learned}", width, "passed")
        if not watched.course.open:
            yield from _congratulation(watched.course, width)
        return
    how = "Open this file in another window (o opens it) and save your change. I'll check it."
    yield from _wrapped(how, width)
    yield from _wrapped(str(exercise.file), width, "place")
    if hint:
        yield "", ""
        yield from _text(exercise.defect.hint, width, "Hint")
    yield from _findings(check, explains, width)


def _congratulation(course: exercises.Course, width: int) -> Iterator[StyledLine]:
    """Yield what somebody reads who has finished the last exercise."""
    yield "", ""
    yield "passed", "* * *  That was the last one. Congratulations!  * * *"
    yield "", ""
    for line in exercises.farewell(course):
        yield from _wrapped(line, width, "place" if line.startswith(" ") else "")


def _findings(check: Check | None, explains: bool, width: int) -> Iterator[StyledLine]:
    """Yield what the tools say; or, if it is asked for, what we say."""
    if check and check.done and check.error:
        yield "", ""
        yield from _wrapped(terminal.plain(check.error), width)
        return
    if not check or not check.findings:
        return
    yield "", ""
    if explains:
        yield "title", "What is wrong, explained (e: back)"
        for line in exercises.lines_of(check.findings, check.report):
            yield from _wrapped(line, width, "" if line.startswith(" ") else "place")
        return
    if check.tools:
        yield "title", "What the tools say"
        for line in check.tools:
            yield from _wrapped(line, width)
    elif check.done:
        yield from _wrapped("No tool complains, and still it doesn't do its job.", width)
    yield "", ""
    yield from _wrapped("Find it yourself, or press e and I'll explain.", width)


def list_of(watched: Watched, chosen: int) -> Iterator[StyledLine]:
    """Yield all exercises, each with its state; chosen: the index of the one that is marked."""
    for index, exercise in enumerate(watched.course.exercises):
        passed = watched.course.is_passed(exercise)
        mark = ">" if index == chosen else " "
        state, defect = "passed" if passed else "open", exercise.defect
        text = f"{mark} {exercise.number:3}  {state:8}{defect.kind:10}{defect.title}"
        yield "bar" if index == chosen else "added" if passed else "", text


def nodes(watched: Watched, width: int) -> Iterator[StyledLine]:
    """Yield what roslaunch and the nodes printed when the check ran them."""
    report = watched.check.report if watched.check else None
    if report and report.console:
        for line in report.console:
            yield from _wrapped(terminal.plain(tool_output.ESCAPES.sub("", line)), width)
    elif watched.check and watched.check.done:
        yield from _wrapped("The nodes didn't run: see what's wrong.", width)
    else:
        yield from _wrapped("Their output appears here once the check has run them.", width)


def diff(lines: Sequence[str], width: int) -> Iterator[StyledLine]:
    for line in lines:
        yield from _wrapped(line, width, _DIFF.get(line[:1], ""))


def _text(text: str, width: int, title: str) -> Iterator[StyledLine]:
    """Yield a title and a text, whose paragraphs are filled."""
    yield "title", title
    for paragraph in text.strip().split("\n\n"):
        yield "", ""
        yield from _wrapped(" ".join(paragraph.split()), width)


def _wrapped(text: str, width: int, style: str = "") -> Iterator[StyledLine]:
    """Yield a line as lines that fit; those after the first are indented as it is, or more."""
    head = re.match(r"(  \w+: +)?\s*", text)
    indent = "  " if style == "place" else " " * head.end() if head else ""
    lines = textwrap.wrap(text, width, subsequent_indent=indent, break_on_hyphens=False)
    yield from ((style, line) for line in lines or [""])
