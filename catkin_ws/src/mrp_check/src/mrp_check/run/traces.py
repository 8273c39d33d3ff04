# SPDX-License-Identifier: BSD-3-Clause
"""All that was seen of a node of the spec."""

from __future__ import annotations

import re
from typing import Any

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Message, Number, Seen
from mrp_check.contract import spec as specs
from mrp_check.contract.finding import SEEN, Finding, Where
from mrp_check.run.observing import ends
from mrp_check.run.planning import WRAP
from mrp_check.run.source_lines import Places

# Topics that belong to ROS itself.
ROS_TOPICS = {"/rosout", "/rosout_agg", "/clock", "/tf", "/tf_static", "/diagnostics"}
# What each node offers by itself.
ROS_SERVICES = {"get_loggers", "set_logger_level", "tf2_frames"}


def outside(topic: str) -> str:
    """Return a topic's name without the namespace that a node has when it runs by itself."""
    return re.sub(r"^/check_\d+/", "/", topic)


class Traces:
    """All that was seen of a node of the spec.

    wanted: what the spec says of it
    path: its full name under the launch file
    seen, seen_alone: what the observer has seen of it, under the launch file and by itself
    waited: which part of the time it waited for a processor while it published there
    console: what roslaunch printed until it was to end
    direct, wrap: what came of it by itself, and near the end of its numbers; or None
    """

    def __init__(self, wanted: specs.NodeSpec, spec: specs.Spec, places: Places) -> None:
        self.wanted, self.name, self.spec, self.places = wanted, wanted.name, spec, places
        self.package, observed = places.package, places.observed
        self.started = observed.started.get(self.name)
        self.path = self.started.path if self.started else spec.node_path(self.name)
        launch, direct = observed.launch, observed.direct
        has_started = self.started is not None or not observed.own_launch
        self.in_launch = launch is not None and has_started
        self.asked = launch.asked if launch else 0.0
        self.console = launch.until_asked() if launch else []
        self.waited = launch.waited.get(self.path, 0.0) if launch else 0.0
        self.latched = launch.latched if launch else {}
        self.direct = observed.alone(self.name)
        self.wrap = observed.alone(WRAP + self.name)
        self.seen = _of_node(launch.seen if launch else Seen(), self.path)
        self.seen_alone = _of_node(direct.seen if direct else Seen(), self.own_name)
        self.has_executable = self.name in observed.executables

    def topics(self, kind: Kind, alone: bool = False) -> dict[str, str]:
        """Return topic -> type of what it publishes (Kind.PUBLISHER), or subscribes to."""
        seen = self.seen_alone if alone else self.seen
        records = seen.publications if kind is Kind.PUBLISHER else seen.subscriptions
        return {record.topic: record.type for record in records if record.topic not in ROS_TOPICS}

    def is_unheard(self, topic: str) -> bool:
        """Return whether nothing is known of what it publishes on a topic that it announces."""
        announced = [*self.seen.publications, *self.seen_alone.publications]
        return any(record.topic == topic and not record.heard for record in announced)

    def died(self) -> int | None:
        """Return the exit code if roslaunch says that the node ended by itself, or None."""
        return ends(self.console).get(self.path)

    def errors(self) -> list[str]:
        """Return the lines that the node, started by itself, wrote to standard error, before it was
        asked to end."""
        if not self.direct:
            return []
        asked = self.direct.asked
        return [
            text
            for time, stream, text in self.direct.lines
            if stream == "err" and (asked is None or time < asked)
        ]

    def finding(
        self, id_: str, message: str, place: Where, certainty: str = SEEN, **rest: Any
    ) -> Finding:
        file, line = place
        return Finding(id_, message, file, line, certainty, node=self.name, **rest)

    def value(self, message: Message, topic: specs.Topic) -> Number | None:
        """Return the number in a message, or None."""
        return topic.value_in((message.fields or {}).get(topic.field))

    def counter_names(self) -> list[str]:
        """Return the names of what holds its counter, as far as they were found."""
        events = self.wrap.events if self.wrap else []
        return next((event.names or [] for event in events if event.event == "set"), [])

    @property
    def own_name(self) -> str | None:
        """The name that it had when it ran by itself, or None."""
        return self.direct.name if self.direct else None

    @property
    def is_registered(self) -> bool:
        """Whether the master heard of it under the launch file."""
        return bool(self.seen.publications or self.seen.subscriptions)


def _of_node(seen: Seen, name: str | None) -> Seen:
    """Return what was seen of one node."""
    return Seen(
        [registration for registration in seen.publications if registration.node == name],
        [registration for registration in seen.subscriptions if registration.node == name],
        [message for message in seen.messages if message.node == name],
        [log for log in seen.logs if log.node == name],
        seen.lag,
        [registration for registration in seen.services if registration.node == name],
        [registration for registration in seen.lookups if registration.node == name],
    )
