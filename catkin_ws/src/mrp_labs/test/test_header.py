#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sends headers: seq is overwritten on the way, and stamp arrives as it was set."""

import unittest

import rospy
import rostest
from mrp_labs.msg import Count
from mrp_testing.lab import PACKAGE
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import wait_until


def headers_on(test, topic):
    """Return a list, to which each header is added that somebody publishes on a topic."""
    headers = []
    subscriber = rospy.Subscriber(topic, Count, lambda msg: headers.append(msg.header))
    test.addCleanup(subscriber.unregister)
    return headers


class TestHeader(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_header")

    def test_header_py(self):
        headers = headers_on(self, "/count")
        publisher = rospy.Publisher("/count", Count, queue_size=10)
        self.addCleanup(publisher.unregister)
        wait_until(publisher.get_num_connections, "it is connected")
        for _ in range(3):
            msg = Count()
            msg.header.seq = 77
            publisher.publish(msg)
        wait_until(lambda: len(headers) == 3, lambda: f"three, not {headers}")
        self.assertEqual([header.seq for header in headers], [1, 2, 3])
        self.assertEqual([header.stamp for header in headers], [rospy.Time(0)] * 3)

    def test_header_cpp(self):
        headers = headers_on(self, "/great_topic")
        # It sets stamp, and leaves seq alone.
        node = (
            program(PACKAGE, "lab_publisher_cpp_node"),
            "_type:=mrp_labs/Count",
            "_period:=0.05",
        )
        with Process(*node, extra_env=LIVE):
            wait_until(lambda: len(headers) >= 3, lambda: f"three, not {headers}")
        numbers = [header.seq for header in headers]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))))
        self.assertNotIn(rospy.Time(0), [header.stamp for header in headers])


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "header", TestHeader)
