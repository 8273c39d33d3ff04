# SPDX-License-Identifier: BSD-3-Clause
"""rostests.txt: each rostest of the workspace is run by make test or by make test-all, once."""

import os

import pytest
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

LISTED = [
    line.split(" ", 2)
    for line in (WORKSPACE / "tests" / "rostests.txt").read_text().splitlines()
    if not line.startswith("#")
]


def rostests(folder):
    """Return what runs the programs test_NAME.py in a package's folder test: NAME.test, if it is
    there, otherwise python.test with the name as its argument. pytest's files are no programs."""
    files = {path.name for path in folder.glob("*.test")}
    programs = (path for path in folder.glob("test_*.py") if os.access(path, os.X_OK))
    names = {path.stem[len("test_") :] for path in programs}
    others = {f"python.test name:={name}" for name in names if f"{name}.test" not in files}
    return files - {"python.test"} | others


def test_each_is_listed_once():
    found = [
        (folder.parent.name, rostest)
        for folder in WORKSPACE.glob("src/*/test")
        for rostest in rostests(folder)
    ]
    assert sorted((package, rostest) for _, package, rostest in LISTED) == sorted(found)


def test_each_has_a_level():
    assert {level for level, _, _ in LISTED} == {"quick", "slow"}


def test_those_of_the_tutorial_are_quick():
    assert "mrp" not in {package for level, package, _ in LISTED if level == "slow"}
