# SPDX-License-Identifier: BSD-3-Clause
"""A node of the spec, and all that was seen of it."""

from __future__ import annotations

import re

from mrp_check.finding import ERROR, Finding
from mrp_check.stages.observing import WRAP, resolved

_DIED = re.compile(
    r"\[(?P<name>\S+)-\d+\] process has "
    r"(?:died \[pid \d+, exit code (?P<code>-?\d+)|finished cleanly)"
)
# Topics that belong to ROS itself.
_ROS_TOPICS = {"/rosout", "/rosout_agg", "/clock", "/tf", "/tf_static", "/diagnostics"}


class Node:
    """See above.

    wanted: what the spec says of it
    all, direct_all: what was seen of all nodes, under the launch file and each by itself
    """

    def __init__(self, node, package, spec, seen, places):
        self.wanted, self.name = node, node.name
        self.package, self.spec, self.places = package, spec, places
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
        fields = message["fields"] or {}
        return fields.get(topic.field)

    def counter_names(self):
        for event in (self.wrap or {}).get("events", []):
            if event["event"] == "set":
                return tuple(event["names"])
        return ()
