# SPDX-License-Identifier: BSD-3-Clause
"""The package's own files that are no Python code: specs and schemas."""

import pathlib

# Where the ROS packages of this machine are.
SHARES = ("/opt/ros/noetic/share", "/usr/share")

_HERE = pathlib.Path(__file__).resolve().parent


def folder(name):
    """Return the package's folder `name`, in the source tree or where it is installed."""
    installed = _HERE.parents[4] / "share" / "mrp_check" / name
    in_sources = _HERE.parents[2] / name
    return in_sources if in_sources.is_dir() else installed
