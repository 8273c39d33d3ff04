# SPDX-License-Identifier: BSD-3-Clause
"""The counter's type in C++, against the largest value."""

from __future__ import annotations

from typing import Iterator

from mrp_check.code.source_node import SourceNode, each_node
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, READ, Finding
from mrp_check.contract.requirements import CONTRACT, Rule


def _of(node: SourceNode) -> Iterator[Finding]:
    values = node.wanted.publishes.values if node.wanted.publishes else None
    if node.is_python or values is None or not values.modulus:
        return
    modulus = values.modulus
    used = {name for p in node.places(Kind.DATA) for name in p.names}
    reported = set()
    for place in node.places(Kind.STEP):
        kind, bits = place.type, place.bits
        if place.text not in used or place.text in reported or bits <= 0:
            continue
        floating = kind in ("float", "double")
        enough = bits - (0 if "unsigned" in kind else 1)
        if not floating and 2**enough >= modulus:
            continue
        reported.add(place.text)
        if floating:
            largest = 24 if kind == "float" else 53
            why = f"past 2^{largest} it no longer counts in whole steps, and it never wraps around."
        elif bits < 32:
            why = (
                f"after {2**enough - 1} it starts over, though the message can hold up to"
                f" {modulus - 1}."
            )
        else:
            why = f"what happens past {2**enough - 1} is undefined in C++."
        declared = [counter for counter in node.places(Kind.COUNTER) if counter.text == place.text]
        yield node.finding(
            "wrap",
            f"The counter {place.text} is a {kind}: {why}",
            declared[0] if declared else place,
            certainty=READ if floating or bits < 32 else HABIT,
            expected="uint32_t",
            fix=f"Make {place.text} a uint32_t.",
        )


RULE = Rule("static", ("facts",), each_node(_of), also=("wrap",), only=CONTRACT)
