# SPDX-License-Identifier: BSD-3-Clause
"""A node that publishes right after it has made its publisher publishes to nobody.

A subscriber needs a moment to connect: https://wiki.ros.org/rospy/Overview/Publishers%20and%20Subscribers
So all messages are lost of a node that was seen to send them at that very moment, and none later.
"""

from __future__ import annotations

import functools
from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Registration
from mrp_check.contract.finding import HABIT, SEEN, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run import logged
from mrp_check.run.case import Case
from mrp_check.run.logged import Run
from mrp_check.run.traces import ROS_TOPICS, outside

_MOMENT = 0.05  # seconds in which no subscriber connects
_LATER = 3.0  # seconds for which it was watched after that
_LATE = 0.1  # seconds: an observer that is so late may have missed what came next


def _findings(case: Case) -> Iterator[Finding]:
    reported = set()
    for run in logged.runs(case.observed):
        for pub in run.seen.publications:
            topic = pub.topic.rsplit("/", 1)[-1]
            if pub.node != run.path or (run.node, topic) in reported or pub.topic in ROS_TOPICS:
                continue
            times = [
                m.time for m in run.seen.messages if (m.node, m.topic) == (run.path, pub.topic)
            ]
            if not times or not _is_lost(case, run, pub, times):
                continue
            reported.add((run.node, topic))
            # Under no launch file of its own, it may wait for somebody else.
            is_sure = run.is_launched and any(s.topic == pub.topic for s in run.seen.subscriptions)
            call = "get_num_connections()" if case.spec.nodes[run.node].language == "python" else ""
            yield Finding(
                "topic",
                f"{run.node} publishes on {outside(pub.topic)} right after creating its publisher,"
                f" and never again, {run.where}: no subscriber is connected yet, so nobody gets"
                " it.",
                *case.places.of_topic(run.node, Kind.PUBLISHER, pub.topic),
                certainty=SEEN if is_sure else HABIT,
                expected="a wait until somebody is connected; or latch",
                seen=f"{len(times)} message(s), {times[-1] - pub.answered:.3f} s after that",
                fix=f"First wait until {call or 'getNumSubscribers()'} is more than 0, or latch.",
                node=run.node,
            )


def _is_lost(case: Case, run: Run, pub: Registration, times: list[float]) -> bool:
    """Return whether all messages of a publisher came at once, and it does not latch them."""
    places = functools.partial(case.facts.of, run.node)
    if any(loop.is_around(place) for loop in places(Kind.LOOP) for place in places(Kind.PUBLISH)):
        return False  # it goes on
    if places(Kind.WAITS) and pub.topic.endswith("/goal"):
        return False  # on a quick machine, an action's server may connect within the moment
    is_late = times[-1] > pub.answered + _MOMENT or run.seen.lag > _LATE
    is_short = run.asked < pub.answered + _LATER and run.ended is None
    latches = run.path in run.latched.get(pub.topic, ())
    if run.ended is not None:  # then it could not be asked
        latches = any(publisher.latch for publisher in places(Kind.PUBLISHER))
    return pub.heard and not (is_late or is_short or latches)


RULE = Rule("run", ("nodes",), _findings, also=("topic",), only=ANY)
