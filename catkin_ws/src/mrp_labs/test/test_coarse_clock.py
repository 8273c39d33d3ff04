#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a loop that is faster than its clock: the test moves the clock ten periods at a time."""

import collections
import unittest

import rospy
import rostest
from mrp_testing import log_line
from mrp_testing.clock import TurnedClock
from mrp_testing.lab import PACKAGE, Lab

NODES = ("/coarse_clock/rate_cpp", "/coarse_clock/rate_py")
STEP = 1.0  # seconds; the loops have a period of 0.1
TURNS = 8


class TestCoarseClock(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_coarse_clock")

    def test_a_loop_faster_than_the_clock(self):
        with TurnedClock() as clock, Lab("loop_coarse_clock.launch", "clock:=false") as lab:

            def rounds(node):
                """Return how often the node has published at each time of the clock."""
                logged = filter(None, map(log_line.parse, list(lab.lines)))
                mine = (line for line in logged if line.text.startswith(f"{node} published "))
                return collections.Counter(line.simulated for line in mine if line.simulated)

            clock.begin(lab, len(NODES), STEP, lambda: all(map(rounds, NODES)))
            while min(len(rounds(node)) for node in NODES) < TURNS:
                before = {node: sum(rounds(node).values()) for node in NODES}
                # Twice at once, as the second sleep finds its time over.
                clock.turn_until(
                    lab,
                    STEP,
                    lambda: all(sum(rounds(node).values()) >= before[node] + 2 for node in NODES),
                )
            for node in NODES:
                self.assertEqual(set(rounds(node).values()) - {1}, {2}, rounds(node))


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "coarse_clock", TestCoarseClock)
