# SPDX-License-Identifier: BSD-3-Clause
"""The web server: the page, the WebSocket over which it gets what happens, and the tutorial."""

import asyncio
import collections
import json
import os
import subprocess
import time

import tornado.httpserver
import tornado.ioloop
import tornado.iostream
import tornado.netutil
import tornado.web
import tornado.websocket

from mrp_view import access, feed
from mrp_view.drawing import Structure
from mrp_view.findings import findings

TICK = 0.1  # seconds between two messages to a browser, at the least
_LAYOUTS = 32  # that are kept


class _Guarded:
    """What each answer has in common: see access.py."""

    def set_default_headers(self):
        for name, value in access.HEADERS.items():
            self.set_header(name, value)

    def prepare(self):
        view = self.application.settings["view"]
        if not access.allowed_host(self.request.host, view.address, view.names):
            self.set_status(403)
            self.finish(
                "The viewer doesn't serve its page at this address. Open the address that it "
                "printed, or start it with --name and the name in your address bar.\n"
            )

    def write_error(self, status_code, **kwargs):
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(f"{status_code}: {self._reason}\n")


class Page(_Guarded, tornado.web.StaticFileHandler):
    pass


class Tutorial(_Guarded, tornado.web.StaticFileHandler):
    async def get(self, path, include_body=True):
        if os.path.isdir(self.root):
            return await super().get(path, include_body)
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.set_status(404)
        self.finish("The tutorial's pages aren't built here. To build them: make docs\n")

    def set_extra_headers(self, path):
        self.set_header("Content-Security-Policy", access.TUTORIAL_POLICY)


class Socket(_Guarded, tornado.websocket.WebSocketHandler):
    """One browser. At most one message to it is under way."""

    def initialize(self):
        self.options = None
        self.is_busy = False
        self.graph_sent = None
        self.log_sent = 0

    def check_origin(self, origin):
        return access.allowed_origin(
            origin, self.request.host, self.application.settings["view"].names
        )

    def prepare(self):
        super().prepare()
        if not self._finished and self.request.headers.get("Origin") is None:
            self.set_status(403)
            self.finish("Expected the header Origin, which a browser sends.\n")

    def open(self):
        view = self.application.settings["view"]
        self.options = feed.options_of({}, view.viewer)
        view.sockets.add(self)

    def on_message(self, message):
        try:
            data = json.loads(message)
        except ValueError:
            data = None
        if not isinstance(data, dict):
            self.close(4001, "expected a JSON object")
            return
        view = self.application.settings["view"]
        self.options = feed.options_of(data, view.viewer)
        self.graph_sent = None

    def on_close(self):
        self.application.settings["view"].sockets.discard(self)

    def send(self, texts):
        """Begin to send these messages. The one before must have gone."""
        self.is_busy = True
        asyncio.ensure_future(self._write(texts))

    async def _write(self, texts):
        try:
            for text in texts:
                await self.write_message(text)
        except (tornado.websocket.WebSocketClosedError, tornado.iostream.StreamClosedError):
            pass
        finally:
            self.is_busy = False


class View:
    """Puts together what the watcher and the listener see, and hands it to the browsers.

    address, port: to listen on; port 0: any that is free
    names: under which the page may be asked for besides
    page, tutorial: folders; that of the tutorial may be made later
    """

    def __init__(self, viewer, listener, address, port, names, page, tutorial):
        self.viewer = viewer
        self.address = address
        self.names = names
        self.sockets = set()
        self._listener = listener
        self._tutorial = tutorial
        self._graph = {"nodes": [], "topics": [], "edges": [], "links": []}
        self._master = {"state": "never", "uri": "", "why": ""}
        self._counts = []
        self._version = 0
        self._layouts = collections.OrderedDict()  # Structure's key -> layout, or an error's text
        self._being_laid_out = set()
        self._dot = asyncio.Lock()

        guarded = {"path": str(page), "default_filename": "index.html"}
        pages = {"path": str(tutorial), "default_filename": "index.html"}
        application = tornado.web.Application(
            [
                (r"/socket", Socket),
                (r"/tutorial/(.*)", Tutorial, pages),
                (r"/(.*)", Page, guarded),
            ],
            view=self,
            log_function=lambda handler: None,
            websocket_ping_interval=10,
            websocket_ping_timeout=30,
            websocket_max_message_size=100_000,
        )
        self._server = tornado.httpserver.HTTPServer(application)
        sockets = tornado.netutil.bind_sockets(port, address)
        self._server.add_sockets(sockets)
        self.port = sockets[0].getsockname()[1]

    def start(self):
        tornado.ioloop.PeriodicCallback(self._tick, TICK * 1000).start()

    def show(self, master, graph, all_counts):
        """Show what the watcher has seen: in the server's own thread.

        master: a dict for the page; graph, all_counts: of graph.build and graph.counts
        """
        self._counts = all_counts
        if (master, graph) != (self._master, self._graph):
            self._master, self._graph = master, graph
            self._version += 1

    def _graph_text(self, socket):
        """Return the graph as a browser has chosen to see it; or None if it has it already, or if
        it is not laid out yet."""
        if socket.graph_sent == self._version:
            return None
        shown = feed.visible(self._graph, socket.options)
        structure = Structure(shown, socket.options["rankdir"])
        layout = self._layouts.get(structure.key)
        if layout is None:
            if structure.key not in self._being_laid_out:
                self._being_laid_out.add(structure.key)
                asyncio.ensure_future(self._lay_out(structure))
            return None
        self._layouts.move_to_end(structure.key)
        socket.graph_sent = self._version
        return feed.encode(
            {
                "t": "graph",
                "viewer": self.viewer,
                "tutorial": self._tutorial.is_dir(),
                "master": self._master,
                "graph": shown,
                "all_topics": [topic["name"] for topic in self._graph["topics"]],
                "layout": layout,
            }
        )

    async def _lay_out(self, structure):
        # One dot at a time: of a graph that changes faster, only what it is in the end is needed.
        async with self._dot:
            try:
                loop = asyncio.get_event_loop()
                layout = await loop.run_in_executor(None, structure.layout)
            except FileNotFoundError:
                layout = {
                    "error": "dot, which draws the graph, isn't installed: apt install graphviz"
                }
            except subprocess.CalledProcessError as error:
                layout = {"error": f"dot couldn't lay out the graph, and says: {error.stderr}"}
            except (OSError, subprocess.SubprocessError) as error:
                layout = {"error": f"dot couldn't lay out the graph: {error}"}
        self._being_laid_out.discard(structure.key)
        self._layouts[structure.key] = layout
        while len(self._layouts) > _LAYOUTS:
            self._layouts.popitem(last=False)

    def _tick(self):
        """Send each browser everything as it is now. What a slow one can't take, it never gets."""
        now = time.time()
        rows = self._listener.look(now)
        lines = list(self._listener.lines)
        state = {
            "t": "tick",
            "now": now,
            "rows": rows,
            "links": self._counts,
            "findings": findings(self._graph, self._counts, rows, self.viewer),
            "log_count": lines[-1][0] if lines else 0,
        }
        for socket in list(self.sockets):
            if socket.is_busy:
                continue
            graph = self._graph_text(socket)
            text = feed.encode({**state, "log": feed.log_since(lines, socket.log_sent)})
            socket.log_sent = state["log_count"]
            socket.send([graph, text] if graph else [text])
