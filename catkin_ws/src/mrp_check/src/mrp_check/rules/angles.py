# SPDX-License-Identifier: BSD-3-Clause
"""The difference of two angles is brought back to half a turn to each side.

atan2() gives -pi..pi. The difference of two such angles may be nearly two pi: the robot then turns
the long way round. https://docs.ros.org/en/noetic/api/angles/html/
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both, uses

_PI = r"(?:math\.|np\.|std::|numpy\.)?(?:M_)?[pP][iI]\b"
# A source that has one of these brings an angle back.
_BACK = re.compile(
    rf"normali[sz]e|shortest|remainder|fmod|wrap|2(?:\.0)?\s*\*\s*{_PI}|%\s*\(|[<>]=?\s*-?\s*{_PI}"
    r"|atan2\s*\(\s*(?:math\.|np\.|std::)?sin"
)
_ATAN2 = r"(?:std::|math\.|np\.)?\batan2\s*\("
# What such an angle is called: a variable, or a function that gives it.
_NAMED = re.compile(
    rf"(?P<variable>[\w.]+)\s*=\s*{_ATAN2}"
    rf"|def (?P<function>\w+)[^\n]*\n(?:[^\n]*\n){{0,3}}?\s*return {_ATAN2}"
)
_HEADING = r"\s*-\s*[\w.>-]*(?:theta|yaw|angle|phi|heading)\w*"


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        text = one.code or uses.code(case.package, one.file)
        if "atan2" not in text or _BACK.search(text):
            continue
        names = [re.escape(m["variable"] or m["function"]) for m in _NAMED.finditer(text)]
        angle = "|".join([r"atan2\s*\([^;\n]*\)", *(rf"\b{name}" for name in names)])
        found = re.search(rf"(?:{angle})(?:\([^()\n]*\))?{_HEADING}", text)
        if found:
            yield one.finding(
                "callbacks",
                "The difference of two angles may be nearly two pi: the robot then turns the long"
                " way round.",
                line_of(found),
                expected="a difference from -pi to pi",
                fix="Bring it back: atan2(sin(d), cos(d)), or angles::normalize_angle(d) in C++.",
            )


RULE = Rule("static", 115, ("facts",), _findings, also=("callbacks",), only=ANY)
