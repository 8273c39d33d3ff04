# SPDX-License-Identifier: BSD-3-Clause
"""A node spins: it calls its callbacks, and keeps no processor busy while it waits for them."""

from __future__ import annotations

from typing import Iterator

from mrp_check.code.facts import Facts
from mrp_check.confined.places import Kind
from mrp_check.confined.seen import LaunchResult
from mrp_check.contract.finding import HABIT, SEEN, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case
from mrp_check.run.node import Node, each_node
from mrp_check.run.observing import ends
from mrp_check.run.traces import ROS_TOPICS

_FEW = 3  # messages that must have come
_SECONDS = 2.0  # for which the first of them must have waited


def _findings(case: Case) -> Iterator[Finding]:
    yield from each_node(_busy)(case)
    reported = set()
    for launched in case.observed.launches:
        for path, name in launched.nodes.items():
            topic = _unheard(launched.seen, path) if name not in reported else None
            if topic:
                reported.add(name)
                file, line = case.places.of(name, Kind.SPIN, Kind.SUBSCRIBER)
                yield Finding(
                    "spin",
                    f"Messages on {topic} come to {name}, {launched.where}, but it calls no"
                    " callback: it never gets to ros::spin() or ros::spinOnce().",
                    file,
                    line,
                    HABIT if _may_wait(case.facts, name) else SEEN,
                    expected="ros::spinOnce() in each turn of the loop, or ros::spin()",
                    seen="no call of a callback",
                    fix="Call ros::spinOnce() in the loop itself, not under a condition.",
                    node=name,
                )


def _unheard(launch: LaunchResult, path: str) -> str | None:
    """Return a topic on which messages came to a node that called no callback at all."""
    seen = launch.seen
    waits = {registration.topic for registration in seen.lookups if registration.node == path}
    if path not in launch.uncalled or path in ends(launch.until_asked()):
        return None
    if waits - {registration.topic for registration in seen.services}:
        return None  # it waits for a service that nobody offers
    for sub in seen.subscriptions:
        if sub.node == path and sub.topic not in ROS_TOPICS:
            sent = [m.time for m in seen.messages if m.topic == sub.topic and m.time > sub.time + 1]
            types = {p.type for p in seen.publications if p.topic == sub.topic}
            if sub.type in types and len(sent) >= _FEW and launch.asked - sent[0] > _SECONDS:
                return sub.topic
    return None


def _may_wait(facts: Facts, name: str) -> bool:
    """Return whether a node sleeps before its loop, or waits for a server: it may spin later."""
    loops, sleeps = facts.of(name, Kind.LOOP), facts.of(name, Kind.SLEEP)
    is_early = any(not any(loop.is_around(sleep) for loop in loops) for sleep in sleeps)
    return is_early or bool(facts.of(name, Kind.WAITS))


_BUSY = 0.9  # part of the time


def _busy(node: Node) -> Iterator[Finding]:
    busy = node.direct.busy if node.direct else None
    if busy is None or busy < _BUSY:
        return
    file, line = node.places.of(node.name, Kind.LOOP, Kind.SPIN)
    rate = "rospy.Rate" if file in node.places.facts.python else "ros::Rate"
    yield node.finding(
        "spin",
        f"{node.name} keeps a processor busy, though nothing arrives: it ran for"
        f" {min(busy, 1):.0%} of the time. One of its loops never pauses.",
        (file, line),
        HABIT,
        expected=f"a {rate}, whose sleep() is called in the loop",
        seen=f"{min(busy, 1):.0%} of a processor",
        fix=f"Create a {rate} before the loop, and call its sleep() at the end of each turn.",
    )


RULE = Rule("run", ("nodes",), _findings, also=("spin",), only=ANY)
