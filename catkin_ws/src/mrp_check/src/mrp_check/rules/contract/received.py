# SPDX-License-Identifier: BSD-3-Clause
"""Subscribers hear every value: by itself, each is sent some."""

from __future__ import annotations

import re
from typing import Collection, Iterator, Sequence

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Log
from mrp_check.contract.finding import HABIT, SEEN, Finding, Where
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.contract.spec import Subscribes
from mrp_check.run import evidence
from mrp_check.run.console_lines import not_logged, other_words, received_pattern, sample
from mrp_check.run.node import Node, each_node
from mrp_check.run.planning import BURST, PACED
from mrp_check.run.words import PREFIX, few


def _of(node: Node) -> Iterator[Finding]:
    """Yield a Finding if the node does not log each value that it is sent, once."""
    sent, pattern, role = node.sent(), received_pattern(node), node.wanted.subscribes
    if not role or not sent or pattern is None:
        return
    logs = node.seen_alone.logs
    heard = {*_values(logs, pattern)}
    lost = [value for value in sent if value not in heard]
    if not lost or heard - set(sent):
        yield from _repeated_finding(node, sent, logs, pattern)
        yield from _slow_finding(node, role, logs, pattern)
        return
    wanted = sample(node.wanted.received_line or "", lost[0])
    number = re.compile(rf"(?<!\w){lost[0]}(?!\w)")  # not that of a name, such as /check_2
    near = [g for g in logs if number.search(g.text) and not pattern.search(g.text)]
    lines = [text for _, _, text in node.direct.lines] if node.direct else []
    printed = [text for text in lines if number.search(text) and not PREFIX.match(text)]
    if near:
        yield other_words(node, near[-1], wanted)
    elif printed:
        yield not_logged(node, printed[-1], wanted)
    elif not heard:
        yield node.finding(
            "received",
            f"{node.name} was sent {len(sent)} messages, but logs none of them.",
            node.places.of(node.name, Kind.SUBSCRIBER, Kind.INIT),
            expected=wanted,
            seen="no such line",
        )
    elif not set(lost) & set(PACED):
        yield _short_queue(node, role, lost, heard & set(BURST))
    else:
        yield _gaps(node, sent, heard, _logged_place(node, logs, pattern))


def _values(logs: Sequence[Log], pattern: re.Pattern[str]) -> list[int]:
    found = (pattern.search(log.text) for log in logs)
    return [int(float(match["value"])) for match in found if match]


def _short_queue(
    node: Node, role: Subscribes, lost: Sequence[int], burst: Collection[int]
) -> Finding:
    return node.finding(
        "queue",
        f"{node.name} was sent {len(BURST)} messages at once, and lost {len(lost)} of them:"
        " its queue is too short.",
        node.places.of_topic(node.name, Kind.SUBSCRIBER, role.topic.name),
        SEEN if len(burst) <= 2 else HABIT,
        expected=f"a queue of {role.queue or 10}",
        seen=f"received {sorted(burst)}",
    )


def _gaps(node: Node, sent: Sequence[int], heard: Collection[int], place: Where) -> Finding:
    sleep = node.places.sleep_beside(node.name, Kind.LOG)
    kept = ", ".join(str(value) for value in sent if value in heard)
    why = " While its callback sleeps, more arrives than its queue holds." if sleep else ""
    return node.finding(
        "callbacks" if sleep else "received",
        f"{node.name} was sent {', '.join(map(str, sent))}, but logs only {kept}." + why,
        sleep or place,
        expected="each value that arrives",
        seen=kept,
    )


def _repeated_finding(
    node: Node, sent: Sequence[int], logs: Sequence[Log], pattern: re.Pattern[str]
) -> Iterator[Finding]:
    values = _values(logs, pattern)
    extra = [value for value in values if value not in sent]
    repeated = [value for value in sent if values.count(value) > 1]
    if extra:
        mistake = f"logs {few(values)}, when it was sent {few(sent)}."
    elif repeated:
        count = values.count(repeated[0])
        mistake = f"logs {repeated[0]} {count} times, though it was sent once."
    else:
        return
    yield node.finding(
        "received",
        f"{node.name} {mistake}",
        _logged_place(node, logs, pattern),
        expected="one line for each message, with its value",
        seen=few(values),
    )


def _slow_finding(
    node: Node, role: Subscribes, logs: Sequence[Log], pattern: re.Pattern[str]
) -> Iterator[Finding]:
    """Yield a Finding if a callback sleeps so long that its queue must overflow, had there been
    more to hear. On a busy machine some values come late: so the least time between two counts."""
    sleep = node.places.sleep_beside(node.name, Kind.LOG)
    roles = [theirs for other in node.spec.nodes.values() for theirs in other.published]
    arriving = sum(1 / r.period for r in roles if r.period and r.topic.name == role.topic.name)
    times = [g.time for g in logs if {*_values([g], pattern)} & {*BURST}]
    least = min((after - before for before, after in zip(times, times[1:])), default=0.0)
    if sleep and least * arriving > 1:
        yield node.finding(
            "callbacks",
            f"{node.name} was sent {len(BURST)} messages at once, and took {least:.1f} s for each"
            " one: its callback sleeps. So more arrives than its queue holds.",
            sleep,
            expected=f"less than {1 / arriving:g} s, as often as messages arrive",
            seen=f"at least {least:.1f} s between two of its lines",
        )


def _logged_place(node: Node, logs: Sequence[Log], pattern: re.Pattern[str]) -> Where:
    for log in logs:
        if pattern.search(log.text):
            return node.places.of_log(node.name, log)
    return node.places.of(node.name, Kind.SUBSCRIBER)


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of),
    requirements={
        "received": Requirement(
            "Subscribers hear every value",
            "subscriber",
            evidence.when(
                lambda node: node.sent() and node.wanted.received_line,
                "logged no value",
                lambda wanted: wanted.subscribes and not wanted.examples,
            ),
        )
    },
    also=("console", "queue", "callbacks"),
    only=CONTRACT,
)
