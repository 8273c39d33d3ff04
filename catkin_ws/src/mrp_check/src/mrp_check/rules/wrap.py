# SPDX-License-Identifier: BSD-3-Clause
"""The values wrap round past the largest one."""

from __future__ import annotations

from mrp_check.contract.finding import NOTE
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence
from mrp_check.running.node import Node, each_node


def _of(node):
    """Yield a Finding if a Python publisher goes wrong at the end of its numbers."""
    role = node.wanted.publishes
    if not (role and role.values and role.values.modulus and node.wrap):
        return
    rule, events = role.values, node.wrap.get("events", [])
    by_kind = {event["event"]: event for event in events}
    last = rule.start + (rule.modulus - 1 - rule.start) // rule.step * rule.step
    expected = f"after {last} comes {rule.after(last)}, modulo {rule.modulus}"
    power = rule.modulus.bit_length() - 1
    if rule.modulus == 2**power:
        expected += f" (2^{power})"
    place = node.places.of_counter(node.name, node.counter_names())
    if "set" not in by_kind:
        if "not_found" in by_kind:
            yield _unchecked(node, last, expected, "was not found")
        return
    after = [e["value"] for e in events if e["event"] == "after"]
    if "error" in by_kind:
        error = by_kind["error"]
        yield node.finding(
            "wrap",
            f"{node.name} stops publishing when its counter has gone past {rule.modulus - 1}:"
            f" {error['text']}",
            place,
            expected=expected,
            seen=error["text"],
        )
    elif after and after[0] not in (last, rule.after(last)):
        # What was set had no effect, or it wraps round before its end.
        if _continues(after, rule):
            yield _unchecked(node, last, expected, "could not be set")
        else:
            yield _wrap_finding(node, after, place, expected)
    elif after:
        index = after.index(last) if last in after else -1
        rest = after[index + 1 :]
        good = (rule.after(last), rule.start)
        if rest and rest[0] not in good or not rest and _stopped(events):
            yield _wrap_finding(node, after, place, expected)


def _unchecked(node, last, expected, why):
    return node.finding(
        "wrap",
        f"It could not be checked what {node.name} publishes after {last}: its counter {why}.",
        node.places.of(node.name, "publish"),
        NOTE,
        expected=expected,
    )


def _wrap_finding(node, after, place, expected):
    rule = node.wanted.publishes.values
    wrong = next((v for v in after if v % rule.modulus < rule.start + 20 * abs(rule.step)), None)
    place = node.places.of_counter(node.name, node.counter_names(), wrong) or place
    shown = ", ".join(map(str, after))
    return node.finding(
        "wrap",
        f"Near the end of its numbers, which is {rule.modulus - 1}, {node.name} publishes {shown}.",
        place,
        expected=expected,
        seen=shown,
    )


def _continues(after, rule):
    """Return whether the values simply go on from where they were before."""
    near = after[0] < rule.start + 20 * abs(rule.step)
    return near and (after[0] - rule.start) % rule.step == 0


def _stopped(events):
    return len([e for e in events if e["event"] == "after"]) < 4


RULE = Rule(
    stage="run",
    order=50,
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
            shown=35,
        )
    },
)
