# SPDX-License-Identifier: BSD-3-Clause
"""Each publisher in Python says how long its queue is: rospy warns of one that does not."""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.rules.queue import no_queue, says_none
from mrp_check.sources.node import Node, each_node


def _of(node: Node) -> Iterator[Finding]:
    for place in node.places(Kind.PUBLISHER) if node.is_python else ():
        if says_none(node, place):
            yield no_queue(
                node, place, "warnings", "queue_size=10, or whatever the topic needs", 10
            )


RULE = Rule("static", 81, ("facts",), each_node(_of), also=("warnings",), only=ANY)
