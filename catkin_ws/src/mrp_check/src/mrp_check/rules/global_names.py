# SPDX-License-Identifier: BSD-3-Clause
"""The topics at which a package's own nodes meet, and its services, follow the group of a node.

https://wiki.ros.org/Names says which names are global.
"""

from __future__ import annotations

from typing import Iterator

from mrp_check.case import Case
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.running.traces import ROS_TOPICS
from mrp_check.sources import asked


def _findings(case: Case) -> Iterator[Finding]:
    named: dict[Kind | str, dict[str, list[tuple[str, int]]]] = {}
    for node, files in case.facts.sources.items():
        for place in case.facts.of(node, Kind.PUBLISHER, Kind.SUBSCRIBER):
            if place.text and place.text.startswith("/") and place.text not in ROS_TOPICS:
                where = named.setdefault(place.kind, {}).setdefault(place.text, [])
                where.append((place.file, place.line))
        for one in asked.of(case.package, files):
            if one.what == "offers" and one.name.startswith("/"):
                named.setdefault("offers", {}).setdefault(one.name, []).append((one.file, one.line))
    # What only one side names may be another package's.
    published, heard = (named.get(kind, {}) for kind in (Kind.PUBLISHER, Kind.SUBSCRIBER))
    own = {name: published[name] + heard[name] for name in published.keys() & heard}
    for name, places in {**own, **named.get("offers", {})}.items():
        for file, line in {file: line for file, line in reversed(places)}.items():
            yield Finding(
                "topic",
                f"The name {name} begins with a slash: it stays the same in each group, so that two"
                " groups of these nodes disturb each other.",
                file,
                line,
                WARNING,
                expected=name[1:],
                seen=case.package.lines(file)[line - 1].strip(),
                fix=f"Write {name[1:]}.",
                change=(name, name[1:]),
            )


RULE = Rule("static", 53, ("facts",), _findings, also=("topic",), only=ANY)
