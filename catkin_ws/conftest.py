# SPDX-License-Identifier: BSD-3-Clause
"""All tests that pytest runs: each has one kind.

The kinds are the marks in pyproject.toml: `pytest -m KIND` runs the tests of a kind. A file says at
its head of which kind its tests are (pytestmark = pytest.mark.slow). A test of another kind says so
itself (@pytest.mark.quick): the mark of a test wins over that of its file.
"""

import os

import pytest

# No test reaches the machine's package manager, sudo or containers.
pytest_plugins = ("mrp_testing.guard",)

KINDS = ("quick", "slow", "sets")

# They take longest: begun last, they would keep one processor busy after all others are done.
FIRST = ("test_page", "test_broken", "test_make", "test_check_sets", "test_check_runs")


def pytest_ignore_collect(collection_path):
    """Leave out what rostest runs: programs, which files of pytest are not."""
    return collection_path.is_file() and os.access(collection_path, os.X_OK) or None


@pytest.hookimpl(tryfirst=True)  # before -m looks at the marks
def pytest_collection_modifyitems(items):
    of_items = [kinds_of(item) for item in items]
    for item, kinds in zip(items, of_items):
        for node in item.listchain():
            node.own_markers = [mark for mark in node.own_markers if mark.name not in KINDS]
        # A test with none or two is in every run, which it fails.
        for kind in kinds if len(kinds) == 1 else KINDS:
            item.add_marker(kind)
    items.sort(key=lambda item: item.path.stem not in FIRST)


def kinds_of(item):
    """Return the kinds that the test names itself; those that its file names if it names none."""
    kinds = []
    for node in item.listchain():  # from the whole run down to the test
        kinds = [mark.name for mark in node.own_markers if mark.name in KINDS] or kinds
    return kinds


def pytest_runtest_setup(item):
    if sum(mark.name in KINDS for mark in item.iter_markers()) != 1:
        pytest.fail("expected one mark of quick, slow, sets; found none or more", pytrace=False)
