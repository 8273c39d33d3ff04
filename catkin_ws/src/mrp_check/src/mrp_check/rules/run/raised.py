# SPDX-License-Identifier: BSD-3-Clause
"""No error is raised while a node goes on."""

from __future__ import annotations

from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.run.node import Node, each_node
from mrp_check.run.starting import id_of_error


def _of(node: Node) -> Iterator[Finding]:
    if node.not_up:
        return
    found = node.places.traceback(node.errors())
    if found:
        place, kind, text = found
        source = node.package.line(place[0], place[1])
        yield node.finding(
            id_of_error(kind, text, "callbacks"),
            f"{node.name} runs into an error as it works: {kind}: {text}",
            place,
            expected="a node that works without an error",
            seen=f"{kind}: {text}, in: {source}",
        )
        return
    called = node.places.wrong_arguments(node.errors())
    if called:
        place, text = called
        yield node.finding(
            "callbacks",
            f"{node.name} has a callback that cannot be called as ROS calls it: {text}.",
            place,
            expected="a callback with one argument besides self",
            seen=f"TypeError: {text}",
        )


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of, also_dead=True),
    also=("callbacks", "python-names", "python-syntax", "type", "node-start"),
)
