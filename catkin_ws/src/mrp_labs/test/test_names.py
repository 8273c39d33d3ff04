#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Starts two nodes with one name: who keeps running? And what does an anonymous name cost?"""

import contextlib
import re
import subprocess
import sys
import unittest

import rospy
import rostest
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.nodes import pid_of, program
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import wait_until

CPP, PY = "/one_name/publisher_cpp", "/one_name/publisher_py"
REASON = "[{}] Reason: new node registered with same name"
# A node that logs while it shuts down.
GOODBYE = (
    sys.executable,
    "-c",
    "import rospy; rospy.init_node('goodbye'); print('up');"
    "rospy.on_shutdown(lambda: rospy.loginfo('goodbye')); rospy.spin()",
)
DISABLED = "/rosout_disable_topics_generation"


def ended_by_name(lab, node):
    """Return the lines in which a node says that it ends because of its name."""
    return [line for line in list(lab.lines) if REASON.format(node) in line]


def has_ended(lab, node):
    """Return whether a node of a lab has ended by itself, with exit code 0."""
    pattern = rf"\[{node[1:]}-\d+\] process has finished cleanly"
    return any(re.fullmatch(pattern, line) for line in list(lab.lines))


def wait_until_published(lab, node, count):
    """Wait until a node has published so many messages more than now."""
    count += len(lab.logged(node))
    lab.wait_for(lambda: len(lab.logged(node)) >= count, f"{node} goes on")


@contextlib.contextmanager
def started_twice(*arguments, first=(), traceback=False):
    """Yield the lab, started, and once more beside it; arguments: of both, or of the first one."""
    both = {"extra_env": LIVE, "traceback": traceback}
    with Lab("one_name.launch", *arguments, *first, **both) as older:
        for node in (CPP, PY):
            wait_until_published(older, node, 3)
        with Lab("one_name.launch", *arguments, **both) as newer:
            yield older, newer


class Anonymous(Process):
    """The idiom with a number behind its name; it has printed its name by now.

    name, rate: what it prints
    """

    def __init__(self, executable, *arguments):
        super().__init__(program(PACKAGE, executable), *arguments, extra_env=LIVE)
        self.wait_for(self._printed, "its name")
        self.name, self.rate = self._printed().groups()
        wait_until(lambda: self.name in subscribers(), f"{self.name} subscribes")

    def _printed(self):
        return re.search(r": my name is (\S+), my rate is (\d+)$", "\n".join(self.lines), re.M)


def subscribers():
    return Graph().subscribers.get("/great_topic", [])


class TestNames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_names")

    def tearDown(self):
        if rospy.has_param(DISABLED):
            rospy.delete_param(DISABLED)

    def test_the_newer_ends_the_older(self):
        with started_twice("asked_once:=true") as (older, newer):
            for node in (CPP, PY):
                older.wait_for(lambda: has_ended(older, node), f"{node} ends")
                self.assertEqual(len(ended_by_name(older, node)), 1, str(older))
            for node in (CPP, PY):
                wait_until_published(newer, node, 3)
                self.assertEqual(ended_by_name(newer, node), [], str(newer))

    def test_a_line_of_log_of_the_older_ends_the_newer(self):
        with Process(*GOODBYE, extra_env=LIVE) as older:
            older.wait_for(lambda: older.lines, "the older one is up")
            with Process(*GOODBYE, extra_env=LIVE) as newer:
                for node in (older, newer):
                    self.assertEqual(node.wait(), 0)
                    self.assertEqual(len(ended_by_name(node, "/goodbye")), 1, str(node))

    def test_both_go_on_when_the_master_cannot_reach_the_older(self):
        with started_twice("asked_once:=true", first=["hostname:=no-such-host"]) as labs:
            for lab in labs * 2:
                for node in (CPP, PY):
                    wait_until_published(lab, node, 3)
                    self.assertEqual(ended_by_name(lab, node), [], str(lab))

    def test_respawned_nodes_end_each_other_for_ever(self):
        # Ctrl-C may find one that is just starting.
        with started_twice("respawn:=true", traceback=True) as labs:
            for lab in labs * 2:
                ends = len(ended_by_name(lab, CPP))
                lab.wait_for(lambda: len(ended_by_name(lab, CPP)) > ends, f"{CPP} ends again")

    def test_anonymous_name(self):
        rospy.set_param("/anonymous_name/rate", 5)
        self.addCleanup(rospy.delete_param, "/anonymous_name")
        for executable in ("anonymous_name", "anonymous_name.py"):
            with Anonymous(executable) as one, Anonymous(executable) as two:
                for node in (one, two):
                    self.assertRegex(node.name, r"^/anonymous_name_\d+(_\d+)?$")
                    self.assertEqual(node.rate, "1")
                self.assertNotEqual(one.name, two.name)

                kill = ("rosnode", "kill", "/anonymous_name")
                found = subprocess.run(kill, capture_output=True, text=True, check=False)
                self.assertIn("Unknown node(s):\n * /anonymous_name", found.stdout + found.stderr)
                self.assertEqual(found.returncode, 1)
                self.assertEqual({one.pid, two.pid}, {pid_of(one.name), pid_of(two.name)})

                with Anonymous(executable, "_rate:=7") as three:
                    self.assertEqual(three.rate, "7")
                with Anonymous(executable, "__name:=anonymous_name") as four:
                    self.assertEqual((four.name, four.rate), ("/anonymous_name", "5"))
                for node in (one, two, three, four):
                    if node.code is None:
                        self.assertEqual(node.stop(), 0, str(node))


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "names", TestNames)
