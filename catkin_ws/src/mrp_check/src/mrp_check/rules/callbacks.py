# SPDX-License-Identifier: BSD-3-Clause
"""No function that publishes, or makes a topic, is one that nobody ever calls."""

from __future__ import annotations

from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence
from mrp_check.sources.node import each_node


def _of(node):
    said = set()
    for kind, id_, does in (
        ("init", "node-start", "starts the node"),
        ("publisher", "topic", "makes the publisher"),
        ("subscriber", "topic", "makes the subscriber"),
        ("publish", "callbacks", "publishes"),
    ):
        places = node.places(kind)
        functions = {id(p): _unused_around(node, p) for p in places}
        if not places or not all(functions.values()):
            continue
        function = functions[id(places[0])]
        if (function.file, function.line) in said:
            continue
        said.add((function.file, function.line))
        timer = " A timer has to be given it as its callback." if kind == "publish" else ""
        yield node.finding(
            id_,
            f"{function.text} {does}, and nobody ever calls or uses it.{timer}",
            function,
            expected=f"a place where {function.text} is used",
            fix=f"Call {function.text}, or hand it over as a callback.",
        )


def _unused_around(node, place):
    around = [f for f in node.places("function") if f.is_around(place) and f.values.get("unused")]
    return around[0] if around else None


RULE = Rule(
    stage="static",
    order=60,
    needs=("facts",),
    findings=each_node(_of),
    requirements={
        "callbacks": Requirement(
            "Each callback is handed over and takes what it gets", "subscriber", evidence.read
        )
    },
    also=("node-start", "topic"),
)
