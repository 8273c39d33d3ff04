# SPDX-License-Identifier: BSD-3-Clause
"""A node's loop pauses: by a rate, a sleep, or whatever else waits."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import WARNING, Finding, Line
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources import uses

# The head of a loop that goes on until Ctrl-C.
_ENDLESS = re.compile(r"\bwhile\b.*(\bok\s*\(\s*\)|is_shutdown|\(\s*(true|1)\s*\)|\bTrue\b|\b1:)")
# All that may wait, in this source or in a library. A name that looks like it is believed.
_WAITS = re.compile(
    r"(?i)sleep|\bspin\s*\(|wait|join|input|\bcin\b|get(line|ch|s)\b|scanf|\bf?(read|gets)"
    r"|recv|accept|select|poll|imshow|callOne|callAvailable|call\s*\(|>>|queue\."
)

_ASKS = "is_shutdown"  # of rospy
_TEXT = re.compile(r"\"[^\"\n]*\"|'[^'\n]*'")


def _findings(case: Case) -> Iterator[Finding]:
    for node in case.facts.sources:
        loop = loop_of(case, node)
        if loop:
            yield _finding(case, node, *loop)


def loop_of(case: Case, node: str) -> Line | None:
    """Return the place of the loop of a node that never pauses, or None."""
    files = case.facts.sources.get(node, [])
    codes = {file: uses.code(case.package, file) for file in files}
    loops = [(p.file, p.line) for p in case.facts.of(node, Kind.LOOP) if p.file in codes]
    # A source of C++ that nothing could read further has its loops all the same.
    loops += [(file, n) for file in case.facts.unread & {*files} for n in _lines(codes[file])]
    endless = [one for one in loops if _ENDLESS.search(_line(codes[one[0]], one[1]))]
    waits = _WAITS.search(_TEXT.sub('""', "\n".join(codes.values())))
    return None if case.facts.of(node, Kind.SLEEP) or waits else next(iter(endless), None)


def may_wait_for_itself(case: Case, node: str) -> bool:
    """Return whether it is chance that Ctrl-C ends a node: rospy's handler of it waits for a lock
    that the loop, which logs or publishes without a pause, holds most of the time."""
    loop = loop_of(case, node)
    return loop is not None and _ASKS in case.package.line(*loop)


def _lines(code: str) -> range:
    return range(1, code.count("\n") + 1)


def _line(code: str, number: int) -> str:
    return code.split("\n")[number - 1]


def _finding(case: Case, node: str, file: str, line: int) -> Finding:
    package = case.package
    rate = "rospy.Rate" if package.kind(file) == "python" else "ros::Rate"
    below = "\n".join(uses.code(package, file).split("\n")[line:])
    fast = ", and publishes as fast as it can" if "publish" in below else ""
    late = "; Ctrl-C may not end it" if fast and _ASKS in package.line(file, line) else ""
    return Finding(
        "spin",
        f"The loop never pauses: it keeps a processor busy{fast}{late}.",
        file,
        line,
        WARNING,
        expected=f"a {rate}, whose sleep() is called in the loop",
        seen=package.line(file, line),
        fix=f"Make a {rate} before the loop, and call its sleep() at the end of it.",
        node=node,
    )


RULE = Rule("static", 51, ("facts",), _findings, also=("spin",), only=ANY)
