# SPDX-License-Identifier: BSD-3-Clause
"""No two programs of one language call themselves the same: the second one ends the first.

A talker in Python and one in C++ are two ways of writing one node.
"""

from __future__ import annotations

from typing import Iterator

from mrp_check.case import Case
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule


def _findings(case: Case) -> Iterator[Finding]:
    named: dict[tuple[str, str], dict[str, Place]] = {}
    for node in case.facts.sources:
        for place in case.facts.of(node, Kind.INIT)[:1]:
            if place.text and place.anonymous is not True:
                key = place.text, case.package.kind(place.file)
                named.setdefault(key, {})[node] = place
    for (name, _), places in named.items():
        first, *others = places
        for node in others:
            place = places[node]
            if place.file != places[first].file:
                yield Finding(
                    "starts",
                    f"{node} calls itself {name}, and so does {first}: where both run under their"
                    " own names, the second one ends the first.",
                    place.file,
                    place.line,
                    WARNING,
                    expected="a name that no other node has",
                    seen=case.package.line(place.file, place.line),
                    fix="Give it a name of its own.",
                    node=node,
                )


RULE = Rule("static", 95, ("facts",), _findings, also=("starts",), only=ANY)
