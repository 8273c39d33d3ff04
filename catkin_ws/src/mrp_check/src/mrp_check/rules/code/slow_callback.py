# SPDX-License-Identifier: BSD-3-Clause
"""A callback of a subscriber does something, and soon: while it sleeps, the messages after it wait.

https://wiki.ros.org/roscpp/Overview/Callbacks%20and%20Spinning
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_facts import callbacks
from mrp_check.code.python_source import Source
from mrp_check.confined.cpp_habits import SHORT
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    for node, files in case.facts.sources.items():
        found = [(p.file, p.line, p.function) for p in case.facts.of(node, Kind.BLOCKS)]
        for source in filter(None, map(case.facts.python.get, files)):
            yield from _empty(node, source)
            found += [(source.file, line, name) for line, name in _sleeping(source)]
        for file, line, name in found:
            yield Finding(
                "callbacks",
                f"{name}() sleeps, and a subscriber calls it: messages that arrive meanwhile wait"
                " or get lost.",
                file,
                line,
                HABIT,
                expected="a callback that returns at once",
                seen=case.package.line(file, line),
                fix="Store what the message says, and do the slow work in main's loop or in a"
                " timer.",
                node=node,
            )


def _empty(node: str, source: Source) -> Iterator[Finding]:
    for function in callbacks(source):
        body = getattr(function, "body", [])
        done = [part for part in body if not isinstance(getattr(part, "value", None), ast.Constant)]
        if all(isinstance(part, ast.Pass) for part in done):
            name = getattr(function, "name", "")
            yield Finding(
                "callbacks",
                f"{name}() does nothing with the messages that a subscriber gives it.",
                source.file,
                body[-1].lineno,
                HABIT,
                expected="a callback that uses its message",
                fix="Do something with the message, or remove the subscriber.",
                node=node,
            )


def _sleeping(source: Source) -> Iterator[tuple[int, str]]:
    """Yield (line, callback) of the first sleep() in each callback of a subscriber."""
    for function, within in callbacks(source).items():
        calls = (node for part in within for node in ast.walk(part) if isinstance(node, ast.Call))
        lines = [call.lineno for call in calls if _sleeps(source, call)]
        if lines:
            yield min(lines), getattr(function, "name", "")


def _sleeps(source: Source, call: ast.Call) -> bool:
    """Return whether a call sleeps, for a rate or for at least a tenth of a second."""
    if source.dotted(call.func) in ("rospy.sleep", "time.sleep"):
        seconds = source.value(call.args[0]) if call.args else None
        return not isinstance(seconds, (int, float)) or seconds >= SHORT
    made = source.made(getattr(call.func, "value", call))
    is_rate = made is not None and source.dotted(made.func) == "rospy.Rate"
    return getattr(call.func, "attr", "") == "sleep" and is_rate


RULE = Rule("static", ("facts",), _findings, also=("callbacks",), only=ANY)
