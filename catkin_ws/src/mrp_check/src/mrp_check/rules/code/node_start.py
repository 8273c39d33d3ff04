# SPDX-License-Identifier: BSD-3-Clause
"""Each node starts ROS, and does so first."""

from __future__ import annotations

from typing import Iterator

from mrp_check.code.source_node import SourceNode, each_node
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.run import evidence


def _of(node: SourceNode) -> Iterator[Finding]:
    inits = node.places(Kind.INIT)
    if not inits:
        yield from () if _only_asks(node) else (_no_init(node),)
        return
    yield from _at_file_scope(node)
    if len(inits) == 1:
        yield from _too_early(node, inits[0])


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


def _at_file_scope(node: SourceNode) -> Iterator[Finding]:
    for place in node.places(Kind.GLOBAL):
        if "ros::NodeHandle" in (place.text, *place.holds):
            yield node.finding(
                "node-start",
                f"{place.name} is created before main begins, and so before ros::init(): creating"
                " a ros::NodeHandle then ends the program.",
                place,
                expected="no NodeHandle at file scope",
                fix="Create it in main, after ros::init().",
                why="init-first",
            )


def _too_early(node: SourceNode, init: Place) -> Iterator[Finding]:
    early = [
        p
        for p in node.places(Kind.HANDLE)
        if p.file == init.file
        and p.function == "main"
        and p.offset < init.offset
        and "ros::NodeHandle" in (p.text, *p.holds)
    ]
    if early:
        yield node.finding(
            "node-start",
            f"{early[0].name} is created on line {early[0].line}, before ros::init() on line"
            f" {init.line}: that ends the program.",
            early[0],
            expected="ros::init() before the first ros::NodeHandle",
            fix="Move ros::init() to the beginning of main.",
            why="init-first",
        )


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=each_node(_of),
    requirements={
        "node-start": Requirement("Each node starts ROS first", "publisher", evidence.read)
    },
)
