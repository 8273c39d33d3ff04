# SPDX-License-Identifier: BSD-3-Clause
"""Where this workspace is. An installed copy of this package does not know it."""

import pathlib
import shutil

WORKSPACE = pathlib.Path(__file__).resolve().parents[4]  # catkin_ws
ROOT = WORKSPACE.parent  # the repository, where the Makefile is


def copy_repository(target, *without):
    """Copy what git knows or would know of the repository to `target`, which is not there yet.

    without: patterns of more names to leave out
    """
    by_name = shutil.ignore_patterns(".git", "__pycache__", ".*_cache", *without)

    def ignored(folder, names):
        # Only here: the checker has a folder build, too.
        built = {"build", "devel", "install"} if pathlib.Path(folder) == WORKSPACE else set()
        return by_name(folder, names) | built

    shutil.copytree(ROOT, target, ignore=ignored, symlinks=True)
    (target / "catkin_ws" / "src" / "CMakeLists.txt").unlink(missing_ok=True)
