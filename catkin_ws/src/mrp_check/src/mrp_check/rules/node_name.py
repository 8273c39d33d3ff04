# SPDX-License-Identifier: BSD-3-Clause
"""Each node gives itself its own name."""

from __future__ import annotations

from mrp_check.contract.finding import WARNING
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence
from mrp_check.sources.node import each_node
from mrp_check.sources.python_source import GAP


def _of(node):
    inits = node.places("init")
    names = {p.text for p in inits}
    if len(inits) != 1 or None in names or GAP in inits[0].text:
        return
    init = inits[0]
    if init.text.lstrip("/") != node.name:
        yield node.finding(
            "node-name",
            f"The node gives itself the name {init.text}; expected {node.name}. roslaunch"
            " hides it, as the launch file's name wins; rosrun does not.",
            init,
            expected=node.name,
            fix=f'Write "{node.name}".',
            change=(f'"{init.text}"', f'"{node.name}"'),
        )
    elif init.values.get("anonymous") is True:
        yield node.finding(
            "node-name",
            "The node asks for an anonymous name: rosrun starts it under another name each time.",
            init,
            severity=WARNING,
            expected=node.name,
            fix="Leave anonymous out." if node.is_python else "Leave AnonymousName out.",
        )


RULE = Rule(
    stage="static",
    order=40,
    needs=("facts",),
    findings=each_node(_of),
    requirements={
        "node-name": Requirement(
            "Each node gives itself its own name", "publisher#start-the-node", evidence.read
        )
    },
)
