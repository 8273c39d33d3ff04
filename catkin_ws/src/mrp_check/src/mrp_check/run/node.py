# SPDX-License-Identifier: BSD-3-Clause
"""A node of the spec, and what comes of all that was seen of it."""

from __future__ import annotations

import copy
import dataclasses
import functools
import itertools
from typing import Callable, Iterable, Iterator, Mapping, Protocol

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Alone, Message, Number
from mrp_check.contract.finding import Finding
from mrp_check.contract.spec import Topic
from mrp_check.run.planning import EXAMPLE, resolved
from mrp_check.run.starting import start_findings
from mrp_check.run.traces import Traces

FEW = 4  # messages without which nothing is said of a rate


class Node(Traces):
    """A node of the spec, with what follows from all that was seen of it."""

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
            for kind, topics in roles
            for topic in topics
        )

    def of_topics(self) -> Iterator[Node]:
        """Yield this node for each topic that it publishes on, as if that were the only one."""
        if len(self.wanted.published) < 2:
            yield self
            return
        for role in self.wanted.published:
            view = copy.copy(self)
            view.wanted = dataclasses.replace(self.wanted, published=(role,))
            yield view

    def ran_for(self, number: int) -> Alone | None:
        """Return what was seen of the run for one of its examples, or None."""
        return self.places.observed.alone(f"{EXAMPLE}{self.name}:{number}")

    def sent(self) -> list[int]:
        """Return the values that it was sent when it ran by itself."""
        sent = self.direct.sent if self.direct else []
        return [value for value in sent if value is not None]

    def published(self, alone: bool = False) -> list[Message]:
        """Return its messages, under the launch file or alone, on the topic that the spec says."""
        path, seen = (self.own_name, self.seen_alone) if alone else (self.path, self.seen)
        name = path and self._topic and resolved(self._topic, path)
        return [message for message in seen.messages if message.topic == name]

    def runs(self) -> list[list[Message]]:
        """Return its messages there of each run; by itself it is seen for longer."""
        # What a node publishes may follow from what it was sent, which differs.
        alone = [] if self.wanted.subscribing else self.published(alone=True)
        return [self.published(), alone]

    @property
    def _topic(self) -> Topic | None:
        return next(iter(self.wanted.publishing), None)

    def has_rate(self) -> bool:
        """Return whether it has published enough to tell its rate."""
        return len(self.published()) >= FEW

    def published_numbers(self) -> list[Number]:
        topic = self._topic
        values = [self.value(message, topic) for message in self.published() if topic]
        return [value for value in values if value is not None]

    def wrong_texts(self) -> list[str]:
        """Return the texts that it published, and that are not what the spec says of its topic."""
        topic = self._topic
        if topic is None or not topic.text:
            return []
        messages = itertools.chain(*self.runs())
        contents = [(message.fields or {}).get(topic.field) for message in messages]
        return [text for text in contents if isinstance(text, str) and topic.value_in(text) is None]

    def has_wrapped(self) -> bool:
        """Return whether it was seen what is published past the largest value: in Python when it
        ran, in C++ by the type of the counter."""
        if self.wrap:
            return any(event.event in ("after", "error") for event in self.wrap.events)
        return any(place.bits for place in self.places.facts.of(self.name, Kind.STEP))

    def has_ended(self) -> bool:
        """Return whether it was asked to end when it was up by itself, and then ended."""
        direct = self.direct
        return direct is not None and None not in (direct.name, direct.stopped_in)


class HasNodes(Protocol):
    """A case.Case, as far as each_node() needs one."""

    @property
    def nodes(self) -> Mapping[str, Node]: ...


def each_node(
    findings: Callable[[Node], Iterable[Finding]], also_dead: bool = False, each_topic: bool = False
) -> Callable[[HasNodes], Iterator[Finding]]:
    """Return the function of a case.Case that asks this of each Node that came up.

    also_dead: of those that did not, too; each_topic: for each topic that it publishes on
    """

    def of_all(case: HasNodes) -> Iterator[Finding]:
        for node in case.nodes.values():
            if node.is_up or also_dead:
                for view in node.of_topics() if each_topic else (node,):
                    yield from findings(view)

    return of_all
