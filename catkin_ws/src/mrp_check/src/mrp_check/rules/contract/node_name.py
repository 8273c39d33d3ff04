# SPDX-License-Identifier: BSD-3-Clause
"""Each node gives itself its own name."""

from __future__ import annotations

from typing import Iterator

from mrp_check.case import evidence
from mrp_check.code.node import Node, each_node
from mrp_check.code.python_text import GAP
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule


def _of(node: Node) -> Iterator[Finding]:
    inits = node.places(Kind.INIT)
    name = inits[0].text if len(inits) == 1 else None
    if name is None or GAP in name:
        return
    init = inits[0]
    if name.lstrip("/") != node.name:
        yield node.finding(
            "node-name",
            f"The node gives itself the name {name}; expected {node.name}. roslaunch"
            " hides it, as the launch file's name wins; rosrun does not.",
            init,
            expected=node.name,
            fix=f'Write "{node.name}".',
            change=(f'"{name}"', f'"{node.name}"'),
        )
    elif init.anonymous is True and not node.wanted.anonymous:
        yield node.finding(
            "node-name",
            "The node asks for an anonymous name: rosrun starts it under another name each time.",
            init,
            certainty=HABIT,
            expected=node.name,
            fix="Leave anonymous out." if node.is_python else "Leave AnonymousName out.",
        )


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=each_node(_of),
    requirements={
        "node-name": Requirement(
            "Each node gives itself its own name", "publisher#start-the-node", evidence.read
        )
    },
    only=CONTRACT,
)
