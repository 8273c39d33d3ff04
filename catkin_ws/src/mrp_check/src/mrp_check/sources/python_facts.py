# SPDX-License-Identifier: BSD-3-Clause
"""What a Python node's source says: its name, topics, messages, counters and lines."""

from __future__ import annotations

import ast

from mrp_check.sources.facts import Place
from mrp_check.sources.python_source import GAP, UNKNOWN, percent

LEVELS = {
    "logdebug": "debug",
    "loginfo": "info",
    "logwarn": "warn",
    "logerr": "error",
    "logerror": "error",
    "logfatal": "fatal",
}


def argument(call, position, name):
    """Return the expression of a call's argument, or None."""
    for keyword in call.keywords:
        if keyword.arg == name:
            return keyword.value
    if position < len(call.args) and not any(
        isinstance(one, ast.Starred) for one in call.args[: position + 1]
    ):
        return call.args[position]
    return None


def message_type(source, node):
    """Return the type of a message class, as in std_msgs/UInt32, or None."""
    name = source.dotted(node) if node is not None else None
    if name:
        parts = name.split(".")
        if "msg" in parts[1:-1]:
            return f"{parts[0]}/{parts[-1]}"
    return None


def places(source):
    """Return the facts.Place of each thing in a python_source.Source, in order."""
    found = []
    for node in ast.walk(source.tree):
        found += _places_of(source, node)
    return sorted(found, key=lambda place: place.line)


def _places_of(source, node):
    def place(kind, text=UNKNOWN, line=None, **values):
        values = {key: value for key, value in values.items() if value is not UNKNOWN}
        plain = text if isinstance(text, str) and text.replace(GAP, "") else None
        return Place(source.file, line or node.lineno, kind, plain, values)

    if isinstance(node, ast.Call):
        yield from _of_call(source, node, place)
    elif isinstance(node, ast.AugAssign):
        step = source.value(node.value)
        sign = {ast.Add: 1, ast.Sub: -1}.get(type(node.op))
        if sign and isinstance(step, (int, float)):
            yield place(
                "step",
                ast.unparse(node.target) if hasattr(ast, "unparse") else UNKNOWN,
                step=sign * step,
            )
        yield from _starts(source, node.target, place)
    elif isinstance(node, ast.Assign) and len(node.targets) == 1:
        target = node.targets[0]
        if (
            isinstance(target, ast.Attribute)
            and source.key(target)
            and not (isinstance(target.value, ast.Name) and target.value.id == "self")
            or isinstance(target, ast.Attribute)
            and isinstance(target.value, ast.Attribute)
        ):
            yield place("data", value=source.value(node.value))
        own = source.key(target)
        inside = [one for one in ast.walk(node.value) if isinstance(one, (ast.Name, ast.Attribute))]
        if own and any(source.key(one) == own for one in inside):
            yield place("step", **_step(source, node.value, own))
            yield from _starts(source, target, place)
    elif isinstance(node, (ast.While, ast.For)):
        yield place("loop")
    elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
        yield place(
            "function",
            node.name,
            end=last_line(node),
            unused=True if _is_unused(source, node) else UNKNOWN,
        )
    elif isinstance(node, ast.ExceptHandler):
        names = [n for n in ast.walk(node.type or node) if isinstance(n, (ast.Name, ast.Attribute))]
        text = {getattr(n, "id", None) or getattr(n, "attr", None) for n in names}
        if node.type is None or text & {"KeyboardInterrupt", "BaseException"}:
            yield place("catch")


def last_line(node):
    return max((getattr(one, "lineno", 0) for one in ast.walk(node)), default=node.lineno)


def _is_unused(source, definition):
    """Return whether a function, method or class is named nowhere but in itself."""
    name = definition.name
    if name.startswith("__") or definition.decorator_list:
        return False
    inside = set(ast.walk(definition))
    for node in ast.walk(source.tree):
        if node in inside:
            continue
        # What a class inherits may call it, as threading.Thread calls run().
        if isinstance(node, ast.ClassDef) and definition in node.body:
            if any(getattr(base, "id", None) != "object" for base in node.bases):
                return False
        named = isinstance(node, ast.Name) and node.id == name
        named = named or isinstance(node, ast.Attribute) and node.attr == name
        if named or isinstance(node, ast.Constant) and node.value == name:
            return False
    return True


def _step(source, node, key):
    """Return what is added to a variable at each step, in an expression such as (x + 2) % 8."""
    values = {}
    for one in ast.walk(node):
        if isinstance(one, ast.BinOp):
            number = source.value(one.right)
            if not isinstance(number, (int, float)):
                continue
            if isinstance(one.op, ast.Mod):
                values["modulus"] = number
            elif isinstance(one.op, ast.BitAnd):
                values["modulus"] = number + 1
            elif isinstance(one.op, ast.Add):
                values["step"] = number
            elif isinstance(one.op, ast.Sub):
                values["step"] = -number
    return values


def _starts(source, target, place):
    """Yield a place for each plain first value of a variable that is counted up."""
    for value in source.stored(source.key(target)):
        if isinstance(value, ast.expr) and isinstance(source.value(value), (int, float)):
            yield place("counter", line=value.lineno, value=source.value(value))


def _of_call(source, node, place):
    name = source.dotted(node.func) or ""
    if isinstance(node.func, ast.Name) and not name:
        name = node.func.id
    call = _Call(source, node, name, place)
    look = next((look for names, look in _CALLS if name in names), None)
    if look:
        yield from look(call)
    elif name.startswith("rospy.log"):
        yield from _log(source, node, name.split(".")[1], place)
    elif name.startswith("threading.") and name.endswith(("Thread", "Timer")):
        yield place("thread", name, daemon=call.value(99, "daemon"))
    elif getattr(node.func, "attr", "") == "publish":
        yield place("publish")
    elif name == "input" or getattr(node.func, "attr", "") in ("join", "wait", "pause"):
        yield place("sleep")


class _Call:
    def __init__(self, source, node, name, place):
        self.source, self.node, self.name, self.place = source, node, name, place

    def value(self, position, keyword):
        return self.source.value(argument(self.node, position, keyword))

    def init(self):
        yield self.place("init", self.value(0, "name"), anonymous=self.value(1, "anonymous"))

    def topic(self, kind, queue, **values):
        yield self.place(
            kind,
            self.value(0, "name"),
            type=message_type(self.source, argument(self.node, 1, "data_class")) or UNKNOWN,
            queue=self.value(queue, "queue_size"),
            queue_line=getattr(argument(self.node, queue, "queue_size"), "lineno", UNKNOWN),
            **values,
        )

    def publisher(self):
        return self.topic("publisher", 6, latch=self.value(4, "latch"))

    def subscriber(self):
        return self.topic("subscriber", 4)

    def timer(self):
        yield self.place("timer", period=self.value(0, "period"), oneshot=self.value(2, "oneshot"))

    def rate(self):
        hertz = self.value(0, "hz")
        plain = isinstance(hertz, (int, float)) and hertz
        yield self.place("timer", period=1 / hertz if plain else UNKNOWN)

    def sleep(self):
        yield self.place("timer", period=self.value(0, "duration"))
        yield self.place("sleep")

    def spin(self):
        yield self.place("spin")

    def print(self):
        texts = [self.source.value(argument) for argument in self.node.args]
        yield self.place("print", " ".join(t if isinstance(t, str) else GAP for t in texts))

    def write(self):
        yield self.place("print", self.value(0, "s"))

    def exit(self):
        yield self.place("exit", self.name, code=self.value(0, "code"))

    def signal(self):
        name = self.source.dotted(argument(self.node, 0, "signalnum"))
        yield self.place("signal", name or UNKNOWN)

    def count(self):
        node, step = self.node, self.value(1, "step")
        start = self.value(0, "start") if node.args or node.keywords else 0
        yield self.place("counter", value=start)
        yield self.place("step", step=1 if step is UNKNOWN and len(node.args) < 2 else step)


_CALLS = (
    (("rospy.init_node",), _Call.init),
    (("rospy.Publisher", "rospy.topics.Publisher"), _Call.publisher),
    (("rospy.Subscriber", "rospy.topics.Subscriber"), _Call.subscriber),
    (("rospy.Timer", "rospy.timer.Timer"), _Call.timer),
    (("rospy.Rate", "rospy.timer.Rate"), _Call.rate),
    (("rospy.sleep", "time.sleep"), _Call.sleep),
    (("rospy.spin",), _Call.spin),
    (("print",), _Call.print),
    (("sys.stdout.write",), _Call.write),
    (("sys.exit", "os._exit", "exit", "quit", "rospy.signal_shutdown"), _Call.exit),
    (("signal.signal",), _Call.signal),
    (("itertools.count",), _Call.count),
)


def _log(source, node, function, place):
    rest = function
    for ending in ("_throttle_identical", "_throttle", "_once"):
        if function.endswith(ending):
            rest = function[: -len(ending)]
    level = LEVELS.get(rest)
    if level is None:
        return
    first = 1 if "throttle" in function else 0
    text = source.value(argument(node, first, "msg"))
    values = [source.value(one) for one in node.args[first + 1 :]]
    if isinstance(text, str) and values:
        text = percent(text, values)
    yield place("log", text, level=level)
