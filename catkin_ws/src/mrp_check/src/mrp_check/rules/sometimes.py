# SPDX-License-Identifier: BSD-3-Clause
"""What a function returns only sometimes is looked at before it is computed with: else it is None.

https://docs.python.org/3/reference/simple_stmts.html#the-return-statement
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources.python_rule import PythonRule, ast_text, of_sources

COMPUTES = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Mod, ast.Pow)


class Sometimes(PythonRule):
    def findings(self) -> Iterator[Finding]:
        asked = {
            self.source.key(node)
            for one in ast.walk(self.source.tree)
            for test in [getattr(one, "test", None)]
            if test is not None
            for node in ast.walk(test)
        }
        said: set[ast.FunctionDef] = set()
        for one in self.source.nodes(ast.BinOp):
            for part in (one.left, one.right) if isinstance(one.op, COMPUTES) else ():
                function = self._gave(part)
                key = self.source.key(part) if isinstance(part, ast.Name) else None
                if function is None or function in said or key and key in asked:
                    continue
                if not self.source.is_guarded(one, "TypeError"):
                    said.add(function)
                    yield self.finding(
                        "python-names",
                        f"{function.name}() returns nothing in line {_bare(function)}: computing"
                        " with it then ends in a TypeError here.",
                        one,
                        severity=WARNING,
                        expected=f"a look whether {ast_text(part)} is None",
                        fix="Leave out the turn in which there is no value.",
                    )

    def _gave(self, node: ast.expr) -> ast.FunctionDef | None:
        """Return the function of which an expression is the value, if it returns one sometimes."""
        stored = [one for one in self.source.stored(self.source.key(node)) if one is not None]
        calls = stored if isinstance(node, ast.Name) else [node]
        functions = [
            self.source.definition(call.func) if isinstance(call, ast.Call) else None
            for call in calls
        ]
        function = functions[0] if functions and len({*functions}) == 1 else None
        is_plain = isinstance(function, ast.FunctionDef) and not function.decorator_list
        return (
            function
            if is_plain and isinstance(function, ast.FunctionDef) and _bare(function)
            else None
        )


def _bare(function: ast.FunctionDef) -> int:
    """Return the line at which a function that returns a value elsewhere returns none; or 0."""
    returns = [one for one in ast.walk(function) if isinstance(one, ast.Return)]
    empty = [one for one in returns if getattr(one.value, "value", one.value) is None]
    return empty[0].lineno if empty and len(empty) < len(returns) else 0


RULE = Rule("static", 128, ("facts",), of_sources(Sometimes), also=("python-names",), only=ANY)
