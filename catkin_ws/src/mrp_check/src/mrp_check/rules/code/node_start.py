# SPDX-License-Identifier: BSD-3-Clause
"""Each node starts ROS. That it does so first, ROS itself says as the node runs."""

from __future__ import annotations

from typing import Iterator

from mrp_check.code.source_node import SourceNode, each_node
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.run import evidence


def _of(node: SourceNode) -> Iterator[Finding]:
    if not node.places(Kind.INIT) and not _only_asks(node):
        yield _no_init(node)


def _only_asks(node: SourceNode) -> bool:
    """Return whether a program is a client of a service, and no node: rospy lets it ask."""
    is_node = node.spec.is_contract or node.places(Kind.PUBLISHER, Kind.SUBSCRIBER, Kind.TIMER)
    return not is_node and bool(node.places(Kind.ASKS))


def _no_init(node: SourceNode) -> Finding:
    call = "rospy.init_node(...)" if node.is_python else "ros::init(...)"
    name = node.name.removesuffix(".py")  # a node's name has no dot
    where = [p for p in node.places(Kind.FUNCTION) if p.text == "main"] or node.places(
        Kind.PUBLISHER, Kind.SUBSCRIBER, Kind.TIMER
    )
    return node.finding(
        "node-start",
        f"{node.main} never calls {call}: without it, there's no node.",
        where[0] if where else (node.main, 1),
        expected=f"{call}, with the name {name}, before all other ROS calls",
        seen="no such call",
        fix=f'Add rospy.init_node("{name}").'
        if node.is_python
        else f'Add ros::init(argc, argv, "{name}"); as the first line of main.',
    )


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=each_node(_of),
    requirements={
        "node-start": Requirement("Each node starts ROS first", "publisher", evidence.read)
    },
)
