# SPDX-License-Identifier: BSD-3-Clause
"""These tests use what the tutorial package's own tests are made of, and leave nothing behind."""

import os
import pathlib
import sys

import pytest

sys.path.insert(
    0, str(pathlib.Path(__file__).resolve().parents[2] / "catkin_ws" / "src" / "mrp" / "test")
)

# And call make as a user does: not within make.
for name in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS"):
    os.environ.pop(name, None)


@pytest.fixture(scope="session")
def image():
    """The image under test: the one that `make docker-build` made."""
    return "mrp:" + os.environ.get("DEBIAN", "bookworm")


@pytest.fixture(scope="session", autouse=True)
def nothing_is_left():
    from containers import PREFIX, docker  # to be found only by the path above

    yield
    listed = [
        docker("ps", "--all", "--format={{.Names}}"),
        docker("network", "ls", "--format={{.Name}}"),
        docker("volume", "ls", "--format={{.Name}}"),
        docker("image", "ls", "--format={{.Repository}}"),
    ]
    assert [name for text in listed for name in text.split() if name.startswith(PREFIX)] == []
