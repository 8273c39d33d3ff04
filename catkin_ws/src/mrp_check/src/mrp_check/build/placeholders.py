# SPDX-License-Identifier: BSD-3-Clause
"""boost::bind's _1 in a source that nobody could compile, for want of a package."""

from __future__ import annotations

import pathlib
import re
from typing import Iterable, Iterator

from mrp_check.code import uses
from mrp_check.contract.finding import Finding
from mrp_check.contract.words import last_part, line_of
from mrp_check.package.package import Package

# Boost 1.73 took _1 out of the global namespace, and Debian's ROS includes the header without it:
# https://www.boost.org/doc/libs/1_73_0/libs/bind/doc/html/bind.html
SAID = "this machine's Boost has it in boost::placeholders alone."
FIX = "Add #include <boost/bind/bind.hpp> and using namespace boost::placeholders;"
_OLD = "boost/bind.hpp"  # has it still
_ROS = (pathlib.Path("/opt/ros/noetic/include/ros"), pathlib.Path("/usr/include/ros"))
_BIND = re.compile(r"(?<!std::)\b(?:boost::)?bind\s*\([^;]*?(?<![\w:])(_[1-9])\b")
# Whose headers are known not to bring it.
_PLAIN = re.compile(
    r"[\w.]+|(ros|actionlib|dynamic_reconfigure|\w+_msgs|\w+_srvs)/.*|boost/(?!bind\.hpp).*"
)


def findings(package: Package, files: Iterable[str]) -> Iterator[Finding]:
    """Yield a Finding for the first _1 of each source in which nothing declares it."""
    if not _is_gone():
        return
    for file in sorted({*files} & {*package.of_kind("cpp")}):
        match = _BIND.search(uses.code(package, file))
        if not match or not _is_plain(package, file):
            continue
        line = line_of(match, 1)
        yield Finding(
            "compile",
            f"{file} uses {match[1]} as a name of its own: {SAID}",
            file,
            line,
            expected=f"boost::placeholders::{match[1]}",
            seen=package.line(file, line),
            fix=FIX,
        )


def _is_gone() -> bool:
    headers = [path for folder in _ROS for path in folder.glob("*.h")]
    return bool(headers) and not any(_OLD in path.read_text() for path in headers)


def _is_plain(package: Package, file: str, seen: tuple[str, ...] = ()) -> bool:
    """Return whether it is known of all headers of a file that they do not declare _1."""
    own = {last_part(path): path for path in package.of_kind("header")}
    if file in seen:
        return True
    if "placeholders" in package.text(file):
        return False
    for header, _ in uses.includes(package, file):
        path = own.get(last_part(header))
        is_made = header.split("/")[0] == package.name  # of its messages
        if path is None and not is_made and not _PLAIN.fullmatch(header):
            return False
        if path and not _is_plain(package, path, (*seen, file)):
            return False
    return True
