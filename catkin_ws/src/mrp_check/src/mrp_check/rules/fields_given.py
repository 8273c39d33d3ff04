# SPDX-License-Identifier: BSD-3-Clause
"""Python: the fields of the package's own definitions get what they are for.

https://wiki.ros.org/rospy/Overview/Services says how rospy takes them from a list, and
https://wiki.ros.org/msg which types they have in Python.
"""

from __future__ import annotations

import ast
import re
from typing import Iterator, NamedTuple

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import last_part
from mrp_check.rules.typed import Typed, says
from mrp_check.sources import uses
from mrp_check.sources.python_facts import argument
from mrp_check.sources.python_rule import of_sources

_FIELD = re.compile(r"^[ \t]*([\w/]+)[ \t]+(\w+)[ \t]*(?:#.*)?$", re.MULTILINE)
_WHOLE = re.compile(r"u?int\d+")
_NUMBER = re.compile(r"u?int\d+|float\d+")
# The ending of a class -> which part of a .srv or .action file it is made of.
_PARTS = {"Request": 0, "Response": 1, "Goal": 0, "Result": 1, "Feedback": 2}


class _Half(NamedTuple):
    """A part of a definition, such as a request: the names of its fields, and their types."""

    names: list[str]
    types: list[str]


class FieldsGiven(Typed):
    def findings(self) -> Iterator[Finding]:
        yield from self._texts()
        yield from self._order()
        yield from self._divided()

    def _divided(self) -> Iterator[Finding]:
        """Yield a finding for each whole number that is given what a division makes."""
        for node in self.source.nodes(ast.Assign):
            target, value = node.targets[0], node.value
            is_division = isinstance(value, ast.BinOp) and isinstance(value.op, ast.Div)
            if not isinstance(target, ast.Attribute) or not is_division:
                continue
            made = self.source.stored(self.source.key(target.value))
            class_ = made[0].func if len(made) == 1 and isinstance(made[0], ast.Call) else None
            type_ = self._types(self.source.dotted(class_) or "").get(target.attr, "")
            if _WHOLE.fullmatch(type_):
                yield self.finding(
                    "python-names",
                    f"/ makes a number with a point in Python 3, and {target.attr} is {type_}: an"
                    " error is raised when the message is sent.",
                    node,
                    severity=WARNING,
                    expected="//, int(...) or round(...)",
                    fix=f"Make a whole number of it; or let {target.attr} be a float64.",
                )

    def _types(self, name: str) -> dict[str, str]:
        """Return field -> type, of the class that is made of a definition of the package's own."""
        own = re.fullmatch(rf"{re.escape(self.package.name)}\.(?:msg|srv)\.(\w+)", name)
        for path in self.package.of_kind(*uses.DEFINITIONS) if own else ():
            if own and own[1] in uses.generated(path):
                endings = [one for one in _PARTS if own[1].endswith(one)]
                is_whole = not endings or "---" not in self.package.text(path)
                return dict(zip(*self._part(path, 0 if is_whole else _PARTS[endings[0]])))
        return {}

    def _part(self, path: str, number: int) -> _Half:
        """Return the fields of a definition's part; none if it has not so many."""
        parts = self.package.text(path).split("---")
        fields = _FIELD.findall(parts[number] if number < len(parts) else "")
        return _Half([name for _, name in fields], [type_ for type_, _ in fields])

    def _half(self, class_: ast.expr | None, part: int) -> _Half | None:
        """Return the request (0) or the response (1) of a service's class, if it is the package's
        own; class_ may be that of the half itself."""
        name = self.source.dotted(class_) or ""
        own = re.fullmatch(rf"{re.escape(self.package.name)}\.srv\.(\w+?)(Request|Response)?", name)
        paths = [p for p in self.package.of_kind("service") if own and last_part(p)[:-4] == own[1]]
        if not own or not paths or own[2] not in (None, ("Request", "Response")[part]):
            return None
        return self._part(paths[0], part)

    def _texts(self) -> Iterator[Finding]:
        """Yield a finding for each number of a request that is given a text."""
        for node in self.source.nodes(ast.Assign):
            target = node.targets[0]
            if isinstance(target, ast.Attribute):
                made = self.source.stored(self.source.key(target.value))
                half = self._made(made[0]) if len(made) == 1 else None
                if half and target.attr in half.names:
                    yield from self._text(half, half.names.index(target.attr), node.value)
        for call in self.source.nodes(ast.Call):
            half = self._made(call) or self._called(call)
            for place, value in enumerate(call.args[: len(half.names)] if half else []):
                yield from self._text(half, place, value) if half else ()

    def _made(self, node: ast.AST | None) -> _Half | None:
        """Return the request that a call of its class makes."""
        if not isinstance(node, ast.Call):
            return None
        is_request = (self.source.dotted(node.func) or "").endswith("Request")
        return self._half(node.func, 0) if is_request else None

    def _called(self, call: ast.Call) -> _Half | None:
        """Return the request of a service that is called through a ServiceProxy."""
        proxy = self.source.made(call.func)
        if proxy and self.source.dotted(proxy.func) == "rospy.ServiceProxy":
            return self._half(argument(proxy, 1, "service_class"), 0)
        return None

    def _text(self, half: _Half, place: int, value: ast.expr) -> Iterator[Finding]:
        typed, type_ = self.typed(value), half.types[place]
        if typed and _NUMBER.fullmatch(type_):
            yield self.finding(
                "python-names",
                f"{says(typed)}, and line {value.lineno} gives it to {half.names[place]}, which is"
                f" {type_}: the call raises an error.",
                typed,
                severity=WARNING,
                expected=f"int({self.written(typed)})",
                fix="Make a number of it, by int(...) or float(...).",
            )

    def _order(self) -> Iterator[Finding]:
        """Yield a finding for each answer whose parts stand in another order than its fields."""
        for call in self.source.nodes(ast.Call):
            if self.source.dotted(call.func) != "rospy.Service":
                continue
            half = self._half(argument(call, 1, "service_class"), 1)
            handler = self.source.definition(argument(call, 2, "handler"))
            returns = ast.walk(handler) if half and handler else ()
            for node in (one for one in returns if isinstance(one, ast.Return)):
                value = node.value
                parts = value.args if isinstance(value, ast.Call) else getattr(value, "elts", [])
                names = [getattr(one, "id", getattr(one, "attr", "")) for one in parts]
                if half and names != half.names and sorted(names) == sorted(half.names):
                    yield self.finding(
                        "callbacks",
                        f"The fields of the response are {', '.join(half.names)}, in this order:"
                        " here they get each other's values.",
                        node.lineno,
                        severity=WARNING,
                        expected=", ".join(half.names),
                        fix="Return them in the order of the fields.",
                    )


RULE = Rule(
    "static", 109, ("facts",), of_sources(FieldsGiven), also=("python-names", "callbacks"), only=ANY
)
