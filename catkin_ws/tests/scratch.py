# SPDX-License-Identifier: BSD-3-Clause
"""A workspace in a temporary folder, with a copy of the tutorial package to build and to break."""

import os
import pathlib
import shutil
import socket
import subprocess

import compiler_cache

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent


def make(folder):
    """Make a workspace at `folder` with a copy of the package mrp; return the package's folder."""
    package = folder / "src" / "mrp"
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(WORKSPACE / "src" / "mrp", package, ignore=ignore)
    return package


def environment():
    """Return the environment without any workspace, and with a master's address of its own."""
    names = ("CMAKE_PREFIX_PATH", "ROS_PACKAGE_PATH", "PYTHONPATH", "LD_LIBRARY_PATH")
    env = {k: v for k, v in os.environ.items() if k not in names}
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        env["ROS_MASTER_URI"] = f"http://localhost:{probe.getsockname()[1]}"
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
