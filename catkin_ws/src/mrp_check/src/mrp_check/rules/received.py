# SPDX-License-Identifier: BSD-3-Clause
"""Subscribers hear every value: by itself, each is sent some."""

from __future__ import annotations

import re

from mrp_check.contract.finding import ERROR, WARNING
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.rules.console import not_logged, other_words, received_pattern, sample
from mrp_check.running import evidence
from mrp_check.running.node import each_node, received_line
from mrp_check.running.observing import BURST, PACED
from mrp_check.running.words import PREFIX, few


def _of(node):
    """Yield a Finding if the node does not log each value that it is sent, once."""
    if not node.wanted.subscribes or not node.direct:
        return
    sent = node.sent()
    pattern = received_pattern(node)
    if not sent or pattern is None:
        return
    logs = node.direct_of("logs")
    heard, near, printed = set(), {}, {}
    for log in logs:
        found = pattern.search(log["text"])
        if found:
            heard.add(int(found["value"]))
    lines = [text for _, _, text in node.direct.get("lines", [])]
    for value in sent:
        if value in heard:
            continue
        number = re.compile(rf"(?<!\d){value}(?!\d)")
        for log in logs:
            if number.search(log["text"]) and not pattern.search(log["text"]):
                near[value] = log
        for text in lines:
            if number.search(text) and not PREFIX.match(text):
                printed[value] = text
    lost = [value for value in sent if value not in heard]
    if not lost or heard - set(sent):
        yield from _repeated_finding(node, sent, logs, pattern)
        return
    wanted = sample(received_line(node), lost[0])
    if lost[0] in near:
        yield other_words(node, near[lost[0]], wanted)
    elif lost[0] in printed:
        yield not_logged(node, printed[lost[0]], wanted)
    elif not heard:
        yield node.finding(
            "received",
            f"{node.name} was sent {len(sent)} messages, and logs none of them.",
            node.places.of(node.name, "subscriber", "init"),
            expected=wanted,
            seen="no such line",
        )
    elif not set(lost) & set(PACED):
        burst = heard & set(BURST)
        yield node.finding(
            "queue",
            f"{node.name} was sent {len(BURST)} messages at once, and lost {len(lost)} of them:"
            " its queue is too short.",
            node.places.of_topic(node.name, "subscriber", node.wanted.subscribing.name),
            ERROR if len(burst) <= 2 else WARNING,
            expected=f"a queue of {node.wanted.subscribes.queue or 10}",
            seen=f"received {sorted(burst)}",
        )
    else:
        sleep = node.places.sleep_beside(node.name, "log")
        kept = [str(value) for value in sent if value in heard]
        why = " While its callback sleeps, more arrives than its queue holds." if sleep else ""
        yield node.finding(
            "callbacks" if sleep else "received",
            f"{node.name} was sent {', '.join(map(str, sent))}, but logs only"
            f" {', '.join(kept)}." + (why or _whose(node, lost, heard)),
            sleep or _logged_place(node, logs, pattern),
            expected="each value that arrives",
            seen=", ".join(kept),
        )


def _whose(node, lost, heard):
    """Say whose values all that were lost could be, and none of the others."""
    for other in node.spec.nodes.values():
        rule = other.publishes.values if other.publishes else None
        if rule and other.publishing == node.wanted.subscribing and abs(rule.step) > 1:
            own = [(value - rule.start) % rule.step == 0 for value in lost]
            others = [(value - rule.start) % rule.step == 0 for value in heard]
            if all(own) and not any(others):
                return f" So it leaves out what comes from {other.name}."
    return ""


def _repeated_finding(node, sent, logs, pattern):
    values = [int(m["value"]) for m in (pattern.search(log["text"]) for log in logs) if m]
    extra = [value for value in values if value not in sent]
    repeated = [value for value in sent if values.count(value) > 1]
    if extra:
        said = f"logs {few(values)}, when it was sent {few(sent)}."
    elif repeated:
        count = values.count(repeated[0])
        said = f"logs {repeated[0]} {count} times, though it was sent once."
    else:
        return
    yield node.finding(
        "received",
        f"{node.name} {said}",
        _logged_place(node, logs, pattern),
        expected="one line for each message, with its value",
        seen=few(values),
    )


def _logged_place(node, logs, pattern):
    for log in logs:
        if pattern.search(log["text"]):
            return node.places.of_log(node.name, log)
    return node.places.of(node.name, "subscriber")


RULE = Rule(
    stage="run",
    order=60,
    needs=("nodes",),
    findings=each_node(_of),
    requirements={
        "received": Requirement(
            "Subscribers hear every value",
            "subscriber",
            evidence.when(
                lambda node: node.sent() and received_line(node),
                "logged no value",
                lambda wanted: wanted.subscribes,
            ),
        )
    },
    also=("console", "queue", "callbacks"),
)
