# SPDX-License-Identifier: BSD-3-Clause
"""Of several conditions, each can be met: one that an earlier one asked for already never is."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, line_of
from mrp_check.sources import in_both
from mrp_check.sources.python_source import Source

_IF = re.compile(r"(?<!\belse )\bif\s*(?=\()")
_ELSE_IF = re.compile(r"\}?\s*else\s+if\s*(?=\()")
_CALLS = re.compile(r"\w\s*\(|\+\+|--|[^=!<>]=[^=]")  # it may be another value the second time


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        for first, line in _in_python(one.python) if one.python else _in_cpp(one.code):
            yield one.finding(
                "callbacks",
                f"This asks the same as line {first}: what stands here is never done.",
                line,
                expected="a condition that no earlier one has",
                fix="Ask for something else, or take the branch out.",
            )


def _in_cpp(text: str) -> Iterator[tuple[int, int]]:
    """Yield (line of the first, line) of each condition of a chain that stands there twice."""
    for begin in _IF.finditer(text):
        known: dict[str, int] = {}
        part: re.Match[str] | None = begin
        while part:
            condition = braced(text, part.end(), "()")
            words, line = " ".join(condition.split()), line_of(part) + part[0].count("\n")
            if words in known and not _CALLS.search(words):
                yield known[words], line
            known.setdefault(words, line)
            block = re.compile(r"\)\s*(?=\{)").match(text, part.end() + len(condition))
            end = block.end() + len(braced(text, block.end())) if block else len(text)
            part = _ELSE_IF.match(text, end)


def _in_python(source: Source) -> Iterator[tuple[int, int]]:
    for one in source.nodes(ast.If):
        above = source.parents.get(one)
        if isinstance(above, ast.If) and above.orelse == [one]:
            continue
        known: dict[str, int] = {}
        part: ast.stmt | None = one
        while isinstance(part, ast.If):
            words, test = ast.dump(part.test), part.test
            if words in known and not any(isinstance(n, ast.Call) for n in ast.walk(test)):
                yield known[words], test.lineno
            known.setdefault(words, test.lineno)
            part = part.orelse[0] if len(part.orelse) == 1 else None


RULE = Rule("static", 120, ("facts",), _findings, also=("callbacks",), only=ANY)
