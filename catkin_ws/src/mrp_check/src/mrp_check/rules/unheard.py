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
from mrp_check.sources.python_source import Source, Variable

# A source that names one of these knows that there may be no message yet.
KNOWS = {"hasattr", "getattr", "globals", "wait_for_message", "setattr"}


class Unheard(PythonRule):
    def findings(self) -> Iterator[Finding]:
        if KNOWS & self.source.names():
            return
        heard = callbacks(self.source)
        given: dict[Variable, set[ast.AST]] = {}
        for key, node in self._variables(ast.Store):
            given.setdefault(key, set()).add(self.source.function(node))
        said: set[Variable] = set()
        for key, node in self._variables(ast.Load):
            setters = given.get(key, set())
            if key in said or not setters or not setters <= heard.keys():
                continue
            called = {function for one in setters for function in heard[one]}
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


def callbacks(source: Source, **others: int) -> dict[ast.AST, set[ast.AST]]:
    """Return the callbacks of subscribers; and of each what it calls, and itself.

    others: what else of rospy's is handed a callback -> at which place
    """
    found: dict[ast.AST, set[ast.AST]] = {}
    places = {f"rospy.{name}": place for name, place in {"Subscriber": 2, **others}.items()}
    for call in source.nodes(ast.Call):
        place = places.get(source.dotted(call.func) or "")
        given = None if place is None else argument(call, place, "callback")
        function = source.definition(given or argument(call, place or 0, "handler"))
        if place is not None and isinstance(function, ast.FunctionDef):
            found[function] = {function, *source.called([function])}
    return found


def in_threads(source: Source) -> set[ast.AST]:
    """Return the functions that rospy calls in threads of its own, which end with the program."""
    called = callbacks(source, Service=2, Timer=1).values()
    return {function for one in called for function in one}


RULE = Rule("static", 37, ("facts",), of_sources(Unheard), also=("callbacks",))
