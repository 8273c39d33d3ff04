# SPDX-License-Identifier: BSD-3-Clause
"""What rospy calls for a service returns a response, whatever it was asked."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_facts import argument
from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.contract.finding import CERTAIN, HABIT, Finding
from mrp_check.contract.requirements import Rule

_FIX = "Return a response: an object of the class whose name ends in Response."


class Responses(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for call in self.source.nodes(ast.Call):
            if self.source.dotted(call.func) == "rospy.Service" and not self.is_own("rospy"):
                handler = self.source.definition(argument(call, 2, "handler"))
                if isinstance(handler, ast.FunctionDef) and not handler.decorator_list:
                    yield from self._of(handler)

    def _of(self, handler: ast.FunctionDef) -> Iterator[Finding]:
        if not falls_through(handler.body):
            return
        name, last = handler.name, handler.body[-1]
        if not any(self._is_response(node, handler) for node in ast.walk(handler)):
            yield self.finding(
                "callbacks",
                f"{name}() answers a service, but returns nothing, so every service call fails.",
                handler,
                expected="return, with the response",
                fix=_FIX,
            )
        elif not isinstance(last, ast.Return):
            yield self.finding(
                "callbacks",
                f"{name}() answers a service, but can reach its end without a return: such a call"
                " fails.",
                last,
                certainty=HABIT,
                expected="return, with the response, at the end of the function",
                fix=_FIX,
            )

    def _is_response(self, node: ast.AST, handler: ast.FunctionDef) -> bool:
        if isinstance(node, (ast.Yield, ast.YieldFrom)):
            return True
        if not isinstance(node, ast.Return) or self.source.function(node) is not handler:
            return False
        return node.value is not None and getattr(node.value, "value", "") is not None


def falls_through(body: list[ast.stmt]) -> bool:
    """Return whether these statements can come to their end, as far as their form says it."""
    last = body[-1] if body else None
    if isinstance(last, (ast.Return, ast.Raise)):
        return isinstance(last, ast.Return) and last.value is None
    if isinstance(last, ast.If):
        return falls_through(last.body) or falls_through(last.orelse)
    if isinstance(last, ast.While):
        is_endless = isinstance(last.test, ast.Constant) and bool(last.test.value)
        return not is_endless or any(isinstance(node, ast.Break) for node in ast.walk(last))
    if isinstance(last, ast.With):
        return falls_through(last.body)
    if isinstance(last, ast.Try) and not last.finalbody:
        parts = [last.orelse or last.body, *(handler.body for handler in last.handlers)]
        return any(map(falls_through, parts))
    return not isinstance(last, ast.Try)


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=of_sources(Responses),
    also=("callbacks",),
    sure=CERTAIN,
)
