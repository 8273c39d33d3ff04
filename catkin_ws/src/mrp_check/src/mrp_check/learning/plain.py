# SPDX-License-Identifier: BSD-3-Clause
"""The exercises as lines, for `make exercise`."""

from __future__ import annotations

import pathlib
import sys

from mrp_check.contract.errors import CannotCheck
from mrp_check.learning import exercise as exercises
from mrp_check.learning.watch import Check
from mrp_check.report import terminal

PASSED, NOT_YET = 0, 1


def say(*lines: str) -> None:
    print(*lines, sep="\n", flush=True)


def run_once(folder: pathlib.Path, hint: bool = False, reset: bool = False) -> int:
    """Show the next exercise, or check it; return the exit code.

    folder: where the student's copies are
    hint: show the hint instead
    reset: make the package again; the student's changes to it are lost
    """
    course = exercises.Course(folder)
    if not course.open:
        say(f"You have finished all {len(course.exercises)}. Well done!")
        return PASSED
    exercise = course.open[0]
    if reset:
        exercise.remove()
    if exercise.prepare():
        say(exercise.label, "", exercise.defect.task, "")
        say("Open this file, fix it, save it, and call `make exercise` again:")
        say(f"  {exercise.file}")
        return PASSED
    if hint:
        say(exercise.defect.hint)
        return PASSED
    shown = terminal.Progress(sys.stderr)
    check = Check(exercise, say=shown.show)
    check.run()
    shown.clear()
    if check.error:
        raise CannotCheck(check.error)
    lines = [f"{exercise.label}, {exercise.name}: {'passed' if check.passed else 'not yet'}."]
    if check.tools:
        lines += ["", "What the tools say:", *check.tools]
    say(*lines, *exercises.lines_of(check.findings, check.report))
    if not check.passed:
        say(f"\nThe task: {exercise.place / 'TASK.md'}", "A hint: make exercise HINT=1")
        return NOT_YET
    course.add(exercise)
    say(f"You've learned: {exercise.defect.learned}", exercises.progress(course), "")
    if course.open:
        return run_once(folder)
    say(f"You have finished all {len(course.exercises)}. Well done!", "")
    say(*exercises.farewell(course))
    return PASSED
