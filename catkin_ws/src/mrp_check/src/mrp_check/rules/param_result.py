# SPDX-License-Identifier: BSD-3-Clause
"""C++: what getParam() returns says whether there is such a parameter; its value is not that.

https://docs.ros.org/en/noetic/api/roscpp/html/classros_1_1NodeHandle.html
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both

_GIVEN = re.compile(
    r"\b(?P<name>\w+)\s*=\s*[\w:.>-]*\bgetParam(?:Cached)?\s*\([^;(),]+,\s*(?P=name)\s*\)"
)


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        for match in _GIVEN.finditer(one.code):
            yield one.finding(
                "starts",
                f"getParam() puts the value into {match['name']}, and then {match['name']} is given"
                " what it returns: 1, or 0 where there is no such parameter.",
                line_of(match, "name"),
                expected=f"getParam(..., {match['name']}) alone, or in an if",
                fix=f"Take '{match['name']} =' out.",
            )


RULE = Rule("static", 108, ("facts",), _findings, also=("starts",), only=ANY)
