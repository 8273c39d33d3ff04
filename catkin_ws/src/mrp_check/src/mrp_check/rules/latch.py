# SPDX-License-Identifier: BSD-3-Clause
"""Nothing is latched that should not be."""

from __future__ import annotations

from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence
from mrp_check.running.node import Node, each_node


def _of(node):
    role = node.wanted.publishes
    messages = node.published() if role else ()
    if not messages:
        return
    latched = node.path in node.latched.get(messages[0]["topic"], [])
    if latched != role.latched:
        yield node.finding(
            "latch",
            f"{node.name} latches its topic: whoever subscribes later first hears an old value."
            if latched
            else f"{node.name} does not latch its topic.",
            node.places.of_topic(node.name, "publisher", role.topic.name),
            expected="a latched publisher" if role.latched else "a publisher without latch",
            seen="latched" if latched else "not latched",
        )


RULE = Rule(
    stage="run",
    order=45,
    needs=("nodes",),
    findings=each_node(_of),
    requirements={
        "latch": Requirement(
            "Nothing is latched that should not be",
            "latch",
            evidence.of_publisher(lambda role: True, Node.published, "published no message"),
        )
    },
)
