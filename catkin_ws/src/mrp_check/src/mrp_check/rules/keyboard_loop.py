# SPDX-License-Identifier: BSD-3-Clause
"""A C++ loop that reads the keyboard asks ros::ok(), too: Ctrl-C alone does not end the reading.

roscpp's handler of SIGINT asks the node to shut down, and the system then goes on with read():
https://wiki.ros.org/roscpp/Overview/Initialization%20and%20Shutdown
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import uses

ASKS_KEYBOARD = "This loop only asks the keyboard"
_LOOP = re.compile(
    r"\bwhile\s*\((?P<asked>[^;{}]*(?:\bcin\b\s*>>|\bgetline\s*\(\s*(?:std::)?cin\b)[^;{}]*)\)"
)
# Whoever has a handler of one's own may end otherwise.
_ASKS = re.compile(r"\b(?:ok|isShuttingDown|isStarted|sigaction|signal)\s*\(")


def _findings(case: Case) -> Iterator[Finding]:
    for name, files in case.facts.sources.items():
        texts = {f: uses.code(case.package, f) for f in files if case.package.kind(f) == "cpp"}
        joined = "\n".join(texts.values())
        if "ros::init" not in joined or _ASKS.search(joined):
            continue
        for file, text in texts.items():
            for match in _LOOP.finditer(text):
                line = line_of(match)
                yield Finding(
                    "exit",
                    f"{ASKS_KEYBOARD}: Ctrl-C does not end the node, which still waits for what is"
                    " typed.",
                    file,
                    line,
                    expected="a loop that asks ros::ok() as well",
                    seen=case.package.lines(file)[line - 1].strip(),
                    fix=f"Write while (ros::ok() && {match['asked'].strip()}), and end the node by"
                    " Ctrl-C and then Enter.",
                    node=name,
                )


RULE = Rule("static", 52, ("facts",), _findings, also=("exit",), only=ANY)
