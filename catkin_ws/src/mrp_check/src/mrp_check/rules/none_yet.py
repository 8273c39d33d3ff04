# SPDX-License-Identifier: BSD-3-Clause
"""What is None until a subscriber's callback has been called is looked at before it is used."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import with_article
from mrp_check.rules.sometimes import COMPUTES
from mrp_check.rules.unheard import KNOWS, Unheard, callbacks
from mrp_check.sources.python_rule import ast_text, of_sources
from mrp_check.sources.python_source import Variable

_OF_CALL = "ServiceException"


class NoneYet(Unheard):
    def findings(self) -> Iterator[Finding]:
        if KNOWS & self.source.names():
            return
        heard, waits = callbacks(self.source), self._waiting()
        asked = {
            self.source.key(node)
            for one in ast.walk(self.source.tree)
            if isinstance(one, (ast.Compare, ast.BoolOp, ast.Not)) or hasattr(one, "test")
            for node in ast.walk(getattr(one, "test", one))
        }
        said: set[Variable] = set()
        for key, node in self._variables(ast.Load):
            setters = waits.get(key, set())
            if key in said or key in asked or not setters or not setters <= heard.keys():
                continue
            called = {function for one in setters for function in heard[one]}
            error = self._fails(node)
            if error and self.source.function(node) not in called:
                if not self.source.is_guarded(node, error):
                    said.add(key)
                    yield self._finding(node, error)

    def _finding(self, node: ast.Name | ast.Attribute, error: str) -> Finding:
        name = ast_text(node)
        ends = f"Python ends with {with_article(error)} when it comes here"
        return self.finding(
            "callbacks",
            f"{name} is None until the first message has come: before that,"
            f" {'each call of the service fails' if error == _OF_CALL else ends}.",
            node,
            severity=WARNING,
            expected=f"a look whether {name} is None",
            fix=f"Leave out what needs {name} as long as it is None.",
        )

    def _waiting(self) -> dict[Variable, set[ast.AST]]:
        """Return the functions that give a value to each variable that is None at first."""
        given: dict[Variable, set[ast.AST]] = {}
        empty: set[Variable] = set()
        for key, node in self._variables(ast.Store):
            value = getattr(self.source.parents[node], "value", node)
            if isinstance(value, ast.Constant) and value.value is None:
                empty.add(key)
            else:
                given.setdefault(key, set()).add(self.source.function(node))
        return {key: setters for key, setters in given.items() if key in empty}

    def _fails(self, node: ast.expr) -> str:
        """Return the name of the error that the use of a variable raises if it is None."""
        above = self.source.parents[node]
        if isinstance(above, ast.Attribute):
            return "AttributeError"
        is_item = isinstance(above, ast.Subscript) and above.value is node
        is_part = isinstance(above, ast.BinOp) and isinstance(above.op, COMPUTES)
        made = getattr(above, "func", None) if isinstance(above, ast.Call) else None
        is_sent = getattr(made, "id", getattr(made, "attr", "")).endswith("Response")
        return "TypeError" if is_item or is_part else _OF_CALL if is_sent else ""


RULE = Rule("static", 129, ("facts",), of_sources(NoneYet), also=("callbacks",), only=ANY)
