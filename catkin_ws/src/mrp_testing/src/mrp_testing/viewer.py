# SPDX-License-Identifier: BSD-3-Clause
"""The viewer under test, a browser's side of its WebSocket, and the nodes to look at."""

import asyncio
import collections
import json
import re
import threading

from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

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
    closed: why the viewer has closed the connection, or None

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
        self.closed = None
        self._url = address.replace("http:", "ws:") + "socket"
        self._origin = address.rstrip("/")
        self._options = options
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *exception):
        try:
            self._loop.call_soon_threadsafe(self._end.set)
        except RuntimeError:  # the viewer has ended the connection
            pass
        self._thread.join(DEADLINE)

    def tell(self, message):
        """Send a message, a dict or a text."""
        text = message if isinstance(message, str) else json.dumps(message)

        async def send():
            await self._connection.write_message(text)

        asyncio.run_coroutine_threadsafe(send(), self._loop).result(DEADLINE)

    def _run(self):
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(self._talk())
        self._loop.close()

    async def _talk(self):
        self._end = asyncio.Event()
        request = HTTPRequest(self._url, headers={"Origin": self._origin})
        self._connection = await websocket_connect(request)
        if self._options:
            await self._connection.write_message(json.dumps(self._options))
        ends = asyncio.ensure_future(self._end.wait())
        while True:
            message = asyncio.ensure_future(self._connection.read_message())
            await asyncio.wait({message, ends}, return_when=asyncio.FIRST_COMPLETED)
            if ends.done() or message.result() is None:
                break
            self._take(json.loads(message.result()))
        self.closed = (self._connection.close_code, self._connection.close_reason)
        self._connection.close()

    def _take(self, message):
        if message["t"] == "graph":
            self.graph = message
            return
        if message.get("all"):
            self.rows, self.links, self.lines = {}, {}, []
        for row in message["rows"]:
            self.rows[row["topic"], row["from"]] = row
            self.samples[row["topic"]] += len(row["samples"])
        for link in message["links"]:
            self.links[link["topic"], link["from"], link["to"]] = link
        for key in message.get("gone", []):
            self.rows.pop(tuple(key), None)
        for key in message.get("links_gone", []):
            self.links.pop(tuple(key), None)
        if message["findings"] is not None:
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
