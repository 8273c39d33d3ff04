# SPDX-License-Identifier: BSD-3-Clause
"""A <remap> of a launch file renames something that its node uses."""

from __future__ import annotations

from typing import Iterator

from mrp_check.case import Case
from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import last_part, nearest
from mrp_check.rules.launch_remap import remap_line
from mrp_check.rules.unread import is_named
from mrp_check.running.observing import Launched
from mrp_check.sources import asked

_ALIKE = 0.75


def _findings(case: Case) -> Iterator[Finding]:
    for launch in case.launches:
        started = {(node.path, node.type): node for node in launch.nodes}
        for launched in (one for one in case.observed.launches if one.file == launch.file):
            for path, name in launched.nodes.items():
                node = started.get((path, name))
                if node and case.nodes[name].is_up:
                    yield from _of(case, launched, name, node)


def _of(case: Case, launched: Launched, name: str, node: Started) -> Iterator[Finding]:
    seen = launched.seen.seen
    records = [*seen.publications, *seen.subscriptions]
    topics = {one.topic for one in records if one.node == node.path}
    files = case.facts.sources.get(name, [])
    services = {one.base for one in asked.of(case.package, files)}
    for old, new in node.remaps:
        base = last_part(old).lstrip("~")
        if not topics or node.resolved(new) in topics or base in services:
            continue
        # It may be made only later on; a name that the sources have nowhere is not.
        used = [topic for topic in topics if last_part(topic) == base]
        if not used and any(is_named(base, case.package.text(file)) for file in files):
            continue
        near = used[0] if used else nearest(old, topics, _ALIKE)
        yield Finding(
            "topic",
            f"The launch file renames {old} of {node.name}, which uses no such name."
            + (f" It uses {near}." if near else ""),
            node.file,
            remap_line(case.package, node, old, new),
            WARNING,
            expected=near or "a name that the node uses",
            seen=f"{old} renamed to {new}",
            node=name,
        )


RULE = Rule("run", 22, ("nodes",), _findings, also=("topic",), only=ANY)
