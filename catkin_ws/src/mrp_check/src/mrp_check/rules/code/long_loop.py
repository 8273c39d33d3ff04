# SPDX-License-Identifier: BSD-3-Clause
"""A loop that counts, and sleeps for long in all, asks whether the node is to end.

Neither ros::Rate and rospy.Rate nor sleep() stop at Ctrl-C, unless time is simulated.
"""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code import in_both
from mrp_check.code.python_callbacks import in_threads
from mrp_check.code.python_source import Source
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, line_of

GOES_ON = "after Ctrl-C it goes on to its end"
_COUNTS = re.compile(
    r"\bfor\s*\(\s*(?:\w+\s+)*(\w+)\s*=\s*(\d+)\s*;\s*\1\s*<=?\s*(\d+)\s*;[^;{}]*(?=\{)"
)
_SLEEPS = re.compile(r"\bDuration\s*\(\s*(\d*\.?\d+)\s*\)\.sleep|(?<![.\w])sleep\s*\(\s*(\d+)\s*\)")
_BY_RATE = re.compile(r"\b(\w+)\.sleep\s*\(\s*\)")
_ASKS = re.compile(r"\bok\s*\(|\bisShuttingDown\b|\bbreak\b|\breturn\b|\bexit\s*\(")


def _findings(case: Case) -> Iterator[Finding]:
    limit = case.spec.shutdown.seconds
    for one in in_both.each(case):
        asked = "rospy.is_shutdown()" if one.python else "ros::ok()"
        for line, seconds in _in_python(one.python) if one.python else _in_cpp(one.code):
            if seconds > limit:
                yield one.finding(
                    "exit",
                    f"This loop does not ask {asked}: {GOES_ON}, which takes up to"
                    f" {seconds:.0f} s.",
                    line,
                    expected=f"{asked} in the loop",
                    fix=f"Ask {asked} in each turn, and leave the loop then.",
                )


def _in_cpp(text: str) -> Iterator[tuple[int, float]]:
    """Yield (line, seconds) of each loop that counts to a number, and sleeps in each turn."""
    for loop in _COUNTS.finditer(text):
        block = braced(text, loop.end())
        if not _ASKS.search(loop[0] + block):
            turns = int(loop[3]) - int(loop[2])
            yield line_of(loop), turns * _pause_in_cpp(text, block)


def _pause_in_cpp(text: str, block: str) -> float:
    """Return the seconds that a block sleeps."""
    plain = sum(float(one[1] or one[2]) for one in _SLEEPS.finditer(block))
    for rate in _BY_RATE.finditer(block):
        made = re.search(rf"\bRate\s+{rate[1]}\s*\(\s*(\d*\.?\d+)\s*\)", text)
        if made and float(made[1]):
            plain += 1 / float(made[1])
    return plain


def _in_python(source: Source) -> Iterator[tuple[int, float]]:
    """Yield the same of a source in Python."""
    let_off = in_threads(source)
    for loop in source.nodes(ast.For):
        if source.function(loop) in let_off:
            continue
        names = {getattr(n, "attr", getattr(n, "id", "")) for n in ast.walk(loop)}
        leaves = any(isinstance(n, (ast.Break, ast.Return, ast.Raise)) for n in ast.walk(loop))
        call = loop.iter
        if not isinstance(call, ast.Call) or getattr(call.func, "id", "") != "range":
            continue
        numbers = [source.value(one) for one in call.args]
        turns = numbers[-1] if len(numbers) == 1 else None
        if isinstance(turns, int) and not leaves and "is_shutdown" not in names:
            yield loop.lineno, turns * sum(_pauses(source, loop))


def _pauses(source: Source, loop: ast.For) -> Iterator[float]:
    for call in ast.walk(loop):
        if isinstance(call, ast.Call) and getattr(call.func, "attr", "") == "sleep":
            value = source.value(call.args[0]) if call.args else None
            made = source.stored(source.key(getattr(call.func, "value", call)))
            if isinstance(value, (int, float)):
                yield value
            elif len(made) == 1 and isinstance(made[0], ast.Call) and made[0].args:
                if source.dotted(made[0].func) == "rospy.Rate":
                    rate = source.value(made[0].args[0])
                    yield 1 / rate if isinstance(rate, (int, float)) and rate else 0.0


RULE = Rule("static", ("facts",), _findings, also=("exit",), only=ANY)
