# SPDX-License-Identifier: BSD-3-Clause
"""What is called of a publisher, a rate or another object of rospy's is one of its methods, and
gets what that takes."""

from __future__ import annotations

import ast
import inspect
import types
from typing import Iterator

from mrp_check.code.python_modules import cannot_bind, resolve, signature
from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.contract.words import nearest, perhaps, with_article

_OF = ("rospy.", "actionlib.")


class Methods(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for call in self.source.nodes(ast.Call):
            name = self._maker(call.func.value) if isinstance(call.func, ast.Attribute) else None
            class_, missing = resolve(name) if name else (None, None)
            if not isinstance(call.func, ast.Attribute) or missing or not inspect.isclass(class_):
                continue
            known = [one for one in dir(class_) if not one.startswith("_")]
            if call.func.attr not in dir(class_):
                near = nearest(call.func.attr, known, 0.5)
                yield self.finding(
                    "python-names",
                    f"A {name} has no method {call.func.attr}(): Python ends with an AttributeError"
                    f" when it comes here.{perhaps(near)}",
                    call,
                    expected=", ".join(known),
                    fix=f"Write {near} for {call.func.attr}." if near else "Call what there is.",
                )
                continue
            function = inspect.getattr_static(class_, call.func.attr)
            if name and inspect.isfunction(function):
                method = types.MethodType(function, class_)
                problem = cannot_bind(method, call)
                if problem:
                    yield self.finding(
                        "python-names",
                        f"{call.func.attr}() of {with_article(name)} is called with the wrong"
                        f" arguments: {problem}.",
                        call,
                        expected=f"{call.func.attr}{signature(method)}",
                        fix="Give it what it takes.",
                    )

    def _maker(self, node: ast.expr) -> str | None:
        """Return the class of rospy's or actionlib's of which a variable is, if it is sure."""
        made = self.source.made(node)
        name = self.source.dotted(made.func) if made else None
        is_own = any(self.is_own(of.rstrip(".")) for of in _OF)
        return name if name and name.startswith(_OF) and not is_own else None


RULE = Rule("static", ("facts",), of_sources(Methods), also=("python-names",))
