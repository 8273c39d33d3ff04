#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs timers by a simulated clock: without one, with a fast one, and with one that jumps."""

import inspect
import re
import unittest

import rosgraph
import rospy
import rostest
from mrp_testing import log_line
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.nodes import pid_of, program
from mrp_testing.process import Process

CPP = ("/time/publisher_wall_cpp", "/time/publisher_steady_cpp")
PY = ("/time/publisher_steady_py",)
ROS = ("/time/publisher_ros_cpp", "/time/publisher_ros_py")
LOOPS = tuple(
    f"/time/loop_{kind}_{language}" for kind in ("rate", "sleep") for language in ("cpp", "py")
)
SUBSCRIBERS = ("/time/subscriber_cpp", "/time/subscriber_py")
ALL_LEVELS = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")

ROS_CPP, ROS_PY = ROS
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
    """Wait until each of the publishers has published so many more; return the number of lines."""
    for publisher in publishers:
        running.wait_for(
            lambda: len(published(running, publisher, begin)) >= count,
            f"{count} values of {publisher} after line {begin}",
        )
    return len(running.lines)


def times(line):
    """Return the wall's and the simulated time in a line, in seconds."""
    logged = log_line.parse(line)
    return logged.wall, logged.simulated


class TestTime(unittest.TestCase):
    def test_no_clock(self):
        with Lab("time_no_clock.launch") as running:
            for subscriber in SUBSCRIBERS:
                for publisher in CPP + PY:
                    running.wait_for_count(subscriber, 8, publisher)
            for publisher in ROS + LOOPS:
                # Alive, but all that it has said is on which topic it would publish; a loop has
                # published once, before its first sleep.
                self.assertIsNotNone(pid_of(publisher), publisher)
                first, *others = running.logged(publisher, ALL_LEVELS)
                self.assertIn("publishes std_msgs/UInt32 on /time/great_topic", first)
                self.assertEqual(others, ["published 1"] if publisher in LOOPS else [], publisher)
            self.assertIs(rosgraph.Master("/test_time").getParam("/use_sim_time"), True)
            self.assertNotIn("/clock", Graph().publishers)
            # It is the clock that was missing, and nothing else.
            with Process(program(PACKAGE, "lab_clock_py_node.py")):
                for subscriber in SUBSCRIBERS:
                    for publisher in ROS + LOOPS:
                        running.wait_until_received(subscriber, 2, publisher=publisher)

    def test_fast_clock(self):
        with Lab("time_fast_clock.launch") as running:
            begin = wait_until_published(running, CPP + PY + ROS, 1)
            end = wait_until_published(running, CPP + PY, 3, begin)
            slow = max(len(published(running, publisher, begin, end)) for publisher in CPP + PY)
            for publisher in ROS:
                # Ten times as many; but a busy machine may keep a timer from some.
                self.assertGreater(len(published(running, publisher, begin, end)), 4 * slow)
                lines = [line for line in running.lines[begin:end] if publisher + " " in line]
                first_wall, first_simulated = times(lines[0])
                last_wall, last_simulated = times(lines[-1])
                factor = (last_simulated - first_simulated) / (last_wall - first_wall)
                self.assertAlmostEqual(factor, 10, delta=3, msg=publisher)

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
