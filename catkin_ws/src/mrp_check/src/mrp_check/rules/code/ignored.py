# SPDX-License-Identifier: BSD-3-Clause
"""A client looks at what a call that can fail returns, and doesn't go on as if it had succeeded.

https://docs.ros.org/en/noetic/api/roscpp/html/classros_1_1ServiceClient.html
https://docs.ros.org/en/noetic/api/actionlib/html/classactionlib_1_1SimpleActionClient.html
"""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    for node in case.facts.sources:
        first = {place.text: place for place in case.facts.of(node, Kind.IGNORED)[::-1]}
        for name, place in first.items():
            is_python = case.package.kind(place.file) == "python"
            when = "when time runs out, or on Ctrl-C"
            if name == "call":
                when = "if nobody offers the service, or if it fails"
            yield Finding(
                "starts",
                f"{name}() returns false {when}, but {node} ignores that and continues as if it"
                " had been answered.",
                place.file,
                place.line,
                HABIT,
                expected=f"if not ...{name}(...):" if is_python else f"if (!...{name}(...))",
                seen=case.package.line(place.file, place.line),
                fix="Check what it returns. If it's false, say what's missing, and leave.",
                node=node,
            )


RULE = Rule("static", ("facts",), _findings, also=("starts",), only=ANY)
