# SPDX-License-Identifier: BSD-3-Clause
"""Python: what a source calls of its own functions and classes is there, and takes what it gets."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import nearest, perhaps
from mrp_check.sources.python_rule import PythonRule, of_sources


class OwnCalls(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for call in self.source.nodes(ast.Call):
            if isinstance(call.func, ast.Name):
                function = self.source.definition(call.func)
                if isinstance(function, ast.FunctionDef) and not self.source.class_(function):
                    yield from self._misfit(call, function, 0)
            elif isinstance(call.func, ast.Attribute):
                class_ = self._class(call.func.value)
                yield from self._method(call, call.func.attr, class_) if class_ else ()

    def _class(self, node: ast.expr) -> ast.ClassDef | None:
        """Return the source's own class, if it has no others above it, of which a variable is."""
        class_ = self.source.class_of(node)
        return class_ if class_ and not class_.decorator_list and not class_.bases else None

    def _method(self, call: ast.Call, name: str, class_: ast.ClassDef) -> Iterator[Finding]:
        found = self.source.stored((class_, name))
        known = sorted({one.name for one in class_.body if isinstance(one, ast.FunctionDef)})
        if not found and "__getattr__" not in known and name not in dir(object):
            near = nearest(name, known)
            yield self.finding(
                "python-names",
                f"{class_.name} has no method {name}(): Python ends with an AttributeError when it"
                f" comes here.{perhaps(near)}",
                call,
                expected=", ".join(known) or "a method",
                fix=f"Write {near} for {name}." if near else f"Write {name}(), or take this out.",
            )
        elif len(found) == 1 and isinstance(found[0], ast.FunctionDef):
            yield from self._misfit(call, found[0], 1)

    def _misfit(self, call: ast.Call, function: ast.FunctionDef, bound: int) -> Iterator[Finding]:
        """Yield a finding if a call gives too few arguments, or too many.

        bound: how many Python itself gives
        """
        given = function.args
        names = [one.arg for one in (*given.posonlyargs, *given.args)][bound:]
        is_open = any(isinstance(one, ast.Starred) for one in call.args)
        is_open |= any(one.arg is None for one in call.keywords) or bool(function.decorator_list)
        if is_open or given.vararg or given.kwarg or given.kwonlyargs:
            return
        required = names[: max(len(names) - len(given.defaults), 0)]
        named = {one.arg for one in call.keywords}
        missing = [one for one in required[len(call.args) :] if one not in named]
        if missing or len(call.args) > len(names):
            lacks = f"{', '.join(missing)} is not given" if missing else "it is given more"
            yield self.finding(
                "python-names",
                f"{function.name}() takes {', '.join(names) or 'nothing'}, and {lacks}: Python ends"
                " with a TypeError when it comes here.",
                call,
                expected=f"{function.name}({', '.join(names)})",
                fix="Give it what it takes.",
            )


RULE = Rule("static", 112, ("facts",), of_sources(OwnCalls), also=("python-names",), only=ANY)
