# SPDX-License-Identifier: BSD-3-Clause
"""No number is unpacked into several names."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.sources.python_rule import PythonRule, of_sources


class Unpacked(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Assign):
            several = [one for one in node.targets if isinstance(one, (ast.Tuple, ast.List))]
            value = node.value.value if isinstance(node.value, ast.Constant) else ""
            if several and (value is None or isinstance(value, (bool, int, float))):
                yield self.finding(
                    "python-names",
                    f"One value, {value}, cannot be taken apart for several names: Python ends"
                    " with a TypeError when it comes here.",
                    node,
                    expected="as many values as names: a, b = 0, 0",
                    fix="Give each name its value.",
                )


RULE = Rule(
    stage="static",
    order=27,
    needs=("facts",),
    findings=of_sources(Unpacked),
    also=("python-names",),
)
