# SPDX-License-Identifier: BSD-3-Clause
"""The exercises: broken packages to fix, and how far somebody has come with them.

An exercise is a defect with a task (defects.py): a correct package (packages.py) with its patch.
The student edits a copy of it. The patch, reversed, is the solution.
"""

from __future__ import annotations

import pathlib
import re
import shutil
import subprocess
import tempfile
from typing import NamedTuple, Sequence

from mrp_check.contract import defects, packages, spec
from mrp_check.contract.finding import NOTE, Finding
from mrp_check.contract.verdict import Report
from mrp_check.learning import opening
from mrp_check.report import terminal


class Exercise(NamedTuple):
    """One exercise, built from a defect.

    number: its place among all exercises, from 1 on; total: how many there are
    place: the folder of the student's copy
    """

    defect: defects.Defect
    number: int
    total: int
    place: pathlib.Path

    @property
    def name(self) -> str:
        return _name(self.defect)

    @property
    def label(self) -> str:
        return f"Exercise {self.number} of {self.total}"

    @property
    def file(self) -> pathlib.Path:
        """The file to open, in the student's copy."""
        return self.place / self.defect.places[0][0]

    @property
    def spec(self) -> spec.Spec:
        """What the package is checked against."""
        return spec.read(spec.find(packages.spec_of(self.defect.base)))

    def prepare(self) -> bool:
        """Make the broken package, unless it is there; return whether it was made."""
        if self.place.exists():
            return False
        self._lay_out_broken(self.place)
        (self.place / "TASK.md").write_text(f"{self.defect.task}\n")
        return True

    def remove(self) -> None:
        """Delete the copy, with the student's changes to it."""
        if self.place.exists():
            shutil.rmtree(self.place)

    def _lay_out_broken(self, folder: pathlib.Path) -> None:
        packages.lay_out(self.defect.base, folder)
        packages.break_(folder, self.defect)

    def solution(self) -> list[str]:
        """Return the lines of a diff: what turns the broken package into the correct one."""
        with tempfile.TemporaryDirectory() as folder:
            self._lay_out_broken(pathlib.Path(folder, "a"))
            packages.lay_out(self.defect.base, pathlib.Path(folder, "b"))
            command = ["diff", "--unified", "--recursive", "--new-file", "a", "b"]
            done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True)
        text = re.sub(r"^diff .*\n", "", done.stdout, flags=re.MULTILINE)
        times = re.compile(r"^([-+]{3} [ab]/.*)\t.*", re.MULTILINE)
        return times.sub(r"\1", text).splitlines()


def _name(defect: defects.Defect) -> str:
    """Return the title as a name: the defect's own name would say too much."""
    return "_".join(re.findall(r"[a-z0-9]+", defect.title.lower()))


def _without_number(name: str) -> str:
    return re.sub(r"^\d+_", "", name)


class Course:
    """All exercises, from the easiest on, and which of them are passed.

    folder: of the student's copies; in it passed.txt, with the name of one exercise in each line

    A later version may number the exercises anew: so an exercise is known by its name alone.
    """

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder.resolve()
        self.folder.mkdir(parents=True, exist_ok=True)
        found = defects.exercises()
        copies = {_without_number(path.name): path for path in sorted(self.folder.iterdir())}
        self.exercises = []
        for number, defect in enumerate(found, 1):
            new = self.folder / f"{number:02}_{_name(defect)}"
            place = copies.get(_name(defect), new)
            self.exercises.append(Exercise(defect, number, len(found), place))
        self._file = self.folder / "passed.txt"
        lines = self._file.read_text(errors="replace").split() if self._file.exists() else []
        self._passed = [_without_number(line) for line in lines]

    @property
    def open(self) -> list[Exercise]:
        return [exercise for exercise in self.exercises if not self.is_passed(exercise)]

    def is_passed(self, exercise: Exercise) -> bool:
        return exercise.name in self._passed

    def add(self, exercise: Exercise) -> None:
        """Keep that an exercise is passed."""
        if not self.is_passed(exercise):
            self._passed.append(exercise.name)
            self._file.write_text("".join(f"{name}\n" for name in self._passed))


def progress(course: Course) -> str:
    """Return how many exercises are passed, such as "7 of 40."."""
    return f"{len(course.exercises) - len(course.open)} of {len(course.exercises)}."


def farewell(course: Course) -> list[str]:
    """Return what somebody reads who has passed the last exercise."""
    return [
        "You've read the errors of Python, g++, CMake and roslaunch, and fixed"
        f" {len(course.exercises)} packages. What's next? In the folder of the repository,",
        "- start a package of your own, with a node and a test that work:",
        "  make new PKG=~/robot_ws/src/laser_filter",
        "- or check one that you have:",
        "  make check PKG=~/catkin_ws/src/my_package ANY=1",
    ]


def wrong(report: Report) -> list[Finding]:
    """Return what is still wrong: an exercise is passed without errors and without warnings.

    Of several findings about the same line, only the first is returned: they have one cause.
    """
    found = [f for f in report.findings if f.severity != NOTE and not f.consequence_of]
    by_line = {(f.file, f.line) if f.line else id(f): f for f in reversed(found)}
    return list(reversed(by_line.values()))


def lines_of(findings: Sequence[Finding], report: Report | None) -> list[str]:
    """Return what a student reads: where it is wrong, what is wrong, and the page that explains it;
    and not how to fix it."""
    lines = []
    for finding in findings:
        lines += ["", f"{terminal.where(finding, report)}: {terminal.plain(finding.message)}"]
        lines += terminal.detail_lines(finding, ("expected", "seen"))
        for name, address in terminal.pages(finding):
            page, _, anchor = address.removeprefix("pages/").partition(".html")
            path = opening.built_page(page)
            lines.append(f"  {name + ':':<10}file://{path}{anchor}")
            if not path.exists():
                lines.append(" " * 12 + "(make docs builds it)")
    return lines
