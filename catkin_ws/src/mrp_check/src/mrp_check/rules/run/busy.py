# SPDX-License-Identifier: BSD-3-Clause
"""A node that waits for nothing keeps a processor busy: it was measured while nothing arrived."""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.node import Node, each_node

_BUSY = 0.9  # part of the time


def _of(node: Node) -> Iterator[Finding]:
    busy = node.direct.busy if node.direct else None
    if busy is None or busy < _BUSY:
        return
    file, line = node.places.of(node.name, Kind.LOOP, Kind.SPIN)
    rate = "rospy.Rate" if file in node.places.facts.python else "ros::Rate"
    yield node.finding(
        "spin",
        f"{node.name} keeps a processor busy, though nothing arrives: it ran for"
        f" {min(busy, 1):.0%} of the time. A loop of it never pauses.",
        (file, line),
        HABIT,
        expected=f"a {rate}, whose sleep() is called in the loop",
        seen=f"{min(busy, 1):.0%} of a processor",
        fix=f"Make a {rate} before the loop, and call its sleep() at the end of it.",
    )


RULE = Rule("run", ("nodes",), each_node(_of), also=("spin",), only=ANY)
