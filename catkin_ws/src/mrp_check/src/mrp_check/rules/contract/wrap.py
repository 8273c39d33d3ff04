# SPDX-License-Identifier: BSD-3-Clause
"""The values wrap round past the largest one."""

from __future__ import annotations

from typing import Iterator, Sequence

from mrp_check.case import evidence
from mrp_check.confined.places import Kind
from mrp_check.confined.plans import TOLD
from mrp_check.confined.seen import Number
from mrp_check.contract.finding import HINT, Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.contract.spec import Values
from mrp_check.run.node import Node, each_node

_FEW_STEPS = 20  # near its first value, a counter has made no more


def _of(node: Node) -> Iterator[Finding]:
    """Yield a Finding if a Python publisher goes wrong at the end of its numbers."""
    rule = node.wanted.publishes.values if node.wanted.publishes else None
    if not (rule and rule.modulus and node.wrap):
        return
    events = {event.event: event for event in node.wrap.events}
    last = rule.start + (rule.modulus - 1 - rule.start) // rule.step * rule.step
    expected = f"after {last} comes {rule.after(last)}, modulo {rule.modulus}"
    power = rule.modulus.bit_length() - 1
    if rule.modulus == 2**power:
        expected += f" (2^{power})"
    if "not_found" in events:
        yield _unchecked(node, last, expected, "was not found")
    elif "error" in events:
        text = events["error"].text
        yield node.finding(
            "wrap",
            f"{node.name} stops publishing when its counter has gone past {rule.modulus - 1}:"
            f" {text}",
            node.places.of_counter(node.name, node.counter_names()),
            expected=expected,
            seen=text,
        )
    elif "set" in events:
        values = [event.value for event in node.wrap.events if event.event == "after"]
        after = [value for value in values if value is not None]
        yield from _at_the_end(node, rule, last, after, expected)


def _at_the_end(
    node: Node, rule: Values, last: int, after: Sequence[Number], expected: str
) -> Iterator[Finding]:
    """Yield a Finding about the values that are published after the counter was set."""
    if not after:
        return
    if after[0] not in (last, rule.after(last)):
        # What was set had no effect, or it wraps round before its end.
        if _continues(after, rule):
            yield _unchecked(node, last, expected, "could not be set")
        else:
            yield _wrap_finding(node, rule, after, expected)
        return
    rest = after[after.index(last) + 1 :] if last in after else after
    good = (rule.after(last), rule.start)
    if rest and rest[0] not in good or not rest and len(after) < TOLD:
        yield _wrap_finding(node, rule, after, expected)


def _unchecked(node: Node, last: int, expected: str, why: str) -> Finding:
    return node.finding(
        "wrap",
        f"It could not be checked what {node.name} publishes after {last}: its counter {why}.",
        node.places.of(node.name, Kind.PUBLISH),
        HINT,
        expected=expected,
    )


def _wrap_finding(node: Node, rule: Values, after: Sequence[Number], expected: str) -> Finding:
    largest, names = (rule.modulus or 1) - 1, node.counter_names()
    near_start = rule.start + _FEW_STEPS * abs(rule.step)
    wrong = next((value for value in after if value % (largest + 1) < near_start), None)
    shown = ", ".join(map(str, after))
    return node.finding(
        "wrap",
        f"Near the end of its numbers, which is {largest}, {node.name} publishes {shown}.",
        node.places.of_counter(node.name, names, wrong),
        expected=expected,
        seen=shown,
    )


def _continues(after: Sequence[Number], rule: Values) -> bool:
    """Return whether the values simply go on from where they were before."""
    near = after[0] < rule.start + _FEW_STEPS * abs(rule.step)
    return near and (after[0] - rule.start) % rule.step == 0


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of),
    requirements={
        "wrap": Requirement(
            "The values wrap round past the largest one",
            "publisher",
            evidence.of_publisher(
                lambda role: role.values and role.values.modulus,
                Node.has_wrapped,
                "has no counter that could be found",
            ),
        )
    },
    only=CONTRACT,
)
