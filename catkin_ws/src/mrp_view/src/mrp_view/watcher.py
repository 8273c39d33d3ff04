# SPDX-License-Identifier: BSD-3-Clause
"""Look at the master and at each node, over and over, in threads of its own."""

import concurrent.futures
import socket
import threading
import time

from mrp_view import reports, rpc
from mrp_view.graph import ALIVE, DEAD, SILENT, NodeReport, Observation

LOOK = 0.5  # seconds from one look at the master to the next
ASK = 1.0  # seconds from one question to a node to the next
TIMEOUT = 1.0  # seconds that a node, or the master, may take to answer
PATIENCE = 3  # questions in a row that must fail before a node is called dead
_MOST = 25  # nodes that are asked in a second
_WORKERS = 16


class Watcher:
    """Keeps an Observation up to date.

    master_uri: where the master should be
    on_look: called after each look, in the watcher's thread, with the watcher

    lock: to be held while `seen` is read
    proxy: the master's, for on_look
    master: "here"; "never" as long as there has been none; "gone" while nodes go on without it;
        "ended" when they have ended, too
    """

    def __init__(self, master_uri, viewer, on_look):
        self.lock = threading.Lock()
        self.observation = Observation(viewer=viewer)
        self.master_uri = master_uri
        self.master = "never"
        self.why = ""
        self._on_look = on_look
        self.proxy = rpc.Proxy(master_uri, TIMEOUT)
        self._proxies = {}  # node -> rpc.Proxy
        self._asked = {}  # node -> when it was asked last
        self._being_asked = set()
        self._end = threading.Event()
        self._pool = concurrent.futures.ThreadPoolExecutor(_WORKERS)
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self):
        self._thread.start()

    def stop(self):
        self._end.set()
        self._thread.join()
        self._pool.shutdown()

    def _run(self):
        while not self._end.is_set():
            begin = time.monotonic()
            self._look_at_master()
            self._ask_nodes()
            with self.lock:
                self.observation.grow_older()
            self._on_look(self)
            self._end.wait(max(0.05, begin + LOOK - time.monotonic()))

    def _look_at_master(self):
        """Take over what the master says; what it said last stays as long as it says nothing."""
        try:
            publishers, subscribers, services = self.proxy.call("getSystemState")
            types = dict(self.proxy.call("getTopicTypes"))
            uris = {}
            nodes = {
                name for part in (publishers, subscribers, services) for _, n in part for name in n
            }
            for node in nodes - set(self._proxies):
                uris[node] = self.proxy.call("lookupNode", node)
        except rpc.ERRORS as error:
            self._without_master(str(error))
            return
        with self.lock:
            self.master = "here"
            self.why = ""
            self.observation.publishers = {topic: sorted(names) for topic, names in publishers}
            self.observation.subscribers = {topic: sorted(names) for topic, names in subscribers}
            self.observation.services = sorted({name for _, names in services for name in names})
            self.observation.types = types
            for node, uri in uris.items():
                self._move(node, uri)
            for node in set(self.observation.reports) - nodes:
                del self.observation.reports[node]
                self._proxies.pop(node, None)
                self._asked.pop(node, None)

    def _without_master(self, why):
        """Keep the nodes that still answer: if none does, the whole system has ended."""
        with self.lock:
            self.why = why
            if self.master == "never":
                return
            others = self.observation.nodes() - {self.observation.viewer}
            reports = [self.observation.reports[node] for node in others]
            # One question that found nobody is enough here. To call a node dead it isn't: roslaunch
            # ends the master and /rosout at almost the same time.
            answer = any(
                report.state in (ALIVE, SILENT) and not report.failures for report in reports
            )
            self.master = "gone" if answer else "ended"
            if self.master == "ended":
                (
                    self.observation.publishers,
                    self.observation.subscribers,
                    self.observation.services,
                ) = {}, {}, []
                self.observation.reports.clear()
                self._proxies.clear()
                self._asked.clear()

    def _move(self, node, uri):
        self._proxies[node] = rpc.Proxy(uri, TIMEOUT)
        self.observation.reports[node] = NodeReport(uri=uri)

    def _ask_nodes(self):
        now = time.monotonic()
        every = max(ASK, len(self._proxies) / _MOST)
        for node, proxy in list(self._proxies.items()):
            if (
                node == self.observation.viewer
                or node in self._being_asked
                or now - self._asked.get(node, 0) < every - LOOK / 2
            ):
                continue
            self._asked[node] = now
            self._being_asked.add(node)
            self._pool.submit(self._ask, node, proxy)

    def _ask(self, node, proxy):
        try:
            state, why, ends = self._answer(node, proxy)
            with self.lock:
                report = self.observation.reports.get(node)
                if report is not None and self._proxies.get(node) is proxy:
                    # A node that ends stops answering a moment before it leaves the master's list.
                    report.failures = report.failures + 1 if state == DEAD else 0
                    if state == DEAD and report.failures < PATIENCE:
                        return
                    report.state, report.why = state, why
                    if ends is not None:
                        report.sent_before = {
                            (connection.topic, connection.peer): connection.messages or 0
                            for connection in report.outbound
                        }
                        report.outbound, report.inbound = ends
        finally:
            self._being_asked.discard(node)

    def _answer(self, node, proxy):
        """Return (state, why, ends or None)."""
        try:
            info = proxy.call("getBusInfo")
        except rpc.ERRORS as error:
            return self._failed(node, proxy, error)
        try:
            stats = proxy.call("getBusStats")
        except rpc.ERRORS:
            stats = []
        return ALIVE, "", reports.ends(info, stats)

    def _failed(self, node, proxy, error):
        if isinstance(error, OSError) and not isinstance(error, socket.timeout):
            # It may have come back at another address.
            try:
                uri = rpc.Proxy(self.master_uri, TIMEOUT).call("lookupNode", node)
                if uri != proxy.uri:
                    with self.lock:
                        self._move(node, uri)
            except rpc.ERRORS:
                pass
            return DEAD, f"nothing answers at {proxy.uri}: {error}", ([], [])
        return SILENT, f"{proxy.uri} doesn't answer: {error}", None
