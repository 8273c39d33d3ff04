# SPDX-License-Identifier: BSD-3-Clause
"""A loop pauses in each turn: in those in which something fails, and in all others."""

from __future__ import annotations

import ast
import re
from typing import Iterable, Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both
from mrp_check.sources.python_source import Source

# What waits, or may: a name that looks like it is believed.
_WAITS = re.compile(r"(?i)sleep|wait|spin|input|recv|accept|select|poll|read|get_?key|join|call")
_CAUGHT = re.compile(r"\bcatch\s*\([^)]*\)\s*\{([^{}]*)\bcontinue\s*;\s*\}")
_RATE = re.compile(r"\bros::(?:Wall)?Rate\s+\w+\s*[({]\s*(\d+(?:\.\d*)?)\s*[)}]")
_TOO_FAST = 10_000  # turns in a second
_AT_FAULT = "goes on at once, past the pause in line {0}: until it works, the loop never pauses"
_IN_A_CASE = "pauses in a condition alone, in line {0}: where it does not hold, it never pauses"
_AT_REST = "pauses in line {0} alone, where something has failed: otherwise it never pauses"


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        places = _in_python(one.python) if one.python else _in_cpp(one.code)
        for line, text in [*places][:1]:
            yield one.finding(
                "spin",
                f"The loop {text}, and keeps a processor busy.",
                line,
                expected="a sleep() in each turn",
                fix="Let the loop sleep here, too.",
            )
        for line, rate in _hurried(one):
            yield one.finding(
                "spin",
                f"No loop comes to {rate:.0f} turns in a second: its sleep() returns at once, and"
                " it keeps a processor busy.",
                line,
                expected="a rate such as rospy.Rate(10) or ros::Rate(10)",
                fix="Write the rate that the robot needs.",
            )


def _hurried(one: in_both.OfNode) -> Iterator[tuple[int, float]]:
    """Yield the line and the number of each rate that no loop comes to."""
    rates = [(line_of(made), float(made[1])) for made in _RATE.finditer(one.code)]
    for call in one.python.nodes(ast.Call) if one.python else ():
        rate = one.python.value(call.args[0]) if one.python and call.args else None
        if isinstance(rate, (int, float)) and _name(call.func) == "Rate":
            rates.append((call.lineno, rate))
    yield from ((line, rate) for line, rate in rates if rate >= _TOO_FAST)


def _in_cpp(text: str) -> Iterator[tuple[int, str]]:
    for caught in _CAUGHT.finditer(text):
        pause = re.compile(r"\bsleep\s*\(").search(text, caught.end())
        before = text[text.rfind("try", 0, caught.start()) : caught.end()]
        if pause and not _WAITS.search(before) and "Duration" not in before:
            yield line_of(caught, 0), _AT_FAULT.format(line_of(pause))


def _in_python(source: Source) -> Iterator[tuple[int, str]]:
    for loop in source.nodes(ast.While):
        for number, one in enumerate(loop.body):
            if isinstance(one, ast.Try):
                pause = next(_waits(loop.body[number + 1 :]), None)
                for handler in one.handlers if pause and not any(_waits(one.body)) else ():
                    last = handler.body[-1]
                    if isinstance(last, ast.Continue) and not any(_waits(handler.body)):
                        yield last.lineno, _AT_FAULT.format(pause.lineno if pause else 0)
        handlers = [node for node in ast.walk(loop) if isinstance(node, ast.ExceptHandler)]
        late = [*_waits(handlers)]
        sleeps = [call.lineno for call in _waits([loop]) if "sleep" in _name(call.func)]
        if sleeps and not late and _is_endless(loop) and not _pauses(source, loop.body):
            yield loop.lineno, _IN_A_CASE.format(min(sleeps))
        if late and _is_endless(loop) and len([*_waits([loop])]) == len(late):
            yield loop.lineno, _AT_REST.format(late[0].lineno)


def _pauses(source: Source, parts: list[ast.stmt]) -> bool:
    """Return whether some statements wait, whatever the conditions among them are."""
    for one in parts:
        # What the source's own functions do belongs to it; where it goes on is too much for this.
        within = [one.test] if isinstance(one, ast.If) else [one]
        called = {
            _name(n.func) for part in within for n in ast.walk(part) if isinstance(n, ast.Call)
        }
        own = (n for n in source.nodes(ast.FunctionDef) if n.name in called)
        if any(_waits([*within, *own])) and not _is_of_film(one):
            return True
        if isinstance(one, ast.If):
            if any(isinstance(node, ast.Continue) for node in ast.walk(one)):
                return True
            if _pauses(source, one.body) and _pauses(source, one.orelse):
                return True
    return False


def _is_of_film(one: ast.stmt) -> bool:
    """Return whether a statement is `ok, picture = video.read()`, which waits for a camera, and
    not at the end of a film."""
    of_two = isinstance(one, ast.Assign) and isinstance(one.targets[0], ast.Tuple)
    value = getattr(one, "value", None)
    return of_two and isinstance(value, ast.Call) and _name(value.func) == "read"


def _is_endless(loop: ast.While) -> bool:
    """Return whether a loop goes on until the node ends."""
    leaves = any(isinstance(node, (ast.Break, ast.Return)) for node in ast.walk(loop))
    asks = {_name(node) for node in ast.walk(loop.test) if isinstance(node, ast.expr)}
    return not leaves and (isinstance(loop.test, ast.Constant) or "is_shutdown" in asks)


def _waits(parts: Iterable[ast.AST]) -> Iterator[ast.Call]:
    """Yield the calls that may wait: by their names, or as they are given a time."""
    for call in (one for part in parts for one in ast.walk(part) if isinstance(one, ast.Call)):
        words = [keyword.arg or "" for keyword in call.keywords] + [_name(call.func)]
        words += [_name(one.func) for one in call.args if isinstance(one, ast.Call)]
        if any(_WAITS.search(word) or word in ("timeout", "Duration") for word in words):
            yield call


def _name(function: ast.expr) -> str:
    return getattr(function, "attr", getattr(function, "id", ""))


RULE = Rule("static", 119, ("facts",), _findings, also=("spin",), only=ANY)
