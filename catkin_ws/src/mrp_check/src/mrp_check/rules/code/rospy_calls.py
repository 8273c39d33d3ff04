# SPDX-License-Identifier: BSD-3-Clause
"""Callbacks that rospy cannot call, and fields that a message does not have.

Of other wrong calls, Python says the same when it gets there.
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_facts import argument
from mrp_check.code.python_rule import MessageClass, PythonRule, ast_text, of_sources
from mrp_check.code.python_source import Function, Variable
from mrp_check.contract.finding import CERTAIN, Finding
from mrp_check.contract.names import nearest, perhaps
from mrp_check.contract.requirements import Rule


class Calls(PythonRule):
    def findings(self) -> Iterator[Finding]:
        yield from self._unknown_fields()
        for node in self.source.nodes(ast.Call):
            yield from self._unknown_arguments(node)
            name = None if self.is_own("rospy") else self.source.dotted(node.func)
            if name == "rospy.Subscriber":
                yield from self._subscriber(node)
            elif name == "rospy.Timer":
                yield from self._timer(node)
            elif name == "actionlib.SimpleActionServer":
                yield from self._callback(argument(node, 2, "execute_cb"), 1, name, "a goal")

    def _subscriber(self, node: ast.Call) -> Iterator[Finding]:
        class_ = self.message_class(argument(node, 1, "data_class"))
        extra = argument(node, 3, "callback_args")
        more = 0 if extra is None or self.source.value(extra) is None else 1
        given = f"a message {class_._type}" if class_ else "a message"
        callback = argument(node, 2, "callback")
        yield from self._callback(callback, 1 + more, "rospy.Subscriber", given)

    def _timer(self, node: ast.Call) -> Iterator[Finding]:
        period = argument(node, 0, "period")
        is_plain = isinstance(period, (ast.Constant, ast.BinOp))
        if period and is_plain and isinstance(self.source.value(period), (int, float)):
            yield self.finding(
                "callbacks",
                "rospy.Timer() takes a rospy.Duration, not a number: the timer's thread ends with"
                " an error, so nothing is ever called.",
                node,
                certainty=CERTAIN,
                expected="rospy.Timer(rospy.Duration(0.5), ...)",
                fix="Write rospy.Duration(...) around the number.",
                change=(self.written(period) + ",", f"rospy.Duration({self.written(period)}),"),
            )
        yield from self._callback(argument(node, 1, "callback"), 1, "rospy.Timer", "a TimerEvent")

    def _callback(
        self, callback: ast.expr | None, count: int, taker: str, given: str
    ) -> Iterator[Finding]:
        """Yield a finding if what is handed over as a callback cannot be called with `count`."""
        if isinstance(callback, ast.Call):
            called = self.source.definition(callback.func)
            if isinstance(called, ast.FunctionDef) and not returns(called):
                yield self._called_at_once(callback, called, taker)
            return
        function = self.source.definition(callback)
        if isinstance(function, (ast.FunctionDef, ast.Lambda)):
            bound = self._bound(function, isinstance(callback, ast.Attribute))
            if bound is not None:
                yield from self._parameters(function, count, bound, taker, given)

    def _called_at_once(self, callback: ast.Call, called: ast.FunctionDef, taker: str) -> Finding:
        name = ast_text(callback.func)
        return self.finding(
            "callbacks",
            f"{called.name}() is called here once, and its result (None) is passed to {taker}(),"
            " so it's never called again.",
            callback,
            certainty=CERTAIN,
            expected=f"{name}, without parentheses",
            fix=f"Write {name} for {name}(...).",
            change=(self.written(callback), self.written(callback.func)),
            why="py-callback-called",
        )

    def _bound(self, function: Function, is_attribute: bool) -> int | None:
        """Return how many arguments a method is called with by itself; None if nobody knows."""
        decorators = {getattr(one, "id", "") for one in getattr(function, "decorator_list", ())}
        if decorators:
            return 0 if decorators == {"staticmethod"} else None
        in_class = isinstance(self.source.parents.get(function), ast.ClassDef)
        return int(is_attribute and in_class and isinstance(function, ast.FunctionDef))

    def _parameters(
        self, function: Function, count: int, bound: int, taker: str, given: str
    ) -> Iterator[Finding]:
        """Yield a finding if a function cannot be called with so many arguments."""
        gets, takes = count + bound, function.args
        most = len(takes.posonlyargs) + len(takes.args)
        least = most - len(takes.defaults)
        is_too_many = gets > most and not takes.vararg
        if is_too_many or gets < least or None in takes.kw_defaults:
            name, s = getattr(function, "name", "the lambda"), "s" if count > 1 else ""
            yield self.finding(
                "callbacks",
                f"{taker}() calls {name}() with {given}, but {name}() takes"
                f" {_count(max(0, least - bound), 'argument')}. Each call raises a TypeError.",
                function,
                certainty=CERTAIN,
                expected=f"{count} parameter{s}" + (" besides self" if bound else ""),
                fix=f"Give {name} the parameter{s} that it's called with.",
                why="timer-callback" if taker == "rospy.Timer" else "bad-callback",
            )

    def _unknown_fields(self) -> Iterator[Finding]:
        for key, class_ in self._messages().items():
            for node in self.source.nodes(ast.Attribute):
                if self.source.key(node.value) == key and not hasattr(class_, node.attr):
                    yield self._no_field(node, class_, node.attr)

    def _messages(self) -> dict[Variable, MessageClass]:
        """Return variable -> class, for the variables that hold a message of a known class."""
        found = {}
        for node in ast.walk(self.source.tree):
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
                class_ = self.message_class(node.value.func)
                for target in node.targets:
                    key = self.source.key(target)
                    if class_ and key and len(self.source.stored(key)) == 1:
                        found[key] = class_
            elif isinstance(node, ast.Call) and self.source.dotted(node.func) == "rospy.Subscriber":
                class_ = self.message_class(argument(node, 1, "data_class"))
                callback = argument(node, 2, "callback")
                function = self.source.definition(callback) if callback is not None else None
                if class_ is None or not isinstance(function, (ast.FunctionDef, ast.Lambda)):
                    continue
                names = function.args.args
                first = 1 if isinstance(callback, ast.Attribute) else 0
                if len(names) > first and not self._called(function):
                    key = (function, names[first].arg)
                    if len(self.source.stored(key)) == 1:
                        found[key] = class_
        return found

    def _called(self, function: Function) -> bool:
        """Return whether a function is called, or handed over, in more than one place."""
        name = getattr(function, "name", None)
        loaded = (n for n in self.source.nodes(ast.Name) if isinstance(n.ctx, ast.Load))
        names = [n.id for n in loaded] + [n.attr for n in self.source.nodes(ast.Attribute)]
        return name is not None and names.count(name) > 1

    def _unknown_arguments(self, node: ast.Call) -> Iterator[Finding]:
        class_ = self.message_class(node.func)
        for keyword in node.keywords:
            if class_ and keyword.arg and keyword.arg not in class_.__slots__:
                yield self._no_field(node, class_, keyword.arg)

    def _no_field(self, node: ast.expr, class_: MessageClass, name: str) -> Finding:
        near = nearest(name, class_.__slots__)
        hint = perhaps(near)
        if not near and len(class_.__slots__) == 1:
            near = class_.__slots__[0]
            hint = f" Its only field is {near}."
        return self.finding(
            "python-names",
            f"A message {class_._type} has no field {name}: Python raises an AttributeError when"
            f" it gets here.{hint}",
            node,
            expected=", ".join(class_.__slots__) or "no field at all",
            fix=f"Write {near} for {name}." if near else "Correct the name.",
            why="no-such-field",
        )


def _count(number: int, what: str) -> str:
    return {0: f"no {what}", 1: f"one {what}"}.get(number, f"{number} {what}s")


def returns(function: ast.FunctionDef) -> bool:
    """Return whether a function returns or yields anything."""
    return any(
        isinstance(n, ast.Return)
        and n.value is not None
        or isinstance(n, (ast.Yield, ast.YieldFrom))
        for n in ast.walk(function)
    ) or bool(function.decorator_list)


RULE = Rule("static", ("facts",), of_sources(Calls), also=("python-names", "callbacks"))
