# SPDX-License-Identifier: BSD-3-Clause
"""rostests.txt: each rostest of the workspace is run by make test or by make test-all, once."""

import pathlib

import pytest

pytestmark = pytest.mark.quick

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
LISTED = [
    line.split()
    for line in (WORKSPACE / "tests" / "rostests.txt").read_text().splitlines()
    if not line.startswith("#")
]


def test_each_is_listed_once():
    files = [(path.parts[-3], path.name) for path in WORKSPACE.glob("src/*/test/*.test")]
    assert sorted((package, name) for _, package, name in LISTED) == sorted(files)


def test_each_has_a_level():
    assert {level for level, _, _ in LISTED} == {"quick", "slow"}


def test_those_of_the_tutorial_and_of_the_labs_are_quick():
    assert {package for level, package, _ in LISTED if level == "slow"} == {"mrp_view"}
