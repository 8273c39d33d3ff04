# SPDX-License-Identifier: BSD-3-Clause
"""What rospy and actionlib are given: callbacks that they cannot call, or that return nothing where
a response is needed; a number for a timer's period; an action server that nothing starts.

Of other wrong calls, Python says the same when it gets there.
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_facts import argument
from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.code.python_source import Function
from mrp_check.contract.finding import CERTAIN, READ, Finding
from mrp_check.contract.requirements import Rule


class Calls(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Call):
            name = None if self.is_own("rospy") else self.source.dotted(node.func)
            if name == "rospy.Subscriber":
                yield from self._subscriber(node)
            elif name == "rospy.Timer":
                yield from self._timer(node)
            elif name == "rospy.Service":
                yield from self._service(argument(node, 2, "handler"))
            elif name == "actionlib.SimpleActionServer":
                yield from self._callback(argument(node, 2, "execute_cb"), 1, name, "a goal")
                yield from self._action_server(argument(node, 3, "auto_start"), node)

    def _subscriber(self, node: ast.Call) -> Iterator[Finding]:
        extra = argument(node, 3, "callback_args")
        more = 0 if extra is None or self.source.value(extra) is None else 1
        callback = argument(node, 2, "callback")
        given = "a message and callback_args" if more else "a message"
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

    def _service(self, given: ast.expr | None) -> Iterator[Finding]:
        handler = self.source.definition(given)
        if not isinstance(handler, ast.FunctionDef) or returns(handler):
            return
        if not isinstance(handler.body[-1], ast.Raise):
            yield self.finding(
                "callbacks",
                f"{handler.name}() answers a service, but returns nothing, so every service call"
                " fails.",
                handler,
                certainty=CERTAIN,
                expected="return, with the response",
                fix="Return a response: an object of the class whose name ends in Response.",
            )

    def _action_server(self, starts: ast.expr | None, node: ast.Call) -> Iterator[Finding]:
        waits = starts is not None and self.source.value(starts) is False
        if waits and "start" not in self.source.names():
            yield self.finding(
                "callbacks",
                "The action server is created with auto_start=False, but nothing calls its start(),"
                " so no goal ever reaches it.",
                node,
                certainty=READ,
                expected="start(), once everything else is set up",
                fix="Call start() on it.",
            )

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
        name = ast.unparse(callback.func)
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
        decorators = {getattr(node, "id", "") for node in getattr(function, "decorator_list", ())}
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
            own = max(0, (most if is_too_many else least) - bound)
            yield self.finding(
                "callbacks",
                f"{taker}() calls {name}() with {given}, but {name}() takes"
                f" {_count(own, 'argument')}. Each call raises a TypeError.",
                function,
                certainty=CERTAIN,
                expected=f"{count} parameter{s}" + (" besides self" if bound else ""),
                fix=f"Give {name} the parameter{s} that it's called with.",
                why="timer-callback" if taker == "rospy.Timer" else "bad-callback",
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


RULE = Rule("static", ("facts",), of_sources(Calls), also=("callbacks",))
