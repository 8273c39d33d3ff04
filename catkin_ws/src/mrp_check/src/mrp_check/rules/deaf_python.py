# SPDX-License-Identifier: BSD-3-Clause
"""A loop of a Python node that did not run asks rospy.is_shutdown(), or does what rospy ends.

rospy's handler of SIGINT keeps KeyboardInterrupt back: a loop that only computes, waits for the
keyboard or calls time.sleep() goes on. What it does on Ctrl-C is seen of a node that runs.
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
_ENDS = "_exit exit is_shutdown kill publish quit signal_shutdown sleep spin wait_for_message".split()


def _findings(case: Case) -> Iterator[Finding]:
    for name, files in case.facts.sources.items():
        node = case.nodes.get(name)
        for source in filter(None, map(case.facts.python.get, files)):
            if node and not node.is_up and _is_rospys(source):
                for loop in source.nodes(ast.While):
                    if _is_deaf(source, loop):
                        yield Finding(
                            "exit",
                            "This loop never ends: it does not ask rospy.is_shutdown(), so Ctrl-C"
                            " does not end the node.",
                            source.file,
                            loop.lineno,
                            WARNING,
                            expected="while not rospy.is_shutdown():",
                            seen=case.package.lines(source.file)[loop.lineno - 1].strip(),
                            fix="Write while not rospy.is_shutdown():.",
                            node=name,
                        )


def _is_rospys(source: Source) -> bool:
    """Return whether rospy handles the signals of a program."""
    calls = [c for c in source.nodes(ast.Call) if source.dotted(c.func) == "rospy.init_node"]
    return bool(calls) and not any(k.arg == "disable_signals" for c in calls for k in c.keywords)


def _is_deaf(source: Source, loop: ast.While) -> bool:
    if not isinstance(loop.test, ast.Constant) or not loop.test.value:
        return False
    within = [node for one in loop.body for node in ast.walk(one)]
    for node in within:  # it grows: what the loop calls belongs to it
        if isinstance(node, ast.Call):
            function = source.definition(node.func)
            if isinstance(function, ast.FunctionDef) and function not in within:
                within += [function, *(n for n in ast.walk(function) if not isinstance(n, _LEAVES))]
    if any(isinstance(node, _LEAVES) for node in within):
        return False
    named = (node for node in within if isinstance(node, (ast.Attribute, ast.Name)))
    return not any(
        (getattr(node, "attr", None) or getattr(node, "id", "")) in _ENDS
        and source.dotted(node) != "time.sleep"
        for node in named
    )


RULE = Rule("stop", 31, ("nodes",), _findings, also=("exit",), only=ANY)
