# SPDX-License-Identifier: BSD-3-Clause
"""The graph as it can be seen from outside: of the master's state and of what the nodes say.

What is known, and what is only inferred, is kept apart:

- who publishes and subscribes what: the master knows;
- who is connected to whom: the nodes know (getBusInfo), and say so while they live;
- a publisher's type: the viewer knows, as it is itself connected to the publisher;
- a subscriber's type: nobody says, but for the line with which a publisher refuses it.
"""

import collections
import dataclasses
import re
from typing import Dict, List, Optional, Set, Tuple

ALIVE, DEAD, SILENT, UNKNOWN = "alive", "dead", "silent", "unknown"

# Looks at a pair of nodes before "no connection" is said: connecting takes a moment.
PATIENCE = 3

# With these words roscpp's and rospy's publishers refuse a subscriber.
_ROSCPP = re.compile(
    r"Client \[(?P<subscriber>\S+)\] wants topic (?P<topic>\S+) to have datatype/md5sum "
    r"\[(?P<wanted>[^\]]*)/\w*\], but our version has \[(?P<has>[^\]]*)/\w*\]"
)
_ROSPY = re.compile(
    r"topic types do not match: \[(?P<wanted>[^\]]*)\] vs\. \[(?P<has>[^\]]*)\]"
    r"\{.*'callerid': '(?P<subscriber>[^']*)'.*'topic': '(?P<topic>[^']*)'"
)

Refusal = collections.namedtuple("Refusal", "topic publisher subscriber wanted has")


def refusal(node, line):
    """Return the Refusal that a node's log line tells of, or None."""
    match = _ROSCPP.search(line) or _ROSPY.search(line)
    return match and Refusal(
        match["topic"], node, match["subscriber"], match["wanted"], match["has"]
    )


@dataclasses.dataclass
class NodeReport:
    """What is known of a node. uri: its XML-RPC address; why: what went wrong when it was asked."""

    uri: Optional[str] = None
    state: str = UNKNOWN
    why: str = ""
    failures: int = 0  # questions in a row that found nobody
    outbound: List = dataclasses.field(default_factory=list)  # of reports.End
    inbound: List = dataclasses.field(default_factory=list)
    sent_before: Dict = dataclasses.field(default_factory=dict)  # (topic, peer) -> messages


@dataclasses.dataclass
class Observation:
    """All that the graph is made of.

    publishers, subscribers: topic -> names of nodes
    services: names of all nodes with services
    types: topic -> the type that the master knows
    reports: node -> NodeReport
    sender_types: (topic, publisher) -> the type that it told the viewer
    latched: those of them that latch
    refusals: (topic, publisher, subscriber) -> Refusal
    age: (topic, publisher, subscriber) -> how often the two have been seen, both alive, and not
        connected, in a row
    viewer: the viewer's own name
    """

    publishers: Dict[str, List[str]] = dataclasses.field(default_factory=dict)
    subscribers: Dict[str, List[str]] = dataclasses.field(default_factory=dict)
    services: List[str] = dataclasses.field(default_factory=list)
    types: Dict[str, str] = dataclasses.field(default_factory=dict)
    reports: Dict[str, NodeReport] = dataclasses.field(default_factory=dict)
    sender_types: Dict[Tuple[str, str], str] = dataclasses.field(default_factory=dict)
    latched: Set[Tuple[str, str]] = dataclasses.field(default_factory=set)
    refusals: Dict[Tuple[str, str, str], Refusal] = dataclasses.field(default_factory=dict)
    age: Dict[Tuple[str, str, str], int] = dataclasses.field(default_factory=dict)
    viewer: str = ""

    def nodes(self):
        """Return the names of all nodes."""
        parts = (*self.publishers.values(), *self.subscribers.values(), self.services)
        return {name for names in parts for name in names}

    def pairs(self):
        """Return (topic, publisher, subscriber) of all who should be connected."""
        return [
            (topic, publisher, subscriber)
            for topic, publishers in self.publishers.items()
            for subscriber in self.subscribers.get(topic, [])
            for publisher in publishers
        ]

    def state(self, node):
        if node == self.viewer:
            return ALIVE
        return self.reports[node].state if node in self.reports else UNKNOWN

    def connected(self, topic, publisher, subscriber):
        """Say if two nodes are connected; None if neither says anything."""
        if self.viewer in (publisher, subscriber):
            return True
        answers = []
        if self.state(publisher) == ALIVE:
            answers.append(self.sent_end(topic, publisher, subscriber) is not None)
        if self.state(subscriber) == ALIVE:
            answers.append(self.received_end(topic, publisher, subscriber) is not None)
        return any(answers) if answers else None

    def sent_end(self, topic, publisher, subscriber):
        """Return the publisher's End of a connection, or None."""
        for end in self.reports.get(publisher, NodeReport()).outbound:
            if (end.topic, end.peer) == (topic, subscriber):
                return end
        return None

    def received_end(self, topic, publisher, subscriber):
        """Return the subscriber's End of a connection, or None."""
        uri = self.reports.get(publisher, NodeReport()).uri
        for end in self.reports.get(subscriber, NodeReport()).inbound:
            if (end.topic, end.peer) == (topic, uri):
                return end
        return None

    def grow_older(self):
        """Count for how long two living nodes have not been connected. Call it after each look."""
        self.age = {
            pair: self.age.get(pair, 0) + 1
            for pair in self.pairs()
            if self.connected(*pair) is False
            and self.state(pair[1]) == self.state(pair[2]) == ALIVE
        }


def link(observation, topic, publisher, subscriber):
    """Return (state, why) of what should be a connection.

    "ok"; "mismatch": the types differ; "none": both live, and are not connected; "waiting": not
    yet; "dead": one of the two is; "unknown": neither node says.
    """
    if DEAD in (observation.state(publisher), observation.state(subscriber)):
        return "dead", ""
    connected = observation.connected(topic, publisher, subscriber)
    if connected:
        return "ok", ""
    if connected is None:
        return "unknown", "neither node answers"
    refused = observation.refusals.get((topic, publisher, subscriber))
    if refused:
        return "mismatch", (
            f"{publisher} refuses {subscriber}: it publishes {refused.has}, "
            f"and {subscriber} expects {refused.wanted}"
        )
    if observation.age.get((topic, publisher, subscriber), 0) < PATIENCE:
        return "waiting", "not connected yet"
    has = observation.sender_types.get((topic, publisher))
    of_type = f" ({has})" if has else ""
    return "none", (
        f"{subscriber} isn't connected to {publisher}{of_type}, though both answer. Perhaps the "
        "types differ, or it can't reach the publisher's address. Its log says more"
    )


def build(observation):
    """Return the graph as the page gets it: nodes, topics, edges and links.

    edges: from a publisher to a topic, or from a topic to a subscriber
    links: from a publisher over a topic to a subscriber, with (state, why) as link() says
    """
    nodes = []
    for name in sorted(observation.nodes()):
        report = observation.reports.get(name, NodeReport())
        nodes.append(
            {"name": name, "state": observation.state(name), "why": report.why, "uri": report.uri}
        )
    topics = []
    for name in sorted({*observation.publishers, *observation.subscribers}):
        sent = {
            observation.sender_types[name, publisher]
            for publisher in observation.publishers.get(name, [])
            if (name, publisher) in observation.sender_types
        }
        types = sorted(sent or {observation.types.get(name, "type unknown")})
        latched = any(
            (name, publisher) in observation.latched
            for publisher in observation.publishers.get(name, [])
        )
        label = (
            types[0]
            + (f" +{len(types) - 1}" if types[1:] else "")
            + (", latched" if latched else "")
        )
        topics.append({"name": name, "types": types, "latched": latched, "label": label})
    links = []
    for topic, publisher, subscriber in observation.pairs():
        state, why = link(observation, topic, publisher, subscriber)
        links.append(
            {"topic": topic, "from": publisher, "to": subscriber, "state": state, "why": why}
        )
    return {"nodes": nodes, "topics": topics, "links": links, "edges": _edges(observation, links)}


def _edges(observation, links):
    of_subscriber = collections.defaultdict(list)
    of_publisher = collections.defaultdict(list)
    for link in links:
        of_subscriber[link["topic"], link["to"]].append(link)
        of_publisher[link["topic"], link["from"]].append(link)
    edges = []
    for topic, publishers in sorted(observation.publishers.items()):
        for publisher in publishers:
            # Red only if all refuse it: otherwise the fault is the subscriber's.
            states = of_publisher[topic, publisher]
            bad = [state for state in states if state["state"] in ("mismatch", "none")]
            worst = bad if len(bad) == len(states) else []
            edges.append(_edge(observation, publisher, topic, publisher, True, worst))
    for topic, subscribers in sorted(observation.subscribers.items()):
        for subscriber in subscribers:
            worst = [
                link
                for link in of_subscriber[topic, subscriber]
                if link["state"] in ("mismatch", "none")
            ]
            edges.append(_edge(observation, topic, subscriber, subscriber, False, worst))
    return edges


def _edge(observation, start, end, node, publishes, faults):
    state = "dead" if observation.state(node) == DEAD else "ok"
    if faults:
        state = "mismatch" if any(fault["state"] == "mismatch" for fault in faults) else "none"
    return {
        "from": start,
        "to": end,
        "publishes": publishes,
        "state": state,
        "why": "\n".join(fault["why"] for fault in faults if fault["state"] == state),
    }


def counts(observation):
    """Return what is known of the messages over each connection: a list of dicts.

    sent: by the publisher to this subscriber; received: by the subscriber
    dropped: by the subscriber's queue, as roscpp counts it
    missing: sent but not received: rospy counts only what its queue has let through. What was sent
        must have been so at the look before this one: but what is under way for longer, as it is
        with a slow callback, is in it, too
    Each may be None: a node does not say (see reports.py).
    """
    result = []
    for topic, publisher, subscriber in observation.pairs():
        sent = observation.sent_end(topic, publisher, subscriber)
        received = observation.received_end(topic, publisher, subscriber)
        if sent is None and received is None:
            continue
        n_sent = sent and sent.messages
        n_received = received and received.messages
        dropped = received and received.dropped
        missing = None
        if dropped is None and n_sent is not None and n_received is not None:
            before = observation.reports[publisher].sent_before.get((topic, subscriber), 0)
            missing = max(0, before - n_received)
        result.append(
            {
                "topic": topic,
                "from": publisher,
                "to": subscriber,
                "sent": n_sent,
                "received": n_received,
                "dropped": dropped,
                "missing": missing,
            }
        )
    return result
