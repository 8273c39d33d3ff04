# SPDX-License-Identifier: BSD-3-Clause
"""The files beside the Python code: contracts, schemas, templates, and defects."""

import functools
import os
import pathlib
import re

# Where the ROS packages of this machine are.
SHARES = ("/opt/ros/noetic/share", "/usr/share")

_HERE = pathlib.Path(__file__).resolve().parent

# Where `make docs` puts the pages.
BUILT_SITE = _HERE.parents[4] / "build" / "docs"


def folder(name: str) -> pathlib.Path:
    """Return the folder `name` of the package, or where it is installed."""
    installed = _HERE.parents[4] / "share" / "mrp_check" / name
    in_sources = _HERE.parents[2] / name
    return in_sources if in_sources.is_dir() else installed


def site() -> str:
    """Return the address of the tutorial's pages: the one in MRP_PAGES; else the folder in which
    they were built here; else that of a release, from package.xml; else ""."""
    if address := os.environ.get("MRP_PAGES", ""):
        return address.rstrip("/")
    return BUILT_SITE.as_uri() if (BUILT_SITE / "index.html").is_file() else _website()


def address_of(page: str) -> str:
    """Return the address of a page, such as pages/why.html#no-rospy; or "" if it's not known."""
    address = site()
    return f"{address}/{page}" if address else ""


def link_to(page: str) -> str:
    """Return the address of a page; or the one it has once `make docs` has built it."""
    return address_of(page) or f"{BUILT_SITE.as_uri()}/{page} (make docs builds it)"


@functools.lru_cache
def _website() -> str:
    manifest = folder("contracts").parent / "package.xml"
    found = re.search(r'<url type="website">(.*)</url>', manifest.read_text())
    return found[1] if found else ""
