# SPDX-License-Identifier: BSD-3-Clause
"""Calls of rospy that cannot work, and callbacks that cannot be called."""

from __future__ import annotations

import ast
import inspect
import re
from typing import Iterator

from mrp_check.code.python_facts import argument
from mrp_check.code.python_modules import cannot_bind, resolve, signature
from mrp_check.code.python_rule import HasFacts, MessageClass, PythonRule, ast_text, of_sources
from mrp_check.code.python_source import Function, Variable
from mrp_check.code.python_text import UNKNOWN
from mrp_check.contract.finding import CERTAIN, Finding
from mrp_check.contract.names import nearest, perhaps
from mrp_check.contract.requirements import Rule


class Calls(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Call):
            name = self.source.dotted(node.func)
            if name and name.startswith("rospy.") and not self.is_own("rospy"):
                yield from self._call(node, name)
                yield from self._logged(node, name)
            elif name == "actionlib.SimpleActionServer":
                execute = argument(node, 2, "execute_cb")
                if execute is not None:
                    yield from self._callback(execute, 1, name, "a goal")

    def _call(self, node: ast.Call, name: str) -> Iterator[Finding]:
        function, missing = resolve(name)
        if missing is not None or not callable(function):
            return
        problem = cannot_bind(function, node)
        if problem:
            hint = ""
            match = re.search(r"unexpected keyword argument '(\w+)'", problem)
            if match:
                hint = perhaps(nearest(match.group(1), inspect.signature(function).parameters))
            yield self.finding(
                "callbacks" if name == "rospy.Timer" else "python-names",
                f"{name}() is called with the wrong arguments: {problem}.{hint}",
                node,
                expected=f"{name}{signature(function)}",
                fix="Compare the call with the one on the page.",
            )
            return
        if name in _CHECKED:
            yield from _CHECKED[name](self, node)

    def _logged(self, node: ast.Call, name: str) -> Iterator[Finding]:
        """Yield a finding if a text that is logged has more or fewer places than values."""
        logs = _LOGS.fullmatch(name)
        given = node.args[1:] if logs and logs["period"] else node.args
        text = getattr(given[0], "value", None) if logs and len(given) > 1 else None
        if not isinstance(text, str):
            return
        places = [one for one in _PLACES.finditer(text) if one["type"] != "%"]
        is_open = any(isinstance(one, (ast.Starred, ast.Dict)) for one in given)
        if is_open or any(one["name"] for one in places):
            return
        wanted = len(places) + sum(one.group().count("*") for one in places)
        if wanted != len(given) - 1:
            yield self.finding(
                "python-names",
                f"The text logged here has {_count(wanted, 'placeholder')}, but gets"
                f" {len(given) - 1}: Python raises a TypeError when it gets here.",
                node,
                expected=f"{name}(... %s, ...), with a placeholder for each value",
                fix="Write a placeholder such as %s for each value.",
            )
            return
        for place, value in zip(places, given[1:]):
            if place["type"] in "diouxXeEfFgG" and self._is_message(value):
                yield self.finding(
                    "python-names",
                    f"{ast_text(value)} is the whole message, but {place.group()} needs a number:"
                    " all that's logged is a TypeError.",
                    node,
                    expected=f"a field of it, such as {ast_text(value)}.data",
                    fix="Name the field.",
                )

    def _is_message(self, node: ast.expr) -> bool:
        """Return whether an expression is what a subscriber's callback is given."""
        function = self.source.function(node)
        if not isinstance(node, ast.Name) or not isinstance(function, ast.FunctionDef):
            return False
        given = {one.arg for one in function.args.args} - {"self"}
        taken = self.handed_over(lambda one: self.source.dotted(one.func) == "rospy.Subscriber")
        is_given_anew = self.source.stored(self.source.key(node)) != [None]
        return {node.id} == given and function in taken and not is_given_anew

    def _init_node(self, node: ast.Call) -> Iterator[Finding]:
        given = argument(node, 0, "name")
        value = self.source.value(given)
        if value is not UNKNOWN and not isinstance(value, str) or self._is_type(given):
            yield self.finding(
                "node-start",
                "rospy.init_node() takes the node's name, a string, as its first argument.",
                node,
                expected='rospy.init_node("NAME")',
                fix="Pass the node's name first.",
            )

    def _is_type(self, node: ast.expr | None) -> bool:
        return self.message_class(node) is not None or isinstance(
            self.source.definition(node), (ast.FunctionDef, ast.ClassDef)
        )

    def _topic_and_type(self, node: ast.Call, what: str = "Publisher") -> Iterator[Finding]:
        topic, class_ = argument(node, 0, "name"), argument(node, 1, "data_class")
        value = self.source.value(class_)
        is_text = isinstance(value, str)
        swapped = self.message_class(topic) is not None
        own = self.source.definition(class_) if class_ is not None else None
        if (
            swapped
            or is_text
            or isinstance(own, (ast.FunctionDef, ast.Lambda))
            or isinstance(class_, ast.Call)
            and self.message_class(class_.func)
        ):
            why = (
                "the topic's name comes first, and then the type"
                if swapped
                else "the second argument has to be the type of the message, a class"
            )
            yield self.finding(
                "type",
                f"rospy.{what}() gets its arguments wrong: {why}.",
                node,
                expected=f'rospy.{what}("TOPIC", UInt32, ...)',
                fix="Compare the call with the one on the page.",
            )

    def _subscriber(self, node: ast.Call) -> Iterator[Finding]:
        yield from self._topic_and_type(node, "Subscriber")
        class_ = self.message_class(argument(node, 1, "data_class"))
        extra = argument(node, 3, "callback_args")
        more = 0 if extra is None or self.source.value(extra) is None else 1
        callback = argument(node, 2, "callback")
        if callback is not None:
            given = f"a message {class_._type}" if class_ else "a message"
            yield from self._callback(callback, 1 + more, "rospy.Subscriber", given)
        elif not any(keyword.arg is None for keyword in node.keywords):
            parent = self.source.parents.get(node)
            if not self._callback_added(parent):
                yield self.finding(
                    "callbacks",
                    "rospy.Subscriber() gets no callback, so nothing happens when a message"
                    " arrives.",
                    node,
                    expected="the callback as the third argument",
                    fix="Pass the callback itself, without calling it.",
                )

    def _callback_added(self, parent: ast.AST | None) -> bool:
        names = {n.attr for n in self.source.nodes(ast.Attribute)}
        return bool(names & {"add_callback", "registerCallback"}) or not isinstance(
            parent, (ast.Assign, ast.Expr)
        )

    def _timer(self, node: ast.Call) -> Iterator[Finding]:
        period, callback = argument(node, 0, "period"), argument(node, 1, "callback")
        is_number = isinstance(period, ast.Constant) and isinstance(period.value, (int, float))
        is_computed = isinstance(period, (ast.BinOp, ast.UnaryOp))
        plain = isinstance(self.source.value(period), (int, float))
        if period is not None and (is_number or is_computed and plain):
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
        if callback is not None:
            yield from self._callback(callback, 1, "rospy.Timer", "a TimerEvent")

    def _callback(
        self, callback: ast.expr, count: int, taker: str, given: str
    ) -> Iterator[Finding]:
        """Yield a finding if what is handed over as a callback cannot be called with `count`."""
        if isinstance(callback, ast.Call):
            called = self.source.definition(callback.func)
            if isinstance(called, ast.FunctionDef) and not returns(called):
                yield self._called_at_once(callback, called, taker)
            return
        if isinstance(self.source.value(callback), (str, int, float)):
            yield self.finding(
                "callbacks",
                f"{taker}() takes a function to call, but gets a plain value.",
                callback,
                expected="the name of a function",
                fix="Pass the function itself, without quotation marks and without calling it.",
            )
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


_LOGS = re.compile(
    r"rospy\.log(?:debug|info|warn|err|fatal)(?:(?P<period>_throttle(?:_identical)?)|_once)?"
)
# https://docs.python.org/3/library/stdtypes.html#printf-style-string-formatting
_PLACES = re.compile(
    r"%(?P<name>\(\w*\))?[-#0 +]*(?:\d+|\*)?(?:\.(?:\d+|\*))?[hlL]?(?P<type>[diouxXeEfFgGcrsa%])"
)
_CHECKED = {
    "rospy.init_node": Calls._init_node,
    "rospy.Publisher": Calls._topic_and_type,
    "rospy.Subscriber": Calls._subscriber,
    "rospy.Timer": Calls._timer,
}


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


class Messages(PythonRule):
    def findings(self) -> Iterator[Finding]:
        yield from self.unknown_fields()
        yield from self.unknown_arguments()

    def unknown_fields(self) -> Iterator[Finding]:
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

    def unknown_arguments(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Call):
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


def _findings(case: HasFacts) -> Iterator[Finding]:
    yield from of_sources(Messages)(case)
    yield from of_sources(Calls)(case)


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=_findings,
    also=("python-names", "node-start", "type", "callbacks"),
)
