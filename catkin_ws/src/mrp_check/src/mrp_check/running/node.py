# SPDX-License-Identifier: BSD-3-Clause
"""A node of the spec, and all that was seen of it."""

from __future__ import annotations

import functools
import re

from mrp_check.contract.finding import ERROR, Finding
from mrp_check.running.observing import WRAP, resolved
from mrp_check.running.starting import start_findings

_DIED = re.compile(
    r"\[(?P<name>\S+)-\d+\] process has "
    r"(?:died \[pid \d+, exit code (?P<code>-?\d+)|finished cleanly)"
)
FEW = 4  # messages without which nothing is said of a rate
# Topics that belong to ROS itself.
_ROS_TOPICS = {"/rosout", "/rosout_agg", "/clock", "/tf", "/tf_static", "/diagnostics"}


class Node:
    """See above.

    wanted: what the spec says of it
    all, direct_all: what was seen of all nodes, under the launch file and each by itself
    """

    def __init__(self, node, case):
        self.wanted, self.name = node, node.name
        self.package, self.spec, self.places = case.package, case.spec, case.places
        seen, spec = case.observed, case.spec
        started = seen.started.get(self.name)
        self.path = started.path if started else spec.node_path(self.name)
        self.started = started
        launch = seen.launch or {"lines": [], "seen": {}}
        self.in_launch = bool(seen.launch) and (started is not None or not seen.own_launch)
        self.asked = launch.get("asked", 0)
        self.console = [text for time, _, text in launch["lines"] if time <= self.asked + 0.5]
        self.all = launch["seen"]
        self.latched = launch.get("latched", {})
        self.direct = seen.alone(self.name)
        self.wrap = seen.alone(WRAP + self.name)
        self.direct_all = (seen.direct or {}).get("seen", {})
        self.has_executable = self.name in seen.executables

    def of(self, kind, path=None, seen=None):
        """Return the records of a kind (publications, messages, logs, ...) that are this node's."""
        records = (self.all if seen is None else seen).get(kind, [])
        return [record for record in records if record["node"] == (path or self.path)]

    def direct_of(self, kind):
        name = self.direct and self.direct["name"]
        return self.of(kind, name, self.direct_all) if name else []

    def topics(self, kind, direct=False):
        records = self.direct_of(kind) if direct else self.of(kind)
        return {
            record["topic"]: record["type"]
            for record in records
            if record["topic"] not in _ROS_TOPICS
        }

    def died(self):
        """Return the exit code if roslaunch says that the node ended by itself, or None."""
        for text in self.console:
            found = _DIED.search(text)
            if found and "/" + found["name"] == self.path:
                return int(found["code"] or 0)
        return None

    def errors(self):
        """Return the lines that the node, started by itself, wrote to standard error, before it was
        asked to end."""
        if not self.direct or "lines" not in self.direct:
            return []
        asked = self.direct.get("asked")
        return [
            text
            for time, stream, text in self.direct["lines"]
            if stream == "err" and (asked is None or time < asked)
        ]

    def finding(self, id_, message, place, severity=ERROR, **rest):
        file, line = place
        return Finding(id_, message, file, line, severity, node=self.name, **rest)

    def own_messages(self, topic):
        name = resolved(topic, self.path)
        return [m for m in self.of("messages") if m["topic"] == name]

    def value(self, message, topic):
        """Return the number in a message, or None: it may be of any type."""
        value = (message["fields"] or {}).get(topic.field)
        return value if isinstance(value, (int, float)) else None

    def counter_names(self):
        for event in (self.wrap or {}).get("events", []):
            if event["event"] == "set":
                return tuple(event["names"])
        return ()

    # What was seen of it, for evidence.py

    @functools.cached_property
    def not_up(self):
        """The Findings that say why the node was not up soon after it was started."""
        return list(start_findings(self)) if self.has_executable else []

    @property
    def own_name(self):
        """The name that it had when it ran by itself, or None."""
        return self.direct and self.direct.get("name")

    @property
    def is_up(self):
        registered = self.of("publications") or self.of("subscriptions") or self.own_name
        return bool(self.has_executable and registered and not self.not_up)

    def meets(self):
        """Return whether it was seen on each topic that it is to be on."""
        roles = (
            ("publications", self.wanted.publishing),
            ("subscriptions", self.wanted.subscribing),
        )
        return all(
            resolved(topic, self.path) in self.topics(kind)
            or self.own_name
            and resolved(topic, self.own_name) in self.topics(kind, direct=True)
            for kind, topic in roles
            if topic
        )

    def sent(self):
        """Return the values that it was sent when it ran by itself."""
        return [value for value in (self.direct or {}).get("sent", []) if value is not None]

    def published(self):
        return self.own_messages(self.wanted.publishing) if self.wanted.publishing else []

    def has_rate(self):
        """Return whether it has published enough to tell its rate."""
        return len(self.published()) >= FEW

    def published_numbers(self):
        values = [self.value(message, self.wanted.publishing) for message in self.published()]
        return [value for value in values if value is not None]

    def has_wrapped(self):
        """Return whether it was seen what is published past the largest value: in Python when it
        ran, in C++ by the type of the counter."""
        if self.wrap:
            return any(
                event["event"] in ("after", "error") for event in self.wrap.get("events", [])
            )
        return any(place.values.get("bits") for place in self.places.facts_of(self.name, "step"))

    def has_ended(self):
        """Return whether it was asked to end when it ran by itself, and then ended."""
        return (self.direct or {}).get("stopped_in") is not None


def received_line(node):
    """Return the spec's line for a value that the node receives, or None."""
    return next((line for line in node.wanted.prints if "{value}" in line), None)


def each_node(findings, also_dead=False):
    """Return the function of a case.Case that asks this of each Node that came up.

    also_dead: of those that did not, too
    """

    def of_all(case):
        for node in case.nodes.values():
            if node.is_up or also_dead:
                yield from findings(node)

    return of_all
