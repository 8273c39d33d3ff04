# SPDX-License-Identifier: BSD-3-Clause
"""What is unpacked into several names has as many values: a number has none, and OpenCV 4's
findContours() has two. https://docs.opencv.org/4.x/d3/dc0/group__imgproc__shape.html"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule


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
            names = several[0].elts if several else []
            called = self.source.dotted(getattr(node.value, "func", None))
            if called == "cv2.findContours" and len(names) == 3:
                yield self.finding(
                    "python-names",
                    "cv2.findContours() returns two values since OpenCV 4, not three: Python ends"
                    " with a ValueError when it comes here.",
                    node,
                    expected="contours, hierarchy = cv2.findContours(...)",
                    fix="Take the first of the three names out.",
                )


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=of_sources(Unpacked),
    also=("python-names",),
)
