# SPDX-License-Identifier: BSD-3-Clause
"""What becomes 0 by surprise: 1/2 in C++ (C++17, 8.6), int() of less than 1 in Python."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both

_BELOW_1 = ("random.random", "numpy.random.rand", "numpy.random.random")
_DIVIDED = re.compile(r"(?<![\w.)\]])(\d+)\s*/\s*(\d+)(?![\w.])")
# A parameter that has a point by default, in a variable that has none.
_CUT = re.compile(
    r"\b(?:int|long|unsigned)\s+\w+\s*=\s*\w+(?:\.|->|::)param(?:::param)?\s*(?:<\s*(?:double|float)\s*>)?"
    r'\s*\(\s*"([^"]*)"\s*,\s*(\d*\.\d*[1-9]\d*)f?\s*\)'
)
_TEXT = re.compile(r'"(?:\\.|[^"\\\n])*"|^\s*#.*$', re.MULTILINE)


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        for call in one.python.nodes(ast.Call) if one.python else ():
            inner = call.args[0] if getattr(call.func, "id", "") == "int" and call.args else None
            if isinstance(inner, ast.Call) and one.python:
                if one.python.dotted(inner.func) in _BELOW_1:
                    yield one.finding(
                        "starts",
                        "int() of a random number below 1 is always 0.",
                        call.lineno,
                        expected="random.randint(0, 9)",
                        fix="Take a whole number: random.randint(...).",
                    )
        for match in _CUT.finditer(one.code):
            yield one.finding(
                "starts",
                f"The parameter {match[1]} is a number with a point, and the rest behind it is"
                f" dropped: {match[2]} becomes {int(float(match[2]))}.",
                line_of(match),
                expected=f"double, as {match[2]} is one",
                fix="Write double for int.",
            )
        code = _TEXT.sub(lambda text: " " * len(text[0]), one.code)
        for match in _DIVIDED.finditer(code):
            above, below = int(match[1]), int(match[2])
            if below and above % below:
                yield one.finding(
                    "starts",
                    f"{match[0]} is {above // below} in C++: the rest of a division of whole"
                    " numbers is dropped.",
                    line_of(match),
                    expected=f"{above}.0/{below}",
                    fix=f"Write {above}.0/{below}.",
                )


RULE = Rule("static", 122, ("facts",), _findings, also=("starts",), only=ANY)
