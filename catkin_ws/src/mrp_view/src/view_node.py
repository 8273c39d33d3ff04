#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Show the graph and the messages of a running system in a browser, live.

It listens to all topics, asks the master and the nodes what they know, and publishes nothing. It
needs no master to start: it waits for one.
"""

import argparse
import errno
import os
import pathlib
import signal
import sys

import rosgraph
import roslib.packages
import rospy
import tornado.ioloop
from mrp_view.graph import build, counts
from mrp_view.listener import Listener
from mrp_view.rpc import ERRORS
from mrp_view.server import View
from mrp_view.watcher import Watcher


def port_number(text):
    """Return the number of a port. Raises argparse.ArgumentTypeError for any other text."""
    if not text.isdecimal() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"expected a number from 0 to 65535; found '{text}'")
    return int(text)


# Options, not parameters: there may be no master yet to ask for parameters.
def options(arguments):
    parser = argparse.ArgumentParser(
        prog="view_node.py", description=__doc__.split("\n")[0], allow_abbrev=False
    )
    parser.add_argument(
        "--address",
        type=lambda text: text.strip("[]"),  # as a URL writes IPv6
        default="127.0.0.1",
        help="address to listen on; 0.0.0.0: on all",
    )
    parser.add_argument("--port", type=port_number, default=8765, help="0: any free port")
    parser.add_argument(
        "--name", action="append", default=[], help="additional host name that may request the page"
    )
    parser.add_argument(
        "--settle",
        type=float,
        default=2.0,
        help="subscribe once a topic has been stable for this long, in seconds",
    )
    parser.add_argument("--tutorial", default="", help="folder of the tutorial's pages")
    return parser.parse_args(arguments)


def forwarded_names(port):
    """Return the name under which GitHub Codespaces forwards a port: [] outside of it."""
    space = os.environ.get("CODESPACE_NAME")
    domain = os.environ.get("GITHUB_CODESPACES_PORT_FORWARDING_DOMAIN", "app.github.dev")
    return [f"{space}-{port}.{domain}"] if space else []


def url(address, port):
    """Return what to open in a browser of this machine. address: that the server listens on"""
    address = {"0.0.0.0": "127.0.0.1", "::": "::1", "": "127.0.0.1"}.get(address, address)
    return f"http://[{address}]:{port}/" if ":" in address else f"http://{address}:{port}/"


class ViewNode:
    def __init__(self, chosen):
        self.name = own_name()
        self.loop = tornado.ioloop.IOLoop.current()
        self.listener = Listener(chosen.settle)
        page = pathlib.Path(roslib.packages.get_pkg_dir("mrp_view")) / "page"
        self.view = View(
            self.name,
            self.listener,
            chosen.address,
            chosen.port,
            [*chosen.name, *forwarded_names(chosen.port)],
            page,
            pathlib.Path(chosen.tutorial or page / "none"),
        )
        self.watcher = Watcher(rosgraph.get_master_uri(), self.name, self.on_look)
        self.is_node = False
        self.ends = False
        self.fault = None

    def run(self):
        """Serve the page until Ctrl-C; return the exit code."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self.on_signal)
        self.view.start()
        self.watcher.start()
        print(f"Open {url(self.view.address, self.view.port)} (Ctrl-C ends it)", flush=True)
        self.loop.start()
        self.ends = True
        self.watcher.stop()
        rospy.signal_shutdown("the viewer ends")
        if self.fault:
            print(f"error: {self.fault}", file=sys.stderr)
            return 1
        return 0

    def on_signal(self, *_):
        self.loop.add_callback_from_signal(self.loop.stop)

    def on_shutdown(self):
        """Stop, called by rospy: it ends the node when another one takes its name."""
        if not self.ends:
            self.fault = (
                f"another node has taken the name {self.name}. "
                "Give one of the two another name: __name:=..."
            )
            self.loop.add_callback(self.loop.stop)

    def on_look(self, watcher):
        """Show what was seen, called after each look at the graph in the watcher's thread."""
        if watcher.master == "here" and not self.is_node:
            # Nothing of it may go to /rosout: it would be shown, and so on.
            rospy.init_node(self.name.rsplit("/", 1)[-1], disable_signals=True, disable_rosout=True)
            rospy.on_shutdown(self.on_shutdown)
            self.is_node = True
        if watcher.master == "ended":
            self.listener.end()
        if watcher.master == "here":
            try:
                self.listener.register_again(watcher.observation, watcher.proxy)
                self.listener.follow(watcher.observation)
            except ERRORS:
                pass  # gone again: the next look sees it
        master = {"state": watcher.master, "uri": watcher.master_uri, "why": watcher.why}
        with watcher.lock:
            self.listener.observe(watcher.observation)
            seen_graph, seen_counts = build(watcher.observation), counts(watcher.observation)
        self.loop.add_callback(self.view.show, master, seen_graph, seen_counts)


def own_name():
    """Return the node's name, as rospy resolves it once there is a master."""
    mappings = rosgraph.names.load_mappings(sys.argv)
    namespace = mappings.get("__ns", os.environ.get("ROS_NAMESPACE", "/"))
    return rosgraph.names.ns_join(
        rosgraph.names.make_global_ns(namespace), mappings.get("__name", "mrp_view")
    )


def main():
    chosen = options(rospy.myargv()[1:])
    try:
        node = ViewNode(chosen)
    except OSError as error:
        advice = "--address takes an address of this machine, such as 127.0.0.1"
        if error.errno == errno.EADDRINUSE:
            advice = (
                "Another viewer may be running; --port chooses another port: "
                'make view VIEW_OPTIONS="--port 8766"'
            )
        where = f"{chosen.address} port {chosen.port}"
        sys.exit(f"error: cannot listen on {where}: {error.strerror}. {advice}")
    sys.exit(node.run())


if __name__ == "__main__":
    main()
