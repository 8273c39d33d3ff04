# SPDX-License-Identifier: BSD-3-Clause
"""Two whole numbers are divided in C++: the rest is dropped, so that 1/2 is 0 (C++17, 8.6)."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both

_DIVIDED = re.compile(r"(?<![\w.)\]])(\d+)\s*/\s*(\d+)(?![\w.])")
_TEXT = re.compile(r'"(?:\\.|[^"\\\n])*"|^\s*#.*$', re.MULTILINE)


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
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
