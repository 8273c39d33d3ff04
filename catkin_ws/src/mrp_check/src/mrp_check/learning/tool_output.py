# SPDX-License-Identifier: BSD-3-Clause
"""The lines in which CMake, g++, Python and ROS say what is wrong with a package.

A student reads them first, as at home, and our explanation only when asked for.
"""

from __future__ import annotations

import pathlib
import re
import subprocess
import traceback
from typing import Iterable, Iterator

from mrp_check.contract.verdict import Report
from mrp_check.report import terminal

_MOST = 12  # lines: of the first error, not of what follows from it
# Colours, and the window's title that roslaunch sets.
ESCAPES = re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07")
_COPY = re.compile(r"/[^\s\"':]*/workspace/src/[^/\s]+/")  # of the package, in the scratch folder
_BUILD_ERROR = re.compile(r"\berror:|CMake Error|undefined reference")
# What nodes log meanwhile, and what make adds to an error of g++.
_NOISE = re.compile(
    r"\[ ?(INFO|DEBUG)\]|process\[|started |make(\[\d+\])?: |.*/ld: .*: in function"
)
_RUN_ERROR = re.compile(
    r"Traceback|\[ ?(WARN|ERROR|FATAL)\]|^ERROR|RLException|\w+Warning:|terminate called|env: "
    r"|process has died|escalating to SIG"
)
_WRAPPER = "/devel/lib/"  # catkin's own script, which runs the package's


def lines_of(report: Report, place: pathlib.Path) -> list[str]:
    """Return the first error that a tool printed, as lines; none if no tool complained.

    place: the student's folder; the tools were given a copy of it
    """
    found = list(_from_first(_BUILD_ERROR, report.tools))
    for finding in report.findings:
        if not found and finding.id == "python-syntax" and finding.file:
            found = _of_python(place / finding.file)
        elif not found and finding.id == "launch-file":
            found = _of_roslaunch(place)
    if not found:
        plain = (ESCAPES.sub("", line) for line in report.console)
        found = list(_without_wrapper(_from_first(_RUN_ERROR, plain)))
    return [terminal.plain(_COPY.sub(f"{place}/", line)) for line in found[:_MOST]]


def _from_first(pattern: re.Pattern[str], lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines from the first that a pattern is found in, without noise."""
    begun = False
    for line in lines:
        begun = begun or bool(pattern.search(line))
        if begun and line.strip() and not _NOISE.match(line):
            yield line


def _without_wrapper(lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines of a traceback but those of the script in which catkin runs the package's."""
    skips = False
    for line in lines:
        if line.startswith('  File "'):
            skips = _WRAPPER in line
        elif not line.startswith("    "):
            skips = False
        if not skips:
            yield line


def _of_python(path: pathlib.Path) -> list[str]:
    """Return what Python says of a file that it cannot read."""
    try:
        compile(path.read_bytes(), str(path), "exec")
    except (SyntaxError, ValueError) as error:
        return "".join(traceback.format_exception_only(type(error), error)).splitlines()
    except OSError:  # it has just gone
        pass
    return []


def _of_roslaunch(place: pathlib.Path) -> list[str]:
    """Return what roslaunch says of a launch file that it cannot read."""
    for path in sorted(place.glob("launch/*.launch")):
        command = ["roslaunch", "--nodes", str(path)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=20)
        except (OSError, subprocess.TimeoutExpired):
            continue
        if done.returncode:
            return [line for line in ESCAPES.sub("", done.stderr).splitlines() if line.strip()]
    return []
