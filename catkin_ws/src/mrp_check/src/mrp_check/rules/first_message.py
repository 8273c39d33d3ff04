# SPDX-License-Identifier: BSD-3-Clause
"""A node that publishes right after it has made its publisher publishes to nobody.

A subscriber needs a moment to connect: https://wiki.ros.org/rospy/Overview/Publishers%20and%20Subscribers
"""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, line_of
from mrp_check.sources import in_both
from mrp_check.sources.python_facts import argument
from mrp_check.sources.python_source import Source

# All that may take a moment, or is done again and again.
_MOMENTS = re.compile(
    r"(?i)sleep|wait|\bwhile\b|spin|getNumSubscribers|\bcin\b|get(line|ch|s)\b|scanf|Timer|usleep"
    r"|\bcall\s*\(|\bvoid\b|\bbool\b|\bclass\b"
)
_MADE = re.compile(r"\b(\w+)\s*=\s*\w+(?:\.|->)advertise\s*(?:<[^;()]*>\s*)?\(([^;]*)\)\s*;")
_FOR = re.compile(r"\bfor\s*\([^{}]*\{")
_WAITS = ("sleep", "wait", "get_num_connections", "input", "spin", "impl", "call")


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        for line in _in_python(one.python) if one.python else _in_cpp(one.code):
            yield one.finding(
                "topic",
                f"{one.node} publishes this at once after it has made its publisher: no subscriber"
                " is connected yet, and nobody hears it.",
                line,
                expected="a wait until somebody is connected; or latch",
                fix=f"Wait first until {_asked(one.python)} is more than 0.",
            )


def _asked(source: Source | None) -> str:
    return "get_num_connections()" if source else "getNumSubscribers()"


def _in_cpp(text: str) -> Iterator[int]:
    """Yield the line of the first publish() after each publisher that is made just before."""
    for made in _MADE.finditer(text):
        name, given = made.groups()
        first = re.compile(rf"\b{name}\s*\.\s*publish\s*\(").search(text, made.end())
        if first and "true" not in given:
            loop = _FOR.search(text, made.end(), first.start())
            within = braced(text, loop.end() - 1) if loop else text[made.end() : first.start()]
            if not _MOMENTS.search(text, made.end(), first.start()) and "sleep" not in within:
                yield line_of(first)


def _in_python(source: Source) -> Iterator[int]:
    """Yield the same of a source in Python."""
    calls = sorted(source.nodes(ast.Call), key=lambda call: (call.lineno, call.col_offset))
    for number, made in enumerate(calls, 1):
        given = source.parents.get(made)
        is_made = source.dotted(made.func) == "rospy.Publisher" and isinstance(given, ast.Assign)
        if is_made and isinstance(given, ast.Assign) and argument(made, 6, "latch") is None:
            key, block = source.key(given.targets[0]), source.parents[given]
            for call in calls[number:]:
                name = getattr(call.func, "attr", getattr(call.func, "id", ""))
                above = [*source.above(call)]
                if block not in above or isinstance(source.function(call), ast.Lambda):
                    continue
                inside = above[: above.index(block)]
                if any(word in name for word in _WAITS) or any(map(_repeats, inside)):
                    break
                if source.definition(call.func) or source.function(call) is not source.function(
                    made
                ):
                    break
                if name == "publish" and source.key(getattr(call.func, "value", call)) == key:
                    yield call.lineno
                    break


def _repeats(one: ast.AST) -> bool:
    """Return whether a loop may publish the message again, a moment later."""
    calls = {getattr(node, "attr", "") for node in ast.walk(one)}
    return isinstance(one, ast.While) or isinstance(one, ast.For) and "sleep" in calls


RULE = Rule("static", ("facts",), _findings, also=("topic",), only=ANY)
