#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs loops instead of timers: which ones drift, and which call spinOnce too seldom?

The test itself moves the clock, and waits for the nodes each time: so nothing depends on how
fast the machine is.
"""

import unittest

import rospy
import rostest
from mrp_testing import log_line
from mrp_testing.clock import TurnedClock
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.nodes import receivers_of

STEP = 0.5  # seconds by which the clock is turned
MESSAGES = 63
PERIOD = 0.25  # seconds between two messages of the lab with spinOnce
TOPIC = "/loop_spin_once/great_topic"
QUEUE_SIZE = 4  # messages, of each subscriber
TURNS = 400  # ten times as many as it takes until the slow loop has missed messages


class TestLoop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_loop")

    def test_drift(self):
        keep, drift = (
            [f"/loop_drift/{kind}_{language}" for kind in kinds for language in ("cpp", "py")]
            for kinds in (("timer", "rate"), ("sleep",))
        )
        with TurnedClock() as clock, Lab("loop_drift.launch", "clock:=false") as lab:

            def least():
                """Return the number of messages of those that keep the period."""
                return min(len(times(lab, node)) for node in keep)

            clock.begin(lab, len(keep + drift), STEP, lambda: least() > 1)
            late = 4 * STEP
            while least() < MESSAGES:
                count = least()
                clock.turn(STEP)
                # A node that had no processor may have begun its period anew, half of it later.
                late += STEP * (clock.turn_until(lab, STEP, lambda: least() > count) - 1)
            # After so many messages, a node that drifts is later than that.
            self.assertLess(late, STEP * MESSAGES / 2, "the machine is too busy")

            for node in keep:
                # The first ones may come late, while the nodes still wait for the clock.
                begin, *others = times(lab, node)[2:MESSAGES]
                for number, time in enumerate(others, 1):
                    self.assertAlmostEqual(time - begin, number, delta=late, msg=node)
            for node in drift:
                # Half of the period more for each, or even more on a busy machine.
                found = times(lab, node)[2:]
                self.assertGreater(len(found), 2, node)
                for before, after in zip(found, found[1:]):
                    self.assertGreater(after - before, 1.5 - 0.01, node)

    def test_spin_once_too_seldom(self):
        publisher, often, seldom, python = (
            f"/loop_spin_once/{name}"
            for name in ("publisher_cpp", "often_cpp", "seldom_cpp", "subscriber_py")
        )
        with TurnedClock() as clock, Lab("loop_spin_once.launch") as lab:
            lab.wait_for(
                lambda: receivers_of(publisher, TOPIC) == sorted([often, seldom, python]),
                "all subscribers are connected",
            )
            clock.begin(lab, 4, PERIOD, lambda: lab.values(python))
            turns = 0
            while len(batches(lab.values(seldom))) <= 3:
                turns += 1
                self.assertLess(turns, TURNS, f"{seldom} misses nothing\n{lab}")
                count = len(lab.values(python))
                clock.turn(PERIOD)
                lab.wait_for_count(python, count + 1)
                # On a busy machine it may not have had a processor: its queue must not overflow.
                lab.wait_for_count(often, count + 2 - QUEUE_SIZE)
            for node in (often, python):
                self.assertEqual(len(batches(lab.values(node))), 1, f"{node}: a gap\n{lab}")
            # The last one may still be on its way to the console.
            for batch in batches(lab.values(seldom))[:-1]:
                self.assertEqual(len(batch), QUEUE_SIZE, str(lab))


def times(lab, node):
    """Return when a node published the messages 1, 2, 3, ... by the clock of the nodes."""
    logged = filter(None, map(log_line.parse, list(lab.lines)))
    found = [line for line in logged if line.text.startswith(f"{node} published ")]
    values = [int(line.text.split()[-1]) for line in found]
    assert values == list(range(1, len(values) + 1)), f"{node}: {values}"
    return [line.simulated or 0 for line in found]


def batches(texts):
    """Split values into runs in which each is the one before plus one."""
    result = []
    for value in map(int, texts):
        if not result or value != result[-1][-1] + 1:
            result.append([])
        result[-1].append(value)
    return result


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "loop", TestLoop)
