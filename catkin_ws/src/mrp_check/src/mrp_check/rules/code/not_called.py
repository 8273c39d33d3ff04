# SPDX-License-Identifier: BSD-3-Clause
"""No statement, and no condition of a loop, names a function without calling it."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.contract.finding import CERTAIN, Finding
from mrp_check.contract.requirements import Rule


class NotCalled(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for loop in self.source.nodes(ast.While):
            called = [node.func for node in ast.walk(loop.test) if isinstance(node, ast.Call)]
            named = (node for node in ast.walk(loop.test) if isinstance(node, ast.Attribute))
            names = (self.source.dotted(node) for node in named if node not in called)
            if "rospy.is_shutdown" in names:
                yield self.finding(
                    "spin",
                    "rospy.is_shutdown is named here, but not called: without parentheses it's"
                    " always true, so the loop does nothing.",
                    loop.test,
                    certainty=CERTAIN,
                    expected="while not rospy.is_shutdown():",
                    fix="Write rospy.is_shutdown() with parentheses.",
                    change=("is_shutdown", "is_shutdown()"),
                )
        for node in self.source.nodes(ast.Expr):
            if isinstance(node.value, (ast.Attribute, ast.Name)):
                yield from self._statement(node, node.value)

    def _statement(self, node: ast.Expr, named: ast.Attribute | ast.Name) -> Iterator[Finding]:
        text, is_spin = ast.unparse(named), self.source.dotted(named) == "rospy.spin"
        if is_spin or isinstance(self.source.definition(named), ast.FunctionDef):
            yield self.finding(
                "spin" if is_spin else "node-start",
                f"{text} is named here, but not called: the parentheses are missing.",
                node,
                expected=f"{text}()",
                fix=f"Write {text}() with parentheses.",
                change=(text, f"{text}()"),
            )


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=of_sources(NotCalled),
    also=("node-start", "spin"),
)
