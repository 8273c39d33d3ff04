# SPDX-License-Identifier: BSD-3-Clause
"""Somebody calls what publishes or subscribes; and what a callback uses is there in time."""

from __future__ import annotations

import ast
from typing import Any, Iterator

from mrp_check.code.python_rule import PythonRule, arguments_of, of_sources
from mrp_check.code.python_source import Defined, Variable
from mrp_check.code.source_node import SourceNode, each_node
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.run import evidence


def _of(node: SourceNode) -> Iterator[Finding]:
    reported = set()
    for kind, id_, does in (
        (Kind.INIT, "node-start", "starts the node"),
        (Kind.PUBLISHER, "topic", "creates the publisher"),
        (Kind.SUBSCRIBER, "topic", "creates the subscriber"),
        (Kind.PUBLISH, "callbacks", "publishes"),
    ):
        places = node.places(kind)
        functions = [_unused_around(node, place) for place in places]
        function = functions[0] if functions else None
        if function is None or None in functions or (function.file, function.line) in reported:
            continue
        reported.add((function.file, function.line))
        timer = " Pass it to a timer as its callback." if kind is Kind.PUBLISH else ""
        yield node.finding(
            id_,
            f"{function.text} {does}, but nothing ever calls or uses it.{timer}",
            function,
            expected=f"a place where {function.text} is used",
            fix=f"Call {function.text}, or pass it as a callback.",
        )


def _unused_around(node: SourceNode, place: Place) -> Place | None:
    around = [f for f in node.places(Kind.FUNCTION) if f.is_around(place) and f.unused]
    return around[0] if around else None


_CALLING = {"rospy.Subscriber": "message", "rospy.Service": "request", "rospy.Timer": "call"}
_BLOCKS = ("body", "orelse", "finalbody")


class EarlyCallback(PythonRule):
    def findings(self) -> Iterator[Finding]:
        calls = {
            call: _CALLING[self.source.dotted(call.func) or ""]
            for call in self.source.nodes(ast.Call)
            if self.source.dotted(call.func) in _CALLING
        }
        called = {self.source.definition(given) for call in calls for given in arguments_of(call)}
        for call, what in calls.items():
            later = self._made_after(call, called)
            for argument in arguments_of(call) if later else ():
                function = self.source.definition(argument)
                used = self._used(function, [])
                name = next((variable for variable in later if variable in used), None)
                given = self.source.stored(name) if name else []
                if isinstance(function, ast.FunctionDef) and name:
                    if any(value and self.source.function(value) is function for value in given):
                        continue  # perhaps it has given it a value before
                    place, expression = later[name], ast.unparse(used[name])
                    yield self.finding(
                        "callbacks",
                        f"{function.name}() uses {expression}, which is only created on line"
                        f" {place.lineno}: a {what} that comes earlier raises an error.",
                        call,
                        certainty=HABIT,
                        expected=f"{expression} before what calls {function.name}()",
                        fix=f"Move line {place.lineno} above this line.",
                    )

    def _made_after(
        self, call: ast.Call, called: set[Defined | None]
    ) -> dict[Variable, ast.Assign]:
        """Return the variables that are given a value only after a call, in the same block, or by
        one of the callbacks; and the statement that does so."""
        made: dict[Variable, list[ast.Assign]] = {}
        for statement in self._after(call):
            if isinstance(statement, ast.Assign):
                for key in filter(None, map(self.source.key, statement.targets)):
                    made.setdefault(key, []).append(statement)
        return {
            key: statements[0]
            for key, statements in made.items()
            if not may_be_inherited(key)
            and all(
                value in [statement.value for statement in statements]
                or isinstance(value, ast.expr)
                and self.source.function(value) in called
                for value in self.source.stored(key)
            )
        }

    def _after(self, call: ast.Call) -> list[ast.stmt]:
        """Return the statements that follow a call's own one."""
        inner: ast.AST = call
        for outer in self.source.above(call):
            for block in (getattr(outer, name, []) for name in _BLOCKS):
                if isinstance(block, list) and inner in block:
                    return block[block.index(inner) + 1 :]
            inner = outer
        return []

    def _used(self, function: ast.AST | None, seen: list[ast.AST]) -> dict[Variable, ast.AST]:
        """Return the variables that a function reads, or one that it calls; and a place of each."""
        if not isinstance(function, ast.FunctionDef) or function in seen:
            return {}
        used: dict[Variable, ast.AST] = {}
        for node in ast.walk(function):
            if isinstance(node, ast.Call):
                used.update(self._used(self.source.definition(node.func), [*seen, function]))
            is_read = isinstance(getattr(node, "ctx", None), ast.Load)
            key = self.source.key(node) if is_read else None
            if key and not self.source.is_guarded(node, "AttributeError", "NameError"):
                used.setdefault(key, node)
        return used


def may_be_inherited(key: Variable) -> bool:
    """Return whether a variable is a member that its class, or another one, may have, too."""
    class_, name = key
    if not isinstance(class_, ast.ClassDef):
        return False
    own = [target for statement in class_.body for target in getattr(statement, "targets", [])]
    bases = [base for base in class_.bases if getattr(base, "id", "") != "object"]
    return bool(bases) or any(getattr(target, "id", "") == name for target in own)


def _findings(case: Any) -> Iterator[Finding]:
    yield from of_sources(EarlyCallback)(case)
    yield from each_node(_of)(case)


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=_findings,
    requirements={
        "callbacks": Requirement(
            "Each callback is passed to ROS and takes what it gets", "subscriber", evidence.read
        )
    },
    also=("node-start", "topic"),
)
