# SPDX-License-Identifier: BSD-3-Clause
"""Debian's releases, and what each has taken away that ROS packages use.

The rules, `make doctor` and `make why` read it here: the checker must be complete without the
workspace's tools, and these already find the checker's folder beside them.
"""

from __future__ import annotations

import pathlib
import re
from typing import Mapping, NamedTuple


class Release(NamedTuple):
    """What ROS 1 meets on a release."""

    name: str
    python: str
    cmake: str


RELEASES: Mapping[int, Release] = {
    12: Release("bookworm", "3.11", "3.25"),
    13: Release("trixie", "3.13", "3.31"),
    14: Release("forky", "3.14", "4.3"),
}

# CMake 4 refuses what is written for a CMake older than 3.5, as catkin's own toplevel.cmake is,
# unless this is in the environment.
CMAKE_LEAST = (3, 5)
CMAKE_VARIABLE, CMAKE_VALUE = "CMAKE_POLICY_VERSION_MINIMUM", "3.5"


class Gone(NamedTuple):
    """What a release has not any more. why: the entry of the page why, whose fix has `instead`."""

    what: str
    since: int
    instead: str
    why: str


GONE: Mapping[str, Gone] = {
    "cmake": Gone(
        "a CMake that takes what was written for one older than 3.5",
        14,
        "cmake_minimum_required(VERSION 3.10)",
        "cmake-too-old",
    ),
    "pkg_resources": Gone("module pkg_resources", 14, "importlib.metadata", "pkg-resources"),
}


def supported() -> str:
    """Return the releases as a sentence's part, the newest first: "14, 13 and 12"."""
    *newest, oldest = sorted(RELEASES, reverse=True)
    return f"{', '.join(map(str, newest))} and {oldest}"


def here(os_release: str = "/etc/os-release") -> int | None:
    """Return the number of this machine's Debian; None if it is another system, or another release.

    That of a release which is not out yet stands in its name alone.
    """
    path = pathlib.Path(os_release)
    text = path.read_text(errors="replace") if path.is_file() else ""
    fields = dict(re.findall(r"^(\w+)=\"?([^\"\n]*)", text, re.MULTILINE))
    if fields.get("ID") != "debian":
        return None
    names = {release.name: number for number, release in RELEASES.items()}
    return names.get(fields.get("VERSION_CODENAME", ""))
