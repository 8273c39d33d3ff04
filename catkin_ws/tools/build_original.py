#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Builds what the original page prints, mended only so far that its nodes start.

Usage: build_original.py FOLDER
Makes that folder anew, as a workspace; `make bench` measures it beside ours.
"""

import pathlib
import shutil
import sys

from mrp_testing import errata, scratch


def build(folder):
    """Build it. Raises AssertionError with what catkin_make printed if that failed."""
    shutil.rmtree(folder, ignore_errors=True)
    package = shutil.copytree(errata.ORIGINAL, folder / "src" / errata.PACKAGE)
    errata.mend(package, *errata.STARTS)
    scratch.catkin_make(folder, "-DCMAKE_BUILD_TYPE=RelWithDebInfo")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    build(pathlib.Path(sys.argv[1]).resolve())
