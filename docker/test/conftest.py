# SPDX-License-Identifier: BSD-3-Clause
"""These tests test the image of a release, and leave nothing behind."""

import os

import pytest
from containers import PREFIX, docker

# Without an engine that is given to them, mrp_testing.guard refuses Docker.
pytest_plugins = ("mrp_testing.guard",)

# These files take longest: begun last, one would keep a worker busy after all others are done.
FIRST = ("test_make", "test_several_hosts", "test_class")

# They call make as a user does: not within make.
for name in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS"):
    os.environ.pop(name, None)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """One worker takes a whole file, whose tests share containers. A fault has its own, and so has
    a test of test_run that does not look at the container that is running."""
    for item in items:
        if item.path.stem not in ("test_faults", "test_run") or "running" in item.fixturenames:
            item.add_marker(pytest.mark.xdist_group(item.path.stem))
    items.sort(key=lambda item: item.path.stem not in FIRST)


def pytest_sessionstart():
    if not os.environ.get("MRP_TEST_ENGINE"):
        pytest.exit(
            "these tests use this machine's Docker engine: make docker-containers gives it", 4
        )


@pytest.fixture(scope="session")
def image():
    """The image under test: the one that `make docker-build` made."""
    return "mrp:" + os.environ.get("DEBIAN", "trixie")


@pytest.fixture(scope="session", autouse=True)
def nothing_is_left():
    yield
    listed = [
        docker("ps", "--all", "--format={{.Names}}"),
        docker("network", "ls", "--format={{.Name}}"),
        docker("volume", "ls", "--format={{.Name}}"),
        docker("image", "ls", "--format={{.Repository}}"),
    ]
    assert [name for text in listed for name in text.split() if name.startswith(PREFIX)] == []
