# SPDX-License-Identifier: BSD-3-Clause
"""C++: a publisher comes from advertise(); publish() of any other ends the program.

https://github.com/ros/ros_comm/blob/noetic-devel/clients/roscpp/include/ros/publisher.h asserts it.
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import uses

_DECLARED = re.compile(r"\bros::Publisher\s+(\w+(?:\s*,\s*\w+)*)\s*;")


def _findings(case: Case) -> Iterator[Finding]:
    texts = {f: uses.code(case.package, f) for f in case.package.of_kind("cpp", "header")}
    everything = "\n".join(texts.values())
    for match in _DECLARED.finditer(everything):
        for name in re.split(r"\s*,\s*", match[1]):
            # What may make it one that works: an initialiser among it.
            gives = (
                rf"\b{name}\s*=(?!=)|&\s*{name}\b|(?<![\w>]\s)\b{name}\s*[({{]"
                rf"|[(,]\s*(?:this->)?{name}\s*[,)]|(?:\.|->){name}\b\s*[^.\s-]"
            )
            if not re.search(gives, everything):
                yield from _of(case, name, texts)


def _of(case: Case, name: str, texts: dict[str, str]) -> Iterator[Finding]:
    for node, files in case.facts.sources.items():
        for file in files:
            call = re.search(rf"\b{name}\s*(?:\.|->)\s*publish\s*\(", texts.get(file, ""))
            if call:
                line = line_of(call)
                yield Finding(
                    "lifetime",
                    f"Nothing makes {name} a publisher of a topic: this call ends the program.",
                    file,
                    line,
                    expected=f"{name} = n.advertise<TYPE>(TOPIC, 10)",
                    seen=case.package.line(file, line),
                    fix=f"Give {name} what advertise() returns, before it publishes.",
                    node=node,
                )


RULE = Rule("static", 103, ("facts",), _findings, also=("lifetime",), only=ANY)
