# SPDX-License-Identifier: BSD-3-Clause
"""What ends the goals of an action server is called, is the server's own, and gives a result.

A goal that nothing ends stays active: its client waits for ever.
https://wiki.ros.org/actionlib/DetailedDescription
"""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both, uses
from mrp_check.sources.in_both import OfNode
from mrp_check.sources.python_facts import argument
from mrp_check.sources.python_source import Source, Variable
from mrp_check.student.package import Package

_PYTHON_ENDS = ("set_succeeded", "set_aborted", "set_preempted")
_CPP_ENDS = re.compile(r"(?:\.|->)\s*set(?:Succeeded|Aborted)\s*\(")
# A function that is defined: its name is group 1.
_FUNCTION = re.compile(r"\bvoid\s+(?:\w+::)*(\w+)\s*\([^;{}]*\)\s*(?=\{)")
_SUCCEEDS = re.compile(r"\b(?:setSucceeded|set_succeeded)\s*\(\s*\)")
_FIELD = re.compile(r"^\s*[\w/]+(?:\[\d*\])?\s+(\w+)\s*(?:#|$)", re.MULTILINE)
_SERVER = "SimpleActionServer"


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        text = case.package.text(one.file)
        if _SERVER not in text:
            continue
        if one.python:
            yield from _of_others(one, one.python)
        yield from _without_result(one, text)
        ends = _in_python(one.python) if one.python else _in_cpp(one.code)
        if ends and all(name and not _is_used(case.package, name) for _, name in ends):
            line, name = ends[0]
            call = re.search(rf"(?<!void )(?<!def )(?<!::)\b{name}\s*\(", text)
            line = line_of(call) if call else line  # somebody has made a comment of the call
            yield one.finding(
                "callbacks",
                f"Only {name}() ends a goal, and nothing calls it: the goal goes on for ever, and"
                " its client waits.",
                line,
                expected=f"a call of {name}()",
                fix=f"Call {name}() when the goal is reached.",
            )


def _without_result(one: OfNode, text: str) -> Iterator[Finding]:
    """Yield a finding if a goal succeeds, and nobody says with which result."""
    results = [one.package.text(file).split("---")[1:2] for file in one.package.of_kind("action")]
    fields = [_FIELD.findall(result[0]) if result else [] for result in results]
    end = _SUCCEEDS.search(one.code or uses.code(one.package, one.file))
    if end and fields and all(fields):
        yield one.finding(
            "callbacks",
            "The goal succeeds without a result: its client gets one of nothing but zeros.",
            line_of(end),
            expected=f"a result with {', '.join(fields[0])}",
            fix="Fill a result, and hand it over here.",
        )


def _in_python(source: Source) -> list[tuple[int, str]]:
    """Return (line, function around it, if any) of each call that ends a goal by itself."""
    calls = [c for c in source.nodes(ast.Call) if getattr(c.func, "attr", "") in _PYTHON_ENDS[:2]]
    return [(call.lineno, getattr(source.function(call), "name", "")) for call in calls]


def _in_cpp(code: str) -> list[tuple[int, str]]:
    """Return the same of a source in C++."""
    return [
        (line_of(end), functions[-1][1] if (functions := [*_around(code, end.start())]) else "")
        for end in _CPP_ENDS.finditer(code)
    ]


def _around(code: str, place: int) -> Iterator[re.Match[str]]:
    """Yield the function in which a place stands, if it returns nothing."""
    for match in _FUNCTION.finditer(code, 0, place):
        if code.count("{", match.end(), place) > code.count("}", match.end(), place):
            yield match


def _is_used(package: Package, name: str) -> bool:
    """Return whether the sources name a function, other than where they define it."""
    texts = [uses.code(package, file) for file in package.of_kind("cpp", "header", "python")]
    own = rf"(?:\bvoid\s+(?:\w+::)*|\bdef\s+){name}\b"
    return any(len(re.findall(rf"\b{name}\b", t)) > len(re.findall(own, t)) for t in texts)


def _of_others(one: OfNode, source: Source) -> Iterator[Finding]:
    """Yield a finding about each server whose callback ends the goals of other servers alone."""
    servers: dict[Variable, ast.Call] = {}
    for call in source.nodes(ast.Call):
        above = source.parents[call]
        is_one = (source.dotted(call.func) or "").endswith(f".{_SERVER}")
        if is_one and isinstance(above, ast.Assign) and source.key(above.targets[0]):
            servers[source.key(above.targets[0])] = call  # type: ignore[index]
    for key, call in servers.items():
        given = argument(call, 2, "execute_cb")
        work = source.definition(given)
        ended = {
            source.key(node.value)
            for node in ast.walk(work or ast.Pass())
            if isinstance(node, ast.Attribute) and node.attr in _PYTHON_ENDS
        }
        if given and ended and ended <= {*servers} - {key}:
            name = getattr(work, "name", "this")
            yield one.finding(
                "callbacks",
                f"{name}() does the work of this server, and ends the goals of another one: no goal"
                " of this server succeeds.",
                given.lineno,
                expected=f"a callback that ends the goals of {key[1]}",
                fix="Give this server a callback of its own.",
            )


RULE = Rule("static", 113, ("facts",), _findings, also=("callbacks",), only=ANY)
