# SPDX-License-Identifier: BSD-3-Clause
"""A workspace in a temporary folder, with copies of packages to build and to break."""

import os
import pathlib
import shutil
import subprocess

from mrp_testing import compiler_cache
from mrp_testing.master import uri_of
from mrp_testing.ports import free_port
from mrp_testing.workspace import WORKSPACE

TESTED = ("src/mrp", "src/mrp_testing")  # the tutorial, and what its rostests need


def make(folder, *packages):
    """Make a workspace at `folder` with copies of packages: their paths in this workspace."""
    for path in map(pathlib.PurePath, packages):
        ignore = shutil.ignore_patterns("__pycache__")
        shutil.copytree(WORKSPACE / path, folder / "src" / path.name, ignore=ignore)


def environment():
    """Return the environment without any workspace, and with a master's address of its own.

    In it, CMake 4 takes what catkin asks for; the tests may not have been started by make.
    """
    names = ("CMAKE_PREFIX_PATH", "ROS_PACKAGE_PATH", "PYTHONPATH", "LD_LIBRARY_PATH")
    env = {k: v for k, v in os.environ.items() if k not in names}
    env["CMAKE_POLICY_VERSION_MINIMUM"] = "3.5"
    env["ROS_MASTER_URI"] = uri_of(free_port())
    return env


def catkin_make(folder, *arguments):
    """Run catkin_make; return what it printed. Raises AssertionError with it if that failed."""
    done = subprocess.run(
        ["catkin_make", "-C", str(folder), "-DPYTHON_EXECUTABLE=/usr/bin/python3", *arguments],
        env={**environment(), **compiler_cache.variables(folder)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


def sourced(setup, *command):
    """Return the command to be run in an environment in which the file `setup` is sourced."""
    return ("bash", "-c", 'source "$0" && exec "$@"', str(setup), *map(str, command))
