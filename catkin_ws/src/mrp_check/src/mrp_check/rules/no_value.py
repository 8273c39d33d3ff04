# SPDX-License-Identifier: BSD-3-Clause
"""What a function returns is used only where it returns something."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import ERROR, WARNING, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.contract.words import with_article
from mrp_check.rules.responses import falls_through
from mrp_check.rules.rospy_calls import returns
from mrp_check.sources.python_rule import PythonRule, of_sources
from mrp_check.sources.python_source import Variable


class NoValue(PythonRule):
    def findings(self) -> Iterator[Finding]:
        said: set[ast.FunctionDef] = set()
        for node in ast.walk(self.source.tree):
            if not isinstance(node, (ast.Attribute, ast.Subscript)):
                continue
            function = self._gave(node.value)
            error = "AttributeError" if isinstance(node, ast.Attribute) else "TypeError"
            if function is None or function in said or self.source.is_guarded(node, error):
                continue
            said.add(function)
            always = not returns(function)
            has = f"no {node.attr}" if isinstance(node, ast.Attribute) else "no items"
            yield self.finding(
                "python-names",
                f"{function.name}() returns nothing{'' if always else ' after an error'}, and"
                f" nothing has {has}: Python ends with {with_article(error)}"
                " when it comes here" + ("." if always else " then."),
                node,
                severity=ERROR if always else WARNING,
                expected=f"return, with a value, at the end of {function.name}()",
                fix=f"Let {function.name}() return what is used here; or take the line out."
                if always
                else "Look whether there is a result before it is used; or let the error pass.",
            )
        yield from self._shown(said)

    def _shown(self, said: set[ast.FunctionDef]) -> Iterator[Finding]:
        """Yield a warning about each result that is shown, though there may be none."""
        for call in self.source.nodes(ast.Call):
            name = self.source.dotted(call.func) or str(getattr(call.func, "id", ""))
            is_shown = name == "print" or name.startswith("rospy.log")
            parts = [node for one in call.args for node in ast.walk(one)] if is_shown else []
            for part in parts:
                if isinstance(self.source.parents[part], (ast.Attribute, ast.Subscript)):
                    continue
                function = self._gave(part) if isinstance(part, (ast.Call, ast.Name)) else None
                if function and returns(function) and function not in said:
                    said.add(function)
                    yield self.finding(
                        "python-names",
                        f"{function.name}() returns nothing after an error, and this shows None as"
                        " its result.",
                        call,
                        severity=WARNING,
                        expected=f"a look at what {function.name}() returns",
                        fix="Show a result only if there is one.",
                    )

    def _gave(self, node: ast.expr) -> ast.FunctionDef | None:
        """Return the function that an expression is the value of, if it returns nothing, or may."""
        key = self.source.key(node) if isinstance(node, ast.Name) else None
        call = (self.source.only(node) if key else None) or node
        if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Name):
            return None
        function = self.source.definition(call.func)
        if not isinstance(function, ast.FunctionDef) or function.decorator_list:
            return None
        if not falls_through(function.body):
            return None
        after_error = isinstance(function.body[-1], ast.Try) and not self._is_asked(key)
        return function if after_error or not returns(function) else None

    def _is_asked(self, key: Variable | None) -> bool:
        """Return whether a condition looks at a variable."""
        tests = (getattr(node, "test", None) for node in ast.walk(self.source.tree))
        named = (node for test in tests if test for node in ast.walk(test))
        return any(key and self.source.key(node) == key for node in named)


RULE = Rule("static", 29, ("facts",), of_sources(NoValue), also=("python-names",))
