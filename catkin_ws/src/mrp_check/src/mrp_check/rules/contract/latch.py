# SPDX-License-Identifier: BSD-3-Clause
"""Nothing is latched that shouldn't be."""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.run import evidence
from mrp_check.run.node import Node, each_node


def _of(node: Node) -> Iterator[Finding]:
    role = node.wanted.publishes
    messages = node.published()
    if not role or not messages:
        return
    latched = node.path in node.latched.get(messages[0].topic, [])
    if latched != role.latched:
        yield node.finding(
            "latch",
            f"{node.name} latches its topic, so late subscribers get an old value first."
            if latched
            else f"{node.name} doesn't latch its topic.",
            node.places.of_topic(node.name, Kind.PUBLISHER, role.topic.name),
            expected="a latched publisher" if role.latched else "a publisher without latch",
            seen="latched" if latched else "not latched",
        )


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of, each_topic=True),
    requirements={
        "latch": Requirement(
            "Nothing is latched that shouldn't be",
            "latch",
            evidence.when(
                Node.published,
                "published no message",
                lambda wanted: wanted.publishes and wanted.of_itself,
            ),
        )
    },
    only=CONTRACT,
)
