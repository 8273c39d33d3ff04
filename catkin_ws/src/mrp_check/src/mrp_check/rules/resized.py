# SPDX-License-Identifier: BSD-3-Clause
"""C++: push_back() puts a value behind those that resize() has made, which stay 0.

https://en.cppreference.com/w/cpp/container/vector/resize
"""

from __future__ import annotations

import itertools
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both

_RESIZED = re.compile(r"\b((?:\w+(?:\.|->))*\w+)\s*(?:\.|->)\s*resize\s*\(\s*(?!0\s*\))")
# What makes room for what follows, or fills what is there.
_FILLED = (
    r"\b{0}\s*(?:(?:\.|->)\s*(?:clear|assign|erase|pop_back|swap|at|insert|begin|data|front)\b"
    r"|(?:\.|->)\s*resize\s*\(\s*0\s*\)|\[[^;\n]*\]\s*=(?!=)|=(?!=))"
)


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        for match in _RESIZED.finditer(one.code):
            name = re.escape(match[1])
            shape, filled = rf"\b{name}\s*(?:\.|->)\s*push_back\s*\(", _FILLED.format(name)
            put = re.compile(shape).search(one.code, match.end())
            between = one.code[match.end() : put.start()] if put else ""
            if put and not _is_left(between) and not re.search(filled, between):
                said = f"push_back() puts this behind the values that {match[1]}.resize() has made"
                yield one.finding(
                    "callbacks",
                    f"{said}, in line {line_of(match)}: they stay 0.",
                    line_of(put),
                    expected=f"{match[1]}[i] = ..., or reserve() in place of resize()",
                    fix=f"Give values to {match[1]}[0], [1], ...; or write reserve() for resize().",
                )
                break


def _is_left(between: str) -> bool:
    """Return whether the block in which a text begins ends within it."""
    depths = itertools.accumulate({"{": 1, "}": -1}.get(one, 0) for one in between)
    return min(depths, default=0) < 0


RULE = Rule("static", 114, ("facts",), _findings, also=("callbacks",), only=ANY)
