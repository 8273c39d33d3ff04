# SPDX-License-Identifier: BSD-3-Clause
"""No rospy.Timer is made before rospy knows the time: its thread would end at once."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.sources.python_rule import PythonRule, of_sources


class EarlyTimer(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for function in ast.walk(self.source.tree):
            if not isinstance(function, (ast.Module, ast.FunctionDef)):
                continue
            inits = [s for s in function.body if self._calls(s, "rospy.init_node")]
            before = function.body[: function.body.index(inits[0])] if inits else []
            for statement in before:
                call = self._makes_timer(statement)
                if call:
                    yield self.finding(
                        "node-start",
                        "A rospy.Timer is made here before rospy.init_node() is called: rospy does"
                        " not know the time yet, the timer's thread ends with a ROSInitException,"
                        " and nothing is ever called.",
                        call,
                        expected="rospy.init_node() before all else",
                        fix=f"Move rospy.init_node() from line {inits[0].lineno} up to before this"
                        " line.",
                    )

    def _calls(self, statement: ast.stmt, name: str) -> bool:
        return (
            isinstance(statement, ast.Expr)
            and isinstance(statement.value, ast.Call)
            and self.source.dotted(statement.value.func) == name
        )

    def _makes_timer(self, statement: ast.stmt) -> ast.Call | None:
        """Return the call in a statement that makes a rospy.Timer, or an object that makes one."""
        if isinstance(statement, (ast.FunctionDef, ast.ClassDef)):
            return None
        for call in ast.walk(statement):
            if not isinstance(call, ast.Call):
                continue
            made = self.source.definition(call.func)
            inside = [call]
            if isinstance(made, ast.ClassDef):
                inits = [n for n in made.body if getattr(n, "name", "") == "__init__"]
                inside += [n for init in inits for n in ast.walk(init) if isinstance(n, ast.Call)]
            if any(self.source.dotted(one.func) == "rospy.Timer" for one in inside):
                return call
        return None


RULE = Rule("static", 23, ("facts",), of_sources(EarlyTimer), also=("node-start",))
