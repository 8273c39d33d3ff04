# SPDX-License-Identifier: BSD-3-Clause
"""The nodes of a package meet: no name of a topic or a service is misspelt, and types agree."""

from __future__ import annotations

import re
import typing
from typing import Iterable, Iterator

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Seen
from mrp_check.contract.finding import HABIT, HINT, SEEN, Finding
from mrp_check.contract.names import last_part, nearest
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case
from mrp_check.run.observing import Launched
from mrp_check.run.traces import ROS_TOPICS, outside

_ALIKE = 0.85
_TOGETHER = "When all nodes run together"
_BY_ITSELF = "Started by itself"


class Endpoint(typing.NamedTuple):
    """A node of the package, or None for another's, that publishes or subscribes; and where its
    source says so, if it was read there."""

    node: str | None
    topic: str
    type: str
    file: str = ""
    line: int = 0


class Graph(typing.NamedTuple):
    """What was seen in a run."""

    where: str
    publishers: list[Endpoint]
    subscribers: list[Endpoint]


def _findings(case: Case) -> Iterator[Finding]:
    reported: set[object] = set()
    published = {
        last_part(publisher.topic) for graph, _ in _graphs(case) for publisher in graph.publishers
    }
    for graph, nodes in _graphs(case):
        for end in graph.subscribers:
            if end.node not in nodes or (end.node, end.topic) in reported:
                continue
            same = [publisher for publisher in graph.publishers if publisher.topic == end.topic]
            for finding in (
                _of_types(case, graph, end, same) if same else _alone(case, graph, end, published)
            ):
                reported.add((end.node, end.topic))
                yield finding
    for launched in case.observed.launches:
        yield from _of_services(case, launched) if launched.file else ()


def _of_services(case: Case, launched: Launched) -> Iterator[Finding]:
    """Yield a finding for each service that a node seeks, if another node offers one whose name is
    alike, and which nobody seeks."""
    seen = launched.seen.seen
    sought = {lookup.topic for lookup in seen.lookups}
    offered = {service.topic: launched.nodes.get(service.node) for service in seen.services}
    for topic, path in {lookup.topic: lookup.node for lookup in seen.lookups}.items():
        node = launched.nodes.get(path)
        near = nearest(topic, [other for other in offered if other not in sought], _ALIKE)
        if node and near and topic not in offered and offered[near] not in (node, None):
            yield Finding(
                "starts",
                f"{node} waits for the service {topic}, {launched.where}, which nobody offers, but"
                f" {offered[near]} offers {near}.",
                *case.places.asked(node, Kind.ASKS, last_part(topic)),
                expected=near,
                seen=topic,
                fix="Give both services one name.",
                node=node,
            )


def _graphs(case: Case) -> Iterator[tuple[Graph, set[str]]]:
    """Yield what was seen under each launch file, and of each by itself, with the nodes that it
    is asked of: all of them, and each by itself, only of those that no launch file starts, as that
    may give them other names."""
    together: set[str] = set()
    for launched in case.observed.launches:
        nodes = {*launched.nodes.values()} - (set() if launched.file else together)
        together |= nodes
        where = f"Under {launched.file}" if launched.file else _TOGETHER
        yield _graph(where, launched.seen.seen, launched.nodes, lambda topic: topic), nodes
    direct = case.observed.direct
    if direct:
        alone = {node.name: key for key, node in direct.nodes.items() if node.name}
        # Each ran in a namespace of its own.
        yield _graph(_BY_ITSELF, direct.seen, alone, outside), {*alone.values()} - together


def _graph(
    where: str,
    seen: Seen,
    nodes: dict[str, str],
    plain: typing.Callable[[str], str],
) -> Graph:
    def ends(records: Iterable[typing.Any]) -> list[Endpoint]:
        found = (
            Endpoint(nodes.get(entry.node), plain(entry.topic), entry.type) for entry in records
        )
        return [end for end in dict.fromkeys(found) if end.topic not in ROS_TOPICS]

    return Graph(where, ends(seen.publications), ends(seen.subscriptions))


def _of_types(
    case: Case, graph: Graph, end: Endpoint, publishers: list[Endpoint]
) -> Iterator[Finding]:
    by_chance = graph.where == _TOGETHER
    types = {other.type for other in publishers}
    for other in publishers:
        if "*" in (end.type, other.type) or other.type == end.type:
            continue
        file, line = case.places.of_topic(end.node or "", Kind.SUBSCRIBER, end.topic)
        yield Finding(
            "type",
            f"{end.node} subscribes to {end.topic} with messages of type {end.type}, but"
            f" {other.node or 'another node'} publishes {other.type} there: nothing arrives.",
            file,
            line,
            # Examples may share a topic's name: each of them runs with its own partner.
            HABIT if by_chance and end.type in types else SEEN,
            expected=other.type,
            seen=end.type,
            fix="Use the same type in both.",
            node=end.node,
        )


def _alone(case: Case, graph: Graph, end: Endpoint, published: set[str]) -> Iterator[Finding]:
    """Yield the Finding about a topic that nobody publishes on."""
    heard = {subscriber.topic for subscriber in graph.subscribers}
    near = _meant(case, end, graph.publishers, graph.subscribers)
    is_actions = last_part(end.topic) in ("feedback", "result", "status")
    if is_actions and any(not node.is_up for node in case.nodes.values()):
        return  # the action is served by one that did not run
    near.sort(key=lambda publisher: publisher.topic in heard)
    file, line = case.places.of_topic(end.node or "", Kind.SUBSCRIBER, end.topic)
    if not any(is_like(publisher, end) for publisher in near):
        if any(_did_not_run_and_names(case, side.topic) for side in (end, *near)):
            return  # one that did not run may publish there
    if not near:
        nobody = "nobody" if last_part(end.topic) in published else "no node of this package"
        yield Finding(
            "topic",
            f"{graph.where}, {end.node} waits for messages on {end.topic}: {nobody} publishes any.",
            file,
            line,
            HINT,
            node=end.node,
        )
        return
    other = near[0]
    # Under their own launch file, both are without a partner: what one says, the other should hear.
    is_run = graph.where not in (_TOGETHER, _BY_ITSELF)
    is_near = is_like(other, end)
    is_sure = other.topic not in heard or is_near and not _is_moved(other, end)
    # A launch file that doesn't start them here may give them other names elsewhere.
    is_sure = is_sure and (is_run or is_near and not case.launches)
    digits = [re.sub(r"\d", "", side.topic) for side in (other, end)]
    fix = "Give both topics one name; a <remap> in the launch file does so, too."
    if other.topic == f"/{last_part(end.topic)}":
        fix = (
            f"If {other.node} writes the name with a first slash, remove that: with it, the name"
            f" doesn't follow the namespace. Or {fix[0].lower()}{fix[1:]}"
        )
    yield Finding(
        "topic",
        f"{graph.where}, {end.node} subscribes to {end.topic}, where nobody publishes, but"
        f" {other.node} publishes on {other.topic}.",
        file,
        line,
        SEEN if is_sure and digits[0] != digits[1] else HABIT,
        expected=other.topic,
        seen=end.topic,
        fix=fix,
        node=end.node,
    )


def _did_not_run_and_names(case: Case, topic: str) -> bool:
    """Return whether the sources of a node that is not up have the last part of a topic's name."""
    files = {
        f for n, node in case.nodes.items() if not node.is_up for f in case.facts.sources.get(n, ())
    }
    return any(last_part(topic) in case.package.text(file) for file in files)


def _meant(
    case: Case, end: Endpoint, publishers: list[Endpoint], subscribers: list[Endpoint]
) -> list[Endpoint]:
    """Return the publishers that a subscriber waits for in vain, as it has another name for their
    topic: it is alike, or their type is the package's own or plain, and they alone are without a
    partner."""
    others = [
        publisher for publisher in publishers if publisher.node and publisher.node != end.node
    ]
    near = [other for other in others if is_like(other, end)]
    heard, published = ({o.topic for o in side} for side in (subscribers, publishers))
    alone = [
        publisher
        for publisher in publishers
        if publisher.type == end.type and publisher.topic not in heard
    ]
    waiting = {o.topic for o in subscribers if o.type == end.type and o.topic not in published}
    is_one = len({publisher.topic for publisher in alone}) == len(waiting) == 1
    is_plain = end.type.partition("/")[0] in (case.package.name, "std_msgs")
    return near or [publisher for publisher in alone if is_plain and is_one and publisher in others]


def is_like(end: Endpoint, other: Endpoint) -> bool:
    """Return whether two names are so alike that one of them is misspelt, or in another group."""
    if end.type != other.type:
        return False
    near = nearest(other.topic.lower(), [end.topic.lower()], _ALIKE)
    return _is_moved(end, other) or near is not None


def _is_moved(end: Endpoint, other: Endpoint) -> bool:
    """Return whether two names differ in their namespaces alone."""
    return last_part(end.topic) == last_part(other.topic)


RULE = Rule("run", ("nodes",), _findings, also=("topic", "type", "starts"), only=ANY)
