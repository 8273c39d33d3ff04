# SPDX-License-Identifier: BSD-3-Clause
"""What a function returns is used only where it returns something."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.rules.responses import falls_through
from mrp_check.rules.rospy_calls import returns
from mrp_check.sources.python_rule import PythonRule, of_sources


class NoValue(PythonRule):
    def findings(self) -> Iterator[Finding]:
        said: set[ast.FunctionDef] = set()
        for node in self.source.nodes(ast.Attribute):
            function = self._gave(node.value)
            if function is None or function in said:
                continue
            if self.source.is_guarded(node, "AttributeError"):
                continue
            said.add(function)
            yield self.finding(
                "python-names",
                f"{function.name}() returns nothing, and nothing has no {node.attr}: Python ends"
                " with an AttributeError when it comes here.",
                node,
                expected=f"return, with a value, at the end of {function.name}()",
                fix=f"Let {function.name}() return what is used here; or take the line out.",
            )

    def _gave(self, node: ast.expr) -> ast.FunctionDef | None:
        """Return the function that an expression is the value of, if it returns nothing."""
        stored = self.source.stored(self.source.key(node)) if isinstance(node, ast.Name) else []
        call = stored[0] if len(stored) == 1 else node
        if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Name):
            return None
        function = self.source.definition(call.func)
        if not isinstance(function, ast.FunctionDef) or function.decorator_list:
            return None
        return None if returns(function) or not falls_through(function.body) else function


RULE = Rule("static", 29, ("facts",), of_sources(NoValue), also=("python-names",))
