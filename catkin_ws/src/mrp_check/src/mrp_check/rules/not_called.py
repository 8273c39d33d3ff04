# SPDX-License-Identifier: BSD-3-Clause
"""No Python statement names a function without calling it."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.sources.python_modules import is_ros, resolve
from mrp_check.sources.python_rule import PythonRule, ast_text, of_sources


class NotCalled(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Expr):
            if not isinstance(node.value, (ast.Attribute, ast.Name)):
                continue
            name = self.source.dotted(node.value)
            own = self.source.definition(node.value)
            of_ros = name is not None and is_ros(name) and not self.is_own(name)
            found, missing = resolve(name) if name and of_ros else (None, "")
            is_function = missing is None and callable(found) or isinstance(own, ast.FunctionDef)
            if isinstance(node.value, ast.Attribute) and node.value.attr == "publish":
                is_function = True
            if is_function:
                text = ast_text(node.value)
                yield self.finding(
                    "spin"
                    if name == "rospy.spin"
                    else "node-start"
                    if not of_ros
                    else "python-names",
                    f"{text} is named here and not called: the brackets are missing.",
                    node,
                    expected=f"{text}()" if not text.endswith("publish") else f"{text}(...)",
                    fix=f"Write {text}() with brackets.",
                    change=(text, f"{text}()") if not text.endswith("publish") else None,
                )


RULE = Rule(
    stage="static",
    order=24,
    needs=("facts",),
    findings=of_sources(NotCalled),
    also=("python-names", "node-start", "spin"),
)
