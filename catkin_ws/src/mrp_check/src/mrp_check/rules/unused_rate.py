# SPDX-License-Identifier: BSD-3-Clause
"""A rate that nobody lets sleep changes nothing: the loop is as fast as all else lets it be."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both
from mrp_check.sources.python_source import Source

_MADE = re.compile(r"\bros::(?:Wall)?Rate\s+(\w+)\s*[({][^;]*;")


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        for name, line in _in_python(one.python) if one.python else _in_cpp(one.code):
            yield one.finding(
                "spin",
                f"Nobody calls {name}.sleep(): this rate changes nothing.",
                line,
                expected=f"{name}.sleep() in the loop",
                fix=f"Call {name}.sleep() at the end of the loop; or take the rate out.",
            )


def _in_cpp(text: str) -> Iterator[tuple[str, int]]:
    """Yield (name, line) of each rate that is named no second time."""
    for made in _MADE.finditer(text):
        if len(re.findall(rf"\b{made[1]}\b", text)) == 1:
            yield made[1], line_of(made)


def _in_python(source: Source) -> Iterator[tuple[str, int]]:
    for call in source.nodes(ast.Call):
        parent = source.parents.get(call)
        if source.dotted(call.func) == "rospy.Rate" and isinstance(parent, ast.Assign):
            target = parent.targets[0]
            name = getattr(target, "attr", getattr(target, "id", ""))
            named = (getattr(n, "attr", getattr(n, "id", "")) for n in ast.walk(source.tree))
            if name and [*named].count(name) == 1:
                yield name, call.lineno


RULE = Rule("static", 101, ("facts",), _findings, also=("spin",), only=ANY)
