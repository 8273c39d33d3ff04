# SPDX-License-Identifier: BSD-3-Clause
"""What only a subscriber's callback gives a value is not read before the first message."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.contract.words import with_article
from mrp_check.rules.early_callback import may_be_inherited
from mrp_check.sources.python_facts import argument
from mrp_check.sources.python_rule import PythonRule, ast_text, of_sources
from mrp_check.sources.python_source import Variable

# A source that names one of these knows that there may be no message yet.
_KNOWS = {"hasattr", "getattr", "globals", "wait_for_message", "setattr"}


class Unheard(PythonRule):
    def findings(self) -> Iterator[Finding]:
        if _KNOWS & self.source.names():
            return
        callbacks = self._callbacks()
        given: dict[Variable, set[ast.AST]] = {}
        for key, node in self._variables(ast.Store):
            given.setdefault(key, set()).add(self.source.function(node))
        said: set[Variable] = set()
        for key, node in self._variables(ast.Load):
            setters = given.get(key, set())
            if key in said or not setters or not setters <= callbacks.keys():
                continue
            called = {function for one in setters for function in callbacks[one]}
            error = "NameError" if isinstance(node, ast.Name) else "AttributeError"
            if self.source.function(node) in called or self.source.is_guarded(node, error):
                continue
            said.add(key)
            name = ast_text(node)
            yield self.finding(
                "callbacks",
                f"Only a message gives {name} a value: before the first one, Python ends with"
                f" {with_article(error)} when it comes here.",
                node,
                severity=WARNING,
                expected=f"a value of {name} from the beginning",
                fix=f"Give {name} a value before the subscriber is made, such as None.",
            )

    def _callbacks(self) -> dict[ast.AST, set[ast.AST]]:
        """Return the callbacks of subscribers; and of each what it calls, and itself."""
        found: dict[ast.AST, set[ast.AST]] = {}
        for call in self.source.nodes(ast.Call):
            if self.source.dotted(call.func) == "rospy.Subscriber":
                function = self.source.definition(argument(call, 2, "callback"))
                if isinstance(function, ast.FunctionDef):
                    found[function] = {function, *self.source.called([function])}
        return found

    def _variables(
        self, context: type[ast.expr_context]
    ) -> Iterator[tuple[Variable, ast.Name | ast.Attribute]]:
        """Yield the members of classes, and the module's variables, that are read or written."""
        for node in ast.walk(self.source.tree):
            if isinstance(node, (ast.Name, ast.Attribute)) and isinstance(node.ctx, context):
                key = self.source.key(node)
                owner = key[0] if key else None
                is_kept = isinstance(node, ast.Name) and owner is self.source.tree
                if key and (is_kept or isinstance(owner, ast.ClassDef)) and "." not in key[1]:
                    if not may_be_inherited(key):
                        yield key, node


RULE = Rule("static", 37, ("facts",), of_sources(Unheard), also=("callbacks",))
