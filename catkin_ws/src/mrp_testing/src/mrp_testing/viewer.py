# SPDX-License-Identifier: BSD-3-Clause
"""The viewer under test, a browser's side of its WebSocket, and the nodes to look at."""

import collections
import json
import re
import threading

import websocket

from mrp_testing import contract
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import DEADLINE, wait_until

PUBLISHERS = tuple(f"{contract.GROUP}/{node.name}" for node in contract.PUBLISHERS)
SUBSCRIBERS = tuple(f"{contract.GROUP}/{node.name}" for node in contract.SUBSCRIBERS)
TOPIC = f"{contract.GROUP}/{contract.TOPIC}"


class PubSub(Process):
    """The tutorial's four nodes."""

    def __init__(self, *arguments, extra_env=None):
        command = ("roslaunch", contract.PACKAGE, contract.LAUNCH_FILE, *arguments)
        super().__init__(*command, extra_env=extra_env)


class Viewer(Process):
    """view_node.py at a free port. address: such as "http://127.0.0.1:40000/"."""

    def __init__(self, *options, port=0, extra_env=None):
        super().__init__(
            program("mrp_view", "view_node.py"),
            *("--port", str(port), *options),
            extra_env={**LIVE, **(extra_env or {})},
        )
        self.wait_for(lambda: self._addresses(), "the address")
        self.address = self._addresses()[0]

    def _addresses(self):
        lines = (re.match(r"Open (http://\S+)", line) for line in list(self.lines))
        return [match[1] for match in lines if match]


class Client:
    """What a page gets: the parts of it as they are now.

    graph: the last message of that kind; rows: (topic, publisher) -> row;
    links: (topic, publisher, subscriber) -> link; findings, lines: as the viewer sends them
    told: (kind, text) of all findings so far
    samples: topic -> how many of its messages were looked into
    closed: whether the viewer has closed the connection

    Use it in a `with`.
    """

    def __init__(self, address, **options):
        self.graph = None
        self.rows = {}
        self.links = {}
        self.findings = []
        self.told = set()
        self.lines = []
        self.ticks = 0
        self.samples = collections.Counter()
        self.closed = False
        self._socket = websocket.create_connection(
            address.replace("http:", "ws:") + "socket",
            origin=address.rstrip("/"),
            timeout=DEADLINE,
            http_no_proxy=["*"],
        )
        if options:
            self.tell(options)
        self._ends = False
        self._thread = threading.Thread(target=self._read)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *exception):
        self._ends = True
        self._thread.join()
        self._socket.close()

    def tell(self, message):
        """Send a message, a dict or a text."""
        self._socket.send(message if isinstance(message, str) else json.dumps(message))

    def _read(self):
        # A message comes ten times a second.
        while not self._ends:
            try:
                text = self._socket.recv()
            except (OSError, websocket.WebSocketException):
                text = ""
            if not text:
                self.closed = True
                return
            self._take(json.loads(text))

    def _take(self, message):
        if message["t"] == "graph":
            self.graph = message
            return
        self.rows = {(row["topic"], row["from"]): row for row in message["rows"]}
        self.links = {(link["topic"], link["from"], link["to"]): link for link in message["links"]}
        for row in message["rows"]:
            self.samples[row["topic"]] += len(row["samples"])
        self.findings = message["findings"]
        self.told |= {(finding["kind"], finding["text"]) for finding in self.findings}
        self.lines = (self.lines + message["log"])[-1000:]
        self.ticks += 1

    def states(self):
        """Return node -> state of the nodes in the graph."""
        nodes = self.graph["graph"]["nodes"] if self.graph else []
        return {node["name"]: node["state"] for node in nodes}

    def edges(self):
        """Return (from, to) -> state of the edges in the graph."""
        edges = self.graph["graph"]["edges"] if self.graph else []
        return {(edge["from"], edge["to"]): edge["state"] for edge in edges}

    def link_states(self):
        """Return (topic, publisher, subscriber) -> (state, why)."""
        links = self.graph["graph"]["links"] if self.graph else []
        return {(o["topic"], o["from"], o["to"]): (o["state"], o["why"]) for o in links}

    def wait_for(self, condition, what):
        return wait_until(condition, lambda: f"{what}\n{self.explain()}")

    def wait_for_finding(self, kind):
        """Wait until there is a finding of a kind: it comes after the graph that it is about."""
        self.wait_for(
            lambda: kind in {finding["kind"] for finding in self.findings},
            f"a finding of the kind {kind}",
        )

    def explain(self):
        return json.dumps(
            [
                self.graph and self.graph["graph"],
                list(self.rows.values()),
                list(self.links.values()),
            ]
        )
