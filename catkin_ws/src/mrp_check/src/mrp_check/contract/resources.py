# SPDX-License-Identifier: BSD-3-Clause
"""The files beside the Python code: specs, schemas, templates, and defects."""

import functools
import pathlib
import re

# Where the ROS packages of this machine are.
SHARES = ("/opt/ros/noetic/share", "/usr/share")

_HERE = pathlib.Path(__file__).resolve().parent


def folder(name: str) -> pathlib.Path:
    """Return the folder `name` of the package, or where it is installed."""
    installed = _HERE.parents[4] / "share" / "mrp_check" / name
    in_sources = _HERE.parents[2] / name
    return in_sources if in_sources.is_dir() else installed


@functools.lru_cache
def website() -> str:
    """Return the address of the tutorial's pages, which package.xml has in a release; or ""."""
    manifest = folder("specs").parent / "package.xml"
    found = re.search(r'<url type="website">(.*)</url>', manifest.read_text())
    return found[1] if found else ""
