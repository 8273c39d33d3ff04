# SPDX-License-Identifier: BSD-3-Clause
"""roscpp: what is not kept ends. (rospy keeps it.)"""

from __future__ import annotations

from typing import Iterator

from mrp_check.code.source_node import SourceNode, each_node
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import CERTAIN, READ, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.run import evidence


def _of(node: SourceNode) -> Iterator[Finding]:
    topics = {"subscribe": node.wanted.subscribing, "advertise": node.wanted.publishing}
    kinds = {"subscribe": Kind.SUBSCRIBER, "advertise": Kind.PUBLISHER}
    for place in node.places(Kind.DISCARDED, Kind.LOCAL):
        call = place.text or ""
        if call in kinds and node.spec.is_contract:
            same = [
                p
                for topic in topics[call]
                for p in node.on_topic(kinds[call], topic)
                if p.file == place.file and p.line == place.line
            ]
            if not same:
                continue
        what = kinds.get(call, Kind.TIMER).value
        if place.kind is Kind.DISCARDED:
            how = "isn't kept anywhere: it's destroyed at the end of this line"
        else:
            how = (
                f"is kept in {place.name}, a variable of {place.function}(): it's destroyed when"
                " that function returns"
            )
        yield node.finding(
            "lifetime",
            f"The {what} that {call}() returns {how}.",
            place,
            # Nobody may need a publisher for longer.
            certainty=READ if what == Kind.PUBLISHER.value else CERTAIN,
            expected=f"a {what} that lives as long as the node, such as a member of the class",
            fix=f"Keep it as a member: {what}_ = ...{call}(...);",
        )


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=each_node(_of),
    requirements={
        "lifetime": Requirement(
            "Publishers, subscribers and timers live as long as the node, and no longer",
            "subscriber",
            evidence.read,
        )
    },
)
