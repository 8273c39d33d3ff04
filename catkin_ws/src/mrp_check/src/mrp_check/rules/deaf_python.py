# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends a Python node: nothing waits for the keyboard, and no loop goes on.

rospy's handler of SIGINT keeps KeyboardInterrupt back: input() waits on, and so does a loop that
only computes or sleeps. Nor does rospy.sleep() raise an error, unless time is simulated.
https://github.com/ros/ros_comm/blob/noetic-devel/clients/rospy/src/rospy/core.py
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources.python_source import Source

_LEAVES = (ast.Break, ast.Raise, ast.Return)
# What asks, what ends the program, and what raises an error of rospy's once the node is to end.
# publish() gives up in silence then.
_ENDS = "_exit exit is_shutdown kill quit signal_shutdown spin wait_for_message".split()


def _findings(case: Case) -> Iterator[Finding]:
    for name, files in case.facts.sources.items():
        node = case.nodes.get(name)
        for source in filter(None, map(case.facts.python.get, files)):
            is_up = bool(node and node.is_up)
            for line, said, expected, fix in _deaf(source, is_up) if _is_rospys(source) else ():
                seen = case.package.lines(source.file)[line - 1].strip()
                place = source.file, line, WARNING
                yield Finding("exit", said, *place, expected, seen, fix, node=name)


def _deaf(source: Source, is_up: bool) -> Iterator[tuple[int, str, str, str]]:
    """Yield (line, what is wrong, what is expected, what to do) of each loop, and of one input().

    is_up: whether the node ran; then it was seen what its loops do
    """
    for loop in source.nodes(ast.While):
        if not is_up and _goes_on(source, loop):
            wanted = "while not rospy.is_shutdown():"
            said = "This loop never ends: it does not ask rospy.is_shutdown(), so Ctrl-C does not"
            yield loop.lineno, f"{said} end the node.", wanted, f"Write {wanted}"
    for call in source.nodes(ast.Call):
        if isinstance(call.func, ast.Name) and call.func.id == "input":
            if not source.definition(call.func) and "input" not in source.imports:
                yield (
                    call.lineno,
                    "Ctrl-C does not end the node while it waits for the keyboard: rospy keeps"
                    " KeyboardInterrupt back, until somebody presses Enter.",
                    "rospy.init_node(..., disable_signals=True)",
                    "Let rospy.init_node() have disable_signals=True, and catch KeyboardInterrupt.",
                )
                return


def _is_rospys(source: Source) -> bool:
    """Return whether rospy handles the signals of a program."""
    calls = [c for c in source.nodes(ast.Call) if source.dotted(c.func) == "rospy.init_node"]
    return bool(calls) and not any(k.arg == "disable_signals" for c in calls for k in c.keywords)


def _goes_on(source: Source, loop: ast.While) -> bool:
    """Return whether a loop goes on for ever, whatever is asked of the node."""
    within = [node for one in loop.body for node in ast.walk(one)]
    if isinstance(loop.test, ast.Constant):
        is_endless = bool(loop.test.value)
    else:
        is_endless = _waits_for_others(source, loop, within)
    if not is_endless:
        return False
    if any(isinstance(node, _LEAVES) for node in within):
        return False
    for function in source.called(loop.body):
        within += ast.walk(function)  # what the loop calls belongs to it
    named = (node for node in within if isinstance(node, (ast.Attribute, ast.Name)))
    return not any(getattr(one, "attr", getattr(one, "id", "")) in _ENDS for one in named)


def _waits_for_others(source: Source, loop: ast.While, within: list[ast.AST]) -> bool:
    """Return whether a loop sleeps until a callback changes what it asks: none is called any more
    once the node is to end."""
    asked = [*ast.walk(loop.test)]
    keys = {source.key(node) for node in asked} - {None}
    given = {
        source.key(node) for node in within if isinstance(getattr(node, "ctx", None), ast.Store)
    }
    calls = [getattr(node.func, "id", "") for node in asked if isinstance(node, ast.Call)]
    sleeps = any(getattr(node, "attr", "") == "sleep" for node in within)
    return bool(keys) and not keys & given and set(calls) <= {"len"} and sleeps


RULE = Rule("stop", 31, ("nodes",), _findings, also=("exit",), only=ANY)
