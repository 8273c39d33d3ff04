#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Waits for one message at a time: what's missed? And when does a publisher know who listens?"""

import contextlib
import signal
import unittest

import rospy
import rostest
from mrp_testing import log_line
from mrp_testing.clock import TurnedClock
from mrp_testing.lab import PACKAGE
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import within
from std_msgs.msg import UInt32

STILL = 0.5  # seconds
TURN = 10.0  # seconds of the turned clock: many periods of the idiom's loop


@contextlib.contextmanager
def publisher(latch=False):
    made = rospy.Publisher("/great_topic", UInt32, queue_size=10, latch=latch)
    try:
        yield made
    finally:
        made.unregister()


def listens(node, talker):
    """Wait until the idiom has a connection to the publisher."""
    node.wait_for(lambda: talker.get_num_connections() == 1, "the idiom listens")


def listens_no_more(node, talker):
    node.wait_for(lambda: talker.get_num_connections() == 0, "the idiom has unsubscribed")


def received(node, *values):
    """Wait until the idiom has logged these values, and no others."""
    wanted = [f"received {value}" for value in values]
    node.wait_for(lambda: len(log_line.texts(node.lines)) >= len(wanted), f"{wanted}")
    assert log_line.texts(node.lines) == wanted, str(node)


class TestWhoListens(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_who_listens")

    def each_idiom(self):
        """Yield the idiom in each language, and the clock by which its loop goes."""
        for executable in ("wait_for_message", "wait_for_message.py"):
            command = program(PACKAGE, executable)
            with TurnedClock() as clock, Process(command, extra_env=LIVE) as node:
                yield node, clock

    def test_what_comes_between_two_waits_is_lost(self):
        for node, clock in self.each_idiom():
            with publisher() as talker:
                listens(node, talker)
                talker.publish(1)
                received(node, 1)
                listens_no_more(node, talker)
                talker.publish(2)
                clock.turn_until(node, TURN, lambda: talker.get_num_connections() == 1)
                talker.publish(3)
                received(node, 1, 3)
                # Not by Ctrl-C: while it logs, rospy may not end.
                node.stop(signal.SIGKILL)

    def test_what_is_latched_comes_again(self):
        for node, clock in self.each_idiom():
            with publisher(latch=True) as talker:
                talker.publish(1)
                received(node, 1)
                clock.turn_until(node, TURN, lambda: len(log_line.texts(node.lines)) >= 2)
                # The loop is late after such a turn, and may not sleep before its next wait.
                self.assertEqual({*log_line.texts(node.lines)}, {"received 1"}, str(node))
                self.assertEqual(node.errors, [], str(node))

    def test_nobody_hears(self):
        for executable in ("latch", "latch.py"):
            command = (program(PACKAGE, executable), "great_topic:=nobody_hears")
            with Process(*command, extra_env=LIVE) as node:
                node.wait_for(lambda: log_line.texts(node.lines), "it has published")
                self.assertFalse(within(STILL, lambda: len(node.lines) > 1), str(node))
                # Not by Ctrl-C: while it logs, rospy may not end.
                node.stop(signal.SIGKILL)
            self.assertEqual(log_line.texts(node.lines), ["published 42"])
            self.assertEqual(node.errors, [])

    def test_timeout(self):
        with self.assertRaises(rospy.ROSException) as raised:
            rospy.wait_for_message("/nobody", UInt32, timeout=0.01)
        self.assertEqual(
            str(raised.exception), "timeout exceeded while waiting for message on topic /nobody"
        )


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "who_listens", TestWhoListens)
