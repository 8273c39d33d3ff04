# SPDX-License-Identifier: BSD-3-Clause
"""roslib.load_manifest() names a package that is there."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import uses

_CALL = re.compile(r"^[^#\n]*\bload_manifest\(\s*['\"]([\w-]+)['\"]\s*\)", re.MULTILINE)


def _findings(case: Case) -> Iterator[Finding]:
    """Look at the text: Python may be unable to read the file."""
    for file in case.package.of_kind("python"):
        for match in _CALL.finditer(case.package.text(file)):
            if match[1] != case.package.name and not uses.is_ros_package(match[1]):
                line = line_of(match, 1)
                yield Finding(
                    "python-names",
                    f"load_manifest() names {match[1]}, and this machine has no such package:"
                    " Python ends with a ResourceNotFound.",
                    file,
                    line,
                    expected="no such line: catkin sets the paths",
                    seen=case.package.line(file, line),
                    fix="Take the line out, and import roslib with it if nothing else needs that.",
                )


RULE = Rule("static", 31, ("facts",), _findings, also=("python-names",))
