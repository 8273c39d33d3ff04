# SPDX-License-Identifier: BSD-3-Clause
"""What the text of a node shows where it did not run: it counts its arguments; or it asks to be
called back in C++, and never spins."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import NOTE, WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.running.node import Node
from mrp_check.sources import uses

# How a program counts its arguments.
COUNTS = r"\bargc\s*[!<>=]|[<>=]\s*argc\b|\blen\(sys\.argv\)"
_CALLED_BACK = re.compile(r"(?:\.|->)(createTimer|createWallTimer|subscribe|advertiseService)\b")
_SPINS = re.compile(r"[sS]pin|callAvailable|callOne|waitForShutdown")


def _findings(case: Case) -> Iterator[Finding]:
    for name, files in case.facts.sources.items():
        node = case.nodes.get(name)
        yield from _arguments(case, node, files) if node else ()
        texts = uses.cpp_code(case.package, files)
        joined = "\n".join(texts.values())
        if not node or node.is_up or "ros::init" not in joined or _SPINS.search(joined):
            continue
        for file, text in texts.items():
            called = _CALLED_BACK.search(text)
            if called:
                line = line_of(called, 1)
                yield Finding(
                    "spin",
                    f"{name} asks to be called back here, and never spins: nothing calls it.",
                    file,
                    line,
                    WARNING,
                    expected="ros::spin() at the end of main",
                    seen=case.package.line(file, line),
                    fix="Write ros::spin() at the end of main.",
                    node=name,
                )


def _arguments(case: Case, node: Node, files: list[str]) -> Iterator[Finding]:
    """Yield a note if a node counts its arguments. Of one that ran it is seen what it does then."""
    counts = case.package.first_match(files, COUNTS)
    ran = node.direct and (node.direct.asked, node.direct.ended_after) != (None, None)
    if counts and not ran:
        said = f"{node.name} did not run; it waits for arguments on its command line, too."
        yield Finding("starts", said, *counts, severity=NOTE, node=node.name)


RULE = Rule("run", 24, ("nodes",), _findings, also=("spin", "starts"), only=ANY)
