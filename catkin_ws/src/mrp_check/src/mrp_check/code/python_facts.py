# SPDX-License-Identifier: BSD-3-Clause
"""What a Python node's source says: its name, topics, messages, counters and lines."""

from __future__ import annotations

import ast
import re
from typing import Any, Callable, Iterable, Iterator, Sequence, Union

from mrp_check.code.python_source import GAP, UNKNOWN, Source
from mrp_check.confined.places import ELSEWHERE, HOME, Kind, Place

Definition = Union[ast.FunctionDef, ast.ClassDef]

LEVELS = {"logdebug", "loginfo", "logwarn", "logerr", "logerror", "logfatal"}
# A method, or a function -> what a call of it is, whatever it is given.
_METHODS = {
    **dict.fromkeys(("set_succeeded", "set_aborted", "set_preempted", "set_canceled"), Kind.ENDS),
    **{"publish": Kind.PUBLISH, "wait_for_server": Kind.WAITS},
    **dict.fromkeys(("join", "wait", "pause"), Kind.SLEEP),
}
_FUNCTIONS = {
    "rospy.spin": Kind.SPIN,
    **dict.fromkeys(("print", "sys.stdout.write"), Kind.PRINT),
    **dict.fromkeys(("os.fork", "os.popen", "os.system", "multiprocessing.Process"), Kind.STARTS),
    **dict.fromkeys(("os.kill", "os.killpg"), Kind.KILLS),
}
# What is asked for or given by its name -> the kind.
_NAMED = {
    "rospy.ServiceProxy": Kind.ASKS,
    "rospy.wait_for_service": Kind.ASKS,
    "rospy.Service": Kind.OFFERS,
    "actionlib.SimpleActionClient": Kind.COMMANDS,
    "actionlib.SimpleActionServer": Kind.SERVES,
}
# A part of the name of a module, or of what is in one -> what a program does that uses it.
_MODULES = {
    **dict.fromkeys(("argparse", "getopt", "myargv", "optparse"), Kind.ARGUMENTS),
    **dict.fromkeys(("display", "serial", "VideoCapture"), Kind.ELSEWHERE),
}
_FAIL = ("wait_for_server", "wait_for_result")
# What asks whether the node is to end, what ends the program, and what raises an error of rospy's
# once it is to end. publish() gives up in silence then.
_ENDS = set("_exit exit is_shutdown kill quit signal_shutdown spin wait_for_message".split())


def argument(call: ast.Call, position: int, name: str) -> ast.expr | None:
    """Return the expression of a call's argument, or None."""
    for keyword in call.keywords:
        if keyword.arg == name:
            return keyword.value
    if position < len(call.args) and not any(
        isinstance(given, ast.Starred) for given in call.args[: position + 1]
    ):
        return call.args[position]
    return None


# What rospy calls in threads of its own -> where it is handed over.
_CALLED = {
    "rospy.Subscriber": (2, "callback"),
    "rospy.Service": (2, "handler"),
    "rospy.Timer": (1, "callback"),
}


def in_threads(source: Source) -> set[ast.AST]:
    """Return the functions that rospy calls in threads of its own, which end with the program, and
    what these call."""
    calls = ((call, source.dotted(call.func) or "") for call in source.nodes(ast.Call))
    given = [argument(call, *_CALLED[name]) for call, name in calls if name in _CALLED]
    called = [function for function in map(source.definition, given) if function]
    return {*called, *source.called(called)}


def places(source: Source) -> list[Place]:
    """Return the Place of each thing in a python_source.Source, in order."""
    found = [place for node in ast.walk(source.tree) for place in _places_of(source, node)]
    return sorted(found, key=lambda place: place.line)


def _places_of(source: Source, node: ast.AST) -> Iterable[Place]:
    look = next((look for kinds, look in _LOOKS if isinstance(node, kinds)), None)
    return look(_Node(source, node), node) if look else ()


def last_line(node: ast.stmt) -> int:
    return max((getattr(part, "lineno", 0) for part in ast.walk(node)), default=node.lineno)


def is_unused(source: Source, definition: Definition) -> bool:
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


class _Node:
    """A node of a source's tree, at which something may stand."""

    def __init__(self, source: Source, node: Any) -> None:
        self.source, self.node = source, node

    def place(
        self, kind: Kind, text: object = UNKNOWN, line: int | None = None, **values: Any
    ) -> Place:
        plain = text if isinstance(text, str) and text.replace(GAP, "") else None
        known = {name: value for name, value in values.items() if value is not UNKNOWN}
        return Place(self.source.file, line or self.node.lineno, kind, plain, **known)

    def call(self, node: ast.Call) -> Iterator[Place]:
        name, method = self.called(node), getattr(node.func, "attr", "")
        look = next((look for names, look in _CALLS if name in names), None)
        if look:
            yield from look(self, node)
        elif name in _FUNCTIONS:
            yield self.place(_FUNCTIONS[name])
        elif name in _NAMED:
            yield from self.named(_NAMED[name])
        elif name.startswith("rospy.log"):
            yield from self.log(node, name.split(".")[1])
        elif name.startswith("subprocess."):
            yield self.place(Kind.STARTS)
        elif name in ("input", "raw_input"):
            yield self.place(Kind.SLEEP)
            is_own = self.source.definition(node.func) or name in self.source.imports
            yield from () if is_own else (self.place(Kind.KEYBOARD),)
        elif method in _METHODS:
            yield self.place(_METHODS[method])

    def called(self, node: ast.Call) -> str:
        """Return the name of what is called; empty if it has none."""
        return self.source.dotted(node.func) or str(getattr(node.func, "id", ""))

    def changed(self, node: ast.AugAssign) -> Iterator[Place]:
        """Look at counter += 2."""
        step = self.source.value(node.value)
        if isinstance(node.op, (ast.Add, ast.Sub)) and isinstance(step, (int, float)):
            yield self.place(Kind.STEP)
        yield from self.first_values(node.target)

    def assigned(self, node: ast.Assign) -> Iterator[Place]:
        """Look at counter = counter + 2 and the like."""
        target = node.targets[0]
        own = self.source.key(target) if len(node.targets) == 1 else None
        inside = [n for n in ast.walk(node.value) if isinstance(n, (ast.Name, ast.Attribute))]
        if own and any(self.source.key(part) == own for part in inside):
            yield self.place(Kind.STEP)
            yield from self.first_values(target)

    def first_values(self, target: ast.expr) -> Iterator[Place]:
        """Yield a place for each plain first value of a variable that is counted up."""
        for value in self.source.stored(self.source.key(target)):
            if isinstance(value, ast.expr) and isinstance(self.source.value(value), (int, float)):
                yield self.place(Kind.COUNTER, line=value.lineno)

    def loop(self, node: ast.While | ast.For) -> Iterator[Place]:
        """Look at a loop, and whether Ctrl-C ends it."""
        within = [part for root in (node, *self.source.called([node])) for part in ast.walk(root)]
        named = {getattr(part, "attr", getattr(part, "id", "")) for part in within}
        leaves = any(isinstance(part, (ast.Break, ast.Raise, ast.Return)) for part in within)
        is_deaf = not leaves and not named & _ENDS and not self.is_in_thread()
        test = node.test if isinstance(node, ast.While) else None
        is_endless = is_deaf and isinstance(test, ast.Constant) and bool(test.value)
        yield self.place(Kind.LOOP, "endless" if is_endless else UNKNOWN, end=last_line(node))

    def is_in_thread(self) -> bool:
        """Return whether rospy calls what is around it in a thread, which ends with the program."""
        return self.source.function(self.node) in in_threads(self.source)

    def statement(self, node: ast.Expr) -> Iterator[Place]:
        """Look for a call that waits for something, and whose result nobody looks at."""
        call = node.value
        name = getattr(call.func, "attr", "") if isinstance(call, ast.Call) else ""
        asks = {attribute.attr for attribute in self.source.nodes(ast.Attribute)}
        is_seen = name == "wait_for_result" and "get_state" in asks
        if isinstance(call, ast.Call) and name in _FAIL and not is_seen:
            if call.args or call.keywords:  # without a limit, it only fails on Ctrl-C
                yield self.place(Kind.IGNORED, name)

    def named(self, kind: Kind) -> Iterator[Place]:
        """Look at a service or an action that is named."""
        name = self.value(0, "name")
        name = self.value(0, "ns") if name is UNKNOWN else name
        if isinstance(name, str):
            yield self.place(kind, name)
        if self.called(self.node) == "rospy.wait_for_service":
            yield self.place(Kind.WAITS)

    def parameter(self, node: ast.Call) -> Iterator[Place]:
        name = self.source.value(argument(node, 0, "param_name") or argument(node, 0, "key"))
        if isinstance(name, str):
            yield self.place(Kind.READS, name)

    def imported(self, node: ast.Import | ast.ImportFrom) -> Iterator[Place]:
        names = [getattr(node, "module", None) or "", *(alias.name for alias in node.names)]
        return self.of_modules(".".join(names))

    def member(self, node: ast.Attribute) -> Iterator[Place]:
        return self.of_modules(self.source.dotted(node) or "")

    def of_modules(self, name: str) -> Iterator[Place]:
        for part in name.split("."):
            if part in _MODULES:
                yield self.place(_MODULES[part])

    def subscript(self, node: ast.Subscript) -> Iterator[Place]:
        """Look for sys.argv[1] and the like, also in what is given to a function; sys.argv[0] is
        the program."""
        name = self.source.dotted(node.value) or getattr(node.value, "id", None)
        if name in ("sys.argv", "argv") and self.source.value(node.slice) != 0:
            yield self.place(Kind.ARGUMENTS)

    def text(self, node: ast.Constant) -> Iterator[Place]:
        is_docstring = isinstance(self.source.parents.get(node), ast.Expr)
        if isinstance(node.value, str) and not is_docstring:
            yield from (self.place(Kind.PATH, path) for path in HOME.findall(node.value))
            if ELSEWHERE.search(node.value):
                yield self.place(Kind.ELSEWHERE)

    def definition(self, node: Definition) -> Iterator[Place]:
        unused = True if is_unused(self.source, node) else None
        yield self.place(Kind.FUNCTION, node.name, end=last_line(node), unused=unused)

    # Calls

    def value(self, position: int, keyword: str) -> object:
        return self.source.value(argument(self.node, position, keyword))

    def init(self, node: ast.Call) -> Iterator[Place]:
        anonymous = self.value(2, "anonymous")
        yield self.place(Kind.INIT, self.value(0, "name"), anonymous=anonymous)

    def topic(self, kind: Kind, position: int) -> Iterator[Place]:
        queue = argument(self.node, position, "queue_size")
        line = queue.lineno if queue is not None else None
        name, length = self.value(0, "name"), self.source.value(queue)
        latch = argument(self.node, 4, "latch") if kind is Kind.PUBLISHER else None
        latches = latch is not None and self.source.value(latch) is not False
        yield self.place(kind, name, queue=length, queue_line=line, latch=latches)

    def publisher(self, node: ast.Call) -> Iterator[Place]:
        return self.topic(Kind.PUBLISHER, 6)

    def subscriber(self, node: ast.Call) -> Iterator[Place]:
        return self.topic(Kind.SUBSCRIBER, 4)

    def timer(self, node: ast.Call) -> Iterator[Place]:
        period, oneshot = self.value(0, "period"), self.value(2, "oneshot")
        yield self.place(Kind.TIMER, period=period, oneshot=oneshot)

    def rate(self, node: ast.Call) -> Iterator[Place]:
        hertz = self.value(0, "hz")
        period = 1 / hertz if isinstance(hertz, (int, float)) and hertz else UNKNOWN
        yield self.place(Kind.TIMER, period=period)

    def sleep(self, node: ast.Call) -> Iterator[Place]:
        yield self.place(Kind.TIMER, period=self.value(0, "duration"))
        yield self.place(Kind.SLEEP)

    def exit(self, node: ast.Call) -> Iterator[Place]:
        code = self.value(0, "status")
        value = code if isinstance(code, int) else int(isinstance(code, str))
        yield self.place(Kind.EXIT, self.called(node), value=value)

    def signal(self, node: ast.Call) -> Iterator[Place]:
        name = self.source.dotted(argument(node, 0, "signalnum"))
        yield self.place(Kind.SIGNAL, name or UNKNOWN)

    def count(self, node: ast.Call) -> Iterator[Place]:
        yield self.place(Kind.COUNTER)
        yield self.place(Kind.STEP)

    def log(self, node: ast.Call, function: str) -> Iterator[Place]:
        plain = re.sub("(_throttle_identical|_throttle|_once)$", "", function)
        if plain in LEVELS:
            yield self.place(Kind.LOG)


_LOOKS: Sequence[tuple[Any, Callable[[_Node, Any], Iterable[Place]]]] = (
    (ast.Call, _Node.call),
    (ast.AugAssign, _Node.changed),
    (ast.Assign, _Node.assigned),
    ((ast.While, ast.For), _Node.loop),
    (ast.Expr, _Node.statement),
    ((ast.FunctionDef, ast.ClassDef), _Node.definition),
    ((ast.Import, ast.ImportFrom), _Node.imported),
    (ast.Attribute, _Node.member),
    (ast.Subscript, _Node.subscript),
    (ast.Constant, _Node.text),
)
_CALLS = (
    (("rospy.init_node",), _Node.init),
    (("rospy.Publisher", "rospy.topics.Publisher"), _Node.publisher),
    (("rospy.Subscriber", "rospy.topics.Subscriber"), _Node.subscriber),
    (("rospy.Timer", "rospy.timer.Timer"), _Node.timer),
    (("rospy.Rate", "rospy.timer.Rate"), _Node.rate),
    (("rospy.sleep", "time.sleep"), _Node.sleep),
    (
        ("sys.exit", "os._exit", "exit", "quit", "SystemExit", "rospy.signal_shutdown"),
        _Node.exit,
    ),
    (("signal.signal",), _Node.signal),
    (("itertools.count",), _Node.count),
    (
        tuple(f"rospy.{verb}_param" for verb in ("get", "has", "search"))
        + ("rospy.get_param_cached",),
        _Node.parameter,
    ),
)
