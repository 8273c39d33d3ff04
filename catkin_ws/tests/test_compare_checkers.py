# SPDX-License-Identifier: BSD-3-Clause
"""The comparison of checkers counts what each reports at a listed place, and what elsewhere."""

import sys

import pytest
from mrp_testing.proves import proves
from mrp_testing.workspace import WORKSPACE

sys.path.insert(0, str(WORKSPACE / "tools"))
import compare_checkers
from compare_checkers import Report

pytestmark = pytest.mark.quick

PACKAGE = ("somebody/some_pkg", ".")


def row(label, place):
    repository, folder = PACKAGE
    return {"repository": repository, "folder": folder, "label": label, "place": place}


LISTED = compare_checkers.defects(
    [
        row("error", "src/talker.py:5 src/my_listener.py:9"),
        row("error", "scripts/*.py:1"),
        row("warning", "package.xml"),
        row("unchecked", "CMakeLists.txt:10"),
        row("none", "src/talker.py:30"),
        row("correct", ""),
    ]
)


@pytest.mark.parametrize(
    ("reports", "errors", "warnings", "elsewhere"),
    [
        ([], 0, 0, 0),
        # Two lines away is near, three are not; and only errors are counted elsewhere.
        ([Report("src/talker.py", 7, True), Report("src/my_listener.py", 9, False)], 1, 0, 0),
        ([Report("src/talker.py", 8, True), Report("src/my_listener.py", 9, False)], 0, 0, 1),
        ([Report("src/talker.py", 8, False)], 0, 0, 0),
        # One of two places is not enough.
        ([Report("src/talker.py", 5, True)], 0, 0, 0),
        # A report on the file as a whole means each of its lines.
        ([Report("scripts/a.py", 0, True), Report("package.xml", 17, False)], 1, 1, 0),
        # What is missing on the machine, and what somebody found to be right, is no defect.
        ([Report("CMakeLists.txt", 10, True), Report("src/talker.py", 30, True)], 0, 0, 2),
    ],
)
@proves(
    "It counts the errors that a checker names, at most two lines away.",
    "Elsewhere are errors that it reports where nobody has listed anything:",
)
def test_what_is_reported_is_counted_by_its_place(reports, errors, warnings, elsewhere):
    (found,) = compare_checkers.table(LISTED, {"some checker": {PACKAGE: reports}})
    assert found == {
        "checker": "some checker",
        "of 2 errors": errors,
        "of 1 warnings": warnings,
        "errors elsewhere": elsewhere,
    }


def test_lines_about_other_files_are_left_out(tmp_path):
    (tmp_path / "a.cpp").write_text("")
    said = f"{tmp_path}/a.cpp:3:1: error: no\n/usr/include/stdio.h:4:1: error: no\na.cpp:5: other\n"
    found = compare_checkers.of_lines(said, tmp_path, lambda text: "error" in text)
    assert found == [Report("a.cpp", 3, True), Report("a.cpp", 5, False)]
