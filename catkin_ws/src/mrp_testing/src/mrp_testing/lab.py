# SPDX-License-Identifier: BSD-3-Clause
"""A lab under test: run with roslaunch as a student runs it, and read line by line."""

import collections
import re

import rosgraph
import roslib.packages

from mrp_testing import log_line
from mrp_testing.graph import Graph
from mrp_testing.process import Process

PACKAGE = "mrp_labs"

# The parameter that each Python node caches.
_CACHED = "/rosout_disable_topics_generation"

_RECEIVED = re.compile(
    r"(?P<node>/\S+) received (?P<value>.*) from (?P<publisher>/\S+?)"
    r"(?: in thread (?P<thread>\d+))?"
)

# How a Python node's traceback ends if Ctrl-C comes before it has started: the test ended the lab,
# and nothing is wrong with the node.
_ENDED_AT_ITS_START = re.compile(r"^KeyboardInterrupt|ROSInitException: init_node interrupted")

# A message that a subscriber has received. value: its text; thread: a number, or None.
Received = collections.namedtuple("Received", "value publisher thread")


def path_of(launch_file):
    """Return the path of one of the labs' launch files: see Lab."""
    return roslib.packages.find_resource(PACKAGE, launch_file)[0]


class Lab(Process):
    """A lab that runs, and the lines that it has printed so far.

    launch_file: such as "latch.launch"
    arguments: those of roslaunch, such as "period:=1"
    traceback: whether one belongs to the claim

    Use it in a `with`: on leaving without an error, the lab is ended as by Ctrl-C, unless it has
    ended by itself, and must end cleanly: with exit code 0, no traceback and no abort.
    """

    def __init__(self, launch_file, *arguments, extra_env=None, traceback=False):
        super().__init__("roslaunch", PACKAGE, launch_file, *arguments, extra_env=extra_env)
        self.traceback = traceback

    def __exit__(self, *exception):
        try:
            if exception[0] is None:
                code = self.stop() if self.code is None else self.wait()
                assert code == 0, f"exit code {code} of {self}"
                assert not any("lock_error" in line for line in self.lines), str(self)
                tracebacks = sum("Traceback" in line for line in self.lines)
                at_start = sum(bool(_ENDED_AT_ITS_START.search(line)) for line in self.lines)
                assert self.traceback or tracebacks <= at_start, str(self)
                self._forget()
            else:
                print(self)  # what it printed often says why
        finally:
            super().__exit__(*exception)

    def _forget(self):
        """Have the master forget the nodes that have ended.

        A Python node subscribes to a parameter, and never unsubscribes: so the master keeps the
        node's address. When a node of that name starts again, the master sends a shutdown to the
        old address. By then another node may have it, such as one of the next lab.
        """
        names = {line.text.split(" ")[0] for line in self._log_lines() if line.text.startswith("/")}
        for name in names - Graph().nodes:
            master = rosgraph.Master(name)
            try:
                master.unsubscribeParam(master.lookupNode(name), _CACHED)
            except rosgraph.MasterException:
                pass  # it does not know the node any more

    def logged(self, node, levels=("INFO",)):
        """Return the texts that a node has logged, each without the node's name in front."""
        texts = [line.text for line in self._log_lines() if line.level in levels]
        return [text[len(node) + 1 :] for text in texts if text.startswith(node + " ")]

    def _log_lines(self):
        return filter(None, map(log_line.parse, list(self.lines)))

    def received(self, node):
        """Return what a subscriber node has received: a list of Received."""
        result = []
        for line in self._log_lines():
            match = _RECEIVED.fullmatch(line.text)
            if match and match["node"] == node:
                result.append(Received(match["value"], match["publisher"], match["thread"]))
        return result

    def values(self, node, publisher=None):
        """Return the texts of the values that a subscriber node has received, of one publisher or
        of all."""
        return [r.value for r in self.received(node) if publisher in (None, r.publisher)]

    def wait_for_count(self, node, count, publisher=None):
        """Wait until a subscriber node has received that many values, whichever; return all that it
        has. The first ones of a publisher are lost to a subscriber that starts after it."""
        self.wait_for(
            lambda: len(self.values(node, publisher)) >= count,
            lambda: f"{node} received {count} values, not only {self.values(node, publisher)}",
        )
        return self.values(node, publisher)
