# SPDX-License-Identifier: BSD-3-Clause
"""The files beside the Python code: specs, schemas, templates, and the workspace's defects."""

import pathlib

# Where the ROS packages of this machine are.
SHARES = ("/opt/ros/noetic/share", "/usr/share")

_HERE = pathlib.Path(__file__).resolve().parent


def folder(name: str) -> pathlib.Path:
    """Return the folder `name` of the package or of its workspace, or where it is installed."""
    installed = _HERE.parents[4] / "share" / "mrp_check" / name
    in_sources = (_HERE.parents[2] / name, _HERE.parents[4] / name)
    return next((folder for folder in in_sources if folder.is_dir()), installed)
