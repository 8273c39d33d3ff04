# SPDX-License-Identifier: BSD-3-Clause
"""The exercises: broken packages to be mended, one after the other. `make exercise` calls this.

An exercise is a defect with a task (defects.py): the tutorial's package with its patch. The student
edits a copy of it. Reversed, the patch is the solution.
"""

from __future__ import annotations

import argparse
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import typing

from mrp_check import check
from mrp_check.contract import defects, spec
from mrp_check.contract.errors import CannotCheck, PackageError
from mrp_check.contract.finding import NOTE
from mrp_check.report import console

PASSED, NOT_YET, UNCHECKED = 0, 1, 2


class ExerciseError(Exception):
    """An exercise cannot be laid out; its text is one sentence."""


class Exercise(typing.NamedTuple):
    """One exercise, made of a defect."""

    defect: defects.Defect

    @property
    def name(self):
        """The number and the title: the defect's own name would say too much."""
        words = re.findall(r"[a-z0-9]+", self.defect.title.lower())
        return "_".join([f"{self.defect.order:02}", *words])

    def lay_out(self, folder):
        """Make the broken package at `folder`, with the task beside it in TASK.md."""
        tutorial = self.defect.path.parent.parent / "src" / "mrp"
        if not (tutorial / "src").is_dir():
            raise ExerciseError(
                f"The exercises are made of the tutorial's sources, and {tutorial} is not there: "
                "call `make exercise` in a clone of the repository."
            )
        shutil.copytree(tutorial, folder, ignore=shutil.ignore_patterns("doc", "__pycache__"))
        patch(folder, self.defect.path)
        (folder / "TASK.md").write_text(f"{self.defect.task}\n")


def patch(folder, file):
    """Apply a patch to a package. Raises ExerciseError if that cannot be done."""
    command = ["patch", "-p1", "--fuzz=0", "--silent", f"--input={file}"]
    try:
        done = subprocess.run(
            command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
    except FileNotFoundError:
        raise ExerciseError("There is no command `patch`: install the package patch.") from None
    if done.returncode != 0:
        raise ExerciseError(f"{file} does not fit the tutorial's package: {done.stdout.strip()}")


def exercises():
    """Return all exercises, from the easiest on."""
    return [Exercise(defect) for defect in defects.exercises()]


class Progress:
    """Which exercises are passed: their names, one in each line of a file."""

    def __init__(self, folder):
        self.file = folder / "passed.txt"

    @property
    def names(self):
        return self.file.read_text().split() if self.file.exists() else []

    def add(self, name):
        self.file.write_text("".join(f"{one}\n" for one in [*self.names, name]))


def faults(report):
    """Return what is still wrong: an exercise is passed without errors and without warnings."""
    return [f for f in report.findings if f.severity != NOTE and not f.consequence_of]


def lines_of(findings):
    """Return what a student is told: where and what, and not how to mend it."""
    lines = []
    for finding in findings:
        where = ":".join(str(part) for part in (finding.file, finding.line) if part is not None)
        lines += ["", f"{where}: {finding.message}" if where else finding.message]
        lines += [f"  expected: {finding.expected}"] if finding.expected else []
        lines += [f"  seen:     {finding.seen}"] if finding.seen else []
    return lines


def show_task(exercise, place, number, count):
    """Print what is to be done, and where."""
    print(f"Exercise {number} of {count}\n\n{exercise.defect.task}\n")
    print(f"The package: {place}\nMend it, and call `make exercise` again.")


def run(folder, hint=False, reset=False):
    """Show the exercise that comes next, or check it; return the exit code.

    folder: where the student's copies are
    hint: show the hint instead
    reset: lay the exercise out anew; what the student has done in it is lost
    """
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    progress, everything = Progress(folder), exercises()
    left = [exercise for exercise in everything if exercise.name not in progress.names]
    if not left:
        print(f"All {len(everything)} exercises are passed.")
        return PASSED
    exercise = left[0]
    number = everything.index(exercise) + 1
    place = folder / exercise.name
    if reset and place.exists():
        shutil.rmtree(place)
    if not place.exists():
        exercise.lay_out(place)
        show_task(exercise, place, number, len(everything))
        return PASSED
    if hint:
        print(exercise.defect.hint)
        return PASSED

    shown = console.Progress(sys.stderr)
    report = check.check(place, spec.read(spec.find("pub_sub")), progress=shown.show)
    shown.clear()
    found = faults(report)
    if report.reason and not found:
        raise CannotCheck(report.reason)
    if found:
        print(f"Exercise {number} of {len(everything)}, {exercise.name}: not yet.")
        print("\n".join(lines_of(found)))
        print(f"\nThe task: {place / 'TASK.md'}\nA hint: make exercise HINT=1")
        return NOT_YET
    progress.add(exercise.name)
    print(f"Exercise {number} of {len(everything)}, {exercise.name}: passed.\n")
    return run(folder)


def main(arguments=None):
    """Do what the command line says, and exit: 0 shown or passed, 1 not yet, 2 cannot check."""
    parser = argparse.ArgumentParser(prog="exercise", description="Shows and checks the exercises.")
    parser.add_argument("folder", type=pathlib.Path, help="where your copies of them are")
    parser.add_argument("--hint", action="store_true", help="show the hint")
    parser.add_argument("--reset", action="store_true", help="begin the exercise anew")
    options = parser.parse_args(arguments)
    # As with Ctrl-C, nothing is left behind then.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        sys.exit(run(options.folder, options.hint, options.reset))
    except (ExerciseError, defects.DefectError, CannotCheck, PackageError) as error:
        print(f"exercise: {error}", file=sys.stderr)
        sys.exit(UNCHECKED)
    except KeyboardInterrupt:
        sys.exit("exercise: stopped before its end; what it ran has ended, too.")


if __name__ == "__main__":
    main()
