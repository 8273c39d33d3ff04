# SPDX-License-Identifier: BSD-3-Clause
"""Publishers publish as often as the contract says."""

from __future__ import annotations

import statistics
from typing import Iterator, NamedTuple, Sequence

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import Finding, Where
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.contract.spec import Publishes
from mrp_check.run import evidence
from mrp_check.run.node import Node, each_node


class _Rate(NamedTuple):
    """What is known of a node's rate. middle: of all gaps between two messages, in seconds

    is_open: whether it may be the machine that was too slow
    """

    middle: float
    too_fast: bool = False
    too_slow: bool = False
    is_open: bool = False


def _rate(node: Node, role: Publishes, period: float) -> _Rate:
    times = [message.time for message in node.published()]
    gaps = [b - a for a, b in zip(times, times[1:])]
    # A busy machine can delay messages, and let them come in a burst after that; it can change
    # neither the middle one of all gaps by much, nor the time that all together take.
    middle, mean = statistics.median(gaps), (times[-1] - times[0]) / len(gaps)
    low, high, lag = period * (1 - role.tolerance), period * (1 + role.tolerance), node.seen.lag
    if max(middle, mean) < low:
        too_fast = max(middle, mean) + 2 * lag < low
        return _Rate(middle, too_fast=too_fast, is_open=not too_fast)
    if min(middle, mean) <= high:
        return _Rate(middle)
    # What has to wait for a processor is slow without any fault of its own.
    own = min(middle, mean) * (1 - node.waited) - 2 * lag
    # Two runs must agree: so it must be as slow by itself.
    alone = [message.time for message in node.published(alone=True)]
    alone_gaps = [b - a for a, b in zip(alone, alone[1:])]
    too_slow = own > high and not (alone_gaps and statistics.median(alone_gaps) <= high)
    return _Rate(middle, too_slow=too_slow, is_open=not too_slow)


def _is_open(node: Node) -> bool:
    for view in node.of_topics():
        role = view.wanted.publishes
        if role and role.period and view.has_rate() and _rate(view, role, role.period).is_open:
            return True
    return False


def _of(node: Node) -> Iterator[Finding]:
    role = node.wanted.publishes
    messages = node.published()
    if not role or not role.period or not messages:
        return
    place = node.places.of(node.name, Kind.TIMER, Kind.PUBLISH)
    expected = f"a message every {role.period:g} s"
    times = [message.time for message in messages]
    if not node.has_rate():
        yield from _too_few(node, role.period, times, place, expected)
        return
    middle, too_fast, too_slow, _ = _rate(node, role, role.period)
    if too_fast or too_slow:
        seen = f"a message every {middle:.2g} s"
        # Beside a timer: a loop's own sleep is what its rate is made of.
        file, line = place
        timer = "Timer" in (node.package.line(file, line) if file and line else "")
        sleep = too_slow and timer and node.places.sleep_beside(node.name, Kind.PUBLISH)
        yield node.finding(
            "rate",
            f"{node.name} publishes too {'often' if too_fast else 'rarely'}: {seen}, where the"
            f" contract says every {role.period:g} s."
            + (" Its callback sleeps, and the timer waits for it." if sleep else ""),
            sleep or place,
            expected=expected,
            seen=seen,
        )


def _too_few(
    node: Node, period: float, times: Sequence[float], place: Where, expected: str
) -> Iterator[Finding]:
    """Yield a Finding if there are too few messages, though there was time for more."""
    waited = (node.asked - times[-1]) * (1 - node.waited)
    if waited <= 3 * period + 10 * node.seen.lag:
        return
    count = "once" if len(times) == 1 else f"{len(times)} messages"
    slow = len(times) > 1 and times[-1] - times[0] > 2 * period
    rest = " in all, far too few." if slow else f", and then no more for {waited:.0f} s."
    yield node.finding(
        "rate", f"{node.name} published {count}{rest}", place, expected=expected, seen=count
    )


_enough = evidence.of_publisher(
    lambda role: role.period, Node.has_rate, "published too few messages"
)
_steady = evidence.of_publisher(
    lambda role: role.period,
    lambda node: not _is_open(node),
    "was slow on a machine that's too busy to tell",
)
RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of, each_topic=True),
    requirements={
        "rate": Requirement(
            "The rate is right",
            "publisher",
            lambda case: _enough(case) or _steady(case),
        )
    },
    only=CONTRACT,
)
