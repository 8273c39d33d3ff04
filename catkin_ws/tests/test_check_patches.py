# SPDX-License-Identifier: BSD-3-Clause
"""The sets that judge the checker are what they say. The checks are made by test_check_sets.py.

Each defect can be injected, and each place that its head names is a line of the broken package;
each exercise can be laid out.
"""

import re
import subprocess
import sys

import check_sets
import pytest

CHECK = check_sets.HERE.parent / "src" / "mrp_check"
sys.path.insert(0, str(CHECK / "src"))

from mrp_check.rules import REQUIREMENTS  # noqa: E402

pytestmark = pytest.mark.quick

SOLUTIONS = sorted(CHECK.glob("exercises/*/solution.patch"))


def assert_places(fields, folder):
    """Raise AssertionError unless a head's finding can be made in the package at a folder."""
    (ids,), (words,) = fields["Finds"], fields["Tells"]
    assert [id_ for id_ in ids.split("|") if id_ not in REQUIREMENTS] == []
    re.compile(words)
    for place in fields["In"]:
        file, pattern = place.split(": ", 1)
        lines = (folder / file).read_bytes().decode("utf-8", "replace").splitlines()
        assert any(re.search(pattern, line) for line in lines), place


@pytest.mark.parametrize("patch", check_sets.PATCHES, ids=lambda patch: patch.stem)
def test_defect_can_be_injected(patch, tmp_path):
    fields = check_sets.head(patch)
    assert fields["Breaks"]
    check_sets.lay_out(fields.get("Base", ["mrp"])[0], tmp_path)
    check_sets.break_(tmp_path, patch)
    assert_places(fields, tmp_path)


@pytest.mark.parametrize("patch", SOLUTIONS, ids=lambda path: path.parent.name)
def test_exercise_can_be_laid_out(patch, tmp_path):
    check_sets.lay_out("mrp", tmp_path)
    command = ["patch", "-p1", "--fuzz=0", "--reverse", f"--input={patch}"]
    subprocess.run(command, cwd=tmp_path, check=True)
    assert_places(check_sets.head(patch), tmp_path)


def test_sets_are_as_large_as_was_asked_for():
    assert len(check_sets.PATCHES) >= 40
    assert len(check_sets.STYLES) >= 12
    assert len(SOLUTIONS) >= 12
