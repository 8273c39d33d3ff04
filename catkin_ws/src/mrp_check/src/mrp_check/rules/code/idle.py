# SPDX-License-Identifier: BSD-3-Clause
"""A callback of a subscriber does something, and soon: while it sleeps, the messages after it wait.

https://wiki.ros.org/roscpp/Overview/Callbacks%20and%20Spinning
"""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code import in_both
from mrp_check.code.in_both import OfNode
from mrp_check.code.python_callbacks import callbacks
from mrp_check.code.python_source import Source
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, line_of

_HEARS = re.compile(r"\bsubscribe\s*(?:<[^;()]*>)?\s*\(([^;]*);")
_SLEEPS = re.compile(r"(?<!::)\b(?:u|nano)?sleep\s*\(")
_SEVERAL = re.compile(r"\b(?:AsyncSpinner|MultiThreadedSpinner)\b")  # threads: others go on
_SLEEP = {"rospy.sleep", "time.sleep"}


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        if one.python:
            yield from _empty(one, one.python)
        for line, name in _in_python(one.python) if one.python else _in_cpp(one.code):
            yield one.finding(
                "callbacks",
                f"{name}() sleeps, and a subscriber calls it: the messages that come in the"
                " meantime wait, or are lost.",
                line,
                expected="a callback that returns at once",
                fix="Keep what the message says, and do what takes time in the loop of main, or"
                " in a timer.",
            )


def _empty(one: OfNode, source: Source) -> Iterator[Finding]:
    for function in callbacks(source):
        body = getattr(function, "body", [])
        said = [part for part in body if not isinstance(getattr(part, "value", None), ast.Constant)]
        if all(isinstance(part, ast.Pass) for part in said):
            name = getattr(function, "name", "")
            yield one.finding(
                "callbacks",
                f"{name}() does nothing with the messages that a subscriber gives it.",
                body[-1].lineno,
                expected="a callback that uses its message",
                fix="Write what is to be done with a message; or take the subscriber out.",
            )


def _in_python(source: Source) -> Iterator[tuple[int, str]]:
    """Yield (line, callback) of the first sleep() in each callback of a subscriber."""
    for function in callbacks(source):
        within = [function, *source.called([function])]
        for call in (node for part in within for node in ast.walk(part)):
            if isinstance(call, ast.Call) and _sleeps(source, call):
                yield call.lineno, getattr(function, "name", "")
                break


def _sleeps(source: Source, call: ast.Call) -> bool:
    """Return whether a call sleeps, for a rate or for at least a tenth of a second."""
    if source.dotted(call.func) in _SLEEP:
        seconds = source.value(call.args[0]) if call.args else None
        return not isinstance(seconds, (int, float)) or seconds >= 0.1
    made = source.made(getattr(call.func, "value", call))
    is_rate = made is not None and source.dotted(made.func) == "rospy.Rate"
    return getattr(call.func, "attr", "") == "sleep" and is_rate


def _in_cpp(text: str) -> Iterator[tuple[int, str]]:
    """Yield the same of a source in C++."""
    if _SEVERAL.search(text):
        return
    given = {name for call in _HEARS.findall(text) for name in re.findall(r"\b[A-Za-z_]\w*", call)}
    for name in sorted(given):
        for head in re.finditer(rf"\b{name}\s*\([^;{{}}()]*\)\s*(?:const\s*)?(?=\{{)", text):
            end = head.end() + len(braced(text, head.end()))
            slept = _SLEEPS.search(text, head.end(), end)
            if slept:
                yield line_of(slept), name


RULE = Rule("static", ("facts",), _findings, also=("callbacks",), only=ANY)
