# SPDX-License-Identifier: BSD-3-Clause
"""The topics at which a package's own nodes meet, and its services, follow the group of a node.

https://wiki.ros.org/Names says which names are global.
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import WARNING, Finding, Line
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.running.traces import ROS_TOPICS
from mrp_check.sources import asked, uses

_ENDS = (Kind.PUBLISHER, Kind.SUBSCRIBER)
# The same in a source in C++ that could not be read, for want of a header.
_SHAPES = {
    Kind.PUBLISHER: re.compile(r'\badvertise\s*<[^;()]*>\s*\(\s*"(/\w[^"]*)"'),
    Kind.SUBSCRIBER: re.compile(r'\bsubscribe\s*(?:<[^;()]*>\s*)?\(\s*"(/\w[^"]*)"'),
}


def _findings(case: Case) -> Iterator[Finding]:
    named: dict[object, dict[str, list[Line]]] = {key: {} for key in (*_ENDS, "offers")}
    for node, files in case.facts.sources.items():
        for place in case.facts.of(node, *_ENDS):
            if place.text and place.text.startswith("/") and place.text not in ROS_TOPICS:
                named[place.kind].setdefault(place.text, []).append((place.file, place.line))
        for kind, match, file in _unread(case, files):
            named[kind].setdefault(match[1], []).append((file, line_of(match, 1)))
        for one in asked.of(case.package, files):
            if one.what == "offers" and one.name.startswith("/"):
                named[one.what].setdefault(one.name, []).append((one.file, one.line))
    # What only one side names may be another package's.
    published, heard = (named[kind] for kind in _ENDS)
    own = {name: published[name] + heard[name] for name in published.keys() & heard}
    for name, places in {**own, **named["offers"]}.items():
        for file, line in {file: line for file, line in reversed(places)}.items():
            yield Finding(
                "topic",
                f"The name {name} begins with a slash: it stays the same in each group, so that two"
                " groups of these nodes disturb each other.",
                file,
                line,
                WARNING,
                expected=name[1:],
                seen=case.package.line(file, line),
                fix=f"Write {name[1:]}.",
                change=(name, name[1:]),
            )


def _unread(case: Case, files: list[str]) -> Iterator[tuple[Kind, re.Match[str], str]]:
    for file in sorted({*files} & case.facts.unread):
        text = uses.code(case.package, file) if case.package.kind(file) == "cpp" else ""
        for kind, shape in _SHAPES.items():
            yield from ((kind, match, file) for match in shape.finditer(text))


RULE = Rule("static", 53, ("facts",), _findings, also=("topic",), only=ANY)
