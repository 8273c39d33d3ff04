#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs timers by a simulated clock that jumps."""

import inspect
import re
import unittest

import rospy
import rostest
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.nodes import pid_of

ROS_CPP, ROS_PY = "/time/publisher_ros_cpp", "/time/publisher_ros_py"
RESET_PY = "/time/publisher_reset_py"
CLOCK = "/time/clock"
MOVED_BACKWARDS = "rospy.exceptions.ROSTimeMovedBackwardsException"
# From rospy 1.17.4 on, Debian 14's, a jump back ends no timer.
ENDS = "MovedBackwards" not in inspect.getsource(rospy.timer.Timer)


def published(running, publisher, begin=0, end=None):
    """Return the values that a publisher says it published, in some of the lab's lines."""
    found = (
        re.search(re.escape(publisher) + r" published (\d+)$", line)
        for line in running.lines[begin:end]
    )
    return [int(match[1]) for match in found if match]


def wait_until_published(running, publishers, count, begin=0):
    """Wait until each of the publishers has published so many more."""
    for publisher in publishers:
        running.wait_for(
            lambda: len(published(running, publisher, begin)) >= count,
            f"{count} values of {publisher} after line {begin}",
        )


class TestTime(unittest.TestCase):
    def test_jump(self):
        publishers = (ROS_PY, ROS_CPP, RESET_PY)
        with Lab("time_jump.launch", traceback=True) as running:
            wait_until_published(running, publishers, 1)

            def line_of(what):
                found = [i for i, line in enumerate(list(running.lines)) if what in line]
                return found[0] if found else None

            running.wait_for(lambda: line_of(CLOCK + " jumps 3600 s back"), "the jump back")
            if ENDS:
                running.wait_for(lambda: line_of(MOVED_BACKWARDS), "rospy's timer ends")
            end = len(running.lines)
            wait_until_published(running, publishers[ENDS:], 6, end)

            # Forward: all go on, but nobody publishes the 7200 values of an hour. When it is busy,
            # the clock may jump several times before rospy's timer sleeps at a jump back.
            forward = line_of(CLOCK + " jumps 3600 s forward")
            for publisher in publishers:
                count = len(published(running, publisher, forward, end))
                self.assertTrue(2 <= count < 1000, f"{publisher}: {count}")
                values = published(running, publisher)
                self.assertEqual(values, list(range(1, len(values) + 1)), publisher)
            # Back: rospy's timer has ended, and its node does not. A line of stdout may come in
            # after a later one of stderr.
            if ENDS:
                self.assertLessEqual(len(published(running, ROS_PY, end)), 1)
            self.assertIsNotNone(pid_of(ROS_PY))
            tracebacks = [line for line in running.lines if line.startswith("Traceback")]
            self.assertEqual(len(tracebacks), ENDS)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "time", TestTime)
