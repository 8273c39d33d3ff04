# SPDX-License-Identifier: BSD-3-Clause
"""The exercises: broken packages to fix, one after the other. `make exercise` calls this.

An exercise is a defect with a task (defects.py): the tutorial's package with its patch. The student
edits a copy of it. The patch, reversed, is the solution.
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
from mrp_check.student.package import Package

PASSED, NOT_YET, UNCHECKED = 0, 1, 2


class ExerciseError(Exception):
    """An exercise cannot be laid out; its text is one sentence."""


class Exercise(typing.NamedTuple):
    """One exercise, built from a defect."""

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
                f"The exercises are built from the tutorial's sources, and there is no {tutorial}:"
                " call `make exercise` in a clone of the repository."
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
        raise ExerciseError(
            f"{file} does not fit the tutorial's package. Undo your changes to both."
            f" The command `patch` says: {done.stdout.strip()}"
        )


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


def lines_of(findings, report):
    """Return what a student reads: where it is wrong and what is wrong, and not how to fix it."""
    lines = []
    for finding in findings:
        lines += ["", f"{console.where(finding, report)}: {console.plain(finding.message)}"]
        lines += console.detail_lines(finding, ("expected", "seen"))
    return lines


def show_task(exercise, place, label):
    """Print the task, and where the package is."""
    print(f"{label}\n\n{exercise.defect.task}\n")
    print(f"The package: {place}\nFix it, and call `make exercise` again.")


def is_passed(exercise, place, label):
    """Check a student's copy, and print what is still wrong. Raises CannotCheck."""
    shown = console.Progress(sys.stderr)
    report = check.check(Package(place), spec.read(spec.find("pub_sub")), progress=shown.show)
    shown.clear()
    found = faults(report)
    if report.reason and not found:
        raise CannotCheck(report.reason)
    print(f"{label}, {exercise.name}: {'not yet' if found else 'passed'}.")
    print("\n".join(lines_of(found, report)))
    if found:
        print(f"\nThe task: {place / 'TASK.md'}\nA hint: make exercise HINT=1")
    return not found


def run(folder, hint=False, reset=False):
    """Show the next exercise, or check it; return the exit code.

    folder: where the student's copies are
    hint: show the hint instead
    reset: make the package again; the student's changes to it are lost
    """
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    progress, everything = Progress(folder), exercises()
    left = [exercise for exercise in everything if exercise.name not in progress.names]
    if not left:
        print(f"All {len(everything)} exercises are passed.")
        return PASSED
    exercise = left[0]
    label = f"Exercise {everything.index(exercise) + 1} of {len(everything)}"
    place = folder / exercise.name
    if reset and place.exists():
        shutil.rmtree(place)
    if not place.exists():
        exercise.lay_out(place)
        show_task(exercise, place, label)
    elif hint:
        print(exercise.defect.hint)
    elif is_passed(exercise, place, label):
        progress.add(exercise.name)
        return run(folder)
    else:
        return NOT_YET
    return PASSED


def main(arguments=None):
    """Do what the command line says, and exit: 0 shown or passed, 1 not yet, 2 cannot check."""
    parser = argparse.ArgumentParser(prog="exercise", description="Shows and checks the exercises.")
    parser.add_argument("folder", type=pathlib.Path, help="the folder of your copies")
    parser.add_argument("--hint", action="store_true", help="show the hint")
    parser.add_argument("--reset", action="store_true", help="begin it again without your changes")
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
