# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends a Python node: nothing waits for the keyboard, and no loop goes on.

rospy's handler of SIGINT keeps KeyboardInterrupt back: input() waits on, and so does a loop that
only computes or sleeps. Nor does rospy.sleep() raise an error, unless time is simulated.
https://github.com/ros/ros_comm/blob/noetic-devel/clients/rospy/src/rospy/core.py
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code.python_callbacks import callbacks, in_threads
from mrp_check.code.python_facts import argument
from mrp_check.code.python_source import Source, Variable
from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.contract.requirements import ANY, Rule

_LEAVES = (ast.Break, ast.Raise, ast.Return)
# What asks, what ends the program, and what raises an error of rospy's once the node is to end.
# publish() gives up in silence then.
_ENDS = "_exit exit is_shutdown kill quit signal_shutdown spin wait_for_message".split()
_GOES_ON = (
    "This loop does not ask whether the node is to end: after Ctrl-C it goes on to its own end."
)
_KEYBOARD = {"input", "raw_input"}
_CTRL_C = "\x03"
_COMPUTES = {"math", "abs", "float", "int", "len", "max", "min", "numpy", "pow", "round", "sqrt"}


def _findings(case: Case) -> Iterator[Finding]:
    reported = set()  # several nodes may import the same module
    for name, files in case.facts.sources.items():
        node = case.nodes.get(name)
        for source in filter(None, map(case.facts.python.get, files)):
            is_up = bool(node and node.is_up)
            for line, said, expected, fix in _deaf(source, is_up) if _is_rospys(source) else ():
                seen = case.package.line(source.file, line)
                place = source.file, line, HINT if said is _GOES_ON else HABIT
                if (source.file, line, said) not in reported:
                    reported.add((source.file, line, said))
                    yield Finding("exit", said, *place, expected, seen, fix, node=name)


def _deaf(source: Source, is_up: bool) -> Iterator[tuple[int, str, str, str]]:
    """Yield (line, what is wrong, what is expected, what to do) of each loop, and of one input().

    is_up: whether the node ran; then it was seen what its loops do
    """
    let_off = in_threads(source)
    for loop in source.nodes(ast.While):
        asked = None if source.function(loop) in let_off else _asks_others(source, loop)
        wanted = "while not rospy.is_shutdown():"
        if asked:
            yield (
                loop.lineno,
                f"Ctrl-C does not end this loop: no message changes {asked} any more then, and the"
                " loop does not ask rospy.is_shutdown().",
                "rospy.is_shutdown() in the loop",
                "Let the loop end when rospy.is_shutdown(), too.",
            )
        elif not is_up and source.function(loop) not in let_off and _goes_on(source, loop):
            said = "This loop never ends: it does not ask rospy.is_shutdown(), so Ctrl-C does not"
            yield loop.lineno, f"{said} end the node.", wanted, f"Write {wanted}"
        elif source.function(loop) not in let_off and _ends_late(source, loop):
            yield (
                loop.lineno,
                _GOES_ON,
                "rospy.is_shutdown() in the loop",
                "Let the loop end when rospy.is_shutdown(), too.",
            )
    yield from _waits_in_hook(source)
    yield from _keyboard(source)


def _waits_in_hook(source: Source) -> Iterator[tuple[int, str, str, str]]:
    """Yield the same of what a function calls at the shutdown, before it sets what that waits for.

    A loop that waits until somebody is connected, or until a member is set, is not left then.
    """
    for hook in _hooks(source):
        for number, statement in enumerate(hook.body):
            later = {key for one in hook.body[number:] for key in _keys(source, one, ast.Store)}
            called = source.called([statement])
            loops = [one for part in called for one in ast.walk(part) if isinstance(one, ast.While)]
            for loop in loops:
                asked = _keys(source, loop.test, ast.Load) & later
                if asked and not _named(source, loop) & {*_ENDS}:
                    name = next(iter(asked))[1]
                    yield (
                        statement.lineno,
                        f"At the shutdown, this comes to the loop of line {loop.lineno}, which only"
                        f" {name} ends for certain, and that is set below: the node may never end.",
                        f"{name} set first",
                        f"Set {name} at the beginning of {hook.name}().",
                    )
                    return


def _keyboard(source: Source) -> Iterator[tuple[int, str, str, str]]:
    """Yield the same of the first line at which a node waits for the keyboard, or of one that keeps
    Ctrl-C from being a signal."""
    constants = {getattr(node, "value", None) for node in source.nodes(ast.Constant)}
    starts = _starts(source)
    for call in source.nodes(ast.Call):
        is_early = any(
            source.function(one) is source.function(call) and call.lineno < one.lineno
            for one in starts
        )
        if source.dotted(call.func) == "tty.setraw" and not constants & {_CTRL_C, ord(_CTRL_C)}:
            yield (
                call.lineno,
                "A raw terminal hands Ctrl-C on as a character: it does not end the node.",
                "a look at each key for '\\x03', or tty.setcbreak()",
                "End the loop on '\\x03'; or write tty.setcbreak() for tty.setraw().",
            )
            return
        asks = call.func.id if isinstance(call.func, ast.Name) else ""
        if asks in _KEYBOARD and not is_early:
            if not source.definition(call.func) and asks not in source.imports:
                yield (
                    call.lineno,
                    "Ctrl-C does not end the node while it waits for the keyboard: rospy keeps"
                    " KeyboardInterrupt back, until somebody presses Enter.",
                    "rospy.init_node(..., disable_signals=True)",
                    "Let rospy.init_node() have disable_signals=True, and catch KeyboardInterrupt.",
                )
                return


def _starts(source: Source) -> list[ast.Call]:
    return [c for c in source.nodes(ast.Call) if source.dotted(c.func) == "rospy.init_node"]


def _is_rospys(source: Source) -> bool:
    """Return whether rospy handles the signals of a program."""
    calls = _starts(source)
    return bool(calls) and not any(k.arg == "disable_signals" for c in calls for k in c.keywords)


def _goes_on(source: Source, loop: ast.While) -> bool:
    """Return whether a loop goes on for ever, whatever is asked of the node."""
    within = [node for one in loop.body for node in ast.walk(one)]
    if not isinstance(loop.test, ast.Constant) or not loop.test.value:
        return False
    if any(isinstance(node, _LEAVES) for node in within):
        return False
    return not _named(source, loop) & {*_ENDS}


def _ends_late(source: Source, loop: ast.While) -> bool:
    """Return whether a loop waits or publishes until it comes to an end of its own."""
    named, asked = _named(source, loop), _keys(source, loop.test, ast.Load)
    if isinstance(loop.test, ast.Constant) or named & {*_ENDS} or asked & _set_at_shutdown(source):
        return False
    return bool(named & {"sleep", "publish"})


def _named(source: Source, loop: ast.While) -> set[str]:
    """Return all names in a loop, and in what it calls, which belongs to it."""
    within = [loop, *source.called([loop])]
    nodes = (node for one in within for node in ast.walk(one))
    return {getattr(one, "attr", getattr(one, "id", "")) for one in nodes}


def _asks_others(source: Source, loop: ast.While) -> str | None:
    """Return the name of what a loop asks before it ends, if it is others that change it all."""
    within = [node for one in loop.body for node in ast.walk(one)]
    asks = [] if isinstance(loop.test, ast.Constant) else [loop.test]
    for leaf in (node for node in within if isinstance(node, _LEAVES)):
        if any(_catches_ctrl_c(one) for one in source.above(leaf)):
            continue
        tests = [
            one.test for one in source.above(leaf) if isinstance(one, ast.If) and one in within
        ]
        asks += tests[:1] or [ast.Constant(True)]
    named = {getattr(node, "attr", getattr(node, "id", "")) for node in within}
    heard = {key for function in callbacks(source) for key in _keys(source, function, ast.Store)}
    found = [_depends_on(source, within, ask) for ask in asks]
    is_heard = all(keys & heard for keys in found) or all(found) and "sleep" in named
    if not found or not is_heard or named & {*_ENDS}:
        return None
    if set().union(*found) & _set_at_shutdown(source):
        return None
    return min(key[1] for key in found[0] & heard or found[0])


def _catches_ctrl_c(node: ast.AST) -> bool:
    """Return whether a node is an `except KeyboardInterrupt`, which rospy never lets happen."""
    kind = node.type if isinstance(node, ast.ExceptHandler) else None
    return isinstance(kind, ast.Name) and kind.id == "KeyboardInterrupt"


def _set_at_shutdown(source: Source) -> set[Variable]:
    """Return what a function changes that rospy.on_shutdown() is given: Ctrl-C changes it."""
    return {key for hook in _hooks(source) for key in _keys(source, hook, ast.Store)}


def _hooks(source: Source) -> list[ast.FunctionDef]:
    """Return the functions that rospy calls at the shutdown."""
    calls = (c for c in source.nodes(ast.Call) if source.dotted(c.func) == "rospy.on_shutdown")
    hooks = (source.definition(argument(call, 0, "h")) for call in calls)
    return [hook for hook in hooks if isinstance(hook, ast.FunctionDef)]


def _depends_on(source: Source, within: list[ast.AST], ask: ast.expr) -> set[Variable]:
    """Return what a condition depends on; nothing if the loop may change that by itself."""
    parts, known = [ask], {*source.imports, *_COMPUTES}
    found: set[Variable] = set()
    for part in parts:  # it grows
        if any(isinstance(n, ast.Call) and not _only_computes(source, n) for n in ast.walk(part)):
            return set()
        keys = _keys(source, part, ast.Load) - found
        for key in (one for one in keys if one[1].partition(".")[0] not in known):
            found.add(key)
            for node in within:
                given, value = source.parents[node], getattr(node, "value", None)
                if isinstance(getattr(node, "ctx", None), ast.Store) and source.key(node) == key:
                    if not isinstance(given, ast.Assign):
                        return set()  # it is counted up, say
                    parts.append(given.value)
                elif value is not None and source.key(value) == key and _changes(node, given):
                    return set()
    return found


def _changes(node: ast.AST, above: ast.AST) -> bool:
    """Return whether a part of something is changed, or a method of it is called."""
    is_called = isinstance(above, ast.Call) and above.func is node
    return is_called or isinstance(getattr(node, "ctx", None), ast.Store)


def _only_computes(source: Source, call: ast.Call) -> bool:
    if getattr(call.func, "attr", "") == "get_num_connections":
        return True  # others change that
    named = source.dotted(call.func) or str(getattr(call.func, "id", ""))
    return named.split(".")[0] in _COMPUTES


def _keys(source: Source, within: ast.AST, context: type[ast.expr_context]) -> set[Variable]:
    nodes = (one for one in ast.walk(within) if isinstance(getattr(one, "ctx", None), context))
    return {key for key in map(source.key, nodes) if key}


RULE = Rule("stop", ("nodes",), _findings, also=("exit",), only=ANY)
