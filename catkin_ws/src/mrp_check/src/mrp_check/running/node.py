# SPDX-License-Identifier: BSD-3-Clause
"""A node of the spec, and what comes of all that was seen of it."""

from __future__ import annotations

import functools
from typing import Callable, Iterable, Iterator, Mapping, Protocol

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Message, Number
from mrp_check.contract.finding import Finding
from mrp_check.running.planning import resolved
from mrp_check.running.starting import start_findings
from mrp_check.running.traces import Traces

FEW = 4  # messages without which nothing is said of a rate


class Node(Traces):
    """See above."""

    @functools.cached_property
    def not_up(self) -> list[Finding]:
        """The Findings that say why the node was not up soon after it was started."""
        return list(start_findings(self)) if self.has_executable else []

    @property
    def is_up(self) -> bool:
        registered = self.is_registered or self.own_name
        return bool(self.has_executable and registered and not self.not_up)

    def meets(self) -> bool:
        """Return whether it was seen on each topic that it is to be on."""
        roles = (
            (Kind.PUBLISHER, self.wanted.publishing),
            (Kind.SUBSCRIBER, self.wanted.subscribing),
        )
        return all(
            resolved(topic, self.path) in self.topics(kind)
            or self.own_name is not None
            and resolved(topic, self.own_name) in self.topics(kind, alone=True)
            for kind, topic in roles
            if topic
        )

    def sent(self) -> list[int]:
        """Return the values that it was sent when it ran by itself."""
        sent = self.direct.sent if self.direct else []
        return [value for value in sent if value is not None]

    def published(self) -> list[Message]:
        """Return its messages, under the launch file, on the topic that the spec says."""
        topic = self.wanted.publishing
        name = topic and resolved(topic, self.path)
        return [message for message in self.seen.messages if message.topic == name]

    def has_rate(self) -> bool:
        """Return whether it has published enough to tell its rate."""
        return len(self.published()) >= FEW

    def published_numbers(self) -> list[Number]:
        topic = self.wanted.publishing
        values = [self.value(message, topic) for message in self.published() if topic]
        return [value for value in values if value is not None]

    def wrong_texts(self) -> list[str]:
        """Return the texts that it published, and that are not what the spec says of its topic."""
        topic = self.wanted.publishing
        if topic is None or not topic.text:
            return []
        said = [(message.fields or {}).get(topic.field) for message in self.published()]
        return [one for one in said if isinstance(one, str) and topic.value_in(one) is None]

    def has_wrapped(self) -> bool:
        """Return whether it was seen what is published past the largest value: in Python when it
        ran, in C++ by the type of the counter."""
        if self.wrap:
            return any(event.event in ("after", "error") for event in self.wrap.events)
        return any(place.bits for place in self.places.facts.of(self.name, Kind.STEP))

    def has_ended(self) -> bool:
        """Return whether it was asked to end when it ran by itself, and then ended."""
        return self.direct is not None and self.direct.stopped_in is not None


class HasNodes(Protocol):
    """A case.Case, as far as each_node() needs one."""

    @property
    def nodes(self) -> Mapping[str, Node]: ...


def each_node(
    findings: Callable[[Node], Iterable[Finding]], also_dead: bool = False
) -> Callable[[HasNodes], Iterator[Finding]]:
    """Return the function of a case.Case that asks this of each Node that came up.

    also_dead: of those that did not, too
    """

    def of_all(case: HasNodes) -> Iterator[Finding]:
        for node in case.nodes.values():
            if node.is_up or also_dead:
                yield from findings(node)

    return of_all
