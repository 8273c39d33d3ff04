# SPDX-License-Identifier: BSD-3-Clause
"""What rospy has not, in a source that Python cannot read: that is found behind the first fault."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of, nearest, perhaps
from mrp_check.sources import uses
from mrp_check.sources.python_modules import resolve

_NAMED = re.compile(r"\brospy\.(\w+)")


def _findings(case: Case) -> Iterator[Finding]:
    everything, missing = resolve("rospy")
    for node, files in case.facts.sources.items():
        unread = case.facts.unread - {*case.facts.python} if missing is None else set()
        for file in unread & {*files}:
            for match in _NAMED.finditer(uses.code(case.package, file)):
                name, line = match[1], line_of(match)
                if not hasattr(everything, name) and case.package.kind(file) == "python":
                    near = nearest(name, dir(everything))
                    yield Finding(
                        "python-names",
                        f"rospy has nothing of the name {name}.{perhaps(near)}",
                        file,
                        line,
                        WARNING,
                        expected=f"rospy.{near}" if near else "what rospy has",
                        seen=case.package.line(file, line),
                        fix=f"Write rospy.{near}." if near else "Look it up in rospy's pages.",
                        node=node,
                    )


RULE = Rule("static", 104, ("facts",), _findings, also=("python-names",), only=ANY)
