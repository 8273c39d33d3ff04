# SPDX-License-Identifier: BSD-3-Clause
"""A node has its own name, too, where no launch file gives it one."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.names import last_part
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.run import evidence
from mrp_check.run.node import Node, each_node


def _of(node: Node) -> Iterator[Finding]:
    own = node.own_name
    if not own:
        return
    name = last_part(own)
    is_anonymous = re.fullmatch(rf"{re.escape(node.name)}_\d+(_\d+)?", name) is not None
    if node.wanted.anonymous and name == node.name:
        yield node.finding(
            "node-name",
            f"{node.name} should ask for an anonymous name, as the contract says: without one, a"
            " second copy ends the first.",
            node.places.of(node.name, Kind.INIT),
            expected=f"{name}_ and a number",
            seen=name,
            fix="Give the call anonymous=True in Python, ros::init_options::AnonymousName in C++.",
        )
    elif is_anonymous and not node.wanted.anonymous:
        yield node.finding(
            "node-name",
            "The node asks for an anonymous name: rosrun starts it under another name each time;"
            " the launch file gives it its own.",
            node.places.of(node.name, Kind.INIT),
            HABIT,
            expected=node.name,
            seen=name,
        )
    elif name != node.name and not is_anonymous:
        yield node.finding(
            "node-name",
            f"Started by itself, {node.name} calls itself {name}: the launch file hides that, but"
            " with rosrun the node has the wrong name.",
            node.places.of(node.name, Kind.INIT),
            expected=node.name,
            seen=name,
            fix=f'Write "{node.name}".',
            change=(f'"{name}"', f'"{node.name}"'),
        )


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of, also_dead=True),
    requirements={
        "node-name": Requirement(
            "Each node gives itself its own name", "publisher#start-the-node", evidence.alone
        )
    },
    only=CONTRACT,
)
