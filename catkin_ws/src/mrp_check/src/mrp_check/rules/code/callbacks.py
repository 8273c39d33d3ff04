# SPDX-License-Identifier: BSD-3-Clause
"""No function that publishes, or makes a topic, is one that nobody ever calls."""

from __future__ import annotations

from typing import Iterator

from mrp_check.case import evidence
from mrp_check.code.node import Node, each_node
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule


def _of(node: Node) -> Iterator[Finding]:
    said = set()
    for kind, id_, does in (
        (Kind.INIT, "node-start", "starts the node"),
        (Kind.PUBLISHER, "topic", "makes the publisher"),
        (Kind.SUBSCRIBER, "topic", "makes the subscriber"),
        (Kind.PUBLISH, "callbacks", "publishes"),
    ):
        places = node.places(kind)
        functions = [_unused_around(node, place) for place in places]
        function = functions[0] if functions else None
        if function is None or None in functions or (function.file, function.line) in said:
            continue
        said.add((function.file, function.line))
        timer = " A timer has to be given it as its callback." if kind is Kind.PUBLISH else ""
        yield node.finding(
            id_,
            f"{function.text} {does}, and nobody ever calls or uses it.{timer}",
            function,
            expected=f"a place where {function.text} is used",
            fix=f"Call {function.text}, or hand it over as a callback.",
        )


def _unused_around(node: Node, place: Place) -> Place | None:
    around = [f for f in node.places(Kind.FUNCTION) if f.is_around(place) and f.unused]
    return around[0] if around else None


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=each_node(_of),
    requirements={
        "callbacks": Requirement(
            "Each callback is handed over and takes what it gets", "subscriber", evidence.read
        )
    },
    also=("node-start", "topic"),
)
