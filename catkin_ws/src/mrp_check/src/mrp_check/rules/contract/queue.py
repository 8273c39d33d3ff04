# SPDX-License-Identifier: BSD-3-Clause
"""Each queue is as long as the contract says, as far as the source says it plainly."""

from __future__ import annotations

from typing import Iterator

from mrp_check.code.source_node import SourceNode, each_node
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import HABIT, READ, Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.run import evidence


def _of(node: SourceNode) -> Iterator[Finding]:
    wanted = node.wanted
    relays = [wanted.relays] if wanted.relays else []
    for kind, topic, asked in (
        *((Kind.SUBSCRIBER, role.topic, role.queue) for role in wanted.subscribed),
        *((Kind.PUBLISHER, role.topic, role.queue) for role in wanted.published),
        *((Kind.SUBSCRIBER, relay.source, relay.queue) for relay in relays),
        *((Kind.PUBLISHER, relay.target, relay.queue) for relay in relays),
    ):
        if not asked:
            continue
        for place in node.on_topic(kind, topic):
            queue = place.queue
            if isinstance(queue, int) and queue is not True and queue != asked:
                yield _other_queue(node, place, kind, queue, asked)
            elif node.is_python and kind is Kind.PUBLISHER and _says_none(node, place):
                yield node.finding(
                    "queue",
                    "rospy.Publisher() gets no queue_size, so publish() waits until each message is"
                    " sent, and rospy warns about it.",
                    place,
                    certainty=HABIT,
                    expected=f"queue_size={asked}",
                    fix=f"Add queue_size={asked}.",
                    why="queue-size-missing",
                )


_REFUSED = (True, Kind.SUBSCRIBER, 0)


def _other_queue(node: SourceNode, place: Place, kind: Kind, queue: int, asked: int) -> Finding:
    words = {
        _REFUSED: "rospy.Subscriber() doesn't accept a queue_size of 0: it raises an error.",
        (True, Kind.SUBSCRIBER, 1): "The subscriber's queue has room for one message. In rospy"
        " each publisher has a queue of its own; a late callback still loses messages.",
        (False, Kind.SUBSCRIBER, 1): "The subscriber's queue has room for one message. All"
        " publishers of the topic share it: two that publish at the same moment push out each"
        " other's values.",
    }
    rooms = f"has room for {queue} messages" if queue else "has no limit"
    return node.finding(
        "queue",
        words.get((node.is_python, kind, queue))
        or f"The {kind.value}'s queue {rooms}; the contract asks for {asked}.",
        (place.file, place.queue_line or place.line),
        # A longer one loses nothing, and one that is little shorter hardly ever.
        certainty=READ if queue == 1 or (node.is_python, kind, queue) in words else HABIT,
        expected=f"queue_size={asked}" if node.is_python else f"a queue of {asked}",
        fix=f"Write {asked} for {queue}.",
        why="py-queue-0" if (node.is_python, kind, queue) == _REFUSED else "",
        change=(f"queue_size={queue}", f"queue_size={asked}")
        if node.is_python
        else (f", {queue}", f", {asked}"),
    )


def _says_none(node: SourceNode, place: Place) -> bool:
    """Return whether a call that begins in a line has no queue_size in its lines."""
    lines = node.package.lines(place.file)[place.line - 1 : place.line + 6]
    text, depth = "", 0
    for line in lines:
        text += line + "\n"
        depth += line.count("(") - line.count(")")
        if depth <= 0:
            break
    if place.queue is not None:
        return False
    return "queue_size" not in text and "**" not in text and text.count(",") < 6


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=each_node(_of),
    requirements={"queue": Requirement("Queues are long enough", "queues", evidence.read)},
    only=CONTRACT,
)
