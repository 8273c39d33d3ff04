# SPDX-License-Identifier: BSD-3-Clause
"""These tests use what the tutorial package's own tests are made of; each has one kind.

The kinds are the marks in pytest.ini: `pytest -m KIND` runs the tests of a kind. A file says at its
head of which kind its tests are (pytestmark = pytest.mark.slow). A test of another kind says so
itself (@pytest.mark.quick): the mark of a test wins over that of its file.
"""

import pathlib
import sys

import pytest

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
for folder in ("src/mrp/test", "src/mrp_check/src", "tools"):
    sys.path.insert(0, str(WORKSPACE / folder))

KINDS = ("quick", "slow", "sets")

# They take longest: begun last, they would keep one processor busy after all others are done.
FIRST = ("test_page", "test_broken", "test_make")


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


@pytest.fixture
def open_folders(tmp_path, tmp_path_factory):
    """Without namespaces, the user that a command runs as must be able to come to its folder."""
    for folder in (tmp_path, *tmp_path.parents):
        if folder.name.startswith("pytest-") or tmp_path_factory.getbasetemp() in folder.parents:
            folder.chmod(0o711)
    tmp_path_factory.getbasetemp().chmod(0o711)
