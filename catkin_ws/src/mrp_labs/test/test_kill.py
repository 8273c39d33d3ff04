#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills nodes and masters: what keeps running, what recovers, and what doesn't?"""

import itertools
import os
import re
import signal
import unittest

import rosgraph
import rostest
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.master import master
from mrp_testing.nodes import pid_of
from mrp_testing.ports import free_port

PUBLISHERS = ("/kill/publisher_cpp", "/kill/publisher_py")
SUBSCRIBERS = ("/kill/subscriber_cpp", "/kill/subscriber_py")
WITNESSES = ("/kill/witness_cpp", "/kill/witness_py")
NODES = PUBLISHERS + SUBSCRIBERS
PAIRS = list(itertools.product(SUBSCRIBERS, PUBLISHERS))
WITNESS_PAIRS = list(itertools.product(WITNESSES, PUBLISHERS))
ENOUGH = 2  # values


def values(lab, subscriber, publisher):
    return list(map(int, lab.values(subscriber, publisher)))


def wait_for_more(lab, pairs):
    """Wait until each of these subscribers has received some more of its publisher."""
    before = {pair: len(values(lab, *pair)) for pair in pairs}
    for pair in pairs:
        lab.wait_for(
            lambda: len(values(lab, *pair)) >= before[pair] + ENOUGH,
            lambda: f"{pair}: more values than {values(lab, *pair)}",
        )


def breaks(lab, subscriber, publisher):
    """Return how often a value was not the one before plus one."""
    found = values(lab, subscriber, publisher)
    return sum(after != before + 1 for before, after in zip(found, found[1:]))


def pids(nodes, master_uri=None):
    return {node: pid_of(node, master_uri) for node in nodes}


def kill(lab, pid):
    """kill -9, and wait until roslaunch has said so."""
    os.kill(pid, signal.SIGKILL)
    died = rf"has died \[pid {pid}, exit code -9,"
    lab.wait_for(
        lambda: any(re.search(died, line) for line in list(lab.lines)),
        f"roslaunch says that {pid} has died",
    )


class TestKill(unittest.TestCase):
    def test_the_others_go_on(self):
        with Lab("kill.launch") as lab:
            wait_for_more(lab, PAIRS)
            pid = pids(NODES)
            kill(lab, pid["/kill/publisher_cpp"])
            wait_for_more(lab, [(subscriber, "/kill/publisher_py") for subscriber in SUBSCRIBERS])
            kill(lab, pid["/kill/subscriber_py"])
            wait_for_more(lab, [("/kill/subscriber_cpp", "/kill/publisher_py")])
            self.assertEqual([breaks(lab, *pair) for pair in PAIRS], [0, 0, 0, 0])
            # Nobody has taken the dead ones from the master's list.
            graph = Graph()
            self.assertEqual(graph.publishers["/kill/great_topic"], sorted(PUBLISHERS))
            self.assertEqual(graph.subscribers["/kill/great_topic"], sorted(SUBSCRIBERS))
            self.assertIsNone(pid_of("/kill/publisher_cpp"))
            self.assertIsNone(pid_of("/kill/subscriber_py"))

    def test_respawn(self):
        with Lab("kill.launch", "respawn:=true") as lab:
            wait_for_more(lab, PAIRS)
            for victim in NODES:
                pid = pid_of(victim)
                before = {pair: breaks(lab, *pair) for pair in PAIRS}
                kill(lab, pid)
                lab.wait_for(lambda: pid_of(victim) not in (None, pid), victim + " is back")
                wait_for_more(lab, PAIRS)
                for pair in PAIRS:
                    new = breaks(lab, *pair) - before[pair]
                    self.assertLessEqual(new, 1 if victim in pair else 0, f"{victim}: {pair}")
            for subscriber, publisher in PAIRS:
                # A publisher that is back begins again.
                found = values(lab, subscriber, publisher)
                fallen = [after for before, after in zip(found, found[1:]) if after < before]
                self.assertEqual(len(fallen), 1, f"{subscriber}: {found}")

    def test_master(self):
        port = free_port()
        uri = f"http://localhost:{port}"
        with master(port) as first, Lab(
            "kill_master.launch", extra_env={"ROS_MASTER_URI": uri}
        ) as lab:
            wait_for_more(lab, PAIRS + WITNESS_PAIRS)
            pid = pids(NODES + WITNESSES, uri)
            self.assertEqual(first.stop(), 0, str(first))
            self.assertFalse(rosgraph.is_master_online(uri))
            wait_for_more(lab, PAIRS + WITNESS_PAIRS)
            with master(port):
                wait_for_more(lab, PAIRS + WITNESS_PAIRS)
                for pair in PAIRS + WITNESS_PAIRS:
                    self.assertEqual(breaks(lab, *pair), 0, pair)
                self.check_who_never_reconnects(lab, pid)

    def check_who_never_reconnects(self, lab, pid):
        for subscriber in SUBSCRIBERS:
            kill(lab, pid[subscriber])
            lab.wait_for(
                lambda: sum("subscribes" in text for text in lab.logged(subscriber)) == 2,
                subscriber + " is back",
            )
        # New subscribers hear nothing of old publishers.
        before = {pair: len(values(lab, *pair)) for pair in PAIRS}
        wait_for_more(lab, WITNESS_PAIRS)
        for pair in PAIRS:
            self.assertEqual(len(values(lab, *pair)), before[pair], pair)

        # They hear new publishers, which old subscribers do not: there, no count begins again.
        for publisher in PUBLISHERS:
            kill(lab, pid[publisher])
        wait_for_more(lab, PAIRS)
        for pair in PAIRS:
            new = values(lab, *pair)[before[pair] :]
            self.assertEqual(new, list(range(new[0], new[-1] + 1)), pair)
            self.assertLess(new[0], values(lab, *pair)[before[pair] - 1], pair)
        for pair in WITNESS_PAIRS:
            self.assertEqual(breaks(lab, *pair), 0, pair)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "kill", TestKill)
