# SPDX-License-Identifier: BSD-3-Clause
"""The counter's type in C++, and where it begins anew, against the largest value."""

from __future__ import annotations

from mrp_check.contract.finding import ERROR, WARNING
from mrp_check.contract.requirements import Rule
from mrp_check.sources.node import each_node


def _of(node):
    values = node.wanted.publishes.values if node.wanted.publishes else None
    if node.is_python or values is None or not values.modulus:
        return
    used = {name for p in node.places("data") for name in p.values.get("names", ())}
    yield from _resets(node, used, values)
    said = set()
    for place in node.places("step"):
        kind, bits = place.values.get("type", ""), place.values.get("bits", 0)
        if place.text not in used or place.text in said or bits <= 0:
            continue
        floating = kind in ("float", "double")
        enough = bits - (0 if "unsigned" in kind else 1)
        if not floating and 2**enough >= values.modulus:
            continue
        said.add(place.text)
        if floating:
            largest = 24 if kind == "float" else 53
            why = f"past 2^{largest} it no longer counts in whole steps, and it never wraps round."
        elif bits < 32:
            why = (
                f"after {2**enough - 1} it begins again, and the message could hold up to"
                f" {values.modulus - 1}."
            )
        else:
            why = f"what happens past {2**enough - 1} is undefined in C++."
        yield node.finding(
            "wrap",
            f"The counter {place.text} is a {kind}: {why}",
            _declared(node, place),
            severity=ERROR if floating or bits < 32 else WARNING,
            expected="uint32_t",
            fix=f"Make {place.text} a uint32_t.",
        )


def _resets(node, used, values):
    for place in node.places("reset"):
        limit, value = place.values["limit"], place.values["value"]
        # Within the last two steps of the range whoever begins anew does no harm.
        if place.text in used and limit < values.modulus - 2 * abs(values.step):
            yield node.finding(
                "wrap",
                f"The counter {place.text} begins again at {value} when it comes to {limit};"
                f" the message could hold up to {values.modulus - 1}.",
                place,
                expected=f"the next value up to {values.modulus - 1}",
                fix="Take the limit away: a uint32_t begins again at 0 by itself.",
            )


def _declared(node, place):
    same = [p for p in node.places("counter") if p.text == place.text]
    return same[0] if same else place


RULE = Rule("static", 90, ("facts",), each_node(_of), also=("wrap",))
