# SPDX-License-Identifier: BSD-3-Clause
"""turtlesim's colours are parameters of its own node since Melodic: /turtlesim/background_r.

https://github.com/ros/ros_tutorials/blob/noetic-devel/turtlesim/CHANGELOG.rst
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import uses

# A name without a slash is looked for in the namespace of its NodeHandle: it may be right.
_COLOUR = re.compile(
    r"""(?:\bros::param::\w+\s*(?:<\w+>)?|\brospy\.\w+_param)\s*\(\s*["'](/?background_[rgb])["']"""
    r"""|["'](/background_[rgb])["']"""
)


def _findings(case: Case) -> Iterator[Finding]:
    for file in case.package.of_kind("cpp", "python"):
        match = _COLOUR.search(uses.code(case.package, file))
        if match and case.package.name != "turtlesim":
            name = match[1] or match[2]
            right = f"/turtlesim/{name.lstrip('/')}"
            yield Finding(
                "starts",
                f"turtlesim reads no parameter {name} since Melodic: it is called {right}.",
                file,
                line_of(match),
                WARNING,
                expected=right,
                seen=case.package.line(file, line_of(match)),
                fix=f"Write {right}, and so for the other two colours.",
            )


RULE = Rule("static", 127, ("facts",), _findings, also=("starts",), only=ANY)
