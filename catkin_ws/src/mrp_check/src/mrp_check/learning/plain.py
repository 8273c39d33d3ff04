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


def show_task(exercise: exercises.Exercise, what_then: str) -> None:
    say(f"{exercise.label}\n\n{exercise.defect.task}\n")
    say(f"Open this file, fix it, save it, and {what_then}:", f"  {exercise.file}")


def verdict(exercise: exercises.Exercise, check: Check) -> str:
    return f"{exercise.label}, {exercise.name}: {'passed' if check.passed else 'not yet'}."


def explanation(check: Check) -> list[str]:
    """Return what the tools say, and what the checker says, as lines."""
    tools = ["", "What the tools say:", *check.tools] if check.tools else []
    return [*tools, *exercises.lines_of(check.findings, check.report)]


def passed(course: exercises.Course, exercise: exercises.Exercise) -> list[str]:
    """Return what a student reads who has passed an exercise."""
    lines = [f"You've learned: {exercise.defect.learned}", f"{exercises.progress(course)}", ""]
    if not course.open:
        lines += [f"You have finished all {len(course.exercises)}. Well done!", ""]
        lines += exercises.farewell(course)
    return lines


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
        show_task(exercise, "call `make exercise` again")
    elif hint:
        say(exercise.defect.hint)
    else:
        shown = terminal.Progress(sys.stderr)
        check = Check(exercise, say=shown.show)
        check.run()
        shown.clear()
        if check.error:
            raise CannotCheck(check.error)
        say(verdict(exercise, check), *explanation(check))
        if not check.passed:
            say(f"\nThe task: {exercise.place / 'TASK.md'}", "A hint: make exercise HINT=1")
            return NOT_YET
        course.add(exercise)
        say(*passed(course, exercise))
        return run_once(folder) if course.open else PASSED
    return PASSED
