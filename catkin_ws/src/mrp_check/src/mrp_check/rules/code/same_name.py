# SPDX-License-Identifier: BSD-3-Clause
"""No two programs call themselves the same: the second one ends the first.

A talker in Python and one in C++ are two ways of writing one node: of them it is a note.
"""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    named: dict[str, dict[str, Place]] = {}
    for node in case.facts.sources:
        for place in case.facts.of(node, Kind.INIT)[:1]:
            if place.text and place.anonymous is not True:
                named.setdefault(place.text, {})[node] = place
    for name, places in named.items():
        first, *others = places
        kinds = {node: case.package.kind(place.file) for node, place in places.items()}
        for node in others:
            place = places[node]
            is_twin = [*kinds.values()].count(kinds[node]) == 1
            if place.file != places[first].file:
                yield Finding(
                    "starts",
                    f"{node} calls itself {name}, and so does {first}: if both run under their own"
                    " names, the second one ends the first.",
                    place.file,
                    place.line,
                    HINT if is_twin else HABIT,
                    expected="a name that no other node has",
                    seen=case.package.line(place.file, place.line),
                    fix="Give it a name of its own.",
                    node=node,
                )


RULE = Rule("static", ("facts",), _findings, also=("starts",), only=ANY)
