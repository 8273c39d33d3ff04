# SPDX-License-Identifier: BSD-3-Clause
"""Publishers and subscribers meet on the topic, with messages of the right type."""

from __future__ import annotations

import difflib
from typing import Iterator, Mapping

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import Finding, Where
from mrp_check.contract.names import last_part
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.contract.spec import Topic
from mrp_check.run import evidence
from mrp_check.run.node import Node, each_node
from mrp_check.run.planning import resolved


def _of(node: Node) -> Iterator[Finding]:
    """Yield a Finding for each topic of the node with another name, type or namespace."""
    roles = (
        ("publishes on", Kind.PUBLISHER, node.wanted.publishing),
        ("subscribes to", Kind.SUBSCRIBER, node.wanted.subscribing),
    )
    for verb, kind, topics in roles:
        seen = node.topics(kind)
        if not topics:
            yield from _unexpected_topic(node, seen, verb, kind)
        for topic in topics:
            others = [resolved(other, node.path) for other in topics if other != topic]
            rest = {name: type_ for name, type_ in seen.items() if name not in others}
            if node.in_launch:
                yield from _topic_finding(node, rest, topic, verb, kind)
            else:
                yield from _direct_topic_finding(node, topic, verb, kind)


def _unexpected_topic(
    node: Node, seen: Mapping[str, str], verb: str, kind: Kind
) -> Iterator[Finding]:
    for topic in node.spec.topics.values():
        name = resolved(topic, node.path)
        if name in seen:
            yield node.finding(
                "topic",
                f"{node.name} {verb} {name}, but the contract doesn't ask for that.",
                node.places.of_topic(node.name, kind, name),
                expected=f"no {kind.value} in this node",
                seen=name,
            )


def _topic_finding(
    node: Node, seen: Mapping[str, str], topic: Topic, verb: str, kind: Kind
) -> Iterator[Finding]:
    expected = resolved(topic, node.path)
    if expected in seen:
        yield from _type_finding(node, seen[expected], topic, verb, kind)
        yield from _namespace_finding(node, topic, verb, kind)
        return
    others = sorted(seen)
    if others:
        nearest = max(others, key=lambda o: difflib.SequenceMatcher(None, o, expected).ratio())
        yield node.finding(
            "topic",
            f"{node.name} {verb} {nearest}, not {expected}." + _topic_hint(node, nearest, topic),
            _topic_place(node, kind, nearest, topic),
            expected=expected,
            seen=", ".join(others),
        )
    elif node.topics(kind, alone=True):  # it was late under the launch file: a busy machine
        yield from _direct_topic_finding(node, topic, verb, kind)
    else:
        yield node.finding(
            "topic",
            f"{node.name} {verb} no topic.",
            node.places.of(node.name, kind, Kind.INIT),
            expected=expected,
            seen="no topic",
        )


def _topic_place(node: Node, kind: Kind, seen: str, topic: Topic) -> Where:
    """Return the place that names a wrong topic: a remap in the launch file, or the source."""
    started = node.started
    for old, new in started.remaps if started else ():
        renamed = last_part(new) == last_part(seen)
        if started and renamed and last_part(old) == topic.name and old != new:
            lines = node.package.lines(started.file) if started.file else []
            named = [n for n, text in enumerate(lines, 1) if "remap" in text and new in text]
            line = next((n for n, text in enumerate(lines, 1) if f'"{new}"' in text), started.line)
            return started.file, [line, *named][-1]
    return node.places.of_topic(node.name, kind, seen)


def _topic_hint(node: Node, seen: str, topic: Topic) -> str:
    if topic.namespace != "group" or last_part(seen) != topic.name:
        return ""
    if seen == node.path + "/" + topic.name:
        return ' A name with ~, or one from a handle created with "~", is private to the node.'
    return " A name that begins with / doesn't follow the group."


def _direct_topic_finding(node: Node, topic: Topic, verb: str, kind: Kind) -> Iterator[Finding]:
    name = node.own_name
    if not name:
        return
    seen, expected = node.topics(kind, alone=True), resolved(topic, name)
    if expected in seen:
        yield from _type_finding(node, seen[expected], topic, verb, kind)
        return
    others = ", ".join(sorted(seen)) or "no topic"
    yield node.finding(
        "topic",
        f"{node.name} {verb} {others}, not {topic.name}.",
        node.places.of_topic(node.name, kind, others),
        expected=topic.name,
        seen=others,
    )


def _type_finding(node: Node, seen: str, topic: Topic, verb: str, kind: Kind) -> Iterator[Finding]:
    expected = topic.type_in(node.package.name)
    if seen in (expected, "*"):
        return
    place = node.places.of_topic(node.name, kind, topic.name)
    yield node.finding(
        "type",
        f"{node.name} {verb} {topic.name} with messages of type {seen}: nothing arrives where"
        f" {expected} is expected.",
        place,
        expected=expected,
        seen=seen,
    )


def _namespace_finding(node: Node, topic: Topic, verb: str, kind: Kind) -> Iterator[Finding]:
    """In a namespace of its own, the node must take its relative topic with it."""
    name = node.own_name
    if not name or topic.namespace != "group":
        return
    seen, expected = node.topics(kind, alone=True), resolved(topic, name)
    if seen and expected not in seen:
        nearest = next((t for t in seen if t.endswith("/" + topic.name)), sorted(seen)[0])
        yield node.finding(
            "namespace",
            f"{node.name} {verb} {nearest}, whatever group it runs in: the name includes the"
            " group, so two robots would share it.",
            node.places.of_topic(node.name, kind, nearest),
            expected=f"the relative name {topic.name}",
            seen=nearest,
        )


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of),
    requirements={
        "topic": Requirement(
            "Publishers and subscribers meet on the topic", "publisher", evidence.meets
        ),
        "type": Requirement("The messages have the right type", "publisher", evidence.meets),
        "namespace": Requirement(
            "The nodes can be moved to another namespace", "namespaces", evidence.alone
        ),
    },
    only=CONTRACT,
)
