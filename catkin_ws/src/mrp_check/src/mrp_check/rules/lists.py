# SPDX-License-Identifier: BSD-3-Clause
"""What was a list, or a method of a dictionary, in Python 2 is not used as one."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.contract.words import with_article
from mrp_check.sources.python_rule import PythonRule, of_sources

# https://docs.python.org/3/whatsnew/3.0.html#views-and-iterators-instead-of-lists
_FUNCTIONS = ("filter", "map", "zip")  # what they return has no length, either
_METHODS = ("items", "keys", "values")
_OF_LISTS = {"append", "extend", "index", "insert", "pop", "remove", "reverse", "sort"}
_GONE = {
    "has_key": "in",
    **{f"{start}{name}": f"{name}()" for name in _METHODS for start in ("iter", "view")},
}


class Lists(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Subscript):
            yield from self._used_as_list(node.value, self.written(node), "TypeError")
        for call in self.source.nodes(ast.Call):
            if isinstance(call.func, ast.Name) and call.func.id == "len" and len(call.args) == 1:
                yield from self._used_as_list(call.args[0], "len()", "TypeError", _FUNCTIONS)
            elif isinstance(call.func, ast.Attribute):
                name = call.func.attr
                if name in _OF_LISTS:
                    yield from self._used_as_list(call.func.value, f"{name}()", "AttributeError")
                elif name in _GONE:
                    yield from self._gone(call, name)

    def _used_as_list(
        self, node: ast.expr, use: str, error: str, names: tuple[str, ...] = _FUNCTIONS + _METHODS
    ) -> Iterator[Finding]:
        """Yield the Finding about a use of what only was a list in Python 2.

        names: of the functions of which that is true
        """
        name = self._made_by(node)
        if name not in names or self.source.is_guarded(node, error):
            return
        yield self.finding(
            "python-names",
            f"In Python 3, {name}() returns no list, and {use} needs one: Python ends with"
            f" {with_article(error)} when it comes here.",
            node,
            expected=f"list(...) around what {name}() returns",
            fix=f"Write list(...) around {name}(...).",
        )

    def _made_by(self, node: ast.expr) -> str | None:
        """Return the function, or the method, that an expression is the value of."""
        call = self.source.only(node) or node
        if not isinstance(call, ast.Call):
            return None
        if isinstance(call.func, ast.Attribute):
            is_own = call.func.attr in _METHODS and self._defines(call.func.attr)
            return None if call.args or call.keywords or is_own else call.func.attr
        if not isinstance(call.func, ast.Name) or self.source.definition(call.func):
            return None
        is_known = call.func.id not in self.source.imports and not self.source.stars
        return call.func.id if is_known else None

    def _gone(self, call: ast.Call, name: str) -> Iterator[Finding]:
        if self._defines(name) or self.source.is_guarded(call, "AttributeError"):
            return
        yield self.finding(
            "python-names",
            f"A dictionary has no {name}() in Python 3: Python ends with an AttributeError when it"
            " comes here.",
            call,
            expected=_GONE[name],
            fix=f"Write {_GONE[name]} for {name}().",
        )

    def _defines(self, name: str) -> bool:
        return any(function.name == name for function in self.source.nodes(ast.FunctionDef))


RULE = Rule("static", 32, ("facts",), of_sources(Lists), also=("python-names",))
